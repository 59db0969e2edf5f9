/*
 * A feed hold on a smoothed curve, and the start after it: as quickly as the axes can at each place of the curve.
 *
 * The place on the curve u, in pieces, moves by its rate r = u', its change q = r' and a constant w = q' in each cycle:
 *
 *     rate |‾‾‾\                 change q |   ___
 *          |    \                         |\_/   \  /     w: the hardest that leaves a way back to a constant rate
 *          |     \___                     |       \/
 *          +------------ time             +------------ time
 *
 * See hold.c. Rates are pieces/cycle, changes pieces/cycle2, w pieces/cycle3.
 */
#ifndef TAKT_MOTION_HOLD_H
#define TAKT_MOTION_HOLD_H

#include "motion/reference.h"
#include "plan/path.h"

#include <stdbool.h>
#include <stdint.h>

/* Pieces of the curve that are looked at, from the setpoint's on. */
#define HOLD_PIECES_MAX 24

/* Derivatives of a piece, by axis: mm (rad) per piece and per piece^2. The second one is linear between its ends. */
struct hold_piece {
    float first[AXIS_COUNT];
    float second[2][AXIS_COUNT];
    float top; /* its highest rate, whatever the overrides are: pieces a cycle */
};

/* Where the setpoint is, in pieces from the start of a block, and how it moves. */
struct hold_state {
    double at;
    double rate;
    double change;
};

/*
 * How it goes on if nothing better is found: the change goes by -ease to -peak, if that is not 0, and by ease to 0. ease 0: no way
 * has been found yet, and there is no peak.
 */
struct hold_ending {
    double ease;
    double peak;
};

struct hold {
    unsigned axes; /* those of the machine, one after the other */
    uint8_t axis[AXIS_COUNT];
    float velocity[AXIS_COUNT]; /* mm (rad) per cycle, cycle2 and cycle3 */
    float acceleration[AXIS_COUNT];
    float jerk[AXIS_COUNT];
    uint32_t block; /* of the path, at whose start place.at is 0 */
    uint32_t end;   /* the pieces of the blocks from it on to this one are known */
    bool whole;     /* and no further piece goes on with the curve */
    double length;  /* path units of a piece */
    float per_mm_s; /* pieces a cycle for mm/s of path */
    uint32_t clear; /* blocks from the first to before this one are fast enough for the rate */
    struct hold_state place;
    double moved; /* pieces, in the last cycle */
    struct hold_ending ending;
    float most;        /* no higher does the rate get in coming to rest */
    float step;        /* the hardest w that was found last, in parts of the hardest the axes can */
    unsigned turn;     /* counts cycles */
    unsigned refusals; /* of the trapezoidal reference, in this cycle */
    bool stops;        /* it was to stop in the last cycle */
    double top;        /* rate that the curve was made for, or more */
    struct hold_piece piece[HOLD_PIECES_MAX];
};

/*
 * Can it take over in this cycle, and slow down? The setpoint is at a position of the path's first block, path units, and
 * has been moved by these ways in the last two cycles. anew: it was not asked in the last cycle. Some pieces ahead are
 * read each time, so that it may be able to in a later cycle.
 */
bool takt_hold_begin(struct hold *h, const struct path *path, const struct reference *l, double at,
                     const double way[2], bool anew);

/* One cycle: slows down as hard as it can, or speeds up. False: it cannot go on by itself; the rate is constant. */
bool takt_hold_step(struct hold *h, const struct path *path, const struct reference *l, bool stop);

/* Path units from the start of its block, and in a cycle. */
static inline double hold_at(const struct hold *h)
{
    return h->place.at * h->length;
}

static inline double hold_way(const struct hold *h)
{
    return h->place.rate * h->length;
}

#endif
