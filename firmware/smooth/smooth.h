/*
 * Smooths chains of motions within a tolerance (G64 P): curves in, pieces of one smooth curve out.
 * See README.md.
 *
 *     push -> [ route ] -> [ window of samples ] -> take
 *
 * Where the path as it is programmed is quicker, its motions are handed on between two rests.
 */
#ifndef TAKT_SMOOTH_SMOOTH_H
#define TAKT_SMOOTH_SMOOTH_H

#include "smooth/head.h"
#include "smooth/merge.h"
#include "smooth/relax.h"
#include "smooth/route.h"
#include "smooth/timing.h"
#include "smooth/verifier.h"
#include "smooth/window.h"
#include "smooth/worth.h"

#include <stdbool.h>
#include <stdint.h>

/* How fast nominal time may pass on a piece. */
struct smooth_rate {
    double most;       /* by the axes' limits: never exceeded */
    double programmed; /* at the programmed feed; infinite for a rapid */
};

/* How fast the rate of nominal time may change on a piece: 1/s, 1/s2. */
struct smooth_change {
    double by;
    double rounded;
};

/* What a piece ends with. */
enum smooth_end {
    SMOOTH_GOES_ON, /* the next one of the curve */
    SMOOTH_STOPS,   /* rest, though the chain goes on: no way on was found */
    SMOOTH_ENDS     /* the chain: rest, in the end of the last motion */
};

/*
 * A piece of curve: x(f) = sum of b_k(f) control[k], f = 0 ... 1 in interval_s of nominal time
 * (window.h).
 */
struct smooth_piece {
    const struct move *move; /* the motion it belongs to; valid until the next call */
    uint32_t number;         /* of that motion */
    struct point control[4];
    double interval_s;
    struct smooth_rate rate;
    struct smooth_change
        change; /* rounded over the same time in all pieces in which the axes move */
    enum smooth_end end;
    bool rotary;    /* no linear axis moves in that motion */
    bool starts;    /* begins at rest */
    bool continues; /* more of the motion that is told follows */
};

/* What has been taken. */
enum smooth_taken {
    /* more motions, or the chain's end, must come first, or the chain has been taken to its end */
    SMOOTH_NONE,
    SMOOTH_PIECE, /* a piece of the curve */
    /* a motion of the path itself: of the piece move, number, starts and continues count */
    SMOOTH_MOTION
};

/* What it computes with: holds nothing between calls. */
union smooth_scratch {
    struct relax relax;
    struct timing timing;
    union worth_work worth;
};

enum smooth_chain {
    SMOOTH_NO_CHAIN,
    SMOOTH_GROWS,   /* one has begun and not been taken to its end */
    SMOOTH_FINISHED /* nothing follows in it */
};

/* Do the axes stand before what comes next? */
enum smooth_standing {
    SMOOTH_STANDS_NOT,
    SMOOTH_STANDS_BEFORE, /* the next piece, or motion, begins at rest */
    SMOOTH_STANDS_BEHIND  /* the last piece has been taken, and a standing one ends the chain */
};

/* Before every place of the route. */
#define SMOOTH_NOWHERE_MM (-1.0)

struct smooth {
    struct smooth_limits limits;
    unsigned expected; /* axes that the next chain moves, by bit */
    /* from here to change nothing is kept while no chain is open */
    struct route route;
    struct window window;
    struct smooth_head head;
    struct merge merge; /* the newest line, not on the route yet */
    struct verifier_change change;
    /* where the pieces that are ready end; before there are any, where the window begins */
    struct order order;
    struct move move; /* of the piece taken last, */
    uint32_t told;    /* and its element: the latest one of the pieces taken */
    unsigned proved;  /* pieces at the window's beginning that keep the tolerance, as they were */
    double known_mm;  /* end of the route when the window was filled */
    /* to this place the path itself is taken, and on to where it rests; or SMOOTH_NOWHERE_MM */
    double exact_mm;
    struct worth_since since;
    enum smooth_standing standing;
    enum smooth_chain chain;
    unsigned ready; /* pieces that may be taken */
    unsigned taken; /* of them */
};

static inline bool smooth_is_open(const struct smooth *s)
{
    return s->chain != SMOOTH_NO_CHAIN;
}

static inline bool smooth_is_finished(const struct smooth *s)
{
    return s->chain == SMOOTH_FINISHED;
}

void takt_smooth_init(struct smooth *s, const struct smooth_limits *limits);
/* May this motion be part of a smooth chain? */
bool takt_smooth_takes(const struct move *move, const struct curve *curve);
/*
 * May it join the chain that is open? True when none is. False: the next chain is expected to begin
 * with it.
 */
bool takt_smooth_joins(struct smooth *s, const struct move *move, const struct curve *curve);
bool takt_smooth_has_room(const struct smooth *s);
/* Appends a motion. Needs room and takt_smooth_joins(). */
void takt_smooth_push(struct smooth *s, const struct move *move, uint32_t number,
                      const struct curve *curve);
/*
 * Is all of the chain so far one programmed line? If nothing follows there is nothing to smooth: no
 * curve is shorter, and what plans lines from rest to rest is quicker. It may be forgotten then.
 */
bool takt_smooth_is_line(const struct smooth *s);
/* Nothing follows in this chain: it ends at rest. */
void takt_smooth_finish(struct smooth *s);
/*
 * The next piece, or the next motion: that is a curve, its end the one of piece->move. scratch: no
 * matter what is in it.
 */
enum smooth_taken takt_smooth_take(struct smooth *s, union smooth_scratch *scratch,
                                   struct smooth_piece *piece, struct curve *curve);
/* Forgets the chain. */
void takt_smooth_end(struct smooth *s);
/* Forgets everything. */
void takt_smooth_reset(struct smooth *s);

#endif
