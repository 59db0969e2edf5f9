/*
 * libFuzzer's target for everything a part program meets before the axes: the interpreter, cutter
 * compensation, and the planner behind them.
 *
 * Any bytes whatever are read to their end. Every line gives moves or an error that says where;
 * every move is inside the travel, and the planner makes finite, complete profiles of them. The
 * bytes also choose, by their digest, how they are read, so that one corpus serves for all.
 */
#include "base/maths.h"
#include "cutter_compensation/cutter_compensation.h"
#include "motion/motion.h"
#include "program/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TRAVEL_MM    500.0
#define TRAVEL_RAD   (20.0 * MATHS_PI)
#define TRAVEL_SLACK 1e-5
/* A loop may make moves for ever; this many are enough. */
#define MOVES_MAX 1000
/* There are never more errors than lines, and lines repeat only in loops. */
#define ERRORS_MAX 1000
/*
 * After this many bytes the source fails, in loops that move nothing: that is a fault of its own to
 * be tried.
 */
#define READ_MAX 200000U

/* Called by libFuzzer with every input. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const struct tool tools[] = {
    {.number = 1, .offset = {{0.0, 0.0, 50.0, 0.0, 0.0, 0.0}}, .diameter_mm = 6.0},
    {.number = 2, .offset = {{1.0, 2.0, 80.5, 0.0, 0.0, 0.0}}, .diameter_mm = 10.0},
    {.number = 3, .offset = {{0.0, 0.0, -12.0, 0.1, 0.0, 0.0}}, .diameter_mm = 0.5},
};
static const struct tool_table tool_table = {tools, sizeof(tools) / sizeof(tools[0])};

/* The text, and how much of it may still be read. */
struct fuzz_source {
    struct source_text text;
    struct source source;
    size_t left;
};

static struct program program;
static struct cutter_compensation offset;
static struct parameters parameters;
/* A program may be slow: what its plan is run for at most. */
#define ROOM_TRIES    20
#define CYCLES_A_TRY  500
#define CYCLES_AT_END 2000

static struct path path;
static struct motion motion;

/* Behind the longest line of the input. */
static size_t column_max;

static void fail(const char *claim)
{
    (void)fprintf(stderr, "not so: %s\n", claim);
    abort();
}

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fail(#condition);                                                                      \
        }                                                                                          \
    } while (0)

static void check_point(const struct point *point, double slack)
{
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        const double limit = axis < AXIS_LINEAR_COUNT ? TRAVEL_MM : TRAVEL_RAD;

        CHECK(maths_abs(point->at[axis]) <= limit + slack);
    }
}

static void check_move(const struct move *move)
{
    CHECK(move->line > 0 || move->kind == MOVE_END);
    if (!move_is_motion(move)) {
        CHECK(move->kind != MOVE_DWELL || (move->dwell_s >= 0.0 && maths_is_finite(move->dwell_s)));
        CHECK(move->kind != MOVE_SPINDLE ||
              (move->speed_rpm >= 0.0 && maths_is_finite(move->speed_rpm)));
        return;
    }
    check_point(&move->end, TRAVEL_SLACK);
    CHECK(move->kind == MOVE_RAPID || (move->feed_mm_s > 0.0 && maths_is_finite(move->feed_mm_s)));
    CHECK(move->tolerance_mm >= 0.0 && maths_is_finite(move->tolerance_mm));
    CHECK(move->cutter_side == CUTTER_OFF);
    if (move_is_arc(move)) {
        CHECK(maths_is_finite(move->centre_mm[0]) && maths_is_finite(move->centre_mm[1]));
        CHECK(move->turns >= 1);
    }
}

/*
 * Columns are those of the text: comments count, and may make a line longer than what is read of
 * it.
 */
static size_t longest_line(const uint8_t *data, size_t size)
{
    size_t longest = 0;
    size_t length = 0;

    for (size_t i = 0; i < size; i++) {
        length = data[i] == '\n' ? 0 : length + 1;
        longest = length > longest ? length : longest;
    }
    return longest;
}

static void check_diagnostic(const struct diagnostic *d)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    CHECK(d->code < TAKT_OK && d->code >= -(int)TAKT_ERROR_TOTAL);
    CHECK(d->line > 0 || d->code == TAKT_ERROR_FROM_LINE_MISSED);
    CHECK(d->column <= column_max);
    CHECK(takt_diagnostic_text(d, text) > 0);
}

/* Runs what has been planned for this many cycles, or to its end. */
static void run_cycles(unsigned cycles)
{
    const struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record;

    for (unsigned i = 0; i < cycles; i++) {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_path_go_on(&path);
            takt_motion_build(&motion);
        }
        if (takt_motion_cycle(&motion, &as_programmed, &record) != MOTION_CYCLE) {
            return;
        }
        for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
            CHECK(maths_is_finite(record.cmd.at[axis]));
        }
    }
}

static void open_path(const struct program_config *config)
{
    struct plan_limits limits = {
        .axes = config->axes, .cycle_s = 0.001, .chord_error_max_mm = 0.001};

    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        const double unit = axis < AXIS_LINEAR_COUNT ? 1.0 : MATHS_PI / 180.0;

        limits.velocity_mm_s[axis] = 250.0 * unit;
        limits.acceleration_mm_s2[axis] = 2000.0 * unit;
        limits.jerk_mm_s3[axis] = 50000.0 * unit;
    }
    takt_path_init(&path, &limits, &config->start);
    takt_motion_init(&motion, &path, &config->start, false);
}

static bool wait_for_room(void)
{
    for (unsigned i = 0; i < ROOM_TRIES && !takt_path_has_room(&path); i++) {
        run_cycles(CYCLES_A_TRY);
    }
    return takt_path_has_room(&path);
}

static void plan_move(const struct move *move)
{
    if (wait_for_room()) {
        takt_path_push(&path, move);
    }
}

static void plan_rest(void)
{
    if (wait_for_room()) {
        takt_path_finish(&path);
    }
    run_cycles(CYCLES_AT_END);
}

static void check_warnings(void)
{
    struct diagnostic warning;

    while (takt_program_warning(&program, &warning) ||
           takt_cutter_compensation_warning(&offset, &warning)) {
        check_diagnostic(&warning);
    }
}

/*
 * A probe that answers half way and comes to rest a little further, or never does; an input that is
 * read, or not.
 */
static void answer(const struct move *asked, const struct point *from)
{
    struct program_answer a = {
        .contact = asked->line % 2 == 0,
        .contact_at = asked->end,
        .rest_at = asked->end,
        .value = asked->line % 2 == 0 ? 1.0 : PROGRAM_INPUT_TIMED_OUT,
    };

    for (unsigned axis = 0; a.contact && axis < AXIS_COUNT; axis++) {
        a.contact_at.at[axis] = 0.5 * (from->at[axis] + asked->end.at[axis]);
        a.rest_at.at[axis] = 0.4 * from->at[axis] + 0.6 * asked->end.at[axis];
    }
    takt_cutter_compensation_answer(&offset, &program, &a);
}

/* Where a motion leads, and what was asked of the world last. */
struct course {
    struct point from, at;
    struct move asked;
};

static void take_move(const struct move *move, struct course *c)
{
    check_move(move);
    plan_move(move);
    if (move_is_motion(move)) {
        c->from = c->at;
        c->at = move->end;
    }
    if (move->kind == MOVE_PROBE || move->kind == MOVE_INPUT) {
        c->asked = *move;
    }
}

static void read_program(struct point at)
{
    struct course course = {.from = at, .at = at};
    struct diagnostic error;
    struct move move;
    enum program_result result;
    unsigned moves = 0;
    unsigned errors = 0;

    while (moves < MOVES_MAX && errors < ERRORS_MAX &&
           (result = takt_cutter_compensation_next(&offset, &program, &move, &error)) !=
               PROGRAM_END) {
        if (result == PROGRAM_ERROR) {
            check_diagnostic(&error);
            errors++;
        } else if (result == PROGRAM_WAIT) {
            answer(&course.asked, &course.from);
        } else {
            take_move(&move, &course);
            moves++;
        }
        check_warnings();
    }
    plan_rest();
}

static long read_some(void *context, char *buffer, size_t size)
{
    struct fuzz_source *s = context;
    const long count = s->source.read(s->source.context, buffer, size);

    if (count > 0 && (size_t)count > s->left) {
        return SOURCE_ERROR;
    }
    s->left -= count > 0 ? (size_t)count : 0;
    return count;
}

static bool seek(void *context, uint64_t position)
{
    struct fuzz_source *s = context;

    return s->source.seek(s->source.context, position);
}

static void set_travel(struct program_config *config)
{
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        config->travel_max[axis] = axis < AXIS_LINEAR_COUNT ? TRAVEL_MM : TRAVEL_RAD;
        config->travel_min[axis] = -config->travel_max[axis];
    }
}

/* FNV-1a, 32 bits. */
static uint32_t digest(const uint8_t *data, size_t size)
{
    uint32_t sum = 2166136261U;

    for (size_t i = 0; i < size; i++) {
        sum = (sum ^ data[i]) * 16777619U;
    }
    return sum;
}

/* The bits of choice, one after the other. */
static bool choose(uint32_t *choice)
{
    const bool bit = (*choice & 1U) != 0;

    *choice >>= 1;
    return bit;
}

static void set_config(struct program_config *config, uint32_t *choice)
{
    *config = (struct program_config){
        .parameters = &parameters, .spindle_max_rpm = 24000.0, .spindle_encoder = true};
    config->axes = choose(choice) ? 0x3fU : 0x7U;
    config->tools = choose(choice) ? &tool_table : NULL;
    config->block_delete = choose(choice);
    config->exact_path = choose(choice);
    config->sharp_corners = choose(choice);
    config->path_tolerance_mm = choose(choice) ? 0.1 : 0.0;
    config->waits = choose(choice);
    if (choose(choice) && choose(choice) && choose(choice)) {
        config->from_line = 1U + *choice % 20U;
    }
    set_travel(config);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint32_t choice = digest(data, size);
    const bool can_seek = choose(&choice) || choose(&choice);
    struct fuzz_source text = {.left = READ_MAX};
    const struct source source = {read_some, can_seek ? seek : NULL, &text};
    struct program_config config;

    column_max = longest_line(data, size) + 1;
    set_config(&config, &choice);
    takt_parameters_clear(&parameters);
    takt_source_open_text(&text.source, &text.text, (const char *)data, size);
    takt_program_open(&program, &config, &source);
    takt_cutter_compensation_open(&offset, &config);
    open_path(&config);
    read_program(config.start);
    return 0;
}
