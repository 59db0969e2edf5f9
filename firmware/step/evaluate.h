/*
 * One tick of an interpolator of unit steps: what the evaluation functions of this room hand out.
 *
 * Coordinates are whole steps. Two forms of each interpolator: improved, the leading axis steps at
 * every tick and the others along with it; plain, one axis steps at a tick.
 */
#ifndef TAKT_STEP_EVALUATE_H
#define TAKT_STEP_EVALUATE_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Coordinates, and differences of them, stay below this: then every evaluation function fits 64
 * bits.
 */
#define EVALUATE_STEPS_MAX (INT64_C(1) << 30)

enum evaluate_form { EVALUATE_IMPROVED, EVALUATE_PLAIN };

struct evaluate_tick {
    uint8_t axes;      /* bit i: axis i steps */
    uint8_t direction; /* bit i: backwards */
};

/* Is this axis in a mask of axes? */
static inline bool evaluate_has(unsigned axes, unsigned axis)
{
    return (axes >> axis & 1U) != 0U;
}

static inline int64_t evaluate_size(int64_t value)
{
    return value < 0 ? -value : value;
}

#endif
