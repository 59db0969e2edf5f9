/*
 * The verifier of paths within a tolerance, against setpoints made by hand: it must follow what is right, and see what is
 * wrong.
 */
#include "unity.h"
#include "verifier/tube_verifier.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* Between two setpoints. */
#define STEP_MM 0.02

#define EXACT_MM 1e-3

static struct parameters parameters;
static struct source_text text;
static struct tube_verifier verifier;
static uint32_t motion; /* that is said to be executed */
static char program_text[400000];

void setUp(void)
{
    takt_parameters_clear(&parameters);
    memset(&verifier, 0, sizeof verifier);
    motion = UINT32_MAX / 2; /* none to be believed */
}

void tearDown(void)
{
    tube_verifier_free(&verifier);
}

static void begin_as(const char *program, bool waits)
{
    struct program_config config = {
        .axes = 0x3f, .parameters = &parameters, .waits = waits, .spindle_encoder = true};
    struct source source;

    for (int i = 0; i < AXIS_COUNT; i++) {
        config.travel_min[i] = -500;
        config.travel_max[i] = 500;
    }
    tube_verifier_free(&verifier);
    takt_source_open_text(&source, &text, program, strlen(program));
    tube_verifier_init(&verifier, &config, &source, EXACT_MM);
}

static void begin(const char *program)
{
    begin_as(program, false);
}

static void to_point(const struct point *p)
{
    TEST_ASSERT_TRUE(tube_verifier_add(&verifier, p, motion));
}

static void jump_to(double x, double y)
{
    to_point(&(struct point){{x, y}});
}

/* Setpoints straight on. */
static void go_to(double x, double y)
{
    const struct point from = verifier.has_next ? verifier.next : verifier.last;
    const double way_x = x - from.at[AXIS_X];
    const double way_y = y - from.at[AXIS_Y];
    const int steps = (int)ceil(hypot(way_x, way_y) / STEP_MM);

    for (int k = 1; k <= steps; k++)
        jump_to(from.at[AXIS_X] + way_x * k / steps, from.at[AXIS_Y] + way_y * k / steps);
}

/* Around a centre; from one angle to another, radians. */
static void go_around(double x, double y, double radius, double from, double to)
{
    const int steps = (int)ceil(fabs(to - from) * radius / STEP_MM);

    for (int k = 0; k <= steps; k++) {
        const double angle = from + (to - from) * k / steps;

        jump_to(x + radius * cos(angle), y + radius * sin(angle));
    }
}

static void finish_within(double path_part, double corner_part)
{
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, path_part, verifier.figures.path_part);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, corner_part, verifier.figures.corner_part);
    TEST_ASSERT_EQUAL_DOUBLE(0, verifier.figures.beyond_mm);
}

static bool is_within(void)
{
    return verifier.figures.path_part <= 1 && verifier.figures.corner_part <= 1;
}

static void test_a_corner_cut_within_the_tolerance_is_measured(void)
{
    begin("G64 P0.1\nF100\nG1 X10\nG1 Y10\n");
    go_to(9.9, 0);
    go_to(10, 0.1);
    go_to(10, 10);
    finish_within(0.5, sqrt(0.5)); /* the middle of the cut: 0.05 off both lines */
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20, verifier.figures.path_length_mm);
}

static void test_a_corner_cut_too_much_is_seen_by_its_distance(void)
{
    begin("G64 P0.1\nF100\nG1 X10\nG1 Y10\n");
    go_to(9.85, 0);
    go_to(10, 0.15);
    go_to(10, 10);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.15 * sqrt(0.5) / 0.1, verifier.figures.corner_part);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.006, verifier.figures.beyond_mm);
    TEST_ASSERT_EQUAL_UINT32(3, verifier.figures.beyond_line);
}

static void test_a_corner_that_is_left_out_is_seen_whatever_is_near(void)
{
    begin("G64 P0.1\nF100\nG1 X10\nG1 X10.4 Y0.3\nG1 X10.8 Y0\nG1 X20\n");
    go_to(20, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 3, verifier.figures.corner_part);
    TEST_ASSERT_TRUE(verifier.figures.path_part > 1);
}

static void test_a_setpoint_far_away_is_seen_and_the_path_is_found_again(void)
{
    begin("G64 P0.1\nF100\nG1 X10\n");
    go_to(5, 0);
    jump_to(5.02, 7);
    jump_to(5.04, 0);
    go_to(10, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 70, verifier.figures.path_part);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 6.9, verifier.figures.beyond_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, verifier.figures.corner_part);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10, verifier.figures.path_length_mm);
}

/* Two circles that touch in the origin, in this order; shorter than what is looked at ahead. */
static const char two_loops[] = "G64 P0.1\nF100\nG3 X0 Y0 I-0.2\nG3 X0 Y0 I0.2\nG1 Y5\n";

static void first_loop(void)
{
    go_around(-0.2, 0, 0.2, 0, 2 * PI);
}

static void second_loop(void)
{
    go_around(0.2, 0, 0.2, PI, 3 * PI);
}

static void test_loops_in_their_order_are_followed(void)
{
    begin(two_loops);
    first_loop();
    second_loop();
    go_to(0, 5);
    finish_within(0, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5 + 0.8 * PI, verifier.figures.path_length_mm);
}

static void test_a_loop_that_is_left_out_is_seen(void)
{
    begin(two_loops);
    second_loop();
    go_to(0, 5);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(verifier.figures.path_part > 1);
    begin(two_loops);
    first_loop();
    go_to(0, 5);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(verifier.figures.path_part > 1);
}

/* Its end is where it begins, so that no corner tells of it. */
static void test_a_loop_that_is_left_out_at_the_end_is_seen(void)
{
    static const char program[] = "G64 P0.1\nF100\nG1 X5\nG3 X5 Y0 I-0.2\n";

    begin(program);
    go_to(5, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(verifier.figures.path_part > 1);
    begin(program);
    go_to(5, 0);
    go_around(4.8, 0, 0.2, 0, 2 * PI);
    finish_within(0, 0);
}

static void test_loops_in_the_wrong_order_are_seen(void)
{
    begin(two_loops);
    second_loop();
    first_loop();
    go_to(0, 5);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(verifier.figures.path_part > 1);
}

static void test_a_circle_the_wrong_way_round_is_seen(void)
{
    begin("G64 P0.1\nF100\nG3 X0 Y0 I-0.2\nG1 Y5\n");
    go_around(-0.2, 0, 0.2, 2 * PI, 0);
    go_to(0, 5);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(verifier.figures.path_part > 1);
}

/* Corners of a square, each of which is visited, but not in the programmed order. */
static void test_corners_in_the_wrong_order_are_seen(void)
{
    begin("G64 P0.1\nF100\nG1 X1\nG1 X0\nG1 Y1\nG1 Y0\nG1 X-1\n");
    go_to(0, 1);
    go_to(0, 0);
    go_to(1, 0);
    go_to(0, 0);
    go_to(-1, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_FALSE(is_within());
}

static void test_a_path_that_goes_back_on_itself_is_followed(void)
{
    begin("G64 P0.1\nF100\nG1 X10\nG1 X0.5\nG1 X9\n");
    go_to(9.95, 0);
    go_to(0.55, 0.02);
    go_to(9, 0);
    finish_within(0.2, 0.5385164807); /* hypot(0.05, 0.02) / 0.1 */
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 28, verifier.figures.path_length_mm);
}

static void test_a_way_there_and_back_that_is_left_out_is_seen(void)
{
    begin("G64 P0.1\nF100\nG1 X10\nG1 X10.5\nG1 X9\nG1 X9 Y5\n");
    go_to(10, 0);
    go_to(9, 0);
    go_to(9, 5);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5, verifier.figures.corner_part);
}

/* Teeth lower than the tolerance: a straight line is as good, however many there are. */
static void test_any_number_of_motions_within_the_tolerance_may_become_one(void)
{
    size_t size = (size_t)snprintf(program_text, sizeof program_text, "G64 P0.1\nF100\n");

    for (int k = 1; k <= 10000; k++)
        size += (size_t)snprintf(program_text + size, sizeof program_text - size, "G1X%.4fY%.3f\n",
                                 0.001 * k, k % 2 == 1 ? 0.05 : 0.0);
    begin(program_text);
    go_to(10, 0);
    TEST_ASSERT_TRUE(verifier.path.capacity <= 1024);
    finish_within(0, 0.5); /* every second end is on the line */
}

static void test_strokes_shorter_than_the_tolerance_may_be_left_out(void)
{
    begin("G64 P0.1\nF100\nG1 X1\nG1 X1.05\nG1 X1\nG1 X1.05\nG1 X1\nG1 X1.05\nG1 X1\nG1 X2\n");
    go_to(2, 0);
    finish_within(0, 0);
}

/* From 1 back by some tolerances, then on: a straight line passes both ends, but never the second after the first. */
static void pass_stroke(double tolerances, double made)
{
    (void)snprintf(program_text, sizeof program_text, "G64 P0.1\nF100\nG1 X1\nG1 X%.6f\nG1 X2\n",
                   1 - 0.1 * tolerances);
    begin(program_text);
    go_to(1 - 0.05 * (tolerances - made), 0);
    go_to(1 - 0.05 * (tolerances + made), 0);
    go_to(2, 0);
    tube_verifier_finish(&verifier);
}

/* Whoever has not gone back is half of the stroke off at best: in its middle when the path is at its ends. */
static void test_a_stroke_back_may_be_left_out_up_to_two_tolerances(void)
{
    pass_stroke(1.95, 0);
    TEST_ASSERT_TRUE(is_within());
    for (unsigned k = 0; k < 20; k++) {
        pass_stroke(2.05 + 0.1 * k, 0);
        TEST_ASSERT_FALSE(is_within());
    }
}

/* On a circle of 10 mm about X-10, by arcs to these angles; gone around without going back. */
static void pass_curved_stroke(double tolerances)
{
    const double angle[] = {1, 1 - 0.01 * tolerances, 2};
    size_t size = (size_t)snprintf(program_text, sizeof program_text, "G64 P0.1\nF100\n");

    for (unsigned k = 0; k < 3; k++)
        size += (size_t)snprintf(program_text + size, sizeof program_text - size,
                                 "G%d X%.9f Y%.9f R10\n", k == 1 ? 2 : 3, 10 * cos(angle[k]) - 10,
                                 10 * sin(angle[k]));
    begin(program_text);
    go_around(-10, 0, 10, 0, 2);
    tube_verifier_finish(&verifier);
}

static void test_a_stroke_back_is_verified_on_bends_as_on_lines(void)
{
    pass_curved_stroke(1.95);
    TEST_ASSERT_TRUE(is_within());
    for (unsigned k = 0; k < 20; k++) {
        pass_curved_stroke(2.05 + 0.1 * k);
        TEST_ASSERT_FALSE(is_within());
    }
}

/* Likewise of one that is cut short: what is missing may be two tolerances in all. */
static void test_a_stroke_back_may_be_cut_short_by_two_tolerances(void)
{
    for (unsigned k = 0; k < 20; k++) {
        const double tolerances = 2.1 + 0.3 * k;

        pass_stroke(tolerances, tolerances - 1.9);
        TEST_ASSERT_TRUE(is_within());
        pass_stroke(tolerances, tolerances - 2.1);
        TEST_ASSERT_FALSE(is_within());
    }
}

static void test_going_back_is_seen_from_two_tolerances_on(void)
{
    for (unsigned k = 0; k < 20; k++) {
        begin("G64 P0.1\nF100\nG1 X10\n");
        go_to(5, 0);
        go_to(5 - 0.1 * (k == 0 ? 1.9 : 2 + 0.1 * k), 0);
        go_to(10, 0);
        tube_verifier_finish(&verifier);
        TEST_ASSERT_EQUAL_INT(k == 0, is_within());
    }
}

static void test_a_way_back_that_is_not_programmed_is_seen(void)
{
    begin("G64 P0.1\nF100\nG1 X10\n");
    go_to(5, 0);
    go_to(4, 0);
    go_to(10, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(verifier.figures.path_part > 6.5);
}

static void test_standing_changes_nothing(void)
{
    begin("G64 P0.1\nF100\nG1 X10\nG1 Y10\n");
    go_to(9.95, 0.05);
    for (int k = 0; k < 1000; k++)
        jump_to(9.95, 0.05);
    go_to(10, 0.1);
    go_to(10, 10);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(is_within());
    TEST_ASSERT_TRUE(verifier.path.capacity <= 64);
}

static void test_an_exact_motion_between_rounded_ones_must_be_exact(void)
{
    static const char program[] = "G64 P0.1\nF100\nG1 X10\nG61\nG1 X20\nG64 P0.1\nG1 X30\n";

    for (unsigned k = 0; k < 2; k++) {
        begin(program);
        go_to(5, 0.05);
        go_to(10, 0);
        go_to(15, k == 0 ? 0 : 0.05);
        go_to(20, 0);
        go_to(25, 0.05);
        go_to(30, 0);
        tube_verifier_finish(&verifier);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.5, verifier.figures.path_part);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, k == 0 ? 0 : 0.05 - EXACT_MM, verifier.figures.beyond_mm);
    }
}

static void test_an_arc_is_measured_by_its_curve_and_not_by_chords(void)
{
    begin("G64 P0.1\nF100\nG3 X-20 Y0 I-10\n");
    go_around(-10, 0, 10.03, 0, PI);
    go_to(-20, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.3, verifier.figures.path_part);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10 * PI, verifier.figures.path_length_mm);
}

/* On a circle of 0.105 in place of 0.2, 1.2 rad from each other: their lines come to 0.105 cos 0.6 = 0.2 - 0.113. */
static void test_between_setpoints_of_a_bend_the_axes_do_not_go_straight(void)
{
    begin("G64 P0.1\nF100\nG3 I-0.2 P3\nG1 Y-5\n");
    for (int k = 0; k < 16; k++)
        jump_to(-0.2 + 0.105 * cos(1.2 * k), 0.105 * sin(1.2 * k));
    go_to(0, 0);
    go_to(0, -5);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(verifier.figures.path_part < 1);
    TEST_ASSERT_TRUE(verifier.figures.corner_part < 1);
    TEST_ASSERT_EQUAL_DOUBLE(0, verifier.figures.beyond_mm);
}

static void test_a_radian_counts_as_a_millimetre(void)
{
    begin("G64 P0.1\nF100\nG1 X10 A57.29577951308232\n");
    for (int k = 1; k <= 100; k++)
        to_point(&(struct point){{0.1 * k, 0, 0, 0.01 * k + (k == 50 ? 0.05 : 0)}});
    finish_within(0.5 / sqrt(1.01), 0);
}

static void test_a_probing_move_ends_where_the_axes_come_to_rest(void)
{
    begin_as("G64 P0.1\nF60\nG38.2 X10\nG1 Y5\n", true);
    go_to(4, 0);
    tube_verifier_answer(&verifier, &(struct program_answer){.contact = true, .rest_at = {{4}}});
    go_to(4, 5);
    finish_within(0, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 9, verifier.figures.path_length_mm);
}

static void test_what_an_answer_comes_before_must_have_been_done(void)
{
    begin_as("G64 P0.1\nF60\nG1 X10\nG1 Y5\nM66 P0 L0\nG1 X0\n", true);
    go_to(9.95, 0);
    tube_verifier_answer(&verifier, &(struct program_answer){.value = 1});
    TEST_ASSERT_TRUE(verifier.figures.corner_part > 40);
}

static void test_a_program_that_is_not_done_to_its_end_is_seen(void)
{
    begin("G64 P0.1\nF100\nG1 X10\nG1 Y10\n");
    go_to(10, 0);
    go_to(10, 9);
    tube_verifier_stop(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 19, verifier.figures.path_length_mm);
    TEST_ASSERT_TRUE(is_within());
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 10, verifier.figures.corner_part);
}

/* Looks that the setpoints of this many motions in a loop of a few tolerances need. */
static uint64_t looks_of(const char *loop[2], unsigned motions, double way_x, double way_y)
{
    size_t size = (size_t)snprintf(program_text, sizeof program_text, "G64 P0.1\nF100\n");

    for (unsigned k = 0; k < motions; k++)
        size +=
            (size_t)snprintf(program_text + size, sizeof program_text - size, "%s\n", loop[k % 2]);
    begin(program_text);
    for (motion = 1; motion <= motions; motion++)
        go_to(motion % 2 == 1 ? way_x : 0, motion % 2 == 1 ? way_y : 0);
    finish_within(0, 0);
    return verifier.looks;
}

static void test_work_is_in_proportion_to_motions_however_often_they_go_over_the_same_place(void)
{
    static const char *const stroke[] = {"0.05", "0.1", "0.2", "0.4", "0.5", "0.7", "1"};

    for (unsigned i = 0; i < sizeof stroke / sizeof stroke[0]; i++) {
        char there[32];
        const char *loop[2] = {there, "G1 X0"};
        uint64_t few, many;

        (void)snprintf(there, sizeof there, "G1 X%s", stroke[i]);
        few = looks_of(loop, 400, strtod(stroke[i], NULL), 0);
        many = looks_of(loop, 1600, strtod(stroke[i], NULL), 0);
        TEST_ASSERT_TRUE(many < 5 * few);
        TEST_ASSERT_TRUE(many <
                         1600UL * 300UL * (unsigned long)(1 + strtod(stroke[i], NULL) / STEP_MM));
    }
}

/* A motion said may be some off. A circle is one, though the verifier cuts it into many pieces. */
static void test_circles_within_the_tolerance_are_motions_whatever_pieces_they_are_cut_into(void)
{
    size_t size = (size_t)snprintf(program_text, sizeof program_text, "G64 P0.1\nF100\n");

    for (unsigned k = 0; k < 10; k++)
        size += (size_t)snprintf(program_text + size, sizeof program_text - size, "G3 I0.03 P2\n");
    (void)snprintf(program_text + size, sizeof program_text - size, "G1 X-1\n");
    begin(program_text);
    motion = 1;
    for (unsigned k = 0; k < 20; k++)
        jump_to(0, 0);
    go_to(-1, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(is_within());
}

/* What is said to be executed is not believed against what the setpoints are. */
static void test_no_motion_that_is_said_to_be_executed_hides_what_is_left_out(void)
{
    for (motion = 0; motion < 2000; motion += 250) {
        size_t size = (size_t)snprintf(program_text, sizeof program_text, "G64 P0.1\nF100\n");

        for (unsigned k = 0; k < 500; k++)
            size += (size_t)snprintf(program_text + size, sizeof program_text - size,
                                     "G1 X0.3\nG1 X0\n");
        (void)snprintf(program_text + size, sizeof program_text - size,
                       "G1 Y1\nG1 Y0\nG1 X0.3\nG1 X0\nG1 X-1\n");
        begin(program_text);
        for (unsigned k = 0; k < 100; k++) {
            go_to(0.3, 0);
            go_to(0, 0);
        }
        go_to(-1, 0);
        tube_verifier_finish(&verifier);
        TEST_ASSERT_FALSE(is_within());
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_corner_cut_within_the_tolerance_is_measured);
    RUN_TEST(test_a_corner_cut_too_much_is_seen_by_its_distance);
    RUN_TEST(test_a_corner_that_is_left_out_is_seen_whatever_is_near);
    RUN_TEST(test_a_setpoint_far_away_is_seen_and_the_path_is_found_again);
    RUN_TEST(test_loops_in_their_order_are_followed);
    RUN_TEST(test_a_loop_that_is_left_out_is_seen);
    RUN_TEST(test_a_loop_that_is_left_out_at_the_end_is_seen);
    RUN_TEST(test_loops_in_the_wrong_order_are_seen);
    RUN_TEST(test_a_circle_the_wrong_way_round_is_seen);
    RUN_TEST(test_corners_in_the_wrong_order_are_seen);
    RUN_TEST(test_a_path_that_goes_back_on_itself_is_followed);
    RUN_TEST(test_a_way_there_and_back_that_is_left_out_is_seen);
    RUN_TEST(test_any_number_of_motions_within_the_tolerance_may_become_one);
    RUN_TEST(test_strokes_shorter_than_the_tolerance_may_be_left_out);
    RUN_TEST(test_a_stroke_back_may_be_left_out_up_to_two_tolerances);
    RUN_TEST(test_a_stroke_back_is_verified_on_bends_as_on_lines);
    RUN_TEST(test_a_stroke_back_may_be_cut_short_by_two_tolerances);
    RUN_TEST(test_going_back_is_seen_from_two_tolerances_on);
    RUN_TEST(test_a_way_back_that_is_not_programmed_is_seen);
    RUN_TEST(test_standing_changes_nothing);
    RUN_TEST(test_an_exact_motion_between_rounded_ones_must_be_exact);
    RUN_TEST(test_an_arc_is_measured_by_its_curve_and_not_by_chords);
    RUN_TEST(test_between_setpoints_of_a_bend_the_axes_do_not_go_straight);
    RUN_TEST(test_a_radian_counts_as_a_millimetre);
    RUN_TEST(test_a_probing_move_ends_where_the_axes_come_to_rest);
    RUN_TEST(test_what_an_answer_comes_before_must_have_been_done);
    RUN_TEST(test_work_is_in_proportion_to_motions_however_often_they_go_over_the_same_place);
    RUN_TEST(test_circles_within_the_tolerance_are_motions_whatever_pieces_they_are_cut_into);
    RUN_TEST(test_no_motion_that_is_said_to_be_executed_hides_what_is_left_out);
    RUN_TEST(test_a_program_that_is_not_done_to_its_end_is_seen);
    return UNITY_END();
}
