#include "controller/machine.h"

#include <string.h>

void machine_set_default(struct machine *machine)
{
    static const char name[] = "built-in three-axis mill";

    memset(machine, 0, sizeof(*machine));
    memcpy(machine->name, name, sizeof(name));
    machine->cycle_us = 1000;
    machine->resolution_per_mm = 1000.0;
    machine->look_ahead_blocks = MACHINE_LOOK_AHEAD_MAX;
    machine->spindle_max_rpm = 24000.0;
    machine->can_bitrate = 1000000;
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        machine->axis[i] = (struct machine_axis){
            .present = true,
            .max_velocity_mm_s = 100.0,
            .max_acceleration_mm_s2 = 1000.0,
            .max_jerk_mm_s3 = 50000.0,
            .travel_min_mm = -500.0,
            .travel_max_mm = 500.0,
            .drive_node = (uint8_t)(i + 1),
            .increments_per_mm = 100000.0,
            .following_error_max_mm = 1.0,
        };
    }
}

unsigned machine_axes(const struct machine *machine)
{
    unsigned axes = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present) {
            axes |= 1U << i;
        }
    }
    return axes;
}
