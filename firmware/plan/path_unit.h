/*
 * Path positions as whole numbers: 2^38 units a mm (or a rad), 3.6e-12 mm each.
 *
 * Positions count from the start of the program and may wrap; only their differences have a
 * meaning. Sums of them are exact, so that an average that runs for days does not drift, and
 * landing is a comparison of integers. Differences up to 2^53 units (32 m) are exact in mm, too:
 * what is worked out from them does not depend on what they are counted from.
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

/* 1.5 x 2^52 units. In doubles from 2^52 units to twice as many a unit is the last bit. */
#define PATH_LARGE_MM (1.5 * 4503599627370496.0 / PATH_UNITS_PER_MM)

/* A way to the nearest whole unit, mm: sums of such ways and positions are exact. */
static inline double path_whole_mm(double mm)
{
    return (mm + PATH_LARGE_MM) - PATH_LARGE_MM;
}

/* Such a way, less than 2^51 units, in units. Quicker than path_units, which is for any. */
static inline uint64_t path_whole_units(double whole_mm)
{
    const union {
        double mm;
        uint64_t bits;
    } none = {PATH_LARGE_MM}, way = {whole_mm + PATH_LARGE_MM};

    return way.bits - none.bits;
}

#endif
