/*
 * Replays a compiled program: setpoints out of its curve instead of out of the planner, in the same
 * control cycle.
 *
 *     intake (background) -> sections, intervals, block ends -> takt_replay_cycle -> setpoint
 *
 * struct motion hands over every motion (motion/handover.h) and does what happens at rest itself.
 * The place on the curve moves at the rate that rate.h allows.
 */
#ifndef TAKT_REPLAY_REPLAY_H
#define TAKT_REPLAY_REPLAY_H

#include "base/error.h"
#include "motion/motion.h"
#include "replay/halt.h"
#include "replay/intake.h"
#include "replay/rate.h"

#include <stdbool.h>
#include <stdint.h>

/* More intervals need not be there to go on: the ring holds no more. */
#define REPLAY_BRAKE_INTERVALS_MAX (INTAKE_INTERVALS_MAX - 2 * REPLAY_RECORD_INTERVALS)

/*
 * Where it is in the program. Single block: it stops at the end of a block that is passed without a
 * stop otherwise.
 */
enum replay_state {
    REPLAY_BETWEEN, /* sections: none is being executed */
    REPLAY_RUNS,
    REPLAY_STOP_AHEAD,   /* at stop_end */
    REPLAY_STOP_REACHED, /* the axes stand there */
    REPLAY_STOP_TOLD     /* and a record has said so */
};

struct replay {
    struct intake *intake;
    struct rate rate;
    struct halt halt;
    enum replay_state state;
    uint64_t stop_end;                     /* in parts of intervals from the section's start */
    struct intake_section section;         /* the one that is being executed */
    uint32_t interval;                     /* intervals of it that are over */
    uint32_t taken;                        /* intervals of it taken from the stream */
    double part;                           /* of the interval */
    int64_t control[4][AXIS_LINEAR_COUNT]; /* quanta */
    double quantum_mm;
    double step;     /* intervals in a cycle at the rate 1 */
    uint32_t blocks; /* of the section that are over */
    uint64_t begin;  /* of the block, in parts of intervals from the section's start */
    uint32_t
        brake_intervals; /* fewer than these and not the section's end: no more must be driven */
    double highest;   /* rate: from there it can be braked within what the rings hold of a stream */
    uint64_t starved; /* cycles in which that slowed the axes down */
    bool waits;       /* the axes stand because the stream is late; they go on by themselves */
    struct diagnostic alarm; /* TAKT_OK: none */
};

enum replay_result {
    REPLAY_CYCLE, /* the record holds this cycle */
    REPLAY_FAILED /* the axes stand, and alarm says why: no cycle was made */
};

/* intake: the caller's, for as long as it replays; no matter what is in it. */
void takt_replay_init(struct replay *r, struct intake *intake, const struct replay_source *source);

/*
 * Background: a move as it goes onto the path, of which the blocks alone are needed, not the feed
 * or the rounding.
 */
void takt_replay_prepare(struct move *move);

/* Background, as often as it likes. */
void takt_replay_read(struct replay *r, const struct plan_limits *limits);

/* Instead of takt_motion_cycle when that says MOTION_HANDED_OVER. */
enum replay_result takt_replay_cycle(struct replay *r, struct motion *m,
                                     const struct motion_operator *wanted,
                                     struct cycle_record *record);

#endif
