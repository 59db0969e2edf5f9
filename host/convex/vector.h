/* Vectors of the three linear axes. */
#ifndef TAKT_HOST_CONVEX_VECTOR_H
#define TAKT_HOST_CONVEX_VECTOR_H

#include "base/maths.h"

static inline double vector_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double vector_length(const double a[3])
{
    return maths_sqrt(vector_dot(a, a));
}

/* The largest of the absolute components. */
static inline double vector_largest(const double a[3])
{
    return maths_max(maths_abs(a[0]), maths_max(maths_abs(a[1]), maths_abs(a[2])));
}

/* way = to - from */
static inline void vector_from_to(const double from[3], const double to[3], double way[3])
{
    for (int i = 0; i < 3; i++)
        way[i] = to[i] - from[i];
}

static inline void vector_copy(const double from[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = from[i];
}

#endif
