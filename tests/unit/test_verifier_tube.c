/*
 * The verifier of paths within a tolerance, against setpoints made by hand: it must follow what is
 * right, and see what is wrong.
 */
#include "tube_bench.h"

#include "base/maths.h"

#define PI 3.14159265358979323846

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

/*
 * On a circle of 0.105 in place of 0.2, 1.2 rad from each other: their lines come to 0.105 cos
 * 0.6 = 0.2 - 0.113.
 */
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
        few = looks_of(loop, 1600, strtod(stroke[i], NULL), 0);
        many = looks_of(loop, 6400, strtod(stroke[i], NULL), 0);
        TEST_ASSERT_TRUE(many < 5 * few);
        /* Elements of 0.2 mm: of shorter strokes more are within reach. */
        TEST_ASSERT_TRUE((double)many < 6400 * 300 * maths_max(1, 0.2 / strtod(stroke[i], NULL)) *
                                            (1 + strtod(stroke[i], NULL) / STEP_MM));
    }
}

/* Lines that a planner takes for one: 96 times 25, in the order of thousandths of P. */
static void test_thousands_of_lines_far_shorter_than_the_tolerance_may_become_one(void)
{
    size_t size = (size_t)snprintf(program_text, sizeof program_text, "G64 P0.1\nF100\n");

    for (unsigned k = 0; k < 2400; k++)
        size +=
            (size_t)snprintf(program_text + size, sizeof program_text - size, "G1 X%.4f Y%.4f\n",
                             0.03 * sin(0.01 * k), 0.03 - 0.03 * cos(0.01 * k));
    (void)snprintf(program_text + size, sizeof program_text - size, "G1 X-1 Y0\n");
    begin(program_text);
    motion = 1;
    jump_to(0, 0);
    go_to(-1, 0);
    tube_verifier_finish(&verifier);
    TEST_ASSERT_TRUE(is_within());
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
    RUN_TEST(test_any_number_of_motions_within_the_tolerance_may_become_one);
    RUN_TEST(test_standing_changes_nothing);
    RUN_TEST(test_an_exact_motion_between_rounded_ones_must_be_exact);
    RUN_TEST(test_an_arc_is_measured_by_its_curve_and_not_by_chords);
    RUN_TEST(test_between_setpoints_of_a_bend_the_axes_do_not_go_straight);
    RUN_TEST(test_a_radian_counts_as_a_millimetre);
    RUN_TEST(test_a_probing_move_ends_where_the_axes_come_to_rest);
    RUN_TEST(test_what_an_answer_comes_before_must_have_been_done);
    RUN_TEST(test_work_is_in_proportion_to_motions_however_often_they_go_over_the_same_place);
    RUN_TEST(test_thousands_of_lines_far_shorter_than_the_tolerance_may_become_one);
    RUN_TEST(test_circles_within_the_tolerance_are_motions_whatever_pieces_they_are_cut_into);
    RUN_TEST(test_no_motion_that_is_said_to_be_executed_hides_what_is_left_out);
    RUN_TEST(test_a_program_that_is_not_done_to_its_end_is_seen);
    return UNITY_END();
}
