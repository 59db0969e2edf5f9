/*
 * A point on a line that follows a target as closely as velocity, acceleration and jerk allow, and
 * never passes an end without being able to rest there: it then comes to rest on it, exactly.
 *
 * Its jerk is constant in each cycle, so the setpoints are samples of a curve that keeps the limits
 * everywhere; their differences are means of its derivatives and keep them too.
 */
#ifndef TAKT_SYNC_FOLLOWER_H
#define TAKT_SYNC_FOLLOWER_H

#include "sync/brake.h"

#include <stdbool.h>

struct follower_target {
    double x_mm;
    double v_mm_s;
    double a_mm_s2;
    double j_mm_s3;
};

/* The way it goes, 1 or -1, and the position that is not passed in it. */
struct follower_end {
    double sense;
    double x_mm;
};

enum follower_state {
    FOLLOWER_FOLLOWS,
    FOLLOWER_LANDS, /* comes to rest on the end, whatever the target does */
    FOLLOWER_STOPS  /* was told to come to rest, on the end too if it was landing there */
};

struct follower {
    double cycle_s;
    double gain_x, gain_v, gain_a; /* 1/s */
    struct brake_limits limits;
    struct brake_state at; /* at the end of the last cycle */
    enum follower_state state;
    double sense;       /* of coming to rest */
    struct brake brake; /* as if sense were 1 */
};

void takt_follower_init(struct follower *f, double cycle_s);

/* bandwidth_rad_cycle: of what the target has been filtered by; the follower is twice as fast. */
void takt_follower_tune(struct follower *f, double bandwidth_rad_cycle);

/* At rest at 0. */
void takt_follower_start(struct follower *f, const struct brake_limits *limits);

/* One cycle. target: at the end of the last one; its jerk in the middle of this one. */
void takt_follower_step(struct follower *f, const struct follower_target *target,
                        const struct follower_end *end);

/* Has it come to rest for good? */
static inline bool follower_rests(const struct follower *f)
{
    return f->state != FOLLOWER_FOLLOWS && brake_is_over(&f->brake);
}

/* From now on it comes to rest as fast as it can. */
void takt_follower_brake(struct follower *f);

#endif
