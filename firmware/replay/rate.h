/*
 * The rate at which a compiled curve is passed: 1 as compiled, 0 at rest, changed so that no axis
 * leaves its limits wherever on the curve that happens.
 *
 * With the place u(t), u' = r, an axis at x(u) has (derivatives of x by u)
 *
 *     velocity x' r,   acceleration x" r^2 + x' r',   jerk x"' r^3 + 3 x" r r' + x' r"
 *
 * The curve keeps |x'| <= V, |x"| <= k A, |x"'| <= k J, with k a little below 1. So for every place
 *
 *     V |r'| <= A (1 - k r^2)                             and
 *     3 A r |r'| + V |r"| <= J (1 - k r^3)
 *
 * are enough. Both follow from |r'| <= L (1 - k r^2) and V |r"| <= 0.4 J (1 - k r^3) with
 *
 *     L = min(A / V, J / (5 A), sqrt(J / (5 V)))          over all axes,
 *
 * and from anywhere within them r can be brought to rest without leaving them: along |r'| = L
 * (1 - k r^2) it is |r"| = 2 L^2 k r (1 - k r^2) <= 2 L^2 (1 - k r^3).
 */
#ifndef TAKT_REPLAY_RATE_H
#define TAKT_REPLAY_RATE_H

#include "base/maths.h"
#include "plan/limits.h"

#include <stdbool.h>

struct rate_limits {
    double kept;   /* k */
    double change; /* L, 1/cycle */
    double room;   /* 0.4 J / V, least of all axes, 1/cycle2 */
};

struct rate {
    struct rate_limits limits;
    double now;    /* r */
    double change; /* r', 1/cycle */
};

/* kept: the part of acceleration and jerk that the curve uses at most, < 1. */
void takt_rate_init(struct rate *r, const struct plan_limits *limits, double kept);

/* The axes stand where nothing of the curve moves: the rate may be anything at once. */
void takt_rate_set(struct rate *r, double to);

/*
 * One cycle towards the rate to, 0 ... 1. Returns how far on the curve it leads, in cycles of the
 * curve.
 */
double takt_rate_step(struct rate *r, double to);

/*
 * How much the change changes in a cycle on the way to the rate to: by room at most, and to a
 * change of most at most; landing: by which it can change when it comes there.
 */
double takt_rate_second(const struct rate *r, double to, double room, double landing, double most);

/* A cycle in which the change changes by second; returns how far on the curve it leads. */
double takt_rate_change_by(struct rate *r, double second);

/*
 * How far on the curve it leads to come to rest from the rate 1, in cycles of the curve, at most.
 */
double takt_rate_brake_cycles(const struct rate *r);

/*
 * The highest rate, up to 1, from which it comes to rest within this many cycles of the curve, 500
 * or more.
 */
double takt_rate_highest(const struct rate *r, double cycles);

/* Is it so near to the rate to that one cycle leads there? room: by which the change can change. */
static inline bool rate_settles(const struct rate *r, double to, double room)
{
    return maths_abs(to - r->now) <= 0.5 * room && maths_abs(r->change) <= room;
}

/* Does it stand? */
static inline bool rate_rests(const struct rate *r)
{
    return r->now == 0.0 && r->change == 0.0;
}

#endif
