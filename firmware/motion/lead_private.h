/*
 * What the parts of the lead point share: lead.c moves it, lead_feed.c finds the feed, lead_halt.c where to halt, lead_place.c
 * its place in a ceiling.
 */
#ifndef TAKT_MOTION_LEAD_PRIVATE_H
#define TAKT_MOTION_LEAD_PRIVATE_H

#include "motion/lead.h"
#include "plan/path_unit.h"

#include <stddef.h>

/* Long ago: more cycles than any window. */
#define LEAD_LONG_AGO UINT32_C(0x7fffffff)

/* Rounding of feed squared. */
#define LEAD_ENERGY_SLACK 1e-6

/* The last deceleration to rest may be more than the allowed one by this part. */
#define LEAD_REST_PART 2e-4

/* What braking is for: a feed, how hard it may be reached, and if it is 0, where to come to rest in this cycle. */
struct lead_brake {
    double at_mm; /* the lead point, from the ceiling's origin */
    double feed;
    double low;      /* the feed it may have at most here, */
    uint32_t pieces; /* and so many from here on that have been braked for */
    double a;
    bool rest;
    uint64_t rest_at;
};

static inline const struct ceiling_piece *lead_piece(const struct lead *l, uint32_t k)
{
    return &l->here.ceiling->piece[k];
}

/* A change from one feed to a higher one, or back, by less than this is rounding: a part of the acceleration, or of it. */
static inline double lead_change_min(double a, double higher)
{
    const double part = 1e-9 * a;

    return part < 0.5 * higher ? part : 0.5 * higher;
}

/* Is there a piece under the lead point, and not the end of all that is known? */
static inline bool lead_has_piece(const struct lead *l)
{
    return l->here.ceiling != NULL && l->here.piece < l->here.ceiling->count;
}

/* A feed of its pieces, mm/cycle. */
static inline double lead_feed(const struct lead *l, float feed_mm_s)
{
    return ceiling_feed(l->here.ceiling, feed_mm_s);
}

/* Where piece k ends, mm from the origin. */
static inline double lead_end_mm(const struct lead *l, uint32_t k)
{
    return l->here.ceiling->end_mm[k];
}

/* Where the setpoint leaves what piece k is made of. */
static inline uint64_t lead_leave_of(const struct lead *l, uint32_t k)
{
    return takt_ceiling_leave(l->here.ceiling, k);
}

static inline double lead_square(double x)
{
    return x * x;
}

/* Path position at or beyond another. */
static inline bool lead_is_beyond(uint64_t position, uint64_t other)
{
    return (int64_t)(position - other) >= 0;
}

static inline bool lead_is_last_of_span(const struct ceiling_piece *p)
{
    return p->stop || p->landed;
}

/* The joint that this span ends with, if it is one to land on; CEILING_NONE: a stop, or it is not known. */
static inline uint32_t lead_landing(const struct lead *l)
{
    return lead_has_piece(l) ? lead_piece(l, l->here.piece)->landing : CEILING_NONE;
}

/* Has it not slowed down for so long that it may speed up? */
static inline bool lead_has_rested(const struct lead *l)
{
    return l->since_minus >= l->window + (l->abrupt ? 1.0 : 0.0);
}

/* How hard it may brake where it is, mm/cycle2. */
static inline double lead_acceleration(const struct lead *l)
{
    return l->here.late ? l->here.late_a : (double)lead_piece(l, l->here.piece)->acceleration;
}

/* Half the window and the margin but for one cycle: that in which the lead point comes to a piece. */
static inline double lead_entry_cycles(const struct lead *l)
{
    return 0.5 * (l->window - 1.0) + CEILING_MARGIN_CYCLES - 1.0;
}

/* lead_place.c: goes on to the pieces that the lead point has come to. */
void takt_lead_follow_pieces(struct lead *l);
/* lead_place.c: begins at a piece, of a new span. */
void takt_lead_enter_piece(struct lead *l, uint32_t k);
/* lead_place.c: forgets ceilings that the setpoint has left, and tells the lowest of the others. */
double takt_lead_low_feed(struct lead *l, uint64_t setpoint);

/* lead_feed.c: what is ahead within a cycle: the lowest feed that any piece's end asks for, or the ceiling low. */
void takt_lead_brake_ahead(const struct lead *l, double low, struct lead_brake *b);
/* lead_feed.c: begins to land (run.active) when it is time to, or makes the joint a stop where it cannot be done. */
void takt_lead_consider_landing(struct lead *l, bool hold, struct lead_brake *b);
static inline void lead_approach_landing(struct lead *l, bool hold, struct lead_brake *b)
{
    if (lead_landing(l) != CEILING_NONE && l->since_plus >= l->window) {
        takt_lead_consider_landing(l, hold, b);
    }
}
/* lead_halt.c: with halt.on: looks for the end to halt at (halt.found). True: it is too fast for the next one. */
bool takt_lead_seek_halt(struct lead *l);
/* lead_halt.c: how hard it brakes for it, mm/cycle2; and could it come to rest there if it braked by a? */
double takt_lead_halt_acceleration(const struct lead *l);
bool takt_lead_can_halt(const struct lead *l, double a);
/* lead_feed.c: brakes for the end that it halts at. */
void takt_lead_brake_to_halt(const struct lead *l, struct lead_brake *b);
/* lead_feed.c: the feed to speed up to in this cycle under the ceiling low; the present one: it may not. */
double takt_lead_speed_up(const struct lead *l, double at_mm, double low);

#endif
