/* How long the programmed path itself takes, and where it rests. */
#ifndef TAKT_SMOOTH_EXACT_TIME_H
#define TAKT_SMOOTH_EXACT_TIME_H

#include "smooth/route.h"

#include <stdbool.h>

/* What an element allows: mm of route and s. */
struct exact_leg {
    float length;
    float feed;
    float acceleration;
    float jerk;
};

/* Working memory, holds nothing between calls: of elements, and v^2 where they begin. */
struct exact_work {
    struct exact_leg leg[SMOOTH_ELEMENTS_MAX];
    float square[SMOOTH_ELEMENTS_MAX + 1];
};

/* Does the exact path come to rest at the start of an element that is not the first? */
bool takt_exact_rests(const struct route *r, const struct smooth_limits *machine, uint32_t index);

/*
 * Seconds from rest at a place to the start of an element behind it, or to the end of the route:
 * index r->count.
 */
float takt_exact_time(const struct route *r, const struct smooth_limits *machine, double at_mm,
                      uint32_t element, uint32_t end, struct exact_work *work);

#endif
