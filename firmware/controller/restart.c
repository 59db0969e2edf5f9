#include "controller/restart.h"

#include "base/assert.h"
#include "controller/controller_feed.h"
#include "controller/controller_shape.h"
#include "controller/controller_steps.h"
#include "program/changes.h"

#include <string.h>

void takt_controller_start_program(struct controller *c, const struct controller_config *config,
                                   const struct point *start)
{
    struct program_config program;
    struct plan_limits limits;

    takt_controller_program_config(config, &program);
    program.start = *start;
    takt_program_open(&c->reader->program, &program, &config->source);
    takt_cutter_compensation_open(&c->reader->offset, &program);
    takt_controller_plan_limits(&c->machine, &limits);
    controller_shape_leave(c, &limits);
    takt_controller_reserve_correction(&c->correction, &c->machine, &limits);
    takt_path_init(&c->path, &limits, start);
    takt_motion_init(&c->motion, &c->path, start, c->machine.override_proportional != 0);
    takt_controller_feed_init(c, config->compiled);
    takt_interpolator_restart(&c->interpolator);
    takt_steps_leave_path(&c->steps);
    takt_spindle_sync_restart(&c->sync);
    takt_correction_forget_setup(&c->correction);
    c->keeps_outputs = config->keeps_outputs;
    c->program_waits = false;
    c->program_late = false;
    c->program_begins = false;
    c->refuse = config->refuse;
    c->program_ended = false;
    c->program_error.code = TAKT_OK;
    c->has_record = false;
    c->pushed = c->reached = c->waits = 0;
    c->record.cmd = *start;
    c->state = CONTROLLER_RUNNING;
}

void takt_controller_drop_program(struct controller *c)
{
    c->program_ended = true;
    c->has_record = false;
    c->state = CONTROLLER_COMPLETED;
}

bool takt_controller_take_back(struct controller *c)
{
    c->program_ended = true;
    return takt_changes_take_back(&c->reader->program, c->reached);
}

void takt_controller_quieten(struct controller *c)
{
    memset(&c->surface, 0, sizeof(c->surface));
    c->outputs.spindle_speed_rpm = 0.0;
    c->outputs.spindle_orient = false;
    c->outputs.mist = false;
    c->outputs.flood = false;
}

void takt_controller_begin(struct controller *c)
{
    c->program_begins = true;
}

void takt_controller_set_coolant(struct controller *c, bool flood, bool on)
{
    if (flood)
        c->outputs.flood = on;
    else
        c->outputs.mist = on;
}

bool takt_controller_passed_stop(const struct controller *c)
{
    return c->has_record && c->motion.end == MOTION_STOPPED;
}

bool takt_controller_is_settled(const struct controller *c)
{
    double rpm;

    return controller_shape_is_settled(c) && !spindle_sync_get_command(&c->sync, &rpm);
}

static void be_faulted(struct controller *c)
{
    takt_controller_quieten(c);
    c->state = CONTROLLER_FAULTED;
    c->fault = *takt_drives_get_fault(&c->drives);
}

void takt_controller_stop_at_once(struct controller *c, enum takt_error reason)
{
    TAKT_ASSERT(reason != TAKT_OK);
    takt_drives_stop_at_once(&c->drives, reason);
    be_faulted(c);
}

void takt_controller_stop_for(struct controller *c, const struct diagnostic *fault)
{
    takt_drives_stop_for(&c->drives, fault);
    be_faulted(c);
}

void takt_controller_end(struct controller *c, bool at_once)
{
    if (at_once) {
        takt_controller_stop_at_once(c, TAKT_ERROR_ENDED);
    } else {
        takt_drives_stop_on_path(&c->drives, TAKT_ERROR_ENDED);
    }
}

bool takt_controller_has_ended(const struct controller *c)
{
    return drives_get_state(&c->drives) == DRIVES_FAULTED;
}

void takt_controller_recover(struct controller *c, const struct controller_config *config,
                             bool home)
{
    struct drives_config drives;

    takt_controller_drives_config(&c->machine, c->dcf, &drives);
    drives.homed = !home && takt_drives_are_homed(&c->drives);
    drives_get_actual(&c->drives, &drives.at);
    takt_drives_init(&c->drives, &drives);
    takt_controller_steps_restart(c);
    takt_controller_get_actual(c, &c->record.set);
    takt_approach_init(&c->approach, &c->record.set);
    takt_correction_restart(&c->correction, &c->record.set);
    controller_shape_restart(c);
    takt_controller_start_program(c, config, &c->record.set);
    c->state = CONTROLLER_STARTING;
}

void takt_controller_follow_drives(struct controller *c, struct point *at)
{
    takt_controller_get_actual(c, at);
    if (drives_get_state(&c->drives) == DRIVES_STARTING) {
        c->record.set = *at;
        takt_approach_init(&c->approach, at);
    } else {
        *at = c->record.set;
    }
}
