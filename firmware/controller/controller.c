#include "controller/controller.h"

#include "base/maths.h"

#include <string.h>

#define START_TIMEOUT_S  5.0
#define ANSWER_TIMEOUT_S 0.02

static double cycle_s(const struct machine *machine)
{
    return 1e-6 * (double)machine->cycle_us;
}

void controller_plan_limits(const struct machine *machine, struct plan_limits *limits)
{
    memset(limits, 0, sizeof(*limits));
    limits->axes = machine_axes(machine);
    limits->cycle_s = cycle_s(machine);
    limits->chord_error_max_mm = 1.0 / machine->resolution_per_mm;
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits->velocity_mm_s[i] = machine->axis[i].max_velocity_mm_s;
        limits->acceleration_mm_s2[i] = machine->axis[i].max_acceleration_mm_s2;
        limits->jerk_mm_s3[i] = machine->axis[i].max_jerk_mm_s3;
    }
}

static uint32_t cycles_in(const struct machine *machine, double time_s)
{
    return (uint32_t)maths_ceil(time_s / cycle_s(machine));
}

static void drives_config_set(struct drives_config *config, const struct machine *machine)
{
    memset(config, 0, sizeof(*config));
    config->start_timeout_cycles = cycles_in(machine, START_TIMEOUT_S);
    config->answer_timeout_cycles = cycles_in(machine, ANSWER_TIMEOUT_S);
    for (int i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (axis->present) {
            config->axis[config->count] = (struct drives_config_axis){
                .axis = (enum axis)i,
                .node = axis->drive_node,
                .increments_per_mm = axis->increments_per_mm,
                .following_error_max_mm = axis->following_error_max_mm,
            };
            config->count++;
        }
    }
}

void controller_program_config(const struct controller_config *config,
                               struct program_config *program)
{
    const struct machine *machine = config->machine;

    memset(program, 0, sizeof(*program));
    program->axes = machine_axes(machine);
    for (int i = 0; i < AXIS_COUNT; i++) {
        program->travel_min[i] = machine->axis[i].travel_min_mm;
        program->travel_max[i] = machine->axis[i].travel_max_mm;
    }
    program->path_tolerance_mm = machine->path_tolerance_mm;
    program->spindle_max_rpm = machine->spindle_max_rpm;
    program->exact_path = config->exact_path;
    program->block_delete = config->block_delete;
    program->from_line = config->from_line;
    program->sharp_corners = machine->sharp_corners;
    program->tools = config->tools;
    program->parameters = config->parameters;
}

void controller_init(struct controller *c, const struct controller_config *config)
{
    struct program_config program;
    struct plan_limits limits;
    struct drives_config drives;

    memset(c, 0, sizeof(*c));
    c->machine = *config->machine;
    c->can = config->can;
    c->state = CONTROLLER_STARTING;
    controller_program_config(config, &program);
    program_open(&c->program, &program, &config->source);
    offset_open(&c->offset, &program);
    controller_plan_limits(&c->machine, &limits);
    window_init(&c->window, &limits, c->machine.look_ahead_blocks, &program.start);
    motion_init(&c->motion, limits.cycle_s, &program.start);
    drives_config_set(&drives, &c->machine);
    drives_init(&c->drives, &drives);
}

/*
 * What ends the program after this move. Nothing answers for a probe here, so a probing move that must make contact
 * fails at its end.
 */
static enum takt_error trouble_of(const struct move *move)
{
    if (move_is_involute(move)) {
        return TAKT_ERROR_INVOLUTE_UNPLANNED;
    }
    if (move->kind == MOVE_PROBE && !move->probe_optional) {
        return TAKT_ERROR_PROBE_NO_CONTACT;
    }
    return TAKT_OK;
}

/* A move has been read: into the window with it, unless it cannot be planned. */
static void take_move(struct controller *c, const struct move *move)
{
    const enum takt_error trouble = trouble_of(move);

    c->program_error.code = TAKT_OK;
    if (trouble != TAKT_ERROR_INVOLUTE_UNPLANNED) {
        window_push(&c->window, move);
    }
    if (trouble != TAKT_OK) {
        diagnostic_set(&c->program_error, trouble, move->line, 0, "", 0, 0.0);
    }
    c->program_ended = trouble != TAKT_OK || move->kind == MOVE_END;
}

/* One move from the program into the window. */
static void read_move(struct controller *c)
{
    struct move move;

    if (offset_next(&c->offset, &c->program, &move, &c->program_error) == PROGRAM_MOVE) {
        take_move(c, &move);
    } else {
        c->program_ended = true;
    }
    if (c->program_ended) {
        window_finish(&c->window);
    }
}

void controller_background(struct controller *c)
{
    while (motion_has_room(&c->motion)) {
        while (!c->program_ended && window_has_room(&c->window)) {
            read_move(c);
        }
        if (!window_is_ready(&c->window)) {
            return;
        }
        window_take(&c->window, motion_next_slot(&c->motion));
        motion_push(&c->motion);
    }
}

static void controller_fail(struct controller *c, const struct diagnostic *fault)
{
    c->state = CONTROLLER_FAULTED;
    c->fault = *fault;
}

/* The queue ran dry: after a program error that is its end, else the background was too slow. */
static void controller_starve(struct controller *c)
{
    struct diagnostic starved = {.code = TAKT_ERROR_STARVED};

    controller_fail(c, c->program_error.code != TAKT_OK ? &c->program_error : &starved);
}

static void follow_drives(struct controller *c)
{
    switch (drives_get_state(&c->drives)) {
    case DRIVES_STARTING:
        break;
    case DRIVES_ENABLED:
        if (c->state == CONTROLLER_STARTING) {
            c->state = CONTROLLER_RUNNING;
        }
        break;
    case DRIVES_FAULTED:
        controller_fail(c, drives_get_fault(&c->drives));
        break;
    }
}

static void follow_path(struct controller *c)
{
    switch (motion_cycle(&c->motion, &c->record)) {
    case MOTION_CYCLE:
        c->has_record = true;
        break;
    case MOTION_DONE:
        c->state = CONTROLLER_COMPLETED;
        break;
    case MOTION_STARVED:
        controller_starve(c);
        break;
    }
}

static void complete_record(struct controller *c)
{
    c->record.override_percent = 100.0;
    c->record.limiter = 1.0;
    c->record.set = c->record.cmd;
    drives_get_actual(&c->drives, &c->record.act);
    c->setpoint = c->record.set;
}

void controller_cycle(struct controller *c, const struct inputs *inputs)
{
    c->inputs = *inputs;
    c->has_record = false;
    drives_receive(&c->drives, &c->can);
    drives_sync(&c->drives, &c->can);
    follow_drives(c);
    if (c->state == CONTROLLER_RUNNING) {
        follow_path(c);
    }
    if (c->has_record) {
        complete_record(c);
    }
    drives_send(&c->drives, &c->can, &c->setpoint);
}

enum controller_state controller_get_state(const struct controller *c)
{
    return c->state;
}

const struct diagnostic *controller_get_fault(const struct controller *c)
{
    return &c->fault;
}

const struct cycle_record *controller_get_record(const struct controller *c)
{
    return c->has_record ? &c->record : NULL;
}

const struct outputs *controller_get_outputs(const struct controller *c)
{
    return &c->outputs;
}

const struct segment *controller_get_segment(const struct controller *c)
{
    return c->has_record ? motion_segment(&c->motion) : NULL;
}
