#include "tuning/loop_object.h"

#include "base/maths.h"

#include <stddef.h>

const struct loop_number loop_number[LOOP_NUMBERS] = {
    {"told_inertia_kg_m2", 1e9, 4, offsetof(struct tuning_gains, told_inertia_kg_m2)},
    {"velocity_bandwidth_hz", 1e3, 4, offsetof(struct tuning_gains, velocity_bandwidth_hz)},
    {"velocity_integral_time_s", 1e6, 4, offsetof(struct tuning_gains, velocity_integral_s)},
    {"position_gain_per_s", 1e3, 4, offsetof(struct tuning_gains, position_gain_per_s)},
    {"velocity_feed_forward_ratio", 1e3, 2, offsetof(struct tuning_gains, velocity_forward)},
    {"torque_feed_forward_ratio", 1e3, 2, offsetof(struct tuning_gains, torque_forward)},
};

uint32_t loop_object_of(const struct tuning_gains *gains, unsigned i)
{
    const char *field = (const char *)gains + loop_number[i].field;
    const double value =
        takt_maths_round(*(const double *)(const void *)field * loop_number[i].per_unit);

    return (uint32_t)maths_clamp(value, 0, UINT32_MAX);
}

void loop_object_take(struct tuning_gains *gains, unsigned i, uint32_t value)
{
    char *field = (char *)gains + loop_number[i].field;

    *(double *)(void *)field = value / loop_number[i].per_unit;
}
