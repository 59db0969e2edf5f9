/*
 * Path positions as whole numbers: 2^38 units a mm (or a rad), 3.6e-12 mm each.
 *
 * Positions count from the start of the program and may wrap; only their differences have a meaning. Sums of them are
 * exact, so that an average that runs for days does not drift, and landing is a comparison of integers. Differences up to
 * 2^53 units (32 m) are exact in mm, too: what is worked out from them does not depend on what they are counted from.
 */
#ifndef TAKT_PLAN_PATH_UNIT_H
#define TAKT_PLAN_PATH_UNIT_H

#include <stdint.h>

#define PATH_UNITS_PER_MM 274877906944.0

/* mm >= 0 to units, to the nearest. */
static inline uint64_t path_units(double mm)
{
    return (uint64_t)(mm * PATH_UNITS_PER_MM + 0.5);
}

/* From one position to another: mm. */
static inline double path_mm(uint64_t from, uint64_t to)
{
    return (double)(int64_t)(to - from) / PATH_UNITS_PER_MM;
}

/*
 * A way to the nearest whole unit, mm: sums of such ways and positions are exact. In doubles from 2^52 units to twice as
 * many a unit is the last bit.
 */
static inline double path_whole_mm(double mm)
{
    const double large_mm = 1.5 * 4503599627370496.0 / PATH_UNITS_PER_MM;

    return (mm + large_mm) - large_mm;
}

#endif
