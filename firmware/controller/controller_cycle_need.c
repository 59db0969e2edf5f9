/* Is the machine's control cycle short enough for what its axes can do? Source: seed 000. */
#include "accuracy/cycle_frequency.h"
#include "base/maths.h"
#include "controller/controller.h"

#include <stddef.h>

/* A circle in the plane of two axes: what both of them can do. */
static struct cycle_limits plane_limits(const struct machine_axis *a, const struct machine_axis *b)
{
    return (struct cycle_limits){
        .feed_mm_s = maths_min(a->max_velocity_mm_s, b->max_velocity_mm_s),
        .acceleration_mm_s2 = maths_min(a->max_acceleration_mm_s2, b->max_acceleration_mm_s2),
        .jerk_mm_s3 = maths_min(a->max_jerk_mm_s3, b->max_jerk_mm_s3),
    };
}

void takt_controller_cycle_need(const struct machine *machine, struct cycle_need *need,
                                struct cycle_limits *limits)
{
    *need = (struct cycle_need){0};
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const unsigned k = (i + 1U) % AXIS_LINEAR_COUNT;
        const struct cycle_limits of_axes = plane_limits(&machine->axis[i], &machine->axis[k]);
        struct cycle_need of_plane;

        if (!machine->axis[i].present || !machine->axis[k].present) {
            continue;
        }
        takt_cycle_frequency_find(&of_axes, 1.0 / machine->resolution_per_mm, &of_plane);
        if (of_plane.frequency_hz > need->frequency_hz) {
            *need = of_plane;
            if (limits != NULL) {
                *limits = of_axes;
            }
        }
    }
}

bool takt_controller_cycle_is_enough(const struct machine *machine, struct diagnostic *warning)
{
    const double frequency_hz = 1e6 / (double)machine->cycle_us;
    struct cycle_need need;

    takt_controller_cycle_need(machine, &need, NULL);
    *warning = (struct diagnostic){.code = TAKT_OK};
    if (frequency_hz >= need.frequency_hz) {
        return true;
    }
    takt_diagnostic_set(warning, TAKT_ERROR_CYCLE_SLOW, 0, 0, "", 0, frequency_hz);
    takt_diagnostic_set_limit(warning, 0.1 * takt_maths_ceil(10.0 * need.frequency_hz));
    return false;
}
