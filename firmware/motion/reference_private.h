/*
 * What the parts of the trapezoidal reference share: reference.c moves it, reference_feed.c finds
 * the feed, reference_halt.c where to halt, reference_place.c its place in a ceiling.
 */
#ifndef TAKT_MOTION_REFERENCE_PRIVATE_H
#define TAKT_MOTION_REFERENCE_PRIVATE_H

#include "motion/reference.h"
#include "plan/path.h"
#include "plan/path_unit.h"

#include <stddef.h>

/* Long ago: more cycles than any window. */
#define REFERENCE_LONG_AGO INT32_MAX

/* Rounding of feed squared. */
#define REFERENCE_FEED_SQUARED_SLACK 1e-6

/* The last deceleration to rest may be more than the allowed one by this part. */
#define REFERENCE_REST_PART 2e-4

/*
 * What braking is for: a feed, how hard it may be reached, and if it is 0, where to come to rest in
 * this cycle.
 */
struct reference_brake {
    double at_mm; /* the trapezoidal reference, from the ceiling's origin */
    double feed;
    double low;      /* the feed it may have at most here, */
    uint32_t pieces; /* and how many from here on have been braked for */
    double a;
    bool rest;
    uint64_t rest_at;
};

static inline const struct ceiling_piece *reference_piece(const struct reference *l, uint32_t k)
{
    return &l->here.ceiling->piece[k];
}

/*
 * A change from one feed to a higher one, or back, by less than this is rounding: a part of the
 * acceleration, or of it.
 */
static inline double reference_change_min(double a, double higher)
{
    const double part = 1e-9 * a;

    return part < 0.5 * higher ? part : 0.5 * higher;
}

/* Is there a piece under the trapezoidal reference, and not the end of all that is known? */
static inline bool reference_has_piece(const struct reference *l)
{
    return l->here.ceiling != NULL && l->here.piece < l->here.ceiling->count;
}

/* A feed of its pieces, mm/cycle. */
static inline double reference_feed(const struct reference *l, float feed_mm_s)
{
    return ceiling_feed(l->here.ceiling, feed_mm_s);
}

/* Where piece k ends, mm from the origin. */
static inline double reference_end_mm(const struct reference *l, uint32_t k)
{
    return l->here.ceiling->end_mm[k];
}

/* Where the setpoint leaves what piece k is made of. */
static inline uint64_t reference_leave_of(const struct reference *l, uint32_t k)
{
    return path_ceiling_leave(l->here.ceiling, k);
}

/* Path position at or beyond another. */
static inline bool reference_is_beyond(uint64_t position, uint64_t other)
{
    return (int64_t)(position - other) >= 0;
}

static inline bool reference_is_last_of_span(const struct ceiling_piece *p)
{
    return p->end != CEILING_GOES_ON;
}

/*
 * The junction that this span ends with, if it is one to land on; CEILING_NONE: a stop, or it is
 * not known.
 */
static inline uint32_t reference_landing(const struct reference *l)
{
    return reference_has_piece(l) ? reference_piece(l, l->here.piece)->landing : CEILING_NONE;
}

/* Has it not slowed down for so long that it may speed up? */
static inline bool reference_has_rested(const struct reference *l)
{
    return l->since_minus >= l->window;
}

/* How hard it may brake where it is, mm/cycle2. */
static inline double reference_acceleration(const struct reference *l)
{
    return l->here.late ? l->here.late_a : (double)reference_piece(l, l->here.piece)->acceleration;
}

/*
 * Half the window and the margin but for one cycle: that in which the trapezoidal reference comes
 * to a piece.
 */
static inline double reference_entry_cycles(const struct reference *l)
{
    return 0.5 * (l->window - 1.0) + CEILING_MARGIN_CYCLES - 1.0;
}

/* reference_place.c: goes on to the pieces that the trapezoidal reference has come to. */
void takt_reference_follow_pieces(struct reference *l);
/* reference_place.c: begins at a piece, of a new span. */
void takt_reference_enter_piece(struct reference *l, uint32_t k);
/*
 * reference_place.c: forgets ceilings that the setpoint has left, and tells the lowest of the
 * others.
 */
double takt_reference_low_feed(struct reference *l, uint64_t setpoint);

/*
 * reference_feed.c: what is ahead within a cycle: the lowest feed that any piece's end asks for, or
 * the ceiling low.
 */
void takt_reference_brake_ahead(const struct reference *l, double low, struct reference_brake *b);
/*
 * reference_feed.c: begins to land (run.phase) when it is time to, or makes the junction a stop
 * where it cannot be done.
 */
void takt_reference_consider_landing(struct reference *l, bool hold, struct reference_brake *b);
static inline void reference_approach_landing(struct reference *l, bool hold,
                                              struct reference_brake *b)
{
    if (reference_landing(l) != CEILING_NONE && l->since_plus >= l->window) {
        takt_reference_consider_landing(l, hold, b);
    }
}
/*
 * reference_halt.c: where it seeks: looks for the end to halt at. True: it is too fast
 * for the next one.
 */
bool takt_reference_seek_halt(struct reference *l);
/*
 * reference_halt.c: how hard it brakes for it, mm/cycle2; and could it come to rest there if it
 * braked by a?
 */
double takt_reference_halt_acceleration(const struct reference *l);
bool takt_reference_can_halt(const struct reference *l, double a);
/* reference_feed.c: brakes for the end that it halts at. */
void takt_reference_brake_to_halt(const struct reference *l, struct reference_brake *b);
/*
 * reference_feed.c: the feed to speed up to in this cycle under the ceiling low; the present one:
 * it may not.
 */
double takt_reference_speed_up(const struct reference *l, double at_mm, double low);

#endif
