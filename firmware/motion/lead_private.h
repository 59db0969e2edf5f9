/*
 * What the parts of the lead point share: lead.c moves it, lead_feed.c finds the feed, lead_exchange.c takes a new
 * ceiling.
 */
#ifndef TAKT_MOTION_LEAD_PRIVATE_H
#define TAKT_MOTION_LEAD_PRIVATE_H

#include "motion/lead.h"
#include "plan/path_unit.h"

/* Rounding of feed squared. */
#define LEAD_ENERGY_SLACK 1e-6

/* A change of feed by less than this part of the acceleration is rounding. */
#define LEAD_CHANGE_MIN 1e-9

/* What braking is for: a feed, how hard it may be reached, and if it is 0, where to come to rest in this cycle. */
struct lead_brake {
    double feed;
    double a;
    bool rest;
    uint64_t rest_at;
};

static inline const struct ceiling_piece *lead_piece(const struct lead *l, uint32_t k)
{
    return &l->ceiling->piece[k];
}

/* Where the setpoint leaves what piece k is made of. */
static inline uint64_t lead_leave_of(const struct lead *l, uint32_t k)
{
    return l->ceiling->origin + (uint64_t)lead_piece(l, k)->leave;
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

/* lead.c: is the lead point past the end of piece k? */
bool lead_has_passed(const struct lead *l, uint32_t k);
/* lead.c: the lead point has come to piece k, whose ceiling binds until the setpoint has left it. */
void lead_low_push(struct lead *l, uint32_t k);

/* lead_exchange.c: the piece behind a landed joint; the count: there is none. */
uint32_t lead_piece_behind(const struct ceiling *c, uint64_t joint);

/* lead_feed.c: what is ahead within a cycle: the lowest feed that any piece's end asks for. */
struct lead_brake lead_brake_ahead(const struct lead *l);
/* lead_feed.c: begins to land (run.active) when it is time to, or makes the joint a stop where it cannot be done. */
void lead_approach_landing(struct lead *l, bool hold, struct lead_brake *b);
/* lead_feed.c: the feed to speed up to in this cycle under the ceiling low; the present one: it may not. */
double lead_speed_up(const struct lead *l, double low);

#endif
