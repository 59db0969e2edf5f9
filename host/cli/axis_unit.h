/*
 * Units at the edges: a rotary axis is shown in degrees, with _deg in the place of _mm.
 */
#ifndef TAKT_HOST_AXIS_UNIT_H
#define TAKT_HOST_AXIS_UNIT_H

#include "base/maths.h"
#include "base/point.h"

#include <stdbool.h>

static inline bool axis_unit_is_rotary(unsigned axis)
{
    return axis >= AXIS_LINEAR_COUNT;
}

/* Shown value per value inside. */
static inline double axis_unit_ratio(unsigned axis)
{
    return axis_unit_is_rotary(axis) ? 180.0 / MATHS_PI : 1.0;
}

static inline const char *axis_unit_name(unsigned axis)
{
    return axis_unit_is_rotary(axis) ? "deg" : "mm";
}

#endif
