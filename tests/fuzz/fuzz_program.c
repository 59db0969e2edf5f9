/*
 * libFuzzer's target for everything a part program meets before the axes: the interpreter, cutter compensation, and
 * the planner behind them.
 *
 * Any bytes whatever are read to their end. Every line gives moves or an error that says where; every move is
 * inside the travel, and the planner makes finite, complete profiles of them. The bytes also choose, by their digest, how they
 * are read, so that one corpus serves for all.
 */
#include "base/maths.h"
#include "offset/offset.h"
#include "plan/window.h"
#include "program/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TRAVEL_MM    500.0
#define TRAVEL_RAD   (20.0 * MATHS_PI)
#define TRAVEL_SLACK 1e-5
/* A loop may make moves for ever; so many are enough. */
#define MOVES_MAX 1000
/* Of errors there are never more than lines, and lines repeat only in loops. */
#define ERRORS_MAX 1000
/* After so many bytes the source fails: of loops that move nothing, and that is a fault of its own to be tried. */
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
static struct offset offset;
static struct parameters parameters;
static struct window window;

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
        CHECK(move->dwell_s >= 0.0 && maths_is_finite(move->dwell_s));
        CHECK(move->speed_rpm >= 0.0 && maths_is_finite(move->speed_rpm));
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

static void check_diagnostic(const struct diagnostic *d)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    CHECK(d->code < TAKT_OK && d->code >= -(int)TAKT_ERROR_TOTAL);
    CHECK(d->line > 0 || d->code == TAKT_ERROR_FROM_LINE_MISSED);
    CHECK(d->column <= PROGRAM_LINE_MAX + 1);
    CHECK(diagnostic_text(d, text) > 0);
}

static void check_segment(const struct segment *segment)
{
    struct profile_state end;

    if (!move_is_motion(&segment->move)) {
        return;
    }
    CHECK(segment->curve.length_mm > 0.0);
    CHECK(segment->profile.duration_s > 0.0 && maths_is_finite(segment->profile.duration_s));
    profile_evaluate(&segment->profile, segment->profile.duration_s, &end);
    CHECK(maths_abs(end.s_mm - segment->curve.length_mm) <= 1e-6 + 1e-9 * segment->curve.length_mm);
}

static void open_window(const struct program_config *config)
{
    struct plan_limits limits = {
        .axes = config->axes, .cycle_s = 0.001, .chord_error_max_mm = 0.001};

    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        const double unit = axis < AXIS_LINEAR_COUNT ? 1.0 : MATHS_PI / 180.0;

        limits.velocity_mm_s[axis] = 250.0 * unit;
        limits.acceleration_mm_s2[axis] = 2000.0 * unit;
        limits.jerk_mm_s3[axis] = 50000.0 * unit;
    }
    window_init(&window, &limits, 16, &config->start);
}

static void plan_move(const struct move *move)
{
    struct segment segment;

    while (!window_has_room(&window)) {
        window_take(&window, &segment);
        check_segment(&segment);
    }
    window_push(&window, move);
}

static void plan_rest(void)
{
    struct segment segment;

    window_finish(&window);
    while (!window_is_empty(&window)) {
        window_take(&window, &segment);
        check_segment(&segment);
    }
}

static void check_warnings(void)
{
    struct diagnostic warning;

    while (program_warning(&program, &warning) || offset_warning(&offset, &warning)) {
        check_diagnostic(&warning);
    }
}

/* A probe that answers half way, or never. */
static void answer_probe(const struct move *move, const struct point *at)
{
    struct point contact;

    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        contact.at[axis] = 0.5 * (at->at[axis] + move->end.at[axis]);
    }
    if (move->line % 2 == 0) {
        program_set_probe(&program, &contact, true);
    }
}

/* False: nothing more is to be read. Involutes are not planned yet. */
static bool take_move(const struct move *move, struct point *at)
{
    check_move(move);
    if (move_is_involute(move)) {
        return false;
    }
    plan_move(move);
    if (move->kind == MOVE_PROBE) {
        answer_probe(move, at);
    }
    if (move_is_motion(move)) {
        *at = move->end;
    }
    return true;
}

static void read_program(struct point at)
{
    struct diagnostic error;
    struct move move;
    enum program_result result;
    unsigned moves = 0;
    unsigned errors = 0;

    while (moves < MOVES_MAX && errors < ERRORS_MAX &&
           (result = offset_next(&offset, &program, &move, &error)) != PROGRAM_END) {
        if (result == PROGRAM_ERROR) {
            check_diagnostic(&error);
            errors++;
        } else if (take_move(&move, &at)) {
            moves++;
        } else {
            break;
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
    *config = (struct program_config){.parameters = &parameters, .spindle_max_rpm = 24000.0};
    config->axes = choose(choice) ? 0x3fU : 0x7U;
    config->tools = choose(choice) ? &tool_table : NULL;
    config->block_delete = choose(choice);
    config->exact_path = choose(choice);
    config->sharp_corners = choose(choice);
    config->path_tolerance_mm = choose(choice) ? 0.1 : 0.0;
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

    set_config(&config, &choice);
    parameters_clear(&parameters);
    source_open_text(&text.source, &text.text, (const char *)data, size);
    program_open(&program, &config, &source);
    offset_open(&offset, &config);
    open_window(&config);
    read_program(config.start);
    return 0;
}
