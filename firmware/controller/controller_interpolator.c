/*
 * The interpolator that follows from a machine: how long its words are, and how far an angle
 * reaches.
 */
#include "controller/controller.h"

#include "base/assert.h"
#include "base/maths.h"

/* V_max: of two linear axes at once, each as fast as the fastest. */
void takt_controller_interpolator_config(const struct machine *machine,
                                         struct interpolator_config *config)
{
    double range_mm = 0.0;
    double velocity_mm_s = 0.0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (axis->present) {
            range_mm = maths_max(range_mm, axis->travel_max_mm - axis->travel_min_mm);
        }
        if (axis->present && i < AXIS_LINEAR_COUNT) {
            velocity_mm_s = maths_max(velocity_mm_s, axis->max_velocity_mm_s);
        }
    }
    TAKT_ASSERT(range_mm >= 0.0 && velocity_mm_s >= 0.0 && machine->resolution_per_mm > 0.0);
    *config = (struct interpolator_config){
        .kind = (enum interpolator_kind)machine->interpolator,
        .end_shift = machine->interpolator_end_shift,
        .angle_bits = machine->interpolator_angle_bits,
        .unit_mm = takt_interpolator_unit_mm(1.0 / machine->resolution_per_mm, range_mm,
                                             machine->interpolator_word_bits),
        .way_max_mm = maths_sqrt(2.0) * velocity_mm_s * 1e-6 * (double)machine->cycle_us,
    };
}
