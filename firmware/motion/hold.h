/*
 * A feed hold on a smoothed curve or an arc, and the start after it: as quickly as the axes can at
 * each place of the curve.
 *
 * The place on the curve u, in pieces, moves by its rate r = u', its change q = r' and a constant
 * w = q' in each cycle:
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
#include <stddef.h>
#include <stdint.h>

/* Pieces of the curve that are looked at, from the setpoint's on: at most, and at least. */
#define HOLD_PIECES_MAX 24
#define HOLD_PIECES_MIN 8

/*
 * So often are pieces looked at in a cycle, at most: what was found before can always be gone on
 * with. Beside a piece as a whole an axis on it counts, one that is read, and the trapezoidal
 * reference, as it takes them time.
 */
#define HOLD_LOOKED_MAX          320
#define HOLD_LOOKED_BY_AXIS      2
#define HOLD_LOOKED_BY_WAY       3
#define HOLD_LOOKED_BY_READING   15
#define HOLD_LOOKED_BY_REFERENCE 25

/*
 * A piece is stored as its derivatives, by axis: mm (rad) per piece, and per piece^2 where it
 * begins and where it ends; the second one is linear between. Behind them its highest rate,
 * whatever the overrides are: pieces a cycle; and of all axes the most of x'/V, x'/A, x''/A, x'/J,
 * x''/J and x'''/J, anywhere on it.
 *
 *     first[axes] | second[axes] | second_end[axes] | top | most[HOLD_BOUNDS]
 */
#define HOLD_BOUNDS 6
static inline size_t hold_stride(unsigned axes)
{
    return 3 * (size_t)axes + 1 + HOLD_BOUNDS;
}

/* Where the setpoint is, in pieces from the start of one, and how it moves. */
struct hold_state {
    double at;
    double rate;
    double change;
};

/*
 * How it goes on if nothing better is found: the change goes by -ease to -peak and stays there
 * until the rate is that from which it goes by ease to 0; where there is no peak it goes there at
 * once. ease 0: no way has been found yet.
 */
struct hold_ending {
    double ease;
    double peak;
};

struct hold {
    unsigned axes;   /* those of the machine, one after the other */
    unsigned pieces; /* that there is room for: */
    float *store;    /* the caller's memory */
    uint8_t axis[AXIS_COUNT];
    float velocity[AXIS_COUNT]; /* mm (rad) per cycle, cycle2 and cycle3 */
    float acceleration[AXIS_COUNT];
    float jerk[AXIS_COUNT];
    /* 0: pieces are the path's blocks; else so many parts of one block, counted from its start: */
    uint32_t parts;
    uint32_t within;
    float part_top; /* the highest rate there */
    uint32_t here;  /* the piece at whose start place.at is 0 */
    uint32_t end;   /* the pieces from it on to before this one are known */
    double length;  /* path units of a piece */
    float per_mm_s; /* pieces a cycle for mm/s of path */
    /* axes that an arc turns, among those above, and by how much on a piece: a line by 0 */
    uint8_t plane[2];
    float turn_cos, turn_sin;
    float off_second; /* derivatives of an arc differ from those of its pieces by this at most */
    float off_third;
    /* pieces from the first to before this one are fast enough for this rate */
    uint32_t clear;
    float clear_rate;
    struct hold_state place;
    double moved; /* pieces, in the last cycle */
    struct hold_ending ending;
    float most;        /* no higher does the rate get in coming to rest */
    float step;        /* the hardest w that was found last, in parts of the hardest the axes can */
    unsigned turn;     /* counts cycles */
    unsigned looked;   /* so often, in this cycle */
    unsigned refusals; /* of the trapezoidal reference, in this cycle */
    bool stops;        /* it was to stop in the last cycle */
    double top;        /* rate that the curve was made for, or more */
};

/* Are pieces the path's blocks? */
static inline bool hold_is_smooth(const struct hold *h)
{
    return h->parts == 0;
}

/* Piece k, if it is known. */
static inline const float *hold_piece(const struct hold *h, uint32_t k)
{
    return h->store + (k % h->pieces) * hold_stride(h->axes);
}

/*
 * Before it is asked for the first time: the axes, and memory for pieces. False: that is too
 * little.
 */
bool takt_hold_prepare(struct hold *h, const struct plan_limits *limits, float *store,
                       size_t floats);

/*
 * Can it take over in this cycle, and slow down? The setpoint is at a position of the path's first
 * block, path units, and has been moved by these ways in the last two cycles. Some pieces ahead are
 * read each time, so that it may be able to in a later cycle.
 */
bool takt_hold_begin(struct hold *h, struct path *path, const struct reference *l, double at,
                     const double way[2]);

/*
 * One cycle: slows down as hard as it can, or speeds up. False: it cannot go on by itself; the rate
 * is constant.
 */
bool takt_hold_step(struct hold *h, struct path *path, const struct reference *l, bool stop);

/* Path units from the start of its piece, and in a cycle. */
static inline double hold_at(const struct hold *h)
{
    return h->place.at * h->length;
}

static inline double hold_way(const struct hold *h)
{
    return h->place.rate * h->length;
}

#endif
