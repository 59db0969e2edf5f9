/*
 * firmware/program/circular.h and travel.h: where an arc's centre is, and how far the arc reaches.
 */
#include "program_reader.h"

#include <stdint.h>
#include <stdio.h>

#define RANDOM_COUNT 20000
#define SAMPLES      400

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

/* SplitMix64 (G. Steele, D. Lea, C. Flood, 2014): 0 <= x < 1. */
static double random_unit(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * random_unit(state);
}

static double distance(double x0, double y0, double x1, double y1)
{
    return maths_sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0));
}

static void check_error(const char *text, enum takt_error code, const char *word, double value)
{
    reader_expect_refused(&reader, text, code);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(word, reader.diagnostic.word, text);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, value, reader.diagnostic.value);
}

static void check_centre(const struct move *move, double first, double second)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, first, move->centre_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, second, move->centre_mm[1]);
}

static void test_offsets_of_the_centre_count_from_the_start(void)
{
    struct move move;

    reader_open(&reader, "F60 G0 X1 Y2 Z3\nG2 X3 I1\nG18 G3 X1 K0.5 I-1 Z4\nG19 G2 Y2 Z4 J5 K0");
    (void)reader_next(&reader, MOVE_RAPID);
    move = reader_expect(&reader, MOVE_ARC_CW, 3.0, 2.0, 3.0);
    check_centre(&move, 2.0, 2.0);
    TEST_ASSERT_EQUAL_INT(PLANE_XY, move.plane);
    move = reader_expect(&reader, MOVE_ARC_CCW, 1.0, 2.0, 4.0);
    check_centre(&move, 3.5, 2.0);
    TEST_ASSERT_EQUAL_INT(PLANE_ZX, move.plane);
    move = reader_expect(&reader, MOVE_ARC_CW, 1.0, 2.0, 4.0);
    check_centre(&move, 7.0, 4.0);
    TEST_ASSERT_EQUAL_INT(PLANE_YZ, move.plane);
}

static void test_absolute_centres_are_work_coordinates(void)
{
    struct move move;

    reader_open(&reader, "F60 #5241=10 #5242=20\nG20 G55 G90.1\nG0 X1 Y0\nG3 X0 Y1 I0 J0");
    (void)reader_next(&reader, MOVE_RAPID);
    move = reader_expect(&reader, MOVE_ARC_CCW, 10.0, 45.4, 0.0);
    check_centre(&move, 10.0, 20.0);
    check_error("F60 G90.1 G2 X2 I1", TAKT_ERROR_ARC_CENTRE_PARTIAL, "J", 0.0);
    check_error("F60 G90.1 G18 G2 X2 I1", TAKT_ERROR_ARC_CENTRE_PARTIAL, "K", 0.0);
}

/*
 * The law of R: |centre - start| = |centre - end| = |R|, and a turn below half for R > 0, above for
 * R < 0.
 */
static void check_radius_form(uint64_t *state)
{
    const double start[2] = {random_between(state, -50.0, 50.0),
                             random_between(state, -50.0, 50.0)};
    const double end[2] = {random_between(state, -50.0, 50.0), random_between(state, -50.0, 50.0)};
    const double half = distance(start[0], start[1], end[0], end[1]) / 2.0;
    const double radius = half * random_between(state, 1.0, 1.5) + 0.001;
    const bool longer = random_unit(state) < 0.5;
    const bool clockwise = random_unit(state) < 0.5;
    struct move move;
    struct curve curve;
    char text[PROGRAM_LINE_MAX];

    (void)snprintf(text, sizeof(text), "G0 X%.6f Y%.6f\nF60 G%d X%.6f Y%.6f R%.6f", start[0],
                   start[1], clockwise ? 2 : 3, end[0], end[1], longer ? -radius : radius);
    reader_open(&reader, text);
    const struct point at = reader_next(&reader, MOVE_RAPID).end;

    move = reader_next(&reader, clockwise ? MOVE_ARC_CW : MOVE_ARC_CCW);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(
        2e-6, radius, distance(at.at[0], at.at[1], move.centre_mm[0], move.centre_mm[1]), text);
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(
        2e-6, radius,
        distance(move.end.at[0], move.end.at[1], move.centre_mm[0], move.centre_mm[1]), text);
    TEST_ASSERT_TRUE_MESSAGE(takt_move_curve(&move, &at, &curve), text);
    TEST_ASSERT_TRUE_MESSAGE((maths_abs(curve.arc.sweep_rad) > MATHS_PI) == longer, text);
}

static void test_a_radius_leads_to_the_arc_of_that_radius(void)
{
    uint64_t state = 1;

    for (int i = 0; i < RANDOM_COUNT; i++) {
        check_radius_form(&state);
    }
}

static void test_a_radius_a_little_too_short_makes_half_a_turn(void)
{
    struct move move;

    reader_open(&reader, "F60 G2 X20 R9.9988");
    move = reader_expect(&reader, MOVE_ARC_CW, 20.0, 0.0, 0.0);
    check_centre(&move, 10.0, 0.0);
    check_error("F60 G2 X20 R9.9987", TAKT_ERROR_ARC_RADIUS_SMALL, "R9.9987", 0.0013);
}

static void test_the_end_may_be_off_its_circle_by_a_rounding_error(void)
{
    struct move move;

    reader_open(&reader, "F60 G2 X20.028 I10");
    move = reader_expect(&reader, MOVE_ARC_CW, 20.028, 0.0, 0.0);
    check_centre(&move, 10.0, 0.0);
    check_error("F60 G2 X20.029 I10", TAKT_ERROR_ARC_ENDPOINT, "G2", 0.029);
}

static void test_a_large_arc_may_be_off_by_a_thousandth_of_its_radius(void)
{
    reader_open(&reader, "F60 G2 X400.19 I200");
    (void)reader_next(&reader, MOVE_ARC_CW);
    check_error("F60 G2 X400.21 I200", TAKT_ERROR_ARC_ENDPOINT, "G2", 0.21);
    check_error("F60 G2 X8002.9 I4000", TAKT_ERROR_ARC_ENDPOINT, "G2", 2.9);
    check_error("F60 G2 X8002.8 I4000", TAKT_ERROR_TRAVEL_EXCEEDED, "X", 8002.8);
}

static void test_the_tolerance_in_inches_is_the_larger_one(void)
{
    reader_open(&reader, "G20 F60 G2 X2.0028 I1");
    (void)reader_next(&reader, MOVE_ARC_CW);
    check_error("G20 F60 G2 X2.0029 I1", TAKT_ERROR_ARC_ENDPOINT, "G2", 0.0029 * 25.4);
}

static void test_full_circles_need_no_end(void)
{
    struct curve curve;
    struct move move;

    reader_open(&reader, "F60 G2 I5\nG3 X0 Y0 J5 P3");
    move = reader_expect(&reader, MOVE_ARC_CW, 0.0, 0.0, 0.0);
    TEST_ASSERT_TRUE(takt_move_curve(&move, &reader.config.start, &curve));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0 * MATHS_PI, curve.length_mm);
    move = reader_expect(&reader, MOVE_ARC_CCW, 0.0, 0.0, 0.0);
    TEST_ASSERT_EQUAL_UINT32(3, move.turns);
    TEST_ASSERT_TRUE(takt_move_curve(&move, &reader.config.start, &curve));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 30.0 * MATHS_PI, curve.length_mm);
}

static void test_arcs_that_cannot_be(void)
{
    check_error("F60 G2 R5", TAKT_ERROR_ARC_CLOSED, "R5", 0.0);
    check_error("F60 G2 X1", TAKT_ERROR_ARC_CENTRE_MISSING, "G2", 0.0);
    check_error("F60 G2 X1 I1 R1", TAKT_ERROR_ARC_CENTRE_TWICE, "R1", 0.0);
    check_error("F60 G2 X1 I0", TAKT_ERROR_ARC_RADIUS_ZERO, "G2", 0.0);
    check_error("F60 G2 X1 I1", TAKT_ERROR_ARC_RADIUS_ZERO, "G2", 0.0);
    check_error("F60 G2 I1 P0", TAKT_ERROR_WORD_OUT_OF_RANGE, "P0", 0.0);
    check_error("F60 G2 I1 P1.5", TAKT_ERROR_WORD_NOT_WHOLE, "P1.5", 1.5);
    check_error("F60 G2 I1 P9999999", TAKT_ERROR_WORD_OUT_OF_RANGE, "P9999999", 9999999.0);
    check_error("F60 G18 G2 X1 J1 I1", TAKT_ERROR_WORD_UNUSED, "J1", 0.0);
    check_error("F60 G19 G2 Y1 I1 K1", TAKT_ERROR_WORD_UNUSED, "I1", 0.0);
}

static void test_an_arc_needs_both_axes_of_its_plane(void)
{
    reader_prepare(&reader);
    reader.config.axes = 1U << AXIS_X | 1U << AXIS_Z;
    reader_text(&reader, "F60 G18 G2 X2 I1\nG17 G2 X4 I1");
    (void)reader_next(&reader, MOVE_ARC_CW);
    reader_expect_error(&reader, TAKT_ERROR_AXIS_MISSING);
    TEST_ASSERT_EQUAL_STRING("Y", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_UINT32(5, reader.diagnostic.column);
}

static void test_ends_beyond_the_travel_are_refused(void)
{
    check_error("G0 X500\nY500.001", TAKT_ERROR_TRAVEL_EXCEEDED, "Y", 500.001);
    TEST_ASSERT_EQUAL_UINT32(2, reader.diagnostic.line);
    TEST_ASSERT_EQUAL_UINT32(1, reader.diagnostic.column);
    check_error("G0 A-361", TAKT_ERROR_TRAVEL_EXCEEDED, "A", -361.0);
    check_error("G20 G0 Z19.7", TAKT_ERROR_TRAVEL_EXCEEDED, "Z", 500.38);
    check_error("#5161=501\nG28", TAKT_ERROR_TRAVEL_EXCEEDED, "X", 501.0);
    TEST_ASSERT_EQUAL_UINT32(1, reader.diagnostic.column);
    check_error("#1=[10**300]\nG20 G0 X[#1*10**7]", TAKT_ERROR_TRAVEL_EXCEEDED, "X",
                1e300 * 25.4e7);
}

/* Samples the curve for its extreme along each axis; the chord is off by r (step/2)^2/2 at most. */
static bool sample_exceeds(const struct move *move, const struct point *at, double limit)
{
    struct curve curve;
    struct point p;

    TEST_ASSERT_TRUE(takt_move_curve(move, at, &curve));
    for (int i = 0; i <= SAMPLES; i++) {
        takt_curve_point(&curve, curve.length_mm * i / SAMPLES, &p);
        for (int axis = 0; axis < AXIS_LINEAR_COUNT; axis++) {
            if (maths_abs(p.at[axis]) > limit) {
                return true;
            }
        }
    }
    return false;
}

/* One arc on a machine with travel -limit ... limit; *refused when the program may not run. */
static struct move try_arc(const char *text, double limit, bool *refused)
{
    struct move move = {0};

    reader_prepare(&reader);
    for (int axis = 0; axis < AXIS_LINEAR_COUNT; axis++) {
        reader.config.travel_min[axis] = -limit;
        reader.config.travel_max[axis] = limit;
    }
    reader_text(&reader, text);
    (void)reader_next(&reader, MOVE_RAPID);
    *refused = takt_program_next(&reader.program, &move, &reader.diagnostic) == PROGRAM_ERROR;
    if (*refused) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(TAKT_ERROR_TRAVEL_EXCEEDED, reader.diagnostic.code, text);
    }
    return move;
}

static void write_random_arc(char *text, size_t size, uint64_t *state, struct point *start)
{
    const double radius = random_between(state, 1.0, 40.0);
    const double centre[2] = {random_between(state, -50.0, 50.0),
                              random_between(state, -50.0, 50.0)};
    const double from = random_between(state, 0.0, MATHS_TWO_PI);
    const double to = random_between(state, 0.0, MATHS_TWO_PI);
    const double end_radius = radius + random_between(state, -0.02, 0.02);

    memset(start, 0, sizeof(*start));
    start->at[0] = centre[0] + radius * takt_maths_cos(from);
    start->at[1] = centre[1] + radius * takt_maths_sin(from);
    (void)snprintf(text, size, "F60 G0 X%.12f Y%.12f\nG%d X%.12f Y%.12f I%.12f J%.12f P%d",
                   start->at[0], start->at[1], random_unit(state) < 0.5 ? 2 : 3,
                   centre[0] + end_radius * takt_maths_cos(to),
                   centre[1] + end_radius * takt_maths_sin(to), centre[0] - start->at[0],
                   centre[1] - start->at[1], 1 + (int)random_between(state, 0.0, 2.5));
}

/*
 * Random arcs against a limit between their ends and their extremes. An arc is refused if a point
 * of it lies outside; one that is refused has a point beyond the limit less the sampling error.
 */
static void test_an_arc_is_refused_if_and_only_if_it_leaves_the_travel(void)
{
    const double limit = 60.0;
    uint64_t state = 2;
    unsigned refusals = 0;

    for (int i = 0; i < RANDOM_COUNT / 10; i++) {
        char text[PROGRAM_LINE_MAX];
        struct point start;
        bool refused;
        bool known;

        write_random_arc(text, sizeof(text), &state, &start);
        if (maths_abs(start.at[0]) > limit || maths_abs(start.at[1]) > limit) {
            continue;
        }
        const struct move move = try_arc(text, 1000.0, &known);

        TEST_ASSERT_FALSE_MESSAGE(known, text);
        (void)try_arc(text, limit, &refused);
        if (sample_exceeds(&move, &start, limit + 2e-6)) {
            TEST_ASSERT_TRUE_MESSAGE(refused, text);
        }
        if (refused) {
            refusals++;
            TEST_ASSERT_TRUE_MESSAGE(sample_exceeds(&move, &start, limit - 0.03), text);
        }
    }
    TEST_ASSERT_TRUE(refusals > 300 && refusals < 1700);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_offsets_of_the_centre_count_from_the_start);
    RUN_TEST(test_absolute_centres_are_work_coordinates);
    RUN_TEST(test_a_radius_leads_to_the_arc_of_that_radius);
    RUN_TEST(test_a_radius_a_little_too_short_makes_half_a_turn);
    RUN_TEST(test_the_end_may_be_off_its_circle_by_a_rounding_error);
    RUN_TEST(test_a_large_arc_may_be_off_by_a_thousandth_of_its_radius);
    RUN_TEST(test_the_tolerance_in_inches_is_the_larger_one);
    RUN_TEST(test_full_circles_need_no_end);
    RUN_TEST(test_arcs_that_cannot_be);
    RUN_TEST(test_an_arc_needs_both_axes_of_its_plane);
    RUN_TEST(test_ends_beyond_the_travel_are_refused);
    RUN_TEST(test_an_arc_is_refused_if_and_only_if_it_leaves_the_travel);
    return UNITY_END();
}
