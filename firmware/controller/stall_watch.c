#include "controller/stall_watch.h"

#include "base/maths.h"

#include <string.h>

/* Part of the limits that a smoothed path leaves to changes of its rate. */
#define CHANGE_PART 0.06

void stall_watch_init(struct stall_watch *w, const struct machine *machine)
{
    memset(w, 0, sizeof(*w));
    w->cycle_s = 1e-6 * (double)machine->cycle_us;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (axis->present) {
            const double ramp_s = axis->max_velocity_mm_s / axis->max_acceleration_mm_s2 +
                                  axis->max_acceleration_mm_s2 / axis->max_jerk_mm_s3;

            w->longest_s = maths_max(w->longest_s, 2.0 * ramp_s / CHANGE_PART);
        }
    }
}

bool stall_watch_cycle(struct stall_watch *w, const struct point *setpoint, double ratio,
                       bool explained)
{
    if (explained || memcmp(setpoint, &w->at, sizeof(w->at)) != 0) {
        w->at = *setpoint;
        w->stood_s = 0.0;
        return true;
    }
    w->stood_s += maths_min(ratio, 1.0) * w->cycle_s;
    return w->stood_s <= w->longest_s;
}
