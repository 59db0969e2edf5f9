/*
 * The lead point: moves along the path with constant acceleration, no acceleration, or constant deceleration, under a
 * ceiling (plan/ceiling.h). The setpoint is its moving average and follows behind it.
 *
 * Between accelerations of opposite sign it keeps its feed for a whole averaging window; then the average's jerk is
 * never more than acceleration / first box, on every setpoint, whatever the operator does.
 *
 * Feeds are mm/cycle, accelerations mm/cycle2, positions path units.
 */
#ifndef TAKT_MOTION_LEAD_H
#define TAKT_MOTION_LEAD_H

#include "motion/landing.h"
#include "plan/ceiling.h"
#include "plan/law.h"

#include <stdbool.h>
#include <stdint.h>

struct lead {
    const struct ceiling *ceiling; /* NULL: none yet */
    enum law law;
    uint64_t at;
    uint64_t span;        /* where the span starts that has been begun last */
    double feed;          /* at the end of the last cycle */
    bool standing;        /* at a stop, or where the machine was switched on: between two spans */
    bool released;        /* and may leave it */
    uint32_t cycles;      /* of the first averaging box, in this span */
    double window;        /* cycles that the averages reach over */
    uint32_t since_plus;  /* cycles since it sped up */
    uint32_t since_minus; /* and since it slowed down */
    uint32_t piece;       /* where the lead point is; the ceiling's count: beyond its end */
    uint16_t landing;     /* the next joint to land on, CEILING_NONE */
    double landing_feed;
    struct landing_run run;
    /* pieces from the setpoint's to the lead point's, their feeds rising: the first is the lowest */
    uint32_t low_first, low_count;
    uint16_t low[CEILING_PIECES_MAX];
};

/* At rest at a position; lead_release lets it leave. */
void lead_init(struct lead *l, enum law law, uint64_t at);

/*
 * A new ceiling, over a path that reaches further or under other overrides. False when it was made for another window
 * than that of the span that has been begun, or when what is new in it cannot be met any more (a short window may show
 * a slow block too late): the old one stays, which ends at rest. setpoint: where the setpoint is.
 */
bool lead_set_ceiling(struct lead *l, const struct ceiling *ceiling, uint64_t setpoint);

/* The stop at which everything stands has been served. */
void lead_release(struct lead *l);

/* A span that begins: the averages start anew from where the lead point is, as if it had always moved by step. */
struct lead_start {
    uint64_t at;
    uint64_t step; /* path units a cycle */
};

/*
 * One cycle. setpoint: where the setpoint was at the end of the last one. hold: come to rest and stay.
 * True when it begins a span, with l->cycles; start is then filled.
 */
bool lead_step(struct lead *l, uint64_t setpoint, bool hold, struct lead_start *start);

#endif
