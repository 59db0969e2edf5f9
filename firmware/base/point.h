/*
 * The axes of a machine and points in their space.
 *
 * X, Y, Z are linear: mm. A, B, C are rotary: radians inside the firmware, degrees only in part
 * programs, machine files and traces. A field that ends in _mm, _mm_s, _mm_s2 or _mm_s3 and belongs
 * to a rotary axis is in rad, rad/s, rad/s2 or rad/s3.
 */
#ifndef TAKT_BASE_POINT_H
#define TAKT_BASE_POINT_H

#include "base/maths.h"

#include <stdbool.h>

enum axis { AXIS_X, AXIS_Y, AXIS_Z, AXIS_A, AXIS_B, AXIS_C, AXIS_COUNT };

#define AXIS_LINEAR_COUNT 3
#define AXIS_LETTERS      "XYZABC"

/* Position of every axis: mm for X, Y, Z, rad for A, B, C. Axes a machine does not have stay 0. */
struct point {
    double at[AXIS_COUNT];
};

/* Every coordinate the same, to the last bit but for the sign of 0. */
static inline bool point_is_same(const struct point *a, const struct point *b)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (a->at[i] != b->at[i]) {
            return false;
        }
    }
    return true;
}

/* |a - b| over the first axes. */
static inline double point_distance(const struct point *a, const struct point *b, int axes)
{
    double square = 0.0;

    for (int i = 0; i < axes; i++) {
        square += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    }
    return maths_sqrt(square);
}

#endif
