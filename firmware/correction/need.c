#include "correction/need.h"

#include "base/assert.h"

void takt_need_add_slope(struct need *need, unsigned corrected, unsigned input, double slope,
                         const struct motion_bound *most)
{
    TAKT_ASSERT(corrected < AXIS_COUNT && input < AXIS_COUNT);
    need->velocity_mm_s[corrected] += slope * most->velocity_mm_s[input];
    need->acceleration_mm_s2[corrected] += slope * most->acceleration_mm_s2[input];
    need->jerk_mm_s3[corrected] += slope * most->jerk_mm_s3[input];
}

void takt_need_jet_add_travel(struct need_jet *jet, const struct motion_bound *most, unsigned axis)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    jet->value[0] += most->farthest_mm[axis];
    jet->value[1] += most->velocity_mm_s[axis];
    jet->value[2] += most->acceleration_mm_s2[axis];
    jet->value[3] += most->jerk_mm_s3[axis];
}

struct need_jet takt_need_jet_wave(double size, double times, const struct motion_bound *most,
                                   unsigned axis)
{
    const double v = times * most->velocity_mm_s[axis];
    const double a = times * most->acceleration_mm_s2[axis];
    const double j = times * most->jerk_mm_s3[axis];

    TAKT_ASSERT(axis < AXIS_COUNT);
    return (struct need_jet){
        {size, size * v, size * (v * v + a), size * (v * v * v + 3.0 * v * a + j)}};
}

void takt_need_add_product(struct need *need, unsigned corrected, const struct need_jet *r,
                           const struct need_jet *a)
{
    const double *p = r->value;
    const double *q = a->value;

    TAKT_ASSERT(corrected < AXIS_COUNT);
    need->size_mm[corrected] += p[0] * q[0];
    need->noise_mm[corrected] += NEED_ROUNDING * p[0] * q[0];
    need->velocity_mm_s[corrected] += p[0] * q[1] + p[1] * q[0];
    need->acceleration_mm_s2[corrected] += p[0] * q[2] + 2.0 * p[1] * q[1] + p[2] * q[0];
    need->jerk_mm_s3[corrected] +=
        p[0] * q[3] + 3.0 * p[1] * q[2] + 3.0 * p[2] * q[1] + p[3] * q[0];
}
