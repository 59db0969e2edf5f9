/*
 * How much of a curve a mm of path is, so that no axis ever shows that path positions are whole
 * numbers.
 *
 * A curve is told by its arc length over X, Y, Z. Beside a short way of these a rotary axis may go
 * far: were the path counted by them, each unit of it would be a large step of that axis, and a
 * feed of it less than a unit a cycle. So the path is as long as the longer of both ways, in mm
 * along X, Y, Z and in rad along A, B, C, each counted by what the machine's axes of that kind are
 * like: a unit that suits fast linear ones may be large for a slow rotary one.
 *
 *     path = max(W |xyz|, V |abc|),      scale = length of the curve / path
 *
 * It depends on the direction alone and changes steadily with it, so that blocks of one direction
 * have one scale. Feeds, accelerations and jerks of a block are those of the path.
 */
#ifndef TAKT_PLAN_SCALE_H
#define TAKT_PLAN_SCALE_H

#include "geometry/curve.h"
#include "plan/limits.h"

#include <stdint.h>

/*
 * Path units of a curve at most. With this many ahead nothing is appended: differences of positions
 * stay within 63 bits.
 */
#define SCALE_LENGTH_UNITS (UINT64_C(1) << 61)

/*
 * 1/W and 1/V of a machine, powers of two: 1 unless a unit of path would show in acceleration or
 * jerk of the slowest axis of that kind, or sums over the longest window would be too large for the
 * fastest.
 */
struct scale {
    double linear, rotary;
};

struct scale takt_scale_of_machine(const struct plan_limits *limits);

/* The scale of a curve on a machine. */
double takt_scale_of_curve(const struct curve *c, const struct scale *machine);

#endif
