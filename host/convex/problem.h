/*
 * A convex problem in changes of a curve's control points and of its time.
 *
 * The curve is q(u), u in knots. Unknown are a change d(u) of the curve and y(u) = 1 + e(u), the
 * square of the rate at which it is passed, both cubic B-splines on the same knots; the first and
 * last three coefficients are 0. Then (warp of time, exact in e; products of d and e left out)
 *
 *     velocity      |q' + d' + q' e / 2|                                <= V
 *     acceleration  |q" + d" + q" e + q' e' / 2|                        <= A
 *     jerk          |q"' + d"' + q"' e + 3/2 q" e' + q' e" / 2| + J e/2 <= J
 *     tube          |N (q + d - closest point)|                                  <= P
 *
 * and the time is sum (1 - e / 2 + 3/8 e^2). The bound of jerk is the tangent of J / sqrt(y), which
 * is convex, so that a change of time alone never leads beyond the limits. Every row may be broken
 * at a price, so that there is a solution from wherever the trajectory is.
 *
 * The rows may also be on two images of the curve w that is changed, each with other weights: q + d
 * is then that of the motors in the rows of velocity, acceleration and jerk, and that of the tool
 * in those of the tube, with d linear in the changes of w and of time (image.h). An image's point j
 * follows from the points j ... j + 2 modes of w. And a tool may stray: up to two more curves have
 * balls of their own, and follow from the motors' by a row an axis (problem_swing).
 */
#ifndef TAKT_HOST_CONVEX_PROBLEM_H
#define TAKT_HOST_CONVEX_PROBLEM_H

#include <stdbool.h>
#include <stddef.h>

/* Points of w that decide one of an image: 1 + 2 modes. */
#define PROBLEM_MODES_MAX 2
#define PROBLEM_REACH_MAX (1 + 2 * PROBLEM_MODES_MAX)

/* Tools that stray, at most. */
#define PROBLEM_STRAYS 2

/* Derivatives that have limits. */
enum problem_form { FORM_VELOCITY, FORM_ACCELERATION, FORM_JERK, FORM_COUNT };

/* Two half knots, and up to four junctions of the path. */
#define CELL_BALLS 6
/* Of a stray tool likewise. */
#define STRAY_BALLS 4

/*
 * |N (offset + sum_k weight_k d_k)| <= radius, N = 1 - along along^T; along = 0: a ball about a
 * corner.
 */
struct problem_ball {
    double weight[4];
    double offset[3];
    double along[3];
    double radius_mm; /* 0: none */
};

/* What one interval between knots asks of the four control points that shape it, limits as 1. */
struct problem_cell {
    double now[3][FORM_COUNT];     /* of every axis: the derivative as it is */
    double time[3][FORM_COUNT][4]; /* what e changes of it */
    double feed_now[3];            /* the velocity as it is, over the feed */
    double feed_scale;             /* 1 / feed, knots; 0: no limit binds */
    struct problem_ball ball[CELL_BALLS];
};

/*
 * How the four control points of motors or tool change with the curve's and with e's: point, axis,
 * of which.
 */
struct problem_side {
    double by_curve[4][3][PROBLEM_REACH_MAX];
    double by_time[4][3][PROBLEM_REACH_MAX];
};

/* The row of one axis that says how a stray tool swings: its sum over the unknowns is 0. */
struct problem_swing {
    double by_own[3]; /* of the first three of the cell's control points of it */
    double
        by_curve[3 + 2 * PROBLEM_MODES_MAX]; /* of control points of w, from the cell's first on */
    double by_time[3 + 2 * PROBLEM_MODES_MAX];
};

/* A stray tool: where it may be, and how it comes there. */
struct problem_stray {
    struct problem_ball ball[STRAY_BALLS];
    struct problem_swing swing[3];
};

struct problem_map {
    struct problem_side motor, tool;
};

struct problem {
    size_t cells;              /* intervals of the curve */
    struct problem_cell *cell; /* owned by the caller */
    unsigned modes;            /* 0: motors, tool and curve are the same */
    struct problem_map *map;   /* of every cell if there are modes; owned by the caller */
    unsigned strays;           /* tools that stray */
    struct problem_stray (
        *stray)[PROBLEM_STRAYS]; /* of every cell if there are any; owned by the caller */
    size_t rest; /* control points before the last ones that stay as well, but for stray tools */
    double scale[3][FORM_COUNT]; /* 1 / limit, knots */
    bool timed;                  /* false: e = 0 */
};

/* Control points at either end of w that stay. */
static inline size_t problem_ends(const struct problem *p)
{
    return 3 + 2 * (size_t)p->modes;
}

/*
 * Unknowns of one control point: x, y, z of w, e, and x, y, z of each stray tool. What a tool does
 * goes with points of w before it: its point j is kept with point j + 2 modes of w, the last that
 * it goes with.
 */
static inline size_t problem_each(const struct problem *p)
{
    return 4 + 3 * (size_t)p->strays;
}

/* Unknowns of one cell: of four control points and of those that modes reach to. */
static inline size_t problem_unknowns(const struct problem *p)
{
    return problem_each(p) * (4 + 2 * (size_t)p->modes);
}

#endif
