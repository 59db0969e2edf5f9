/*
 * The programmed path of one chain: curves that follow each other without a stop, with a nominal feed along them.
 *
 *     push -> [ element | element | ... ] -> forget
 *
 * Places on it are told by the length from the chain's start, mm (rad where only rotary axes move).
 */
#ifndef TAKT_SMOOTH_ROUTE_H
#define TAKT_SMOOTH_ROUTE_H

#include "geometry/curve.h"
#include "program/move.h"
#include "smooth/limits.h"

#include <stdbool.h>
#include <stdint.h>

struct route_element {
    struct move move;
    uint32_t number; /* of the motion */
    struct curve curve;
    double start_mm;    /* on the route */
    double feed_mm_s;   /* highest nominal feed: programmed, and what its curvature allows */
    double along_mm_s2; /* nominal acceleration along it */
    double energy_cap;  /* highest feed squared at its start, for the corner there, mm2/s2 */
    double energy;      /* from which everything known that follows can be met */
    double turn;        /* |change of direction| at its start */
};

struct route {
    struct smooth_limits limits;
    double tolerance_mm;
    uint32_t first; /* elements forgotten so far */
    uint32_t count; /* elements pushed so far */
    struct route_element element[SMOOTH_ELEMENTS_MAX];
};

/* A place on the route near to a point. */
struct route_foot {
    uint32_t element;   /* index of an element */
    double at_mm;       /* on the route */
    double distance_mm; /* weighted (limits.h) */
    struct point point;
};

void route_init(struct route *r, const struct smooth_limits *limits, double tolerance_mm);
bool route_has_room(const struct route *r);
/* Appends a curve that begins where the last one ended. Needs room. */
void route_push(struct route *r, const struct move *move, uint32_t number,
                const struct curve *curve);
/* Elements that end before at_mm are no longer asked for. */
void route_forget(struct route *r, double at_mm);

const struct route_element *route_element(const struct route *r, uint32_t index);
double route_end(const struct route *r);
/* Index of the element at a place; the later one at a joint. hint: an index near by. */
uint32_t route_find(const struct route *r, double at_mm, uint32_t hint);
void route_point(const struct route *r, double at_mm, uint32_t *hint, struct point *p);
/* Unit vectors (weighted) at both sides of the start of an element that is not the first. */
void route_corner(const struct route *r, uint32_t index, struct point *before, struct point *after);
/*
 * The nearest place to x between from_mm and to_mm that can be walked to from f->at_mm in f->element without moving
 * away: at a retrace it stays on the branch it is on.
 */
void route_foot(const struct route *r, const struct point *x, double from_mm, double to_mm,
                struct route_foot *f);
/* Highest nominal feed at a place, and the acceleration there. */
double route_feed(const struct route *r, double at_mm, uint32_t *hint);
double route_acceleration(const struct route *r, uint32_t index);

#endif
