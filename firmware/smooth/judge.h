/*
 * What a piece of the curve needs of the axes, and whether it is within the tolerance.
 */
#ifndef TAKT_SMOOTH_JUDGE_H
#define TAKT_SMOOTH_JUDGE_H

#include "smooth/window.h"

/* Most of |dx/du|, |d2x/du2|, |d3x/du3| on a piece, u in s of nominal time; by slot. */
struct judge_need {
    float first[AXIS_COUNT];
    float second[AXIS_COUNT];
    float third[AXIS_COUNT];
    float feed_mm_s; /* along the path: over X, Y, Z, or over A, B, C where only they move */
};

/* How fast nominal time should pass on a piece: what it is timed by. */
struct judge_rate {
    float
        most; /* at which the axes have just all left that a change of the rate takes everywhere */
    float programmed; /* at the programmed feed; infinite for a rapid */
};

/*
 * How fast the rate r of nominal time may change on every piece, 1/s: by at its full rate, still where it stands, and
 * by r^2 + still (1 - r^2) between, since a curve needs x" r^2 of the acceleration.
 */
struct judge_change {
    double by;
    double still;
    double rounded;    /* by: 1/s2 */
    double rounding_s; /* over which it is rounded */
};

/* What a machine's axes are left for changes of rate. */
void judge_change(const struct smooth_limits *limits, struct judge_change *change);
void judge_need(const struct window *w, const struct route *r, unsigned piece,
                struct judge_need *need);
/* The highest rate, 1 at most, at which a piece leaves every axis something for changes of it: never exceeded. */
float judge_most(const struct judge_need *need, const struct route *r,
                 const struct judge_change *change);
/*
 * How fast the rate may change on a piece while it is not above a rate, 1/s: by a power of two times what it may on all, so
 * that neighbours mostly have the same.
 */
float judge_change_on(const struct judge_need *need, const struct route *r,
                      const struct judge_change *change, float rate);
void judge_rate(const struct judge_need *need, const struct route *r, uint32_t element,
                const struct judge_change *change, struct judge_rate *rate);
/* Pieces from the first one on, count at most, that keep the tolerance and pass their corners within it. */
unsigned judge_pieces(const struct window *w, const struct route *r, unsigned count);
/* Of the first count of these, those that pass every corner beside them without the pieces behind, which may change. */
unsigned judge_whole(const struct window *w, const struct route *r, unsigned count);

#endif
