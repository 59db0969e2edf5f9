#include "machine/machine.h"

#include "base/maths.h"
#include "canopen/node.h"
#include "classic/interpolator.h"
#include "classic/limiter.h"

#include <string.h>

void takt_machine_set_default(struct machine *machine)
{
    static const char name[] = "built-in three-axis mill";

    memset(machine, 0, sizeof(*machine));
    memcpy(machine->name, name, sizeof(name));
    machine->cycle_us = 1000;
    machine->resolution_per_mm = 1000.0;
    machine->look_ahead_blocks = MACHINE_LOOK_AHEAD_MAX;
    machine->spindle_max_rpm = 24000.0;
    machine->tool_change_s = 60.0;
    machine->spindle_ramp_rpm_s = 12000.0;
    machine->spindle_encoder_counts = 4096;
    machine->thread_tolerance_mm = 0.1;
    machine->can_bitrate = 1000000;
    machine->heartbeat_ms = 100;
    machine->boot_timeout_ms = 3000;
    machine->sdo_timeout_ms = 2000;
    machine->controller_node = 127;
    machine->error_pdo = 1;
    machine->interpolator_word_bits = INTERPOLATOR_WORD_BITS;
    machine->interpolator_end_shift = INTEGRATE_END_SHIFT;
    for (unsigned i = 0; i < MACHINE_GANTRIES_MAX; i++) {
        machine->gantry[i].axis = AXIS_COUNT;
        machine->gantry[i].drive_node = (uint8_t)(NODE_MAX - 1 - i);
    }
    takt_correction_settings_set_default(&machine->correction);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        machine->axis[i] = (struct machine_axis){
            .present = true,
            .max_velocity_mm_s = 100.0,
            .max_acceleration_mm_s2 = 1000.0,
            .max_jerk_mm_s3 = 50000.0,
            .limiter_band_percent = LIMITER_BAND_PERCENT,
            .travel_min_mm = -500.0,
            .travel_max_mm = 500.0,
            .drive_node = (uint8_t)(i + 1),
            .increments_per_mm = 100000.0,
            .following_error_max_mm = 1.0,
            .steps_per_mm = 1000.0,
            .step_rate_max_hz = 200000.0,
            .home_method = 37,
            .home_velocity_mm_s = 20.0,
            .home_zero_velocity_mm_s = 2.0,
            .home_acceleration_mm_s2 = 500.0,
            .home_timeout_s = 60.0,
        };
    }
}

struct drives_rates takt_machine_get_rates(const struct machine *machine)
{
    return (struct drives_rates){machine->can_bitrate, machine->can_data_bitrate};
}

unsigned takt_machine_axes(const struct machine *machine)
{
    unsigned axes = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present) {
            axes |= 1U << i;
        }
    }
    return axes;
}

unsigned takt_machine_io_count(const struct machine *machine)
{
    unsigned count = 0;

    while (count < IO_NODES_MAX && machine->io[count].node != 0) {
        count++;
    }
    return count;
}

unsigned takt_machine_gantry_count(const struct machine *machine)
{
    unsigned count = 0;

    while (count < MACHINE_GANTRIES_MAX && machine->gantry[count].axis < AXIS_COUNT) {
        count++;
    }
    return count;
}

/* Nodes of all drives on CAN, and their buses. */
static unsigned list_drives(const struct machine *machine, uint8_t node[MACHINE_NODES_MAX],
                            uint8_t bus[MACHINE_NODES_MAX])
{
    unsigned count = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&machine->axis[i])) {
            bus[count] = machine->axis[i].drive_bus;
            node[count++] = machine->axis[i].drive_node;
        }
    }
    for (unsigned i = 0; i < takt_machine_gantry_count(machine); i++) {
        bus[count] = machine->gantry[i].drive_bus;
        node[count++] = machine->gantry[i].drive_node;
    }
    return count;
}

unsigned takt_machine_drive_nodes(const struct machine *machine, uint8_t node[MACHINE_NODES_MAX])
{
    uint8_t bus[MACHINE_NODES_MAX];

    return list_drives(machine, node, bus);
}

unsigned takt_machine_bus_nodes(const struct machine *machine, unsigned bus,
                                uint8_t node[MACHINE_NODES_MAX])
{
    uint8_t of_bus[MACHINE_NODES_MAX];
    const unsigned all = list_drives(machine, node, of_bus);
    unsigned count = 0;

    for (unsigned i = 0; i < all; i++) {
        if (of_bus[i] == bus) {
            node[count++] = node[i];
        }
    }
    return count;
}

unsigned takt_machine_bus_count(const struct machine *machine)
{
    uint8_t node[MACHINE_NODES_MAX], bus[MACHINE_NODES_MAX];
    const unsigned drives = list_drives(machine, node, bus);
    unsigned last = 0;

    for (unsigned i = 0; i < drives; i++) {
        last = bus[i] > last ? bus[i] : last;
    }
    for (unsigned i = 0; i < takt_machine_io_count(machine); i++) {
        last = machine->io[i].bus > last ? machine->io[i].bus : last;
    }
    return last + 1;
}

void takt_machine_motion_bound(const struct machine *machine, struct motion_bound *most)
{
    memset(most, 0, sizeof(*most));
    for (int i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (axis->present) {
            most->velocity_mm_s[i] = axis->max_velocity_mm_s;
            most->acceleration_mm_s2[i] = axis->max_acceleration_mm_s2;
            most->jerk_mm_s3[i] = axis->max_jerk_mm_s3;
            most->farthest_mm[i] =
                maths_max(maths_abs(axis->travel_min_mm), maths_abs(axis->travel_max_mm));
        }
    }
}
