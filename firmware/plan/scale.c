#include "plan/scale.h"

#include "base/assert.h"
#include "base/maths.h"
#include "plan/path_unit.h"

/*
 * Rounding changes the second and third differences of setpoints by 2 units, and by two and three
 * times 8 where one so near to an end is put on it (motion/motion.c): with this many units in the
 * least A tau^2 and J tau^3 that is less than 1/14,000 of the acceleration limit, and 1/2048 of the
 * jerk limit.
 */
#define ACCELERATION_UNITS 262144.0
#define JERK_UNITS         65536.0

/*
 * The sums of the averages: product of the boxes times the way between trapezoidal reference and
 * setpoint.
 */
#define SUM_UNITS 9223372036854775808.0

/* The bits of the linear axes, and of the rotary ones. */
#define LINEAR ((1U << AXIS_LINEAR_COUNT) - 1U)
#define ROTARY (((1U << AXIS_COUNT) - 1U) & ~LINEAR)

/* Fastest way in a cycle along some axes. */
static double fastest(const struct plan_limits *limits, unsigned axes)
{
    double square = 0.0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes & axes & 1U << i) != 0) {
            square += limits->velocity_mm_s[i] * limits->velocity_mm_s[i];
        }
    }
    return maths_sqrt(square) * limits->cycle_s;
}

/*
 * Units of a scale of 1 in the least A tau^2 and J tau^3, as parts of those that must be in them.
 */
static double least_units(const struct plan_limits *limits, unsigned axes)
{
    const double t = limits->cycle_s;
    double least = MATHS_INFINITY;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes & axes & 1U << i) != 0) {
            least = maths_min(least, limits->acceleration_mm_s2[i] * (t * t) / ACCELERATION_UNITS);
            least = maths_min(least, limits->jerk_mm_s3[i] * (t * t * t) / JERK_UNITS);
        }
    }
    return least * PATH_UNITS_PER_MM;
}

/* Likewise in the largest sum: the trapezoidal reference is half a window ahead. */
static double largest_sum(const struct plan_limits *limits, unsigned axes)
{
    const uint32_t cycles = takt_ramp_profile_cycles_max(limits->profile);
    double product = 1.0;

    for (unsigned i = 0; i < takt_ramp_profile_boxes(limits->profile); i++) {
        product *= (double)takt_ramp_profile_box_cycles(i, cycles);
    }
    return 0.5 * (double)takt_ramp_profile_window_cycles(limits->profile, cycles) * product *
           PATH_UNITS_PER_MM * fastest(limits, axes);
}

static double scale_of_axes(const struct plan_limits *limits, unsigned axes)
{
    const double units = least_units(limits, axes);
    const double sum = largest_sum(limits, axes);
    double scale = 1.0;

    while (units < scale && 2.0 * sum < SUM_UNITS * scale) {
        scale *= 0.5;
    }
    while (sum >= SUM_UNITS * scale) {
        scale *= 2.0;
    }
    TAKT_ASSERT(scale > 0.0 && sum < SUM_UNITS * scale);
    return scale;
}

struct scale takt_scale_of_machine(const struct plan_limits *limits)
{
    return (struct scale){
        .linear = scale_of_axes(limits, LINEAR),
        .rotary = scale_of_axes(limits, ROTARY),
    };
}

/* |d abc / ds|^2 */
static double turning_square(const struct curve *c)
{
    double square = 0.0;

    for (unsigned i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        if (c->slope.at[i] != 0.0) {
            square += c->slope.at[i] * c->slope.at[i];
        }
    }
    return square;
}

/* A smoothed curve counts its nominal time (block.c). */
double takt_scale_of_curve(const struct curve *c, const struct scale *machine)
{
    TAKT_ASSERT(c->length_mm >= 0.0);
    if (c->kind == CURVE_SPLINE) {
        return 1.0;
    }
    const double turning = c->rotary ? 0.0 : maths_sqrt(turning_square(c));
    const double linear = c->rotary ? machine->rotary : machine->linear;
    const double scale = turning * linear > machine->rotary ? machine->rotary / turning : linear;

    return maths_max(scale, c->length_mm * (PATH_UNITS_PER_MM / (double)SCALE_LENGTH_UNITS));
}
