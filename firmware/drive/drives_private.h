/*
 * Shared by the sources of this room.
 */
#ifndef TAKT_DRIVE_DRIVES_PRIVATE_H
#define TAKT_DRIVE_DRIVES_PRIVATE_H

#include "canopen/cia402.h"
#include "drive/drives.h"

/* TPDO1: statusword and actual position. TPDO2, error code and following error, is of the same length. */
#define DRIVES_STATUS_LENGTH 6

/* Period of TPDO2. */
#define DRIVES_EVENT_MS 100

/*
 * A fault of the drive at this index: ends DRIVES_STARTING and DRIVES_ENABLED. The first fault stays, since what
 * follows is its consequence. meaning: of the value, a constant; NULL: it has none.
 */
void drives_raise(struct drives *d, unsigned index, enum takt_error error, double value,
                  const char *meaning);
/* The same about an object of the drive. */
void drives_raise_object(struct drives *d, unsigned index, uint32_t object, enum takt_error error,
                         double value, const char *meaning);
/* An emergency or error code has come after the statusword that told of the fault: it completes the diagnostic. */
void drives_complete_fault(struct drives *d, unsigned index, uint16_t code);

/* DRIVE_FAULT, by the code of an emergency; EMCY_NONE: none has come. */
void drives_raise_reported(struct drives *d, unsigned index, uint16_t code);

/* Drives are enabled and watched: in operation, and while axes are homed. */
bool drives_are_watched(const struct drives *d);

/* Setpoints cannot be followed any more: DRIVES_BRAKING. */
void drives_brake(struct drives *d);
/* A cycle of DRIVES_STOPPING, with its setpoints, and one of DRIVES_BRAKING. */
void drives_watch_stop(struct drives *d);
void drives_watch_brakes(struct drives *d);

/* For people: a rotary axis in degrees. */
double drives_axis_shown(const struct drives_axis *axis, double value_mm);
bool drives_axis_is_enabled(const struct drives_axis *axis);
double drives_cycles_ms(const struct drives *d, uint32_t cycles);

/* Setpoints of all drives, of so many cycles ago: mm or rad. */
static inline const double *drives_sent(const struct drives *d, unsigned ago)
{
    return d->sent_mm[(d->cycle - ago) & (DRIVES_HISTORY - 1)];
}

/* Cycles since the last TPDO1, 0: one came in this cycle; and since the last heartbeat. */
static inline uint32_t drives_silent_cycles(const struct drives *d, const struct drives_axis *axis)
{
    return d->cycle - axis->reported;
}
static inline uint32_t drives_heartless_cycles(const struct drives *d,
                                               const struct drives_axis *axis)
{
    return d->cycle - axis->beaten;
}

/* A cycle of DRIVES_STARTING after its frames have been received. */
void drives_start(struct drives *d);
/* A drive has booted while the drives are being started. */
void drives_start_again(struct drives *d, unsigned index);
void drives_enter_phase(struct drives *d, enum drives_phase phase);

/*
 * What a drive is asked and told before it is started: number counts from 0, whole drive by whole drive. False: there
 * are no more.
 */
struct drives_step {
    uint32_t object; /* SDO_OBJECT */
    uint8_t length;  /* bytes to write; 0: it is read */
    bool optional;   /* a drive may lack it */
    uint32_t value;  /* to write */
};
bool drives_find_step(const struct drives *d, unsigned index, unsigned number,
                      struct drives_step *step);
/* True: a drive may answer a reading step like this. Else the fault has been raised. */
bool drives_accept(struct drives *d, unsigned index, const struct drives_step *step,
                   uint32_t value);

/* A cycle of the phases DRIVES_SELECT and DRIVES_HOME. */
void drives_select(struct drives *d);
void drives_home(struct drives *d);
/* The next order of axes that are homed; none: all drives are ready. */
void drives_home_next(struct drives *d);

/* Enabled, and neither reports nor heartbeats have ceased. */
static inline bool drives_is_linked(const struct drives *d, const struct drives_axis *axis)
{
    return cia402_is_enabled(axis->statusword) &&
           drives_silent_cycles(d, axis) <= d->answer_timeout_cycles &&
           drives_heartless_cycles(d, axis) <= d->heartless_most_cycles;
}

/* Supervision, once a cycle. */
void drives_check_operation(struct drives *d);
/* The same as far as it concerns drives that hold a position while others are homed. True: no fault. */
bool drives_check_links(struct drives *d, unsigned index);

#endif
