#include "controller/restart.h"

#include "controller/controller_feed.h"
#include "controller/controller_shape.h"
#include "controller/controller_steps.h"

#include <string.h>

void controller_start_program(struct controller *c, const struct controller_config *config,
                              const struct point *start)
{
    struct program_config program;
    struct plan_limits limits;

    controller_program_config(config, &program);
    program.start = *start;
    program_open(&c->reader->program, &program, &config->source);
    offset_open(&c->reader->offset, &program);
    controller_plan_limits(&c->machine, &limits);
    controller_shape_leave(c, &limits);
    controller_reserve_correction(&c->correction, &c->machine, &limits);
    path_init(&c->path, &limits, start);
    motion_init(&c->motion, &c->path, start, c->machine.override_proportional != 0);
    controller_feed_init(c, config->compiled);
    lock_restart(&c->lock);
    correction_forget_setup(&c->correction);
    c->keeps_outputs = config->keeps_outputs;
    c->program_waits = false;
    c->program_late = false;
    c->program_begins = false;
    c->refuse = config->refuse;
    c->program_ended = false;
    c->program_error.code = TAKT_OK;
    c->has_record = false;
    c->record.cmd = *start;
    c->state = CONTROLLER_RUNNING;
}

void controller_drop_program(struct controller *c)
{
    c->program_ended = true;
    c->has_record = false;
    c->state = CONTROLLER_COMPLETED;
}

void controller_quieten(struct controller *c)
{
    memset(&c->surface, 0, sizeof(c->surface));
    c->outputs.spindle_speed_rpm = 0.0;
    c->outputs.spindle_orient = false;
    c->outputs.mist = false;
    c->outputs.flood = false;
}

void controller_begin(struct controller *c)
{
    c->program_begins = true;
}

void controller_set_coolant(struct controller *c, bool flood, bool on)
{
    if (flood)
        c->outputs.flood = on;
    else
        c->outputs.mist = on;
}

bool controller_passed_stop(const struct controller *c, bool *optional)
{
    for (uint32_t i = c->motion.passed_first; c->has_record && i != c->path.first; i++) {
        if (path_kind(&c->path, i) == MOVE_STOP) {
            struct move move;

            path_read_move(&c->path, i, &move);
            *optional = move.optional;
            return true;
        }
    }
    return false;
}

static void be_faulted(struct controller *c)
{
    controller_quieten(c);
    c->state = CONTROLLER_FAULTED;
    c->fault = *drives_get_fault(&c->drives);
}

void controller_stop_at_once(struct controller *c, enum takt_error reason)
{
    drives_stop_at_once(&c->drives, reason);
    be_faulted(c);
}

void controller_stop_for(struct controller *c, const struct diagnostic *fault)
{
    drives_stop_for(&c->drives, fault);
    be_faulted(c);
}

void controller_end(struct controller *c, bool at_once)
{
    if (at_once) {
        controller_stop_at_once(c, TAKT_ERROR_ENDED);
    } else {
        drives_stop_on_path(&c->drives, TAKT_ERROR_ENDED);
    }
}

bool controller_has_ended(const struct controller *c)
{
    return drives_get_state(&c->drives) == DRIVES_FAULTED;
}

void controller_recover(struct controller *c, const struct controller_config *config, bool home)
{
    struct drives_config drives;

    controller_drives_config(&c->machine, c->dcf, &drives);
    drives.homed = !home && drives_are_homed(&c->drives);
    drives_init(&c->drives, &drives);
    controller_steps_restart(c);
    correction_restart(&c->correction, &c->record.set);
    controller_shape_restart(c);
    controller_start_program(c, config, &c->record.set);
    c->state = CONTROLLER_STARTING;
}

void controller_follow_drives(struct controller *c, struct point *at)
{
    controller_get_actual(c, at);
    if (drives_get_state(&c->drives) == DRIVES_STARTING) {
        c->record.set = *at;
        approach_init(&c->approach, at);
    } else {
        *at = c->record.set;
    }
}
