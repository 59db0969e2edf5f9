/*
 * Random chains of moves from a fixed seed, and setpoints verified by their differences: for tests
 * of planner and motion together. The families are chosen for what breaks planners: corners of any
 * angle, nearly collinear blocks, blocks shorter than a cycle, zigzags, arcs into arcs, helices,
 * arcs whose two radii differ.
 */
#ifndef TAKT_TESTS_RANDOM_CHAIN_H
#define TAKT_TESTS_RANDOM_CHAIN_H

#include "base/maths.h"
#include "plan/limits.h"
#include "program/move.h"

#include <stdint.h>
#include <string.h>

#define CHAIN_AXES 3

enum chain_family {
    CHAIN_CORNERS,
    CHAIN_NEARLY_COLLINEAR,
    CHAIN_POLYGON,
    CHAIN_TINY,
    CHAIN_ZIGZAG,
    CHAIN_ARCS,
    CHAIN_SPIRAL_ARCS,
    CHAIN_HELICES,
    CHAIN_MIXED
};

struct chain {
    uint64_t seed;
    struct point at; /* end of the moves made so far */
    double heading_rad;
};

static inline double chain_between(struct chain *c, double low, double high)
{
    c->seed = c->seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(c->seed >> 11) / 9007199254740992.0;
}

static inline double chain_decades(struct chain *c, double from, double to)
{
    return takt_maths_power(10.0, chain_between(c, from, to));
}

static inline struct move chain_line(struct chain *c, double length_mm, double rise_mm)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = chain_between(c, 0, 1) < 0.1 ? MOVE_RAPID : MOVE_FEED;
    m.feed_mm_s = chain_between(c, 0, 1) < 0.5 ? 100.0 : chain_between(c, 5, 105);
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    m.end = c->at;
    m.end.at[AXIS_X] += length_mm * takt_maths_cos(c->heading_rad);
    m.end.at[AXIS_Y] += length_mm * takt_maths_sin(c->heading_rad);
    m.end.at[AXIS_Z] += rise_mm;
    return m;
}

/*
 * An arc that leaves along the heading; its end may lie off the circle by a factor, and it may
 * rise.
 */
static inline struct move chain_arc(struct chain *c, double off_circle, double rise_mm)
{
    const double radius = chain_decades(c, -1, 2);
    const double sign = chain_between(c, 0, 1) < 0.5 ? -1.0 : 1.0;
    const double sweep = sign * maths_min(6.2, chain_decades(c, -2, 0.8));
    const double angle = c->heading_rad - sign * MATHS_HALF_PI + sweep;
    struct move m = chain_line(c, 0.0, rise_mm);

    m.kind = sign < 0 ? MOVE_ARC_CW : MOVE_ARC_CCW;
    m.centre_mm[0] = c->at.at[AXIS_X] - sign * radius * takt_maths_sin(c->heading_rad);
    m.centre_mm[1] = c->at.at[AXIS_Y] + sign * radius * takt_maths_cos(c->heading_rad);
    m.end.at[AXIS_X] = m.centre_mm[0] + radius * off_circle * takt_maths_cos(angle);
    m.end.at[AXIS_Y] = m.centre_mm[1] + radius * off_circle * takt_maths_sin(angle);
    c->heading_rad += sweep;
    return m;
}

static inline struct move chain_corner(struct chain *c)
{
    c->heading_rad = chain_between(c, 0, MATHS_TWO_PI);
    const double length = chain_decades(c, -3, 2);

    return chain_line(c, length, chain_between(c, -length, length));
}

static inline struct move chain_move_of(struct chain *c, enum chain_family family, unsigned number)
{
    switch (family) {
    case CHAIN_CORNERS:
        return chain_corner(c);
    case CHAIN_NEARLY_COLLINEAR:
        c->heading_rad += chain_between(c, -0.5, 0.5) * chain_decades(c, -6, -1);
        return chain_line(c, chain_decades(c, -3, 1), 0.0);
    case CHAIN_POLYGON:
        c->heading_rad += 0.001745;
        return chain_line(c, 0.035, 0.0);
    case CHAIN_TINY:
        c->heading_rad += chain_between(c, -0.005, 0.005);
        return chain_line(c, chain_decades(c, -4, -1), 0.0);
    case CHAIN_ZIGZAG:
        c->heading_rad += (number % 2 == 0 ? 1.0 : -1.0) * chain_decades(c, -5, -1);
        return chain_line(c, chain_between(c, 0.01, 0.31), 0.0);
    case CHAIN_ARCS:
        return chain_arc(c, 1.0, 0.0);
    case CHAIN_SPIRAL_ARCS:
        return chain_arc(c, chain_between(c, 0.999, 1.001), 0.0);
    case CHAIN_HELICES:
    case CHAIN_MIXED:
        break;
    }
    return chain_arc(c, 1.0, chain_between(c, -10, 10));
}

/* The next move of a chain; in the mixed family one of any other. */
static inline struct move chain_next(struct chain *c, enum chain_family family, unsigned number)
{
    const double any = family == CHAIN_MIXED ? chain_between(c, 0, 1) : 0.0;
    const struct move m = chain_move_of(
        c, family == CHAIN_MIXED ? (enum chain_family)(any * CHAIN_MIXED) : family, number);

    c->at = m.end;
    return m;
}

/* The largest ratios to the limits so far, of setpoints handed over one by one. */
struct chain_verifier {
    double history[AXIS_COUNT][4]; /* newest first */
    double velocity, acceleration, jerk;
};

static inline void chain_verifier_axis(struct chain_verifier *seen,
                                       const struct plan_limits *limits, int axis, double x)
{
    const double t = limits->cycle_s;
    double *h = seen->history[axis];

    memmove(h + 1, h, 3 * sizeof(*h));
    h[0] = x;
    const double v = maths_abs(h[0] - h[1]) / t;
    const double a = maths_abs(h[0] - 2 * h[1] + h[2]) / (t * t);
    const double j = maths_abs(h[0] - 3 * h[1] + 3 * h[2] - h[3]) / (t * t * t);

    seen->velocity = maths_max(seen->velocity, v / limits->velocity_mm_s[axis]);
    seen->acceleration = maths_max(seen->acceleration, a / limits->acceleration_mm_s2[axis]);
    seen->jerk = maths_max(seen->jerk, j / limits->jerk_mm_s3[axis]);
}

static inline void chain_verifier_setpoint(struct chain_verifier *seen,
                                           const struct plan_limits *limits,
                                           const struct point *cmd)
{
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        if (axis < CHAIN_AXES || (limits->axes & 1U << axis) != 0) {
            chain_verifier_axis(seen, limits, axis, cmd->at[axis]);
        }
    }
}

#endif
