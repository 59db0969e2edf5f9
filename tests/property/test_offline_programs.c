/*
 * takt correct on random programs of everything it writes, in all planes, units and coordinate
 * systems: the corrected program, read again by the interpreter, follows the corrected path of the
 * program.
 */
#define _POSIX_C_SOURCE 200809L

#include "base/maths.h"
#include "correct/offline.h"
#include "offline_program.h"
#include "property_arguments.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAMS     40
#define MOTIONS_MAX  8192
#define TOLERANCE_MM 0.0005
/* Coordinates have six decimals, inches eight; centres and radii too. */
#define ROUNDING_MM 4e-6

static struct session session;
static struct options options;
static struct correction_tables tables;
static struct table table;
static struct correction correction;
static struct parameters parameters;
static struct program program;
static char place[80]; /* what is verified, for messages */

/* ---- a machine with a curved field of errors ---- */

/* Up to 60 um, slopes up to 1 um/mm: steeper than machines are. */
static double field(unsigned axis, double x, double y, double z)
{
    return 0.02 * sin(0.02 * x + 0.011 * y + axis) +
           0.02 * cos(0.017 * y - 0.008 * z + 2.0 * axis) + 0.02 * sin(0.02 * z + 0.01 * x - axis);
}

static void make_table(void)
{
    table.inputs = table.outputs = 3;
    for (uint8_t i = 0; i < 3; i++) {
        table.input[i] = i;
        table.knots[i] = 11;
        table.output[i] = (struct table_output){i, TABLE_BOTH};
        for (unsigned k = 0; k < 11; k++)
            table.knot_mm[i][k] = -250.0 + 50.0 * k;
    }
    for (uint32_t row = 0; row < 11 * 11 * 11; row++) {
        for (unsigned i = 0; i < 3; i++)
            table.value_mm[3 * row + i] =
                (float)field(i, table.knot_mm[0][row % 11], table.knot_mm[1][row / 11 % 11],
                             table.knot_mm[2][row / 121]);
    }
}

void setUp(void)
{
    struct diagnostic wrong;

    make_table();
    TEST_ASSERT_TRUE(takt_grid_set(&tables.volume, &table, &wrong));
    session = (struct session){.options = &options, .correction = &tables};
    machine_setup_set_default(&session.setup);
    takt_parameters_clear(&session.parameters.values);
    state = 1;
}

void tearDown(void)
{
}

/* G18 and G19 arcs cannot be run in a turned system: such programs are written anew. */
static bool is_good(void);

/* ---- reading ---- */

struct motions {
    unsigned count;
    struct point start[MOTIONS_MAX];
    struct move move[MOTIONS_MAX];
    uint32_t spindle; /* events of the spindle */
};

static struct motions wanted, written;
static unsigned lines;          /* that arcs or involutes have become */
static struct diagnostic error; /* of the last reading */

static bool read_motions(const char *from, size_t size, struct motions *m)
{
    struct controller_config controller = {.machine = &session.setup.machine,
                                           .parameters = &parameters};
    struct program_config config;
    struct source_text reader;
    struct source source;
    struct point at;
    enum program_result result;
    struct move move;

    parameters = session.parameters.values;
    takt_controller_program_config(&controller, &config);
    takt_source_open_text(&source, &reader, from, size);
    takt_program_open(&program, &config, &source);
    at = config.start;
    m->count = m->spindle = 0;
    while ((result = takt_program_next(&program, &move, &error)) == PROGRAM_MOVE) {
        m->spindle += move.kind == MOVE_SPINDLE;
        if (!move_is_motion(&move))
            continue;
        TEST_ASSERT_TRUE(m->count < MOTIONS_MAX);
        m->start[m->count] = at;
        m->move[m->count++] = move;
        at = move.end;
    }
    return result == PROGRAM_END;
}

static bool is_good(void)
{
    return read_motions(text, length, &wanted);
}

/* ---- verifying ---- */

static void corrected(const struct move *move, const struct point *at, struct point *to)
{
    struct point k;

    takt_correction_evaluate(&correction, at, move, &k);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        to->at[i] = at->at[i] + k.at[i];
}

static double distance(const struct point *a, const struct point *b)
{
    double square = 0;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        square += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    return sqrt(square);
}

static double distance_at(const struct curve *c, const struct move *move, double s,
                          const struct point *from)
{
    struct point at, to;

    takt_curve_point(c, s, &at);
    corrected(move, &at, &to);
    return distance(&to, from);
}

/*
 * Distance of a point from the corrected path, near the place *s and beyond it; *s becomes the
 * nearest place.
 */
static double nearest(const struct curve *c, const struct move *move, double step,
                      const struct point *from, double *s)
{
    double low = maths_max(0.0, *s - 0.01), high = maths_min(c->length_mm, *s + 2.0 * step + 0.01);

    for (int i = 0; i < 60; i++) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;

        if (distance_at(c, move, a, from) < distance_at(c, move, b, from))
            high = b;
        else
            low = a;
    }
    *s = 0.5 * (low + high);
    return distance_at(c, move, *s, from);
}

#define SAMPLES 7

/* One piece of the written program along the corrected path of a motion, from *s on. */
static double verify_piece(const struct curve *c, const struct move *move, unsigned piece,
                           double *s)
{
    struct curve w;
    double worst = 0;

    if (!takt_move_curve(&written.move[piece], &written.start[piece], &w))
        return 0;
    for (unsigned i = 1; i <= SAMPLES; i++) {
        struct point at;

        takt_curve_point(&w, w.length_mm * i / SAMPLES, &at);
        worst = maths_max(worst, nearest(c, move, w.length_mm / SAMPLES, &at, s));
    }
    return worst;
}

static bool ends_at(const struct move *move, const struct point *end)
{
    return distance(&move->end, end) < ROUNDING_MM;
}

/* Errors leave no arc of one that hardly turns. */
static bool is_kind(const struct move *move, const struct move *as_written)
{
    const bool curved = move_is_arc(move) || move_is_involute(move);

    lines += curved && as_written->kind == MOVE_FEED;
    return as_written->kind == move->kind || (curved && as_written->kind == MOVE_FEED);
}

static bool is_thread(const struct move *move)
{
    return move->kind == MOVE_THREAD || move->kind == MOVE_TAP || move->kind == MOVE_TAP_OUT;
}

/* A thread stays one motion, and has as many turns as programmed. */
static unsigned verify_thread(unsigned motion, unsigned piece, const struct curve *c)
{
    const struct move *move = &wanted.move[motion];
    const struct move *as_written = &written.move[piece];
    struct point end;
    struct curve w;

    corrected(move, &move->end, &end);
    TEST_ASSERT_TRUE_MESSAGE(ends_at(as_written, &end), place);
    TEST_ASSERT_TRUE_MESSAGE(takt_move_curve(as_written, &written.start[piece], &w), place);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-5, c->length_mm / move->feed_rev_mm,
                                      w.length_mm / as_written->feed_rev_mm, place);
    return piece + 1;
}

/* The pieces of one motion; returns the number of the one behind them. */
static unsigned verify_motion(unsigned motion, unsigned piece, double *worst)
{
    const struct move *move = &wanted.move[motion];
    struct point end;
    struct curve c;
    double s = 0;
    const bool has_curve = takt_move_curve(move, &wanted.start[motion], &c);

    if (has_curve && is_thread(move))
        return verify_thread(motion, piece, &c);
    corrected(move, &move->end, &end);
    for (;; piece++) {
        TEST_ASSERT_TRUE_MESSAGE(piece < written.count, place);
        TEST_ASSERT_TRUE_MESSAGE(is_kind(move, &written.move[piece]), place);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-9, move->feed_mm_s, written.move[piece].feed_mm_s,
                                          place);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(move->overrides, written.move[piece].overrides, place);
        if (has_curve && move->kind != MOVE_RAPID)
            *worst = maths_max(*worst, verify_piece(&c, move, piece, &s));
        if (ends_at(&written.move[piece], &end) &&
            (!has_curve || move->kind == MOVE_RAPID || s > c.length_mm - 0.02))
            return piece + 1;
    }
}

static void correct(char **out, size_t *size, struct offline_totals *totals)
{
    struct offline_config config = {.session = &session,
                                    .tolerance_mm = TOLERANCE_MM,
                                    .text = text,
                                    .length = length,
                                    .name = "program",
                                    .out = open_memstream(out, size)};

    TEST_ASSERT_NOT_NULL(config.out);
    TEST_ASSERT_EQUAL_INT_MESSAGE(STATUS_DONE, offline_correct(&config, totals), place);
    TEST_ASSERT_EQUAL_INT(0, fclose(config.out));
}

static double verify_program(void)
{
    struct offline_totals totals;
    double worst = 0;
    unsigned piece = 0;
    char *out = NULL;
    size_t size = 0;

    correct(&out, &size, &totals);
    if (!read_motions(out, size, &written)) {
        char why[DIAGNOSTIC_TEXT_MAX];

        (void)takt_diagnostic_text(&error, why);
        printf("%s: what is written, line %u: %s\n", place, (unsigned)error.line, why);
        TEST_FAIL();
    }
    for (unsigned i = 0; i < wanted.count; i++)
        piece = verify_motion(i, piece, &worst);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(written.count, piece, place);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted.spindle, written.spindle, place);
    TEST_ASSERT_TRUE_MESSAGE(worst <= TOLERANCE_MM + ROUNDING_MM, place);
    free(out);
    return worst;
}

static unsigned programs = PROGRAMS, first_seed;

static void test_what_is_written_follows_the_corrected_path(void)
{
    const struct point start = {{0}};
    unsigned verified = 0, motions = 0, pieces = 0;
    double worst = 0;

    takt_correction_init(&correction, &session.setup.machine.correction, 7, 0.001, &tables, &start);
    for (unsigned seed = first_seed; seed < first_seed + programs; seed++) {
        say_program(seed);
        if (!is_good())
            continue;
        (void)snprintf(place, sizeof place, "seed %u", seed);
        worst = maths_max(worst, verify_program());
        verified++;
        motions += wanted.count;
        pieces += written.count;
    }
    printf("%u programs, %u motions in %u pieces, at most %.6f mm off the corrected path\n",
           verified, motions, pieces, worst);
    TEST_ASSERT_TRUE_MESSAGE(100 * lines < pieces, "arcs and involutes stay what they are");
    TEST_ASSERT_GREATER_THAN(programs / 2, verified);
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &programs, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_what_is_written_follows_the_corrected_path);
    return UNITY_END();
}
