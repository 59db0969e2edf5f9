/*
 * How far the lines through setpoints leave a smoothed curve, in which pieces that counts, and how
 * the units of a window hold all of it.
 */
#include "smooth/chord.h"

#include <string.h>
#include <unity.h>

#define CYCLE_S 1e-3
#define SAMPLES 16
#define BENT    8 /* the only sample that does not lie in line with its neighbours */

static struct smooth_limits limits;
static struct route route;
static struct window window;

void setUp(void)
{
    limits = (struct smooth_limits){
        .axes = 7, .chord_error_max_mm = 1e-3, .cycle_s = CYCLE_S, .windows = 1.0};
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits.velocity_mm_s[i] = 100.0;
        limits.acceleration_mm_s2[i] = 1000.0;
        limits.jerk_mm_s3[i] = 50000.0;
    }
    takt_route_init(&route, &limits, 0.01);
}

void tearDown(void)
{
}

static void set_sample(unsigned i, double x_mm)
{
    const double p[AXIS_COUNT] = {x_mm};
    struct window_spot spot;

    takt_window_nearest(&window, &route, p, &spot);
    takt_window_set(&window, &route, i, &spot);
}

/* All samples at 0, one elsewhere: c_0 - 2 c_1 + c_2 is x beside it, and -2 x at it. */
static void bend(double interval_s, double x_mm)
{
    takt_chord_init(&route.chord, CYCLE_S, interval_s);
    takt_window_init(&window, &route, interval_s);
    window.count = SAMPLES;
    for (unsigned i = 0; i < SAMPLES; i++) {
        set_sample(i, i == BENT ? x_mm : 0.0);
    }
}

static double leaves(unsigned piece)
{
    return (double)takt_chord_leaves(&window, &route, piece);
}

/* |x''| cycle^2/8, x'' = 2 x/d^2. */
static void test_lines_leave_the_curve_by_its_second_derivative(void)
{
    bend(2e-3, 0.004);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 2.0 * 0.004 * 0.25 / 8.0, leaves(BENT - 1));
    bend(5e-4, 0.004);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 2.0 * 0.004 * 4.0 / 8.0, leaves(BENT - 1));
}

/* The piece i lies between samples i + 1 and i + 2. */
static void check_reach(double interval_s, unsigned pieces)
{
    bend(interval_s, 0.004);
    const double most = leaves(BENT - 1);

    for (unsigned piece = 0; piece + 3 < SAMPLES; piece++) {
        const bool reaches = piece + 2 + pieces >= BENT && piece + 1 <= BENT + pieces;

        TEST_ASSERT_EQUAL(reaches, leaves(piece) >= most);
    }
}

static void test_a_line_of_a_cycle_reaches_into_the_pieces_beside_one_that_is_longer(void)
{
    check_reach(2e-3, 1);
    check_reach(1e-3, 1);
}

static void test_it_reaches_two_of_half_a_cycle(void)
{
    check_reach(5e-4, 2);
}

static void test_samples_in_line_are_left_by_nothing(void)
{
    bend(2e-3, 0.004);
    for (unsigned i = 0; i < SAMPLES; i++) {
        set_sample(i, 0.25 * i);
    }
    for (unsigned piece = 0; piece + 3 < SAMPLES; piece++) {
        TEST_ASSERT_TRUE(leaves(piece) < 1e-6);
    }
}

/* An axis that reaches its velocity in a hundredth of an interval, and a wide tolerance. */
static void test_a_window_has_units_for_its_longest_steps_and_the_tolerance(void)
{
    limits.velocity_mm_s[AXIS_X] = 1.0;
    limits.acceleration_mm_s2[AXIS_X] = 20000.0;
    limits.jerk_mm_s3[AXIS_X] = 5e7;
    takt_route_init(&route, &limits, 0.6);
    takt_window_init(&window, &route, 6e-3);
    const double least_step_mm = 0.25 * 20000.0 * 6e-3 * 6e-3;
    const double p[AXIS_COUNT] = {0.6 + least_step_mm * window.capacity};
    double q[AXIS_COUNT];
    struct window_spot spot;

    takt_window_nearest(&window, &route, p, &spot);
    takt_window_place(&window, &route, &spot, q);
    TEST_ASSERT_DOUBLE_WITHIN(window.unit_mm[0], p[0], q[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lines_leave_the_curve_by_its_second_derivative);
    RUN_TEST(test_a_line_of_a_cycle_reaches_into_the_pieces_beside_one_that_is_longer);
    RUN_TEST(test_it_reaches_two_of_half_a_cycle);
    RUN_TEST(test_samples_in_line_are_left_by_nothing);
    RUN_TEST(test_a_window_has_units_for_its_longest_steps_and_the_tolerance);
    return UNITY_END();
}
