/*
 * Memory of the drives: only for sizeof. Nobody outside this room reads or writes a field.
 */
#ifndef TAKT_DRIVE_DRIVES_STATE_H
#define TAKT_DRIVE_DRIVES_STATE_H

#include "canopen/node.h"
#include "canopen/sdo_client.h"

/*
 * Setpoints remembered until the position they led to is reported; a power of two above
 * DRIVES_LATENCY_CYCLES.
 */
#define DRIVES_HISTORY 4

/* What happens in DRIVES_STARTING, in this order. */
enum drives_phase {
    DRIVES_BOOT,      /* nodes are reset; each says that it has booted */
    DRIVES_CONFIGURE, /* each is checked and configured over SDO */
    DRIVES_START,     /* nodes become operational, one a cycle: that staggers their event timers */
    DRIVES_ENABLE,    /* statuswords lead to "operation enabled" */
    DRIVES_SELECT, /* each shows the mode it is to be in: homing, or cyclic synchronous position */
    DRIVES_HOME    /* the axes of one order look for their home */
};

struct drives_axis {
    struct drives_config_axis config;
    uint16_t target_cob_id; /* of the RPDO2 that carries the target */
    uint8_t target_offset;  /* byte of the target in that frame */
    bool target_last;       /* the frame is complete with it */

    bool reset_pending;
    bool booted;       /* its boot-up message has come */
    bool started;      /* NMT start has been sent */
    bool heard;        /* a TPDO1 has come since it was started */
    uint32_t reported; /* cycle of the last TPDO1 */
    uint32_t beaten;   /* and of the last heartbeat */
    uint16_t statusword;
    int32_t actual_inc;
    double actual_mm;   /* the same */
    uint16_t emcy_code; /* last emergency; 0: none, or all gone */

    uint8_t mode;         /* that the drive is to be in */
    uint16_t command;     /* controlword beside what the state asks for: CIA402_START_HOMING or 0 */
    uint16_t controlword; /* last sent */
    int32_t target_inc;
    double lag_mm; /* following error of the last report before a fault */
    bool lost;     /* after a fault: its setpoints lead nowhere */
    bool homed;
    bool homing_seen;    /* the statusword has shown that homing is under way */
    int32_t braking_inc; /* where it was when its rest was looked at last */
    uint32_t rest_cycles;
};

struct drives {
    unsigned count;
    uint8_t node[AXIS_COUNT];
    uint32_t cycle_us;
    uint8_t controller_node;
    uint16_t heartbeat_ms;
    uint32_t heartbeat_cycles;      /* period */
    uint32_t heartless_most_cycles; /* without one from a drive */
    uint32_t start_timeout_cycles;
    uint32_t answer_timeout_cycles;
    uint32_t sdo_timeout_cycles;
    uint32_t stop_timeout_cycles;
    uint32_t brake_timeout_cycles;
    struct drives_axis axis[AXIS_COUNT];
    struct point actual; /* the actual_mm of all axes; 0 for axes without a drive */
    double sent_mm[DRIVES_HISTORY][AXIS_COUNT]; /* setpoints of cycle k at [k % DRIVES_HISTORY] */
    uint8_t axis_of_node[NODE_MAX + 1];         /* index into axis; AXIS_COUNT: not ours */

    enum drives_state state;
    uint32_t cycle;       /* counts drives_send; wraps */
    uint32_t beat_cycles; /* since our last heartbeat */

    enum drives_phase phase;
    uint32_t start_cycles; /* spent in DRIVES_STARTING, without homing */
    uint32_t phase_cycles; /* spent in the phase */
    unsigned at_axis;      /* that is being configured or asked */
    unsigned at_step;      /* of its configuration */
    unsigned repeats;      /* of the request under way */
    bool homed;            /* no axis is left to be homed */
    uint8_t home_order;    /* axes of this order are being homed; 0: not yet */
    struct sdo_client sdo;

    struct diagnostic fault;
    unsigned fault_axis;  /* index into axis of what the fault is about */
    uint32_t stop_cycles; /* spent in DRIVES_STOPPING or DRIVES_BRAKING */
    uint32_t rest_cycles; /* setpoints have not changed for */
};

#endif
