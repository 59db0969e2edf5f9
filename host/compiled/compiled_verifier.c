#include "compiled/compiled_verifier.h"

#include "ahead/limits.h"
#include "base/maths.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "config/shaper.h"
#include "motion/handover.h"
#include "replay/replay.h"
#include "verifier/verifier.h"
#include "vibration/vibration.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* What is off the tolerance by no more than this is rounding. */
#define BEYOND_MAX_MM 1e-9

/* An axis is at a limit from this part of it on. */
#define AT_LIMIT 0.97

/* Cycles between two looks at Ctrl-C. */
#define WATCH_CYCLES 4096

/* Read in pieces, as the controller does. */
#define TOP_UP_PART 8

/* Text of what one planner does. */
#define SHARES_MAX 160

/*
 * Replayed a second time at this rate, so that the curve is seen between the setpoints of the
 * first.
 */
#define SLOW_RATE 0.23

struct trial {
    const struct session *session;
    struct session_reading reading;          /* of the replay */
    struct session_reading verifier_reading; /* of the verifier */
    struct path path;
    struct motion motion;
    struct replay replay;
    struct tube_verifier tube;
    struct vibration vibration; /* from setpoints to the tool, which the path is for */
    struct plan_limits limits;
    uint32_t look_ahead;
    double rate;
    double stray;  /* of what the modes' frequencies are uncertain by: -1 ... 1 */
    bool on_board; /* nothing is replayed: for comparison */
    bool ended;
    bool out_of_order;
    uint32_t block; /* of the last cycle */
    double x[AXIS_COUNT], v[AXIS_COUNT], a[AXIS_COUNT];
    uint64_t at_velocity, at_acceleration, at_jerk;
    struct compiled_figures *figures;
};

static size_t read_stream(void *context, uint8_t *bytes, size_t size)
{
    return fread(bytes, 1, size, context);
}

/*
 * What the caller may tell: the motion, of a line of the program if it is not 0, is not to be
 * written.
 */
__attribute__((format(printf, 3, 4))) static void refuse(struct trial *t, uint32_t line,
                                                         const char *why, ...)
{
    va_list arguments;

    t->figures->why_line = line;
    va_start(arguments, why);
    (void)vsnprintf(t->figures->why, sizeof t->figures->why, why, arguments);
    va_end(arguments);
}

/* The tool rests where the axes do. */
static void begin_tool(struct trial *t, const struct point *start)
{
    struct vibration_config modes;
    struct point tool = *start;

    shaper_planned_modes(&t->session->setup, &modes);
    vibration_shift(&modes, t->stray);
    vibration_init(&t->vibration, &modes, t->limits.cycle_s);
    vibration_follow(&t->vibration, &tool);
}

/* At another rate the modes are not met as planned: only limits are verified then. */
static bool has_path(const struct trial *t)
{
    return !t->on_board && (t->rate == 1 || !t->vibration.any);
}

static void begin(struct trial *t, FILE *stream)
{
    const struct replay_source compiled = {.context = stream, .read = read_stream};
    struct program_config config;
    struct source source;

    session_begin_reading(t->session, &t->verifier_reading, &config, &source);
    takt_controller_plan_limits(&t->session->setup.machine, &t->limits);
    tube_verifier_init(&t->tube, &config, &source, t->limits.chord_error_max_mm);
    if (t->stray != 0)
        tube_verifier_widen(&t->tube, STRAY_TOLERANCES);
    session_begin_reading(t->session, &t->reading, &config, &source);
    takt_program_open(&t->reading.program, &config, &source);
    takt_cutter_compensation_open(&t->reading.offset, &config);
    compiled_limits(t->session, &config.start, &t->limits);
    takt_path_init(&t->path, &t->limits, &config.start);
    takt_motion_init(&t->motion, &t->path, &config.start, false);
    if (!t->on_board) {
        takt_handover_allow(&t->motion, MOTION_HANDS_OVER_LINEAR);
        takt_replay_init(&t->replay, takt_path_lend(&t->path, sizeof(struct intake)), &compiled);
    }
    t->look_ahead = t->session->setup.machine.look_ahead_blocks;
    begin_tool(t, &config.start);
    for (int i = 0; i < AXIS_COUNT; i++)
        t->x[i] = config.start.at[i];
}

static void read_move(struct trial *t)
{
    struct diagnostic error;
    struct move move;

    if (takt_cutter_compensation_next(&t->reading.offset, &t->reading.program, &move, &error) ==
        PROGRAM_MOVE) {
        if (!t->on_board)
            takt_replay_prepare(&move);
        takt_path_push(&t->path, &move);
        return;
    }
    t->ended = true;
    takt_path_finish(&t->path);
}

static void background(struct trial *t)
{
    if (!t->on_board)
        takt_replay_read(&t->replay, &t->limits);
    if (takt_motion_wanted(&t->motion) == NULL)
        return;
    takt_path_go_on(&t->path);
    const uint32_t wanted = takt_path_look_ahead(&t->path, t->look_ahead);

    if (takt_motion_ahead(&t->motion) + wanted / TOP_UP_PART <= wanted) {
        while (!t->ended && takt_path_has_room(&t->path) && takt_motion_ahead(&t->motion) < wanted)
            read_move(t);
    }
    takt_motion_build(&t->motion);
}

static bool is_at(double ratio)
{
    return ratio >= AT_LIMIT;
}

/* Velocity, acceleration and jerk by differences, over their limits. */
static void verify_axes(struct trial *t, const struct point *cmd)
{
    const double rate_hz = 1 / t->limits.cycle_s;
    bool at[3] = {false, false, false};

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double v = (cmd->at[i] - t->x[i]) * rate_hz;
        const double a = (v - t->v[i]) * rate_hz;
        const double j = (a - t->a[i]) * rate_hz;
        const double ratio[3] = {maths_abs(v) / t->limits.velocity_mm_s[i],
                                 maths_abs(a) / t->limits.acceleration_mm_s2[i],
                                 maths_abs(j) / t->limits.jerk_mm_s3[i]};

        t->x[i] = cmd->at[i];
        t->v[i] = v;
        t->a[i] = a;
        if ((t->limits.axes & (1U << i)) == 0)
            continue;
        t->figures->velocity[i] = maths_max(t->figures->velocity[i], ratio[0]);
        t->figures->acceleration[i] = maths_max(t->figures->acceleration[i], ratio[1]);
        t->figures->jerk[i] = maths_max(t->figures->jerk[i], ratio[2]);
        for (int k = 0; k < 3; k++)
            at[k] = at[k] || is_at(ratio[k]);
    }
    t->at_velocity += at[0] ? 1 : 0;
    t->at_acceleration += at[1] ? 1 : 0;
    t->at_jerk += at[2] ? 1 : 0;
}

static bool verify_path(struct trial *t, const struct cycle_record *record)
{
    struct point tool = record->cmd;

    if (t->vibration.any)
        vibration_follow(&t->vibration, &tool);
    return tube_verifier_add(&t->tube, &tool, record->block);
}

static bool verify_cycle(struct trial *t, const struct cycle_record *record)
{
    verify_axes(t, &record->cmd);
    t->out_of_order = t->out_of_order || record->block < t->block;
    t->block = record->block;
    t->figures->cycles++;
    return !has_path(t) || verify_path(t, record);
}

/* MOTION_CYCLE: goes on. */
static enum motion_result cycle(struct trial *t, bool *good)
{
    const struct motion_operator wanted = {.feed_ratio = t->rate, .rapid_ratio = t->rate};
    struct cycle_record record = {0};
    enum motion_result result;

    background(t);
    result = takt_motion_cycle(&t->motion, &wanted, &record);
    if (result == MOTION_NOT_YET)
        return MOTION_CYCLE;
    if (result == MOTION_HANDED_OVER) {
        if (takt_replay_cycle(&t->replay, &t->motion, &wanted, &record) == REPLAY_FAILED)
            return MOTION_EMPTY;
        result = MOTION_CYCLE;
    }
    if (result == MOTION_CYCLE)
        *good = verify_cycle(t, &record);
    return result;
}

static enum command_status replay(struct trial *t)
{
    enum motion_result result = MOTION_CYCLE;
    bool good = true;

    while (result == MOTION_CYCLE && good) {
        result = cycle(t, &good);
        if (t->figures->cycles % WATCH_CYCLES == 0 && interrupt_asked())
            return STATUS_INTERRUPTED;
    }
    if (!good) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    if (result == MOTION_DONE)
        return STATUS_DONE;
    if (result == MOTION_STALLED) {
        refuse(t, takt_motion_stalled_line(&t->motion), "the axes do not go on here");
        return STATUS_FAILED;
    }
    refuse(t, 0, "the compiled motion does not fit the program after block %u", (unsigned)t->block);
    return STATUS_FAILED;
}

static bool keeps(struct trial *t, const char *what, int axis, double ratio, double most)
{
    if (ratio <= most)
        return true;
    refuse(t, 0, "the compiled motion has %.6g times the %s limit of axis %c", ratio, what,
           AXIS_LETTERS[axis]);
    return false;
}

static bool keeps_limits(struct trial *t)
{
    const struct compiled_figures *f = t->figures;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if (!keeps(t, "velocity", i, f->velocity[i], VERIFIER_VELOCITY_RATIO) ||
            !keeps(t, "acceleration", i, f->acceleration[i], VERIFIER_ACCELERATION_RATIO) ||
            !keeps(t, "jerk", i, f->jerk[i], VERIFIER_JERK_RATIO))
            return false;
    }
    return true;
}

static void set_shares(const struct trial *t)
{
    struct compiled_figures *f = t->figures;
    const double cycles = maths_max((double)f->cycles, 1);

    f->blocks = t->block;
    f->time_s = (double)f->cycles * t->limits.cycle_s;
    f->at_velocity = (double)t->at_velocity / cycles;
    f->at_acceleration = (double)t->at_acceleration / cycles;
    f->at_jerk = (double)t->at_jerk / cycles;
}

static bool keeps_path(struct trial *t)
{
    struct compiled_figures *f = t->figures;

    tube_verifier_finish(&t->tube);
    f->tube = t->tube.figures;
    f->of_tool = t->vibration.any;
    if (f->tube.beyond_mm <= BEYOND_MAX_MM)
        return true;
    refuse(t, f->tube.beyond_line, "the compiled motion is %.6f mm beyond the tolerance here",
           f->tube.beyond_mm);
    return false;
}

static enum command_status conclude(struct trial *t)
{
    set_shares(t);
    if (t->on_board)
        return STATUS_DONE;
    if (has_path(t) && !keeps_path(t) && t->stray == 0)
        return STATUS_FAILED;
    if (t->out_of_order) {
        refuse(t, 0, "the compiled motion does not keep the order of blocks");
        return STATUS_FAILED;
    }
    return keeps_limits(t) ? STATUS_DONE : STATUS_FAILED;
}

/* One replay at a rate; without a stream the planner on board instead. */
static enum command_status verify_at(const struct session *s, FILE *stream, double rate,
                                     double stray, struct compiled_figures *figures)
{
    struct trial *t = calloc(1, sizeof *t);
    enum command_status status;

    if (t == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    if (stream != NULL)
        rewind(stream);
    t->on_board = stream == NULL;
    t->session = s;
    t->figures = figures;
    t->rate = rate;
    t->stray = stray;
    begin(t, stream);
    status = replay(t);
    if (status == STATUS_DONE)
        status = conclude(t);
    tube_verifier_free(&t->tube);
    free(t);
    return status;
}

/* Within the tolerances that it may be off there? Motions in exact path promise nothing there. */
static bool keeps_stray(struct compiled_figures *figures, int n)
{
    if (figures->stray[n].path_part <= 1)
        return true;
    (void)snprintf(figures->why, sizeof figures->why,
                   "where modes are as much %s as geometry.mode_uncertainty_percent says the "
                   "tool is %.6f mm off the path",
                   n == 0 ? "lower" : "higher", figures->stray[n].deviation_mm);
    return false;
}

/* The tool on machines of other modes. */
static enum command_status verify_strays(const struct session *s, FILE *stream,
                                         struct compiled_figures *figures)
{
    struct vibration_config modes;
    enum command_status status = STATUS_DONE;

    shaper_planned_modes(&s->setup, &modes);
    figures->of_strays = vibration_is_uncertain(&modes);
    for (int n = 0; n < 2 && figures->of_strays && status == STATUS_DONE; n++) {
        struct compiled_figures other = {0};

        status = verify_at(s, stream, 1, n == 0 ? -1 : 1, &other);
        figures->stray[n] = other.tube;
        if (status == STATUS_DONE && !keeps_stray(figures, n))
            status = STATUS_FAILED;
    }
    return status;
}

enum command_status compiled_verifier(const struct session *s, FILE *stream,
                                      struct compiled_figures *figures)
{
    struct compiled_figures slow = {0};
    enum command_status status = verify_at(s, stream, 1, 0, figures);

    if (status == STATUS_DONE)
        status = verify_at(s, stream, SLOW_RATE, 0, &slow);
    figures->tube.deviation_mm = maths_max(figures->tube.deviation_mm, slow.tube.deviation_mm);
    return status == STATUS_DONE ? verify_strays(s, stream, figures) : status;
}

static int write_shares(char *text, size_t size, const char *name, const struct compiled_figures *f)
{
    return snprintf(text, size,
                    "\"%s\": {\"time_s\": %.6f, \"velocity\": %.6f, \"acceleration\": %.6f, "
                    "\"jerk\": %.6f}",
                    name, f->time_s, f->at_velocity, f->at_acceleration, f->at_jerk);
}

char *compiled_shares_json(const struct session *s, FILE *stream)
{
    struct compiled_figures board = {0};
    struct compiled_figures ahead = {0};
    char first[SHARES_MAX];
    char second[SHARES_MAX];
    char *json = malloc(2 * SHARES_MAX + 8);

    if (json == NULL || verify_at(s, NULL, 1, 0, &board) != STATUS_DONE ||
        verify_at(s, stream, 1, 0, &ahead) != STATUS_DONE) {
        free(json);
        return NULL;
    }
    (void)write_shares(first, sizeof first, "board", &board);
    (void)write_shares(second, sizeof second, "ahead", &ahead);
    (void)snprintf(json, 2 * SHARES_MAX + 8, "{%s, %s}", first, second);
    return json;
}
