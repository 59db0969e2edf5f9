#include "session/planner.h"

#include "base/maths.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "config/shaper.h"
#include "motion/motion.h"
#include "plan/path_unit.h"

#include <assert.h>
#include <stdlib.h>

struct planner {
    struct session_reading reading;
    struct path path;
    struct motion motion;
    uint32_t look_ahead;
    double cycle_s;
    bool ended;
    uint64_t cycles_before;       /* made before the last one */
    struct planned_block planned; /* the block being passed */
    double entered_s;             /* when its start was passed */
    /* of each motion by its number: as planned_block has it, but for what turns */
    double *program_mm_s;
    size_t room;
    bool failed; /* out of memory */
};

/* As the controller does. */
static void reserve_for_correction(const struct session *s, const struct point *start,
                                   struct plan_limits *limits)
{
    static _Thread_local struct correction correction;

    takt_correction_init(&correction, &s->setup.machine.correction, limits->axes, limits->cycle_s,
                         s->correction, start);
    takt_controller_reserve_correction(&correction, &s->setup.machine, limits);
}

static void start_planner(struct planner *p, const struct session *s)
{
    struct program_config config;
    struct plan_limits limits;
    struct source source;

    session_begin_reading(s, &p->reading, &config, &source);
    takt_program_open(&p->reading.program, &config, &source);
    takt_cutter_compensation_open(&p->reading.offset, &config);
    shaper_plan_limits(&s->setup, &limits);
    reserve_for_correction(s, &config.start, &limits);
    p->look_ahead = s->setup.machine.look_ahead_blocks;
    p->cycle_s = limits.cycle_s;
    takt_path_init(&p->path, &limits, &config.start);
    takt_motion_init(&p->motion, &p->path, &config.start, false);
}

static_assert(SMOOTH_AHEAD_PIECES == MACHINE_LOOK_AHEAD_MAX,
              "smoothing leaves so much for a stop within the blocks that are known");

/* What the program asks of the newest motion: a smoothed path has feeds in nominal time alone. */
static void note_feed(struct planner *p, const struct move *move)
{
    const bool counts = move->kind != MOVE_RAPID && move->feed_rev_mm == 0.0;

    if (p->path.motions >= p->room) {
        const size_t room = 2 * (size_t)p->path.motions + 1024;
        double *grown = realloc(p->program_mm_s, room * sizeof *grown);

        p->failed = p->failed || grown == NULL;
        if (grown == NULL)
            return;
        p->program_mm_s = grown;
        p->room = room;
    }
    p->program_mm_s[p->path.motions] = counts ? move->feed_mm_s : 0;
}

static void push(struct planner *p, const struct move *move)
{
    takt_path_push(&p->path, move);
    if (move_is_motion(move))
        note_feed(p, move);
}

static double program_feed(const struct planner *p, const struct block *block)
{
    const bool counts = block_is_motion(block) && !block->curve.rotary && block->number < p->room;

    return counts ? p->program_mm_s[block->number] : 0;
}

static void read_move(struct planner *p)
{
    struct diagnostic diagnostic;
    struct move move;

    switch (takt_cutter_compensation_next(&p->reading.offset, &p->reading.program, &move,
                                          &diagnostic)) {
    case PROGRAM_MOVE:
        push(p, &move);
        break;
    case PROGRAM_WAIT:
        break; /* a plan takes it that a probing move reaches its end, and an input has come */
    case PROGRAM_LATER: /* no file has text that is still coming */
    case PROGRAM_END:
    case PROGRAM_ERROR:
        p->ended = true;
        takt_path_finish(&p->path);
        break;
    }
}

static void fill_path(struct planner *p)
{
    if (takt_motion_wanted(&p->motion) == NULL)
        return;
    takt_path_go_on(&p->path);
    const uint32_t wanted = takt_path_look_ahead(&p->path, p->look_ahead);

    while (!p->ended && takt_path_has_room(&p->path) && takt_motion_ahead(&p->motion) < wanted)
        read_move(p);
    takt_motion_build(&p->motion);
}

/* A block that never reaches its ceiling is governed by its ramps. */
static enum governor governor_of(const struct path *path, uint32_t index,
                                 const struct planned_block *planned)
{
    const struct ceiling_request program = {.feed_ratio = 1, .rapid_ratio = 1};
    const double feed_mm_s = takt_ceiling_block_feed(path, index, &program);

    if (planned->path_feed_mm_s < feed_mm_s * (1 - 1e-6))
        return GOVERNOR_RAMP;
    return planned->block->feed_cap_mm_s < planned->block->feed_program_mm_s ? planned->block->cap
                                                                             : GOVERNOR_PROGRAM;
}

static double path_feed(const struct planner *p)
{
    return p->motion.feed / p->cycle_s;
}

/*
 * When the end of a block was passed: within the last cycle, as if the setpoint went evenly; a stop
 * and a wait are left as a cycle begins.
 */
static double passed_at(const struct planner *p, const struct block *block)
{
    const double feed_mm_s = path_feed(p);
    const double now_s = p->cycle_s * (double)p->motion.cycles;
    const double beyond_mm = path_mm(block->start + block->length, p->motion.setpoint);

    if (block->end == JUNCTION_STOP)
        return p->cycle_s * (double)p->cycles_before;
    if (!(feed_mm_s > 0))
        return now_s;
    return now_s - maths_clamp(beyond_mm / feed_mm_s, 0, p->cycle_s);
}

static void enter(struct planner *p, double feed_mm_s, double now_s)
{
    p->planned = (struct planned_block){.feed_start_mm_s = feed_mm_s,
                                        .feed_cruise_mm_s = feed_mm_s,
                                        .path_feed_mm_s = feed_mm_s > 0 ? path_feed(p) : 0};
    p->entered_s = now_s;
}

/* Hands on one block that this cycle has passed. */
static void leave(struct planner *p, uint32_t index, double feed_mm_s,
                  const struct planner_listener *listener)
{
    const struct block *block = path_read(&p->path, index);
    const double now_s = passed_at(p, block);

    p->planned.block = block;
    p->planned.feed_end_mm_s = block->end == JUNCTION_STOP ? 0 : feed_mm_s;
    p->planned.time_s = maths_max(0, now_s - p->entered_s);
    if (block_is_motion(block))
        p->planned.governor = governor_of(&p->path, index, &p->planned);
    p->planned.program_mm_s = program_feed(p, block);
    listener->take(listener->context, &p->planned);
    enter(p, p->planned.feed_end_mm_s, now_s);
}

static enum motion_result step(struct planner *p, struct cycle_record *record)
{
    const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};

    fill_path(p);
    p->cycles_before = p->motion.cycles;
    return takt_motion_cycle(&p->motion, &as_programmed, record);
}

static void leave_passed(struct planner *p, double feed_mm_s,
                         const struct planner_listener *listener, struct planner_totals *totals)
{
    for (uint32_t i = p->motion.passed_first; i != p->path.first; i++) {
        totals->stops += path_at(&p->path, i)->motion && path_at(&p->path, i)->end == JUNCTION_STOP;
        leave(p, i, feed_mm_s, listener);
    }
}

/* Tells of the cycle that has been made, in the block that it has come to. */
static bool wants_more(struct planner *p, const struct planner_listener *listener)
{
    if (listener->wants_more == NULL || p->path.first == p->path.closed)
        return true;
    p->planned.block = path_first(&p->path);
    p->planned.program_mm_s = program_feed(p, p->planned.block);
    return listener->wants_more(listener->context, &p->planned);
}

static enum motion_result walk(struct planner *p, const struct planner_listener *listener,
                               struct planner_totals *totals)
{
    struct cycle_record record = {0};
    enum motion_result result = MOTION_CYCLE;
    bool wanted = true;

    while ((result == MOTION_CYCLE || result == MOTION_NOT_YET) && wanted && !p->failed &&
           !interrupt_asked()) {
        result = step(p, &record);
        leave_passed(p, record.feed_mm_s, listener, totals);
        p->planned.feed_cruise_mm_s = maths_max(p->planned.feed_cruise_mm_s, record.feed_mm_s);
        p->planned.path_feed_mm_s = maths_max(p->planned.path_feed_mm_s, path_feed(p));
        wanted = wants_more(p, listener);
    }
    if (result == MOTION_DONE) /* the end of the program itself is never passed */
        leave(p, p->motion.current, 0, listener);
    totals->cycles = p->motion.cycles;
    return result;
}

/* NULL, after a message: out of memory. The caller frees it. */
static struct planner *begin_planner(const struct session *s, struct planner_totals *totals)
{
    struct planner *p = calloc(1, sizeof *p);

    *totals = (struct planner_totals){0};
    if (p == NULL)
        message_command_error("out of memory");
    else
        start_planner(p, s);
    return p;
}

static enum command_status end_planner(const struct session *s, struct planner *p,
                                       enum motion_result result)
{
    const bool stalled = result == MOTION_STALLED;
    struct diagnostic why;

    takt_diagnostic_set(&why, TAKT_ERROR_STALLED, takt_motion_stalled_line(&p->motion), 0, "", 0,
                        0.0);
    const bool failed = p->failed;

    if (stalled)
        message_program_error(&s->program, &why);
    if (failed)
        message_command_error("out of memory");
    free(p->program_mm_s);
    free(p);
    if (stalled)
        return STATUS_FAILED;
    if (failed)
        return STATUS_ENVIRONMENT;
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}

enum command_status planner_walk(const struct session *s, const struct planner_listener *listener,
                                 struct planner_totals *totals)
{
    struct planner *p = begin_planner(s, totals);

    if (p == NULL)
        return STATUS_ENVIRONMENT;
    return end_planner(s, p, walk(p, listener, totals));
}
