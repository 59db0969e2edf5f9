/*
 * The controller's background: the program is read and planned as far ahead as there is room, and
 * ceilings are built.
 */
#include "controller/controller.h"

#include "base/assert.h"
#include "program/changes.h"

static void push(struct controller *c, const struct move *move)
{
    c->pushed++;
    takt_changes_place(&c->reader->program, move->changes, c->pushed);
    takt_path_push(&c->path, move);
}

/* The axes come to rest before it, where it waits. */
static void hold_back(struct controller *c, const struct move *move)
{
    struct move stop = *move;

    TAKT_ASSERT(takt_path_has_room(&c->path));
    stop.kind = MOVE_DWELL;
    stop.dwell_s = 0.0;
    push(c, &stop);
    c->program_waits = true;
}

/* The move that has waited. */
static void take_held(struct controller *c)
{
    if (takt_controller_probe_begin(&c->probe)) {
        push(c, &c->probe.move);
        c->program_waits = false;
    }
}

/* A move has been read: onto the path with it. */
static void take_move(struct controller *c, struct move *move)
{
    TAKT_ASSERT(!c->program_ended);
    c->program_error.code = TAKT_OK;
    if (c->replays) {
        takt_replay_prepare(move);
    }
    if (move->kind == MOVE_SETUP) {
        takt_correction_tell_setup(&c->correction, move->channel, move->setup);
    }
    if (takt_controller_probe_ask(&c->probe, move, machine_cycle_s(&c->machine),
                                  takt_drives_have_probe(&c->drives))) {
        push(c, move);
    } else {
        hold_back(c, move);
    }
    c->program_ended = move->kind == MOVE_END;
}

/* A line is wrong, and has changed nothing. */
static bool leaves_out_line(struct controller *c)
{
    if (c->refuse == NULL || c->reader->program.phase == PROGRAM_ENDED ||
        !c->refuse(c->reader->program.config.listener, &c->program_error)) {
        return false;
    }
    c->program_error.code = TAKT_OK;
    return true;
}

/* One move from the program onto the path. */
static void read_move(struct controller *c)
{
    struct move move;

    switch (takt_cutter_compensation_next(&c->reader->offset, &c->reader->program, &move,
                                          &c->program_error)) {
    case PROGRAM_MOVE:
        take_move(c, &move);
        break;
    case PROGRAM_WAIT:
        c->program_waits = true;
        break;
    case PROGRAM_LATER:
        c->program_late = true;
        break;
    case PROGRAM_ERROR:
        c->program_ended = !leaves_out_line(c);
        break;
    case PROGRAM_END:
        c->program_ended = true;
        break;
    }
    if (c->program_ended) {
        takt_path_finish(&c->path);
    }
}

/*
 * The axes rest for the set-up that has been told: it is taken, and is in force before they move.
 * True: it is, or *good is not.
 */
static bool take_setup(struct controller *c, bool *good)
{
    if (!controller_probe_has_rest_for(&c->probe, MOVE_SETUP)) {
        return true;
    }
    if (takt_correction_is_setting_up(&c->correction)) {
        return false;
    }
    if (takt_correction_is_set_up(&c->correction)) {
        return true;
    }
    *good = takt_correction_take_setup(&c->correction);
    return !*good;
}

/* What the program asked has been answered: it goes on from where the axes rest. */
static void take_answer(struct controller *c)
{
    struct program_answer answer;
    struct diagnostic error;
    bool good = true;

    if (!take_setup(c, &good) || !takt_controller_probe_take(&c->probe, &answer, &error)) {
        return;
    }
    if (!good) {
        error.code = TAKT_ERROR_SETUP_RESERVE;
    }
    c->program_waits = false;
    if (error.code != TAKT_OK) {
        c->program_error = error;
        c->program_ended = true;
        takt_path_finish(&c->path);
        return;
    }
    takt_cutter_compensation_answer(&c->reader->offset, &c->reader->program, &answer);
}

/* It is over or was given up, perhaps by a cycle that has interrupted the background. */
static bool is_over(const struct controller *c)
{
    return c->state >= CONTROLLER_STOPPING;
}

static bool can_read(struct controller *c)
{
    return !is_over(c) && !c->program_ended && !c->program_waits && !c->program_late &&
           takt_path_has_room(&c->path);
}

/* A text that comes slowly begins to be driven when as much of it is there as is ever looked at. */
static bool waits_for_text(struct controller *c)
{
    return c->program_late && !motion_has_ceiling(&c->motion) &&
           (!c->program_begins || takt_motion_ahead(&c->motion) == 0);
}

/*
 * Reads more only when the look-ahead has become shorter by this part of it: a ceiling is then made
 * for many blocks.
 */
#define TOP_UP_PART 8

void takt_controller_background(struct controller *c)
{
    if (is_over(c)) {
        return;
    }
    take_answer(c);
    if (c->replays) {
        takt_replay_read(&c->replay, &c->path.limits);
    }
    if (takt_motion_wanted(&c->motion) == NULL) {
        return;
    }
    takt_path_go_on(&c->path);
    take_held(c);
    c->program_late = false;
    const uint32_t wanted = takt_path_look_ahead(&c->path, c->machine.look_ahead_blocks);

    if (takt_motion_ahead(&c->motion) + wanted / TOP_UP_PART <= wanted) {
        while (can_read(c) && takt_motion_ahead(&c->motion) < wanted) {
            read_move(c);
        }
    }
    if (!waits_for_text(c)) {
        takt_motion_build(&c->motion);
    }
}
