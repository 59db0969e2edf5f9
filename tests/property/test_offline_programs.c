/*
 * takt correct on random programs of everything it writes, in all planes, units and coordinate systems: the corrected
 * program, read again by the interpreter, follows the corrected path of the program.
 */
#define _POSIX_C_SOURCE 200809L

#include "base/maths.h"
#include "correct/offline.h"
#include "property_arguments.h"
#include "unity.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAMS     40
#define MOTIONS      24
#define MOTIONS_MAX  8192
#define TOLERANCE_MM 0.0005
/* Coordinates have six decimals, inches eight; centres and radii too. */
#define ROUNDING_MM 4e-6
#define TEXT_MAX    65536

/* Positions stay within the table. */
#define REACH_MM 180.0

static struct session session;
static struct options options;
static struct correction_tables tables;
static struct table table;
static struct correction correction;
static struct parameters parameters;
static struct program program;
static uint64_t state;
static char text[TEXT_MAX];
static char place[80]; /* what is verified, for messages */
static size_t length;

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

/* ---- random programs ---- */

/* xorshift64*: S. Vigna, 2016. */
static double uniform(double low, double high)
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return low + (high - low) * (double)((state * UINT64_C(0x2545F4914F6CDD1D)) >> 11) * 0x1p-53;
}

static unsigned below(unsigned count)
{
    return (unsigned)uniform(0.0, count - 1e-9);
}

__attribute__((format(printf, 1, 2))) static void say(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    length += (size_t)vsnprintf(text + length, sizeof text - length, format, arguments);
    va_end(arguments);
    TEST_ASSERT_TRUE(length < sizeof text);
}

/* What the program being written is in. */
static struct {
    unsigned plane; /* first axis: 0 XY, 2 ZX, 1 YZ */
    double unit_mm;
    bool incremental;
    bool turned;     /* G17 alone */
    double at_mm[3]; /* work coordinates */
} now;

static void say_axes(const double to_mm[3])
{
    for (unsigned i = 0; i < 3; i++)
        say(" %c%.9f", AXIS_LETTERS[i],
            (to_mm[i] - (now.incremental ? now.at_mm[i] : 0.0)) / now.unit_mm);
    memcpy(now.at_mm, to_mm, sizeof now.at_mm);
}

static void say_line(const char *code)
{
    double to_mm[3];

    for (unsigned i = 0; i < 3; i++)
        to_mm[i] = uniform(-REACH_MM / 2, REACH_MM / 2);
    say("%s", code);
    say_axes(to_mm);
    say(below(4) == 0 ? " (on) F%d\n" : "\n", 500 + (int)below(1000));
}

/* Goes to a place near the middle first, so that the curve stays inside. */
static void say_approach(double u, double v)
{
    double to_mm[3];

    for (unsigned i = 0; i < 3; i++)
        to_mm[i] = uniform(-30, 30);
    to_mm[now.plane] = u;
    to_mm[(now.plane + 1) % 3] = v;
    say("G1");
    say_axes(to_mm);
    say("\n");
}

static void say_end(double u, double v)
{
    double to_mm[3];

    memcpy(to_mm, now.at_mm, sizeof to_mm);
    to_mm[now.plane] = u;
    to_mm[(now.plane + 1) % 3] = v;
    to_mm[(now.plane + 2) % 3] += below(2) == 0 ? 0.0 : uniform(-20, 20);
    say_axes(to_mm);
}

static void say_centre(double u, double v)
{
    say(" %c%.9f %c%.9f", 'I' + (char)now.plane, u / now.unit_mm, 'I' + (char)((now.plane + 1) % 3),
        v / now.unit_mm);
}

static void say_arc(void)
{
    const double radius = uniform(0.5, 60), from = uniform(-3, 3), to = uniform(-3, 3);
    const double cu = uniform(-30, 30), cv = uniform(-30, 30);

    say_approach(cu + radius * cos(from), cv + radius * sin(from));
    say(below(2) == 0 ? "G2" : "G3");
    say_end(cu + radius * cos(to), cv + radius * sin(to));
    say_centre(-radius * cos(from), -radius * sin(from));
    say(below(3) == 0 ? " (round)\n" : "\n");
}

static void string_end(double r, double hand, double heading, double phi, double at[2])
{
    at[0] = r * (cos(heading + hand * phi) + hand * phi * sin(heading + hand * phi));
    at[1] = r * (sin(heading + hand * phi) - hand * phi * cos(heading + hand * phi));
}

static void say_involute(void)
{
    const double r = exp(uniform(log(0.3), log(10))), turns = 60 / r;
    const double from = below(3) == 0 ? 0.0 : uniform(0, turns);
    const double to = from + (from < turns / 2 ? 1 : -1) * uniform(0.3, turns / 2);
    const double hand = below(2) == 0 ? 1 : -1, heading = uniform(-3, 3);
    double a[2], b[2];

    string_end(r, hand, heading, from, a);
    string_end(r, hand, heading, to, b);
    say_approach(a[0], a[1]);
    say((hand > 0) == (to > from) ? "G3.2" : "G2.2");
    say_end(b[0], b[1]);
    say_centre(-a[0], -a[1]);
    say(" R%.9f\n", r / now.unit_mm);
}

/* A hole with the spindle on, and back to what the others expect. */
static void say_cycle(void)
{
    static const char *const codes[] = {"G81", "G82 P0.1", "G83 Q5",   "G84 P0.1",
                                        "G85", "G86 P0.1", "G89 P0.1", "G73 Q5"};
    const char *const code = codes[below(8)];
    const double top = uniform(10, 20), bottom = top - uniform(2, 20);
    double to_mm[3] = {uniform(-80, 80), uniform(-80, 80), 40};
    const bool incremental = now.incremental;

    say("G17 G90 M3 S300\nG1");
    now.incremental = false;
    say_axes(to_mm);
    say("\n%s X%.9f Y%.9f Z%.9f R%.9f (hole)\n", code, to_mm[0] / now.unit_mm,
        to_mm[1] / now.unit_mm, bottom / now.unit_mm, top / now.unit_mm);
    say("G80 M5 %s\n", incremental ? "G91" : "");
    now.incremental = incremental;
    now.plane = 0;
}

/* Offsets that are set where the machine stands; 'now' counts on with the coordinates they give. */
static void say_offset(void)
{
    const double x = uniform(-20, 20);

    say(below(2) == 0 ? "G92 X%.9f\n" : "G10 L20 P0 X%.9f\n", x / now.unit_mm);
    now.at_mm[0] = x;
}

/* A thread, or a tapped hole. */
static void say_thread(void)
{
    double to_mm[3] = {uniform(-50, 50), uniform(-50, 50), uniform(-50, 50)};
    double before_mm[3];

    memcpy(before_mm, now.at_mm, sizeof before_mm);
    say("M3 S300\n");
    say(below(2) == 0 ? "G33" : "G33.1 (tap)");
    say_axes(to_mm);
    say(" K%.6f\nM5\n", 1.25 / now.unit_mm);
    if (strstr(text + length - 120, "(tap)") != NULL)
        memcpy(now.at_mm, before_mm, sizeof before_mm);
}

static void say_change(void)
{
    static const char *const planes[] = {"G17", "G19", "G18"};

    now.plane = now.turned ? 0 : below(3);
    say("%s", planes[now.plane]);
    now.unit_mm = below(3) == 0 ? 25.4 : 1.0;
    say(now.unit_mm > 1.0 ? " G20 F%d" : " G21 F%d", now.unit_mm > 1.0 ? 20 : 600);
    now.incremental = below(3) == 0;
    say(now.incremental ? " G91" : " G90");
    say(" (change)\n");
}

static void say_motion(unsigned what)
{
    switch (what) {
    case 0:
        say_line("G0");
        break;
    case 1:
        say_arc();
        break;
    case 2:
    case 3:
        say_involute();
        break;
    case 4:
        say_cycle();
        break;
    case 5:
        say_offset();
        break;
    case 6:
        say_change();
        break;
    case 7:
        say_thread();
        break;
    default:
        say_line("G1");
    }
}

static void say_program(unsigned seed)
{
    state = UINT64_C(0x9E3779B97F4A7C15) * (seed + 1);
    length = 0;
    memset(&now, 0, sizeof now);
    now.unit_mm = 1.0;
    say("(program %u)\nG21 G90 G17 G61 F600\n", seed);
    now.turned = below(4) == 0;
    say("G10 L2 P1 X%.3f Y%.3f Z%.3f R%.3f\nG54\n", uniform(-20, 20), uniform(-20, 20),
        uniform(-20, 20), now.turned ? uniform(-90, 90) : 0.0);
    say_line("G0");
    for (unsigned i = 0; i < MOTIONS; i++)
        say_motion(below(10));
    say("M2\n");
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

/* Distance of a point from the corrected path, near the place *s and beyond it; *s becomes the nearest place. */
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
