/* What tables over one axis take of the axes: bounds over all pieces. */
#include "base/assert.h"
#include "base/maths.h"
#include "correction/axis_tables.h"
#include "correction/edge.h"

/* As in grid_need.c: differences over whole cycles instead of derivatives. */
#define NEED_MARGIN 2.0

/* Bounds of a cubic and its derivatives over 0 ... h. */
struct cubic_bound {
    double size, first, second, third;
};

static void raise(double *most, double value)
{
    *most = maths_max(*most, maths_abs(value));
}

/*
 * Value and slope of a cubic are largest where their absolute terms add; the second derivative at
 * one of the ends.
 */
static void add_cubic(struct cubic_bound *bound, const float c[4], double h)
{
    const double c0 = maths_abs((double)c[0]);
    const double c1 = maths_abs((double)c[1]);
    const double c2 = maths_abs((double)c[2]);
    const double c3 = maths_abs((double)c[3]);
    const double first = c1 + h * (2.0 * c2 + 3.0 * h * c3);

    TAKT_ASSERT(h > 0.0);
    raise(&bound->size, c0 + h * (c1 + h * (c2 + h * c3)));
    raise(&bound->first, first);
    raise(&bound->second, 2.0 * c2 + 6.0 * h * c3 + EDGE_SECOND_MAX * first / h);
    raise(&bound->third, 6.0 * c3 + EDGE_THIRD_MAX * first / (h * h));
}

/* A K(x(t)): a is 1 for the mean, and fades between -1 and 1 for the half difference. */
static void add_pair(const struct axis_pair *pair, const struct cubic_bound *bound,
                     const struct approach_bound *a, const struct motion_bound *most,
                     struct need *need)
{
    const double v = most->velocity_mm_s[pair->input];
    const double slope_s = bound->first * v;
    const double slope_s2 =
        bound->first * most->acceleration_mm_s2[pair->input] + NEED_MARGIN * bound->second * v * v;

    TAKT_ASSERT(pair->input < AXIS_COUNT && pair->corrected < AXIS_COUNT);
    need->size_mm[pair->corrected] += bound->size;
    need->noise_mm[pair->corrected] += NEED_ROUNDING * bound->size;
    takt_need_add_slope(need, pair->corrected, pair->input, bound->first, most);
    need->velocity_mm_s[pair->corrected] += a->velocity_per_s * bound->size;
    need->acceleration_mm_s2[pair->corrected] += NEED_MARGIN * bound->second * v * v +
                                                 2.0 * a->velocity_per_s * slope_s +
                                                 a->acceleration_per_s2 * bound->size;
    need->jerk_mm_s3[pair->corrected] +=
        NEED_MARGIN * (3.0 * bound->second * v * most->acceleration_mm_s2[pair->input] +
                       bound->third * v * v * v) +
        3.0 * (a->velocity_per_s * slope_s2 + a->acceleration_per_s2 * slope_s) +
        a->jerk_per_s3 * bound->size;
}

void takt_axis_tables_need(const struct axis_tables *tables, const struct approach_bound *approach,
                           const struct motion_bound *most, struct need *need)
{
    static const struct approach_bound still = {0.0, 0.0, 0.0};

    for (unsigned i = 0; i < tables->count; i++) {
        const struct axis_pair *pair = &tables->pair[i];
        struct cubic_bound mean = {0};
        struct cubic_bound half = {0};

        for (unsigned k = pair->first; k + 1U < pair->first + pair->points; k++) {
            const double h = tables->knot_mm[k + 1] - tables->knot_mm[k];

            add_cubic(&mean, tables->piece[k].mean, h);
            add_cubic(&half, tables->piece[k].half, h);
        }
        add_pair(pair, &mean, &still, most, need);
        if (pair->directed) {
            add_pair(pair, &half, approach, most, need);
        }
    }
}
