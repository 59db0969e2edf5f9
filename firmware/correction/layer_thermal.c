/*
 * Thermal growth over the distance from a reference:
 *
 *     K_i = - growth_i rise_i (x_i - reference_i)
 *
 * The rise comes from a sensor in steps, and is followed smoothly.
 */
#include "base/maths.h"
#include "correction/layer.h"

static bool thermal_begin(const struct correction *c, struct layer_notes *notes)
{
    bool any = false;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        notes->fade[i].value = c->rise_k[i];
        any = any || c->settings.thermal_per_k[i] != 0.0;
    }
    return any;
}

static void thermal_follow(struct correction *c, struct layer_notes *notes)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (!fade_is_at(&notes->fade[i], c->rise_k[i])) {
            (void)fade_cycle(&notes->fade[i], c->rise_k[i], &c->layer_pace);
        }
        notes->coefficient[i] = (float)(-c->settings.thermal_per_k[i] * notes->fade[i].value);
    }
}

static void thermal_add(struct correction *c, struct layer_notes *notes, double weight,
                        struct correction_sum *sum)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const float distance = (float)(c->at->at[i] - c->settings.thermal_reference_mm[i]);

        sum->fine[i] += (float)weight * notes->coefficient[i] * distance;
    }
}

/* No axis gets warmer than this, and sensors change by so much at a time. */
#define RISE_MAX_K  30.0
#define RISE_STEP_K 5.0

static void thermal_need(const struct correction *c, const struct layer_notes *notes,
                         const struct motion_bound *most, struct need *need)
{
    (void)notes;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double per_k = maths_abs(c->settings.thermal_per_k[i]);
        const double step_mm = per_k * RISE_STEP_K * most->farthest_mm[i];

        takt_need_add_slope(need, i, i, per_k * RISE_MAX_K, most);
        need->size_mm[i] += per_k * RISE_MAX_K * most->farthest_mm[i];
        need->noise_mm[i] += per_k * RISE_MAX_K * most->farthest_mm[i] * NEED_ROUNDING;
        need->velocity_mm_s[i] += step_mm * takt_fade_velocity_per_s(&c->layer_pace);
        need->acceleration_mm_s2[i] += step_mm * takt_fade_acceleration_per_s2(&c->layer_pace);
        need->jerk_mm_s3[i] += step_mm * takt_fade_jerk_per_s3(&c->layer_pace);
    }
}

const struct correction_layer takt_layer_thermal = {
    .name = "thermal",
    .begin = thermal_begin,
    .follow = thermal_follow,
    .add = thermal_add,
    .need = thermal_need,
};
