/*
 * Does the curve follow the route in order? A way along both, never backwards, with no more than
 * the tolerance between them, is looked for while the curve is gone along in chords (Alt and Godau
 * 1995): kept are the places of the route that such a way can have come to when the curve has come
 * so far. Where there is none, the order is broken or the tube left.
 *
 *      curve ──a────────b──        places of the route within P of b:   [─────]        [──]
 *      route ══════╗   ╔═══        those that can be come to:              [──]
 *                  ╚═══╝
 */
#ifndef TAKT_SMOOTH_ORDER_H
#define TAKT_SMOOTH_ORDER_H

#include "smooth/route.h"

/*
 * Stretches of route that can have been come to, apart from each other; of more, the lowest are
 * given up.
 */
#define ORDER_SPANS 4

struct order_span {
    double first_mm, last_mm;
};

struct order {
    unsigned count;   /* 0: there is no way */
    uint32_t element; /* at or near the first place */
    struct order_span span[ORDER_SPANS];
};

/* From one place of the curve to another. */
struct order_chord {
    double from[AXIS_COUNT];     /* by slot */
    float way[SMOOTH_SLOTS_MAX]; /* weighted */
    float within_mm;             /* how near the curve must be to the route, */
    float corner_mm;             /* and to its corners and bends */
    float least_mm_s[2];         /* slower motions, linear and rotary, it may but pass at once */
};

/* The curve begins at a place of the route. */
void takt_order_start(struct order *o, double at_mm, uint32_t element);
/* It goes on along a chord. */
void takt_order_go(struct order *o, const struct route *r, const struct order_chord *chord);
/* Can it have come to this place, or farther? */
static inline bool order_reaches(const struct order *o, double at_mm)
{
    return o->count > 0 && o->span[o->count - 1].last_mm >= at_mm;
}
/* The place nearest before this one that it can have come to, or else the first one. */
double takt_order_place(const struct order *o, double at_mm);

#endif
