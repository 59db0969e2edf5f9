#include "controller/controller.h"

#include "base/assert.h"
#include "base/maths.h"
#include "controller/controller_feed.h"
#include "controller/controller_shape.h"
#include "controller/controller_spindle_sync.h"
#include "controller/controller_steps.h"
#include "controller/outputs.h"
#include "controller/restart.h"
#include "program/changes.h"

#include <string.h>

void takt_controller_init(struct controller *c, const struct controller_config *config)
{
    const struct point start = {0};
    struct drives_config drives;
    struct interpolator_config interpolator;

    memset(c, 0, sizeof(*c));
    c->machine = *config->machine;
    c->can = config->can;
    c->reader = config->reader;
    controller_shape_init(c, config);
    takt_correction_init(&c->correction, &c->machine.correction, takt_machine_axes(&c->machine),
                         machine_cycle_s(&c->machine), config->correction, &start);
    takt_controller_start_program(c, config, &start);
    c->state = CONTROLLER_STARTING;
    takt_spindle_watch_init(&c->spindle, machine_cycle_s(&c->machine),
                            c->machine.spindle_load_limit_percent, c->machine.spindle_at_speed_s);
    takt_tool_changer_init(&c->changer, machine_cycle_s(&c->machine), c->machine.tool_change_s);
    takt_controller_spindle_sync_init(c);
    c->dcf = config->dcf;
    takt_controller_drives_config(&c->machine, c->dcf, &drives);
    takt_drives_init(&c->drives, &drives);
    takt_controller_steps_init(c, &config->step);
    (void)takt_controller_cycle_is_enough(&c->machine, &c->warning);
    takt_controller_interpolator_config(&c->machine, &interpolator);
    takt_interpolator_init(&c->interpolator, &interpolator);
    takt_approach_init(&c->approach, &start);
}

static void controller_fail(struct controller *c, const struct diagnostic *fault)
{
    TAKT_ASSERT(fault->code != TAKT_OK);
    c->state = CONTROLLER_FAULTED;
    c->fault = *fault;
}

/* Everything has been done, and no end of the program came: an error ended it. */
static void controller_end_in_error(struct controller *c)
{
    c->reached = CHANGES_ALL;
    controller_fail(c, &c->program_error);
}

/* The drives hold where they stand; the program starts where it starts. */
static void come_to_start(struct controller *c)
{
    struct point actual;

    takt_controller_get_actual(c, &actual);
    if (takt_approach_cycle(&c->approach, &c->machine, &actual, &c->record.set)) {
        c->record.cmd = c->record.set;
        controller_shape_restart(c);
        c->state = CONTROLLER_RUNNING;
    }
}

/* On the way to the start of the program there is no path to come to rest on. */
static void brake_off_the_path(struct controller *c)
{
    if (c->state == CONTROLLER_STARTING) {
        takt_drives_stop_for(&c->drives, takt_drives_get_fault(&c->drives));
    }
}

static void follow_drives(struct controller *c)
{
    switch (drives_get_state(&c->drives)) {
    case DRIVES_STARTING:
        takt_motion_prepare(&c->motion);
        break;
    case DRIVES_ENABLED:
        if (c->state == CONTROLLER_STARTING) {
            come_to_start(c);
        }
        break;
    case DRIVES_STOPPING:
        brake_off_the_path(c);
        break;
    case DRIVES_BRAKING:
        if (c->state < CONTROLLER_STOPPING) {
            c->state = CONTROLLER_STOPPING;
        }
        break;
    case DRIVES_FAULTED:
        controller_fail(c, takt_drives_get_fault(&c->drives));
        break;
    }
}

/* The spindle's angle, speed and load. */
static void follow_spindle(struct controller *c, const struct spindle_feedback *spindle)
{
    spindle_sync_measure(&c->sync, spindle);
    if (c->state == CONTROLLER_RUNNING && !spindle_watch_cycle(&c->spindle, spindle)) {
        controller_fail(c, &(const struct diagnostic){.code = TAKT_ERROR_SPINDLE_SLOW});
    }
}

/* M6: the changer brings the tool, if there is one. */
static void follow_changer(struct controller *c)
{
    const bool stands = c->state == CONTROLLER_RUNNING && c->motion.end == MOTION_CHANGES_TOOL;
    bool is_changed = false;

    c->changer.is_there = takt_drives_find_input(&c->drives, IO_TOOL_CHANGED, &is_changed);
    const enum takt_error error = takt_tool_changer_cycle(&c->changer, stands, is_changed);
    if (error != TAKT_OK) {
        controller_fail(
            c, &(const struct diagnostic){.code = error, .value = c->machine.tool_change_s});
    }
    c->outputs.tool_change = tool_changer_asks(&c->changer);
}

static enum motion_hold hold_of(const struct controller *c, const struct inputs *in)
{
    if (drives_get_state(&c->drives) == DRIVES_STOPPING) {
        return MOTION_STOPS;
    }
    return in->feed_stop ? MOTION_HOLDS : in->feed_hold ? MOTION_HOLD_ASKED : MOTION_GOES;
}

static enum motion_obeys obeys_of(const struct inputs *in)
{
    return !in->program_stop   ? MOTION_OBEYS_NONE
           : in->optional_stop ? MOTION_OBEYS_M0_AND_M1
                               : MOTION_OBEYS_M0;
}

static struct motion_operator operator_of(const struct controller *c, const struct inputs *in)
{
    return (struct motion_operator){
        .feed_ratio = c->spindle.ratio *
                      maths_clamp(0.01 * in->feed_override_percent, 0.0, BLOCK_OVERRIDE_MAX),
        .rapid_ratio = maths_clamp(0.01 * in->rapid_override_percent, 0.0, 1.0),
        .hold = hold_of(c, in),
        .single_block = in->single_block,
        .obeys = obeys_of(in),
        .wait = c->spindle.waits,
        .settles = !controller_shape_is_settled(c),
        .tool_waits = tool_changer_waits(&c->changer),
        .measures = true,
        .spindle_rev_s = c->spindle.rev_s,
    };
}

/* Spindle, coolant and lines, as what has been passed in this cycle sets them. */
static void follow_events(struct controller *c)
{
    for (uint32_t i = c->motion.passed_first; i != c->path.first; i++) {
        if (!path_at(&c->path, i)->motion) {
            struct move move;

            c->waits++;
            takt_path_read_move(&c->path, i, &move);
            takt_outputs_apply(&c->outputs, &c->surface, &move);
            takt_spindle_watch_pass(&c->spindle, &move);
            if (move.kind == MOVE_WEAR) {
                takt_correction_set_wear(&c->correction, move.tool, move.wear_length_mm,
                                         move.wear_time_s);
            }
        }
    }
    outputs_follow(&c->outputs, &c->surface, &c->record.cmd);
}

/* No cycle was made, but events may stand before the end, and the end is one. */
static void end_program(struct controller *c)
{
    TAKT_ASSERT(c->path.first != c->path.closed);
    follow_events(c);
    if (!c->keeps_outputs) {
        takt_outputs_apply(&c->outputs, &c->surface, &path_first(&c->path)->move);
    }
    c->reached = CHANGES_ALL;
    c->state = CONTROLLER_COMPLETED;
}

/* A thread: the setpoint follows the spindle's angle. */
static void follow_angle(struct controller *c, const struct motion_operator *asked)
{
    const enum spindle_sync_result result = takt_spindle_sync_cycle(
        &c->sync, &c->motion, asked, c->outputs.spindle_speed_rpm, &c->record);

    if (result == SPINDLE_SYNC_FAILED) {
        controller_fail(c, &c->sync.alarm);
    }
    c->has_record = result == SPINDLE_SYNC_CYCLE;
}

/* A compiled program: the setpoint is on its curve. */
static void follow_replay(struct controller *c, const struct motion_operator *asked)
{
    c->has_record = takt_replay_cycle(&c->replay, &c->motion, asked, &c->record) == REPLAY_CYCLE;
    if (!c->has_record) {
        controller_fail(c, &c->replay.alarm);
    }
}

/* The setpoint is not motion's. */
static void follow_handed_over(struct controller *c, const struct motion_operator *asked)
{
    if (!takt_controller_feed_is_product(c)) {
        follow_angle(c, asked);
        return;
    }
    if (c->replays) {
        follow_replay(c, asked);
        return;
    }
    takt_product_cycle(&c->product, &c->motion, asked, &c->record);
    c->has_record = true;
}

/* A fault of the planner; the axes stand. */
static void fail_stalled(struct controller *c)
{
    struct diagnostic stalled;

    takt_diagnostic_set(&stalled, TAKT_ERROR_STALLED, takt_motion_stalled_line(&c->motion), 0, "",
                        0, 0.0);
    controller_fail(c, &stalled);
}

static void follow_path(struct controller *c, const struct inputs *in)
{
    const struct motion_operator asked = operator_of(c, in);

    switch (takt_motion_cycle(&c->motion, &asked, &c->record)) {
    case MOTION_CYCLE:
        c->has_record = true;
        break;
    case MOTION_HANDED_OVER:
        follow_handed_over(c, &asked);
        break;
    case MOTION_NOT_YET:
        break;
    case MOTION_DONE:
        end_program(c);
        break;
    case MOTION_EMPTY:
        controller_end_in_error(c);
        break;
    case MOTION_STALLED:
        fail_stalled(c);
        break;
    }
}

void takt_controller_get_actual(const struct controller *c, struct point *actual)
{
    drives_get_actual(&c->drives, actual);
    if (steps_are_there(&c->steps)) {
        takt_steps_get_actual(&c->steps, actual);
    }
}

/* Where the axes are. */
static struct controller_place place_of(const struct controller *c)
{
    struct controller_place at;

    const struct point *corrected = controller_shape_input(c);

    takt_controller_get_actual(c, &at.reported);
    for (int i = 0; i < AXIS_COUNT; i++) {
        at.actual.at[i] = at.reported.at[i] - (corrected->at[i] - c->record.cmd.at[i]);
    }
    return at;
}

/* What the program has asked of probe and inputs. */
static void follow_probe(struct controller *c, const struct inputs *in)
{
    const struct controller_place at = place_of(c);

    if (takt_controller_probe_watch(&c->probe, &motion_block(&c->motion)->move, in, &at)) {
        takt_motion_end_here(&c->motion);
    }
    if (hold_of(c, in) == MOTION_GOES && c->program_waits && takt_motion_is_idle(&c->motion) &&
        controller_shape_is_settled(c)) {
        struct inputs seen = *in;

        takt_drives_add_inputs(&c->drives, &seen);
        (void)takt_controller_probe_rest(&c->probe, &seen, &c->drives, &c->record.cmd, &at);
    }
}

/* What the machine's interpolator makes of the exact setpoint. */
static void interpolate(struct controller *c, const struct block *block)
{
    if (!interpolator_is_exact(&c->interpolator) && block_is_motion(block)) {
        takt_interpolator_cycle(&c->interpolator, &block->curve, c->record.block, c->record.landed,
                                &c->record.cmd);
    }
}

/* Blocks have the number of the motion that they are, or that is before them. */
static void note_place(struct controller *c, const struct block *block)
{
    const bool waits = !block_is_motion(block) && c->motion.current == c->path.first;

    c->reached = block->number + c->waits + (waits ? 1U : 0U);
}

static void complete_record(struct controller *c, const struct inputs *in)
{
    const struct block *block = motion_block(&c->motion);

    note_place(c, block);
    interpolate(c, block);
    takt_correction_cycle(&c->correction, &c->record.cmd, &block->move, &c->record.set);
    controller_shape_cycle(c, move_is_synchronized(&block->move));
    takt_controller_get_actual(c, &c->record.act);
    c->record.spindle_rev = in->spindle.angle_rev;
}

/* Between programs correction fades in; whatever has begun to fade goes on until it is done. */
static bool stands_corrected(const struct controller *c)
{
    return drives_get_state(&c->drives) == DRIVES_ENABLED &&
           (c->state == CONTROLLER_COMPLETED ||
            (c->state != CONTROLLER_STARTING && takt_correction_get_running(&c->correction) != 0));
}

/* A cycle without motion. */
static void stand(struct controller *c)
{
    if (stands_corrected(c)) {
        takt_correction_stand(&c->correction, &c->record.cmd, &c->record.set);
        controller_shape_cycle(c, false);
    }
}

/* What is sent, too. */
static bool stands_still(const struct controller *c)
{
    return takt_motion_rests(&c->motion) && controller_shape_is_settled(c);
}

/* Nothing that stands behind the place in the program is done any more. */
static bool rests_after_fault(const struct controller *c)
{
    return drives_get_state(&c->drives) == DRIVES_STOPPING && stands_still(c);
}

void takt_controller_cycle(struct controller *c, const struct inputs *inputs)
{
    const bool starts = c->state == CONTROLLER_STARTING; /* that is enough for one cycle */

    c->has_record = false;
    takt_drives_receive(&c->drives, c->can.port);
    takt_drives_sync(&c->drives, c->can.port);
    follow_drives(c);
    follow_spindle(c, &inputs->spindle);
    if (c->state == CONTROLLER_RUNNING && !starts && !rests_after_fault(c)) {
        follow_path(c, inputs);
    }
    if (c->has_record) {
        follow_events(c);
        complete_record(c, inputs);
        if (controller_probe_is_asked(&c->probe)) {
            follow_probe(c, inputs);
        }
    } else {
        stand(c);
    }
    controller_spindle_sync_command(c);
    if (drives_get_state(&c->drives) == DRIVES_STOPPING && c->state == CONTROLLER_RUNNING &&
        !stands_still(c)) {
        drives_await_rest(&c->drives);
    }
    takt_drives_send(&c->drives, c->can.port, &c->record.set);
    if (drives_have_io(&c->drives)) {
        follow_changer(c);
        takt_drives_send_outputs(&c->drives, c->can.port, &c->outputs);
    }
    if (steps_are_there(&c->steps)) {
        takt_controller_steps_cycle(c);
    }
}
