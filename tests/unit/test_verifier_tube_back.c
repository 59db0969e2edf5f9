/* The verifier of the tube where the path goes back on itself. */
#include "tube_bench.h"

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

static void test_strokes_shorter_than_the_tolerance_may_be_left_out(void)
{
    begin("G64 P0.1\nF100\nG1 X1\nG1 X1.05\nG1 X1\nG1 X1.05\nG1 X1\nG1 X1.05\nG1 X1\nG1 X2\n");
    go_to(2, 0);
    finish_within(0, 0);
}

/*
 * From 1 back by some tolerances, then on: a straight line passes both ends, but never the second
 * after the first.
 */
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

/*
 * Whoever has not gone back is half of the stroke off at best: in its middle when the path is at
 * its ends.
 */
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_path_that_goes_back_on_itself_is_followed);
    RUN_TEST(test_a_way_there_and_back_that_is_left_out_is_seen);
    RUN_TEST(test_strokes_shorter_than_the_tolerance_may_be_left_out);
    RUN_TEST(test_a_stroke_back_may_be_left_out_up_to_two_tolerances);
    RUN_TEST(test_a_stroke_back_is_verified_on_bends_as_on_lines);
    RUN_TEST(test_a_stroke_back_may_be_cut_short_by_two_tolerances);
    RUN_TEST(test_going_back_is_seen_from_two_tolerances_on);
    RUN_TEST(test_a_way_back_that_is_not_programmed_is_seen);
    return UNITY_END();
}
