/*
 * Threads and rigid tapping: the axes follow the spindle's measured angle.
 *
 *     encoder -> angle.h -> lead_in.h (what position belongs to the angle) -> follower.h (limits) -> setpoint
 *
 * struct motion stops before a block that follows the spindle and hands it over
 * (motion/handover.h); takt_spindle_sync_cycle executes it, and hands back at its end. See
 * README.md.
 */
#ifndef TAKT_SYNC_SPINDLE_SYNC_H
#define TAKT_SYNC_SPINDLE_SYNC_H

#include "base/error.h"
#include "hal/inputs.h"
#include "motion/motion.h"
#include "sync/angle.h"
#include "sync/chain.h"
#include "sync/follower.h"
#include "sync/lead_in.h"
#include "sync/tap.h"

#include <stdbool.h>
#include <stdint.h>

/* Slower than this, the spindle stands. */
#define SPINDLE_SYNC_STANDS_RPM 1.0

struct spindle_sync_config {
    double cycle_s;
    /* from the reading of an angle to the axes' being at that cycle's setpoint; >= 1 */
    double ahead_cycles;
    double tolerance_mm; /* farther off the angle than this is an alarm; > 0 */
    double counts;       /* of the encoder in a revolution; > 0 */
    double ramp_rpm_s;   /* of the spindle's drive; > 0 */
    double max_rpm;      /* of the spindle; 0: no limit */
    double wait_s;       /* longest wait for the spindle to turn as commanded; > 0 */
};

enum spindle_sync_phase {
    SPINDLE_SYNC_IDLE,
    SPINDLE_SYNC_WAITS,   /* for the spindle to turn at its speed */
    SPINDLE_SYNC_FOLLOWS, /* first for the zero angle */
    SPINDLE_SYNC_RETURNS  /* tapped: for the spindle to turn as before */
};

struct spindle_sync {
    struct spindle_sync_config config;
    struct angle angle;
    const struct spindle_feedback *spindle; /* of this cycle */
    enum spindle_sync_phase phase;
    double sense;   /* 1: clockwise */
    uint32_t stood; /* cycles before the spindle was looked at */
    uint64_t waited;
    struct chain chain;
    struct chain_leg at;    /* of the setpoint */
    struct chain_leg ahead; /* of the angle */
    struct lead_in lead_in;
    struct follower follower;
    struct tap tap;
    double before_rpm; /* commanded before tapping */
    bool commands;     /* in this cycle */
    double command_rpm;
    uint32_t next_block; /* a thread that begins with this block goes on with this zero angle */
    double next_zero_rev;
    struct diagnostic alarm; /* TAKT_OK: none */
};

enum spindle_sync_result {
    SPINDLE_SYNC_CYCLE, /* the record holds this cycle */
    SPINDLE_SYNC_FAILED /* the axes stand, and alarm says why: no cycle was made */
};

void takt_spindle_sync_init(struct spindle_sync *l, const struct spindle_sync_config *config);

/* A new program: what was being executed is forgotten, the spindle goes on turning. */
void takt_spindle_sync_restart(struct spindle_sync *l);

/*
 * Every control cycle, whatever the axes do. spindle: as long as takt_spindle_sync_cycle is called
 * in it.
 */
static inline void spindle_sync_measure(struct spindle_sync *l,
                                        const struct spindle_feedback *spindle)
{
    l->spindle = spindle;
    l->commands = false;
    angle_measure(&l->angle, spindle->angle_rev);
}

/*
 * Instead of takt_motion_cycle when that says MOTION_HANDED_OVER. commanded_rpm: of the spindle,
 * signed.
 */
enum spindle_sync_result takt_spindle_sync_cycle(struct spindle_sync *l, struct motion *m,
                                                 const struct motion_operator *wanted,
                                                 double commanded_rpm, struct cycle_record *record);

/* Does this cycle command the spindle? Then *rpm is the speed, signed. */
static inline bool spindle_sync_get_command(const struct spindle_sync *l, double *rpm)
{
    if (l->commands) {
        *rpm = l->command_rpm;
    }
    return l->commands;
}

#endif
