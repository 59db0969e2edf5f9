/*
 * Any bytes whatever are read to the end: every line gives moves or an error, every move is finite and inside the
 * travel, and nothing is read out of bounds (which the sanitizers watch).
 *
 * The bytes are real lines with random changes, so that they go deep before they go wrong.
 */
#include "base/maths.h"
#include "program/program.h"

#include "unity.h"

#include <stdio.h>
#include <string.h>

#define PROGRAMS     4000
#define LINES        30
#define TEXT_MAX     8000
#define TRAVEL_MM    500.0
#define TRAVEL_SLACK 1e-5

static const char *const lines[] = {
    "N10 G21 G90 G94 G17 G40 G49 G80",
    "G0 X10 Y-20.5 Z3",
    "G1 X[#1*10.] Y[#2*-56.128] F[#4*100]",
    "G2 X20 Y0 I5 J-5 P2 F300",
    "G3 X1.5 Y2.5 R-12",
    "G18 G2 X0 Z0 K5",
    "#1=10 #2=[#1+1] #<name>=-3.5",
    "#[#1 MOD 30 + 1]=##2",
    "X[SIN[30]*2**3] Y[ATAN[1]/[2]] Z[EXISTS[#<name>]]",
    "G28 Z1",
    "G53 G0 Z-10.0 M5",
    "G54 (a comment) G64 P0.1 Q0.2",
    "G92 X1 Y2",
    "G92.1 M3 S1000",
    "T1 M6",
    "G43 H1 Z100 ; rest",
    "G4 P0.5 M8",
    "G93 G1 X1 F2",
    "G91 X-1 Y1",
    "G20 X1",
    "/ G1 X1 Y1",
    "M0",
    "#5221=10 G55",
    "%",
};

static struct program program;
static struct parameters parameters;
static uint64_t state;
static char text[TEXT_MAX];

void setUp(void)
{
}

void tearDown(void)
{
}

/* SplitMix64 (G. Steele, D. Lea, C. Flood, 2014). */
static unsigned random_below(unsigned limit)
{
    uint64_t z = (state += UINT64_C(0x9e3779b97f4a7c15));

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (unsigned)((z ^ (z >> 31)) % limit);
}

static char random_byte(void)
{
    static const char likely[] = "GMXYZIJKRPFSTHNABC#<>[]()+-*/=.;%0123456789 \n\t";

    if (random_below(8) == 0) {
        return (char)random_below(256);
    }
    return likely[random_below(sizeof(likely) - 1)];
}

/* One change: a byte replaced, left out, doubled, or a piece copied over another. */
static size_t mutate(size_t length)
{
    const size_t at = random_below((unsigned)length);
    const size_t to = random_below((unsigned)length);
    size_t count = random_below(40);

    switch (random_below(4)) {
    case 0:
        text[at] = random_byte();
        return length;
    case 1:
        memmove(text + at, text + at + 1, length - at - 1);
        return length - 1;
    case 2:
        memmove(text + at + 1, text + at, length - at);
        return length + 1;
    default:
        count = at + count > length ? length - at : count;
        count = to + count > length ? length - to : count;
        memmove(text + to, text + at, count);
        return length;
    }
}

/* Changes seldom in half of the programs, so that some run through. */
static size_t write_program(void)
{
    const unsigned changes = random_below(2) == 0 ? random_below(6) : random_below(200);
    size_t length = 0;

    for (unsigned i = 0; i < LINES; i++) {
        const char *line = lines[random_below(sizeof(lines) / sizeof(lines[0]))];

        length += (size_t)snprintf(text + length, sizeof(text) - length, "%s\n", line);
    }
    for (unsigned i = 0; i < changes; i++) {
        length = mutate(length);
    }
    return length;
}

static void check_motion(const struct move *move)
{
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        const double limit = axis < AXIS_LINEAR_COUNT ? TRAVEL_MM : MATHS_TWO_PI;

        TEST_ASSERT_TRUE_MESSAGE(maths_abs(move->end.at[axis]) <= limit + TRAVEL_SLACK, text);
    }
    TEST_ASSERT_TRUE_MESSAGE(move->kind == MOVE_RAPID || move->feed_mm_s > 0.0, text);
    if (move->kind == MOVE_ARC_CW || move->kind == MOVE_ARC_CCW) {
        TEST_ASSERT_TRUE_MESSAGE(maths_is_finite(move->centre_mm[0]), text);
        TEST_ASSERT_TRUE_MESSAGE(maths_is_finite(move->centre_mm[1]), text);
        TEST_ASSERT_TRUE_MESSAGE(move->turns >= 1, text);
    }
}

static void check_error(const struct diagnostic *d)
{
    char message[DIAGNOSTIC_TEXT_MAX];

    TEST_ASSERT_TRUE_MESSAGE(d->code < 0 && d->line > 0 && d->column <= PROGRAM_LINE_MAX + 1, text);
    TEST_ASSERT_TRUE_MESSAGE(diagnostic_text(d, message) > 0, text);
}

static void open_program(struct source_text *context, size_t length)
{
    struct program_config config = {.axes = 0x3fU, .parameters = &parameters};
    struct source source;

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        config.travel_max[axis] = axis < AXIS_LINEAR_COUNT ? TRAVEL_MM : MATHS_TWO_PI;
        config.travel_min[axis] = -config.travel_max[axis];
    }
    config.block_delete = random_below(2) == 0;
    parameters_clear(&parameters);
    source_open_text(&source, context, text, length);
    program_open(&program, &config, &source);
}

/* Counts the moves and the errors; a program has no more of either than its lines can make. */
static void run_program(size_t length, unsigned *moves, unsigned *errors)
{
    struct source_text context;
    struct diagnostic diagnostic;
    struct move move;
    enum program_result result;
    unsigned steps = 0;

    open_program(&context, length);
    while ((result = program_next(&program, &move, &diagnostic)) != PROGRAM_END) {
        TEST_ASSERT_TRUE_MESSAGE(++steps <= length * PROGRAM_QUEUE_MAX + 2, text);
        if (result == PROGRAM_ERROR) {
            check_error(&diagnostic);
            ++*errors;
        } else {
            ++*moves;
            if (move_is_motion(&move)) {
                check_motion(&move);
            }
        }
    }
    while (program_warning(&program, &diagnostic)) {
        check_error(&diagnostic);
    }
}

static void test_any_text_is_read_to_its_end(void)
{
    unsigned moves = 0;
    unsigned errors = 0;

    for (uint64_t seed = 1; seed <= PROGRAMS; seed++) {
        state = seed;
        run_program(write_program(), &moves, &errors);
    }
    /* Both ways of reading a line have been tried. */
    TEST_ASSERT_TRUE(moves > PROGRAMS && errors > PROGRAMS);
}

static void test_random_bytes_are_read_to_their_end(void)
{
    unsigned moves = 0;
    unsigned errors = 0;

    for (uint64_t seed = 1; seed <= PROGRAMS / 10; seed++) {
        state = seed;
        for (size_t i = 0; i < TEXT_MAX / 4; i++) {
            text[i] = (char)random_below(256);
        }
        run_program(TEXT_MAX / 4, &moves, &errors);
    }
    TEST_ASSERT_TRUE(errors > PROGRAMS / 10);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_any_text_is_read_to_its_end);
    RUN_TEST(test_random_bytes_are_read_to_their_end);
    return UNITY_END();
}
