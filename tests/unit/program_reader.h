/*
 * For tests of the program room: a program from a string, on a machine with axes X Y Z A, travel
 * -500 ... 500 mm and -360 ... 360 degrees, at 0, with spindle up to 24,000 rev/min, two tools, and
 * parameters all 0.
 */
#ifndef TAKT_TESTS_PROGRAM_READER_H
#define TAKT_TESTS_PROGRAM_READER_H

#include "base/maths.h"
#include "program/program.h"

#include "unity.h"

#include <string.h>

#define RAD_PER_DEGREE (MATHS_PI / 180.0)

struct reader {
    struct program program;
    struct parameters parameters;
    struct source_text text;
    struct program_config config;
    struct diagnostic diagnostic;
};

static const struct tool reader_tools[] = {
    {.number = 5, .offset = {{0.5, 0.25, 100.0, 0.0, 0.0, 0.0}}, .diameter_mm = 6.0},
    {.number = 12, .offset = {{0.0, 0.0, 40.0, 0.0, 0.0, 0.0}}, .diameter_mm = 3.0},
};

static const struct tool_table reader_table = {reader_tools, 2};

/* Everything but the text, for tests that change something before reader_text. */
static inline void reader_prepare(struct reader *r)
{
    memset(r, 0, sizeof(*r));
    takt_parameters_clear(&r->parameters);
    r->config.axes = 0xfU;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double limit = i < AXIS_LINEAR_COUNT ? 500.0 : 360.0 * RAD_PER_DEGREE;

        r->config.travel_min[i] = -limit;
        r->config.travel_max[i] = limit;
    }
    r->config.spindle_max_rpm = 24000.0;
    r->config.spindle_encoder = true;
    r->config.tools = &reader_table;
    r->config.parameters = &r->parameters;
}

static inline void reader_text(struct reader *r, const char *text)
{
    struct source source;

    takt_source_open_text(&source, &r->text, text, strlen(text));
    takt_program_open(&r->program, &r->config, &source);
}

static inline void reader_open(struct reader *r, const char *text)
{
    reader_prepare(r);
    reader_text(r, text);
}

/*
 * What has been read must be a move of this kind; if it is an error, the test fails with its text.
 */
static inline void reader_check(const struct reader *r, enum program_result result,
                                enum move_kind kind, const struct move *move)
{
    char text[DIAGNOSTIC_TEXT_MAX] = "";

    if (result == PROGRAM_ERROR) {
        (void)takt_diagnostic_text(&r->diagnostic, text);
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(PROGRAM_MOVE, result, text);
    TEST_ASSERT_EQUAL_INT(kind, move->kind);
}

static inline void reader_check_end(const struct move *move, double x, double y, double z)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, x, move->end.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, y, move->end.at[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, z, move->end.at[AXIS_Z]);
}

/* The next move, which must be one of this kind. */
static inline struct move reader_next(struct reader *r, enum move_kind kind)
{
    struct move move = {0};
    const enum program_result result = takt_program_next(&r->program, &move, &r->diagnostic);

    reader_check(r, result, kind, &move);
    return move;
}

/* The next move must be of this kind and end at x y z. */
static inline struct move reader_expect(struct reader *r, enum move_kind kind, double x, double y,
                                        double z)
{
    const struct move move = reader_next(r, kind);

    reader_check_end(&move, x, y, z);
    return move;
}

static inline void reader_expect_rapid(struct reader *r, double x, double y, double z)
{
    (void)reader_expect(r, MOVE_RAPID, x, y, z);
}

/* The next thing must be an error; its place, word and value are then in r->diagnostic. */
static inline void reader_expect_error(struct reader *r, enum takt_error code)
{
    struct move move;

    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, takt_program_next(&r->program, &move, &r->diagnostic));
    TEST_ASSERT_EQUAL_INT(code, r->diagnostic.code);
}

/* Opens a text whose first error, after any moves, must be this one. */
static inline void reader_expect_refused(struct reader *r, const char *text, enum takt_error code)
{
    struct move move;
    enum program_result result;

    reader_open(r, text);
    do {
        result = takt_program_next(&r->program, &move, &r->diagnostic);
    } while (result == PROGRAM_MOVE);
    TEST_ASSERT_EQUAL_INT_MESSAGE(PROGRAM_ERROR, result, text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(code, r->diagnostic.code, text);
}

static inline void reader_expect_end(struct reader *r)
{
    struct move move;

    (void)reader_next(r, MOVE_END);
    TEST_ASSERT_EQUAL_INT(PROGRAM_END, takt_program_next(&r->program, &move, &r->diagnostic));
    TEST_ASSERT_EQUAL_INT(PROGRAM_END, takt_program_next(&r->program, &move, &r->diagnostic));
}

#endif
