/*
 * Memory of the drives: only for sizeof. Nobody outside this room reads or writes a field.
 */
#ifndef TAKT_DRIVE_DRIVES_STATE_H
#define TAKT_DRIVE_DRIVES_STATE_H

#include "canopen/node.h"

/*
 * Setpoints remembered until the position they led to is reported; a power of two above
 * DRIVES_LATENCY_CYCLES.
 */
#define DRIVES_HISTORY 4

struct drives_axis {
    struct drives_config_axis config;
    uint16_t target_cob_id; /* of the RPDO2 that carries the target */
    uint8_t target_offset;  /* byte of the target in that frame */

    bool heard;             /* a TPDO1 has come since the drive booted */
    uint32_t silent_cycles; /* since the last TPDO1; 0: one came this cycle */
    uint16_t statusword;
    int32_t actual_inc;
    uint16_t emcy_code; /* last emergency; 0: none, or all gone */

    uint16_t controlword; /* last sent */
    int32_t target_inc;
    double sent_mm[DRIVES_HISTORY]; /* setpoint of cycle k at [k % DRIVES_HISTORY] */
};

struct drives {
    unsigned count;
    uint32_t start_timeout_cycles;
    uint32_t answer_timeout_cycles;
    struct drives_axis axis[AXIS_COUNT];
    uint8_t axis_of_node[NODE_MAX + 1]; /* index into axis; AXIS_COUNT: not ours */

    enum drives_state state;
    uint32_t cycle;         /* counts drives_send; wraps */
    uint32_t start_cycles;  /* cycles spent in DRIVES_STARTING */
    bool nmt_start_pending; /* nodes are waiting to be started */
    struct diagnostic fault;
    unsigned fault_axis; /* index into axis of what the fault is about */
};

#endif
