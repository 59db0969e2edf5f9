/*
 * What happens in a drive, as it happens: for logs.
 */
#ifndef TAKT_SERVO_DRIVE_EVENT_H
#define TAKT_SERVO_DRIVE_EVENT_H

#include <stdint.h>

enum drive_event_kind {
    DRIVE_EVENT_BOOT,      /* boot-up message sent */
    DRIVE_EVENT_NMT,       /* first: enum nmt_state, the new one */
    DRIVE_EVENT_STATE,     /* first, second: enum takt_cia402_state, from and to */
    DRIVE_EVENT_MODE,      /* first: mode of operation */
    DRIVE_EVENT_EMCY,      /* first: error code, 0: all gone; second: error register */
    DRIVE_EVENT_PDO,       /* first: 1400 ... or 1800 ...; second: its COB-ID, as set */
    DRIVE_EVENT_SDO_ABORT, /* first: object; second: abort code */
    DRIVE_EVENT_SETPOINT,  /* first: a new target of profile position, increments */
    DRIVE_EVENT_HOMING,    /* first: 0 begun, 1 attained, 2 interrupted, 3 failed; second: method */
    DRIVE_EVENT_PROBE, /* first: touch probe, 1 or 2; second: increments that have been latched */
    DRIVE_EVENT_TIME,  /* first: ms since midnight; second: days since 1984 */
    /* first: line of the fault script that takes effect; second: enum inject_kind */
    DRIVE_EVENT_FAULT,
    DRIVE_EVENT_FAULT_END /* the same, it ends */
};

struct drive_event {
    enum drive_event_kind kind;
    uint64_t time_ns; /* since the drive was switched on */
    uint8_t node;
    uint32_t first, second;
};

struct drive_observer {
    void (*on_event)(void *context, const struct drive_event *event);
    void *context;
};

#endif
