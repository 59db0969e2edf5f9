/*
 * What the rooms of the controller are set up with: limits to plan by, and what a program is read
 * by, of a machine.
 */
#include "controller/controller.h"

#include "base/assert.h"

#include <string.h>

void takt_controller_plan_limits(const struct machine *machine, struct plan_limits *limits)
{
    memset(limits, 0, sizeof(*limits));
    limits->axes = takt_machine_axes(machine);
    limits->cycle_s = machine_cycle_s(machine);
    limits->profile = (enum ramp_profile)machine->profile;
    limits->landing = (enum landing)machine->landing;
    TAKT_ASSERT(limits->cycle_s > 0.0 && machine->resolution_per_mm > 0.0);
    limits->chord_error_max_mm = 1.0 / machine->resolution_per_mm;
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits->velocity_mm_s[i] = machine->axis[i].max_velocity_mm_s;
        limits->acceleration_mm_s2[i] = machine->axis[i].max_acceleration_mm_s2;
        limits->jerk_mm_s3[i] = machine->axis[i].max_jerk_mm_s3;
    }
}

void takt_controller_reserve_correction(struct correction *correction,
                                        const struct machine *machine, struct plan_limits *limits)
{
    struct motion_bound most;
    struct need need;

    takt_machine_motion_bound(machine, &most);
    takt_correction_reserve(correction, &most, &need);
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits->velocity_mm_s[i] -= need.velocity_mm_s[i];
        limits->acceleration_mm_s2[i] -= need.acceleration_mm_s2[i];
        limits->jerk_mm_s3[i] -= need.jerk_mm_s3[i];
    }
}

void takt_controller_program_config(const struct controller_config *config,
                                    struct program_config *program)
{
    const struct machine *machine = config->machine;

    memset(program, 0, sizeof(*program));
    program->axes = takt_machine_axes(machine);
    for (int i = 0; i < AXIS_COUNT; i++) {
        program->travel_min[i] = machine->axis[i].travel_min_mm;
        program->travel_max[i] = machine->axis[i].travel_max_mm;
    }
    program->path_tolerance_mm = machine->path_tolerance_mm;
    program->spindle_max_rpm = machine->spindle_max_rpm;
    program->spindle_encoder = machine->spindle_encoder_counts > 0;
    program->exact_path = config->exact_path;
    program->block_delete = config->block_delete;
    program->from_line = config->from_line;
    program->sharp_corners = machine->sharp_corners;
    program->correction_layers = CORRECTION_LAYERS_COUNT;
    program->say = config->say;
    program->listener = config->listener;
    program->modes = config->modes;
    program->tools = config->tools;
    program->parameters = config->parameters;
    program->waits = true;
}
