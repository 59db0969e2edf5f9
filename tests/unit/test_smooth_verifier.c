/* How fast nominal time may pass on a piece of a smoothed curve, and how fast that may change. */
#include "smooth/verifier.h"

#include "base/maths.h"

#include <string.h>
#include <unity.h>

static struct smooth_limits limits;
static struct verifier_change change;
static struct verifier_need need;
static struct route route;

void setUp(void)
{
    memset(&need, 0, sizeof need);
}

void tearDown(void)
{
}

/* That of a tolerance of 0.02 mm at 1000 mm/s2. */
#define INTERVAL_S 4e-3

static void find_change(double interval_s, double way_mm, bool whole)
{
    const struct verifier_way way = {whole ? way_mm : 0.0, way_mm};

    takt_verifier_change(&limits, interval_s, &way, &change);
}

/* One axis. */
static void set_machine(double velocity, double acceleration, double jerk)
{
    memset(&limits, 0, sizeof limits);
    limits.axes = 1;
    limits.windows = 1.0;
    limits.cycle_s = 5e-4;
    limits.velocity_mm_s[AXIS_X] = velocity;
    limits.acceleration_mm_s2[AXIS_X] = acceleration;
    limits.jerk_mm_s3[AXIS_X] = jerk;
    find_change(INTERVAL_S, MATHS_INFINITY, false);
    takt_route_init(&route, &limits, 0.01);
}

static struct verifier_rate rate;

static double rate_of(double first, double second, double third)
{
    need.first[0] = (float)first;
    need.second[0] = (float)second;
    need.third[0] = (float)third;
    takt_verifier_rate(&need, &route, 0, &change, &rate);
    return (double)rate.most;
}

/* x' r <= V, x' r' + x'' r^2 <= A, x' r'' + 3 x'' r r' + x''' r^3 <= J */
static void check_limits(double r, double first, double second, double third)
{
    const double j =
        first * change.by / change.rounding_s + 3.0 * second * r * change.by + third * r * r * r;

    TEST_ASSERT_TRUE(first * r <= limits.velocity_mm_s[AXIS_X] * (1.0 + 1e-6));
    TEST_ASSERT_TRUE(first * change.by + second * r * r <= limits.acceleration_mm_s2[AXIS_X]);
    TEST_ASSERT_TRUE(j <= limits.jerk_mm_s3[AXIS_X]);
}

/* The built-in mill: A/J is 20 ms, shorter than any limit of the rounding. */
static void test_a_change_is_rounded_over_the_time_that_the_acceleration_takes(void)
{
    set_machine(100.0, 1000.0, 50000.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.02, change.rounding_s);
}

/*
 * V r'/A of the acceleration: 6 % at least, half at most, and between what a stop over 0.7 of 256
 * pieces needs.
 */
static void test_shorter_pieces_leave_more_for_changes_up_to_half(void)
{
    set_machine(100.0, 250.0, 50000.0);
    find_change(20e-3, MATHS_INFINITY, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.06 * 2.5, change.by);
    find_change(6e-3, MATHS_INFINITY, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0 / (2.0 * 0.7 * 256.0 * 6e-3), change.by);
    find_change(1e-3, MATHS_INFINITY, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5 * 2.5, change.by);
}

/* What a piece leaves that needs so much velocity, and half of the acceleration. */
static double left_at(double velocity)
{
    (void)rate_of(velocity, 125.0, 0.0);
    return (double)takt_verifier_change_on(&need, &route, &change, &rate);
}

/*
 * 2.8 1/s are needed for a stop over the pieces. At the highest velocity 1.25 leave half of the
 * acceleration: there the rate changes that slowly, and where it costs no rate by twice that, which
 * is near enough, or more.
 */
static void test_slow_axes_leave_what_a_stop_over_short_pieces_needs(void)
{
    set_machine(100.0, 250.0, 50000.0);
    find_change(1e-3, MATHS_INFINITY, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.5, change.wanted);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.25, left_at(100.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.25, left_at(70.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2.5, left_at(51.0));
    TEST_ASSERT_TRUE((double)rate.most > 0.98);
    TEST_ASSERT_TRUE(left_at(5.0) > 10.0);
    find_change(6e-3, MATHS_INFINITY, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, change.by, change.wanted);
}

/*
 * R^2 = x r'/(12 J), but a cycle at least and A/J = 20 ms at most; V r'/R is no more than 0.3 of J.
 */
static void test_on_a_short_way_changes_of_rate_are_rounded_over_less(void)
{
    set_machine(100.0, 1000.0, 50000.0);
    const double by = change.by;

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20e-3, change.rounding_s);
    find_change(INTERVAL_S, 1000.0, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20e-3, change.rounding_s);
    find_change(INTERVAL_S, 100.0, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, by, change.by);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 100.0 * by / (12.0 * 50000.0),
                              change.rounding_s * change.rounding_s);
    find_change(INTERVAL_S, 1.0, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, by / (12.0 * 50000.0), change.rounding_s * change.rounding_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.3 * 500.0 * change.rounding_s, change.by);
    find_change(INTERVAL_S, 0.01, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, limits.cycle_s, change.rounding_s);
    find_change(INTERVAL_S, 1.0, false);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, by, change.by);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, by / (0.3 * 500.0), change.rounding_s);
}

/* V J/A^2 = 1/16: the axis comes to sqrt(V J), a quarter of A, at most. */
static void test_acceleration_that_jerk_leaves_no_time_for_counts_for_nothing(void)
{
    set_machine(100.0, 1000.0, 10000.0);
    const struct verifier_change reached = change;

    set_machine(100.0, 4000.0, 10000.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, reached.by, change.by);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, reached.rounding_s, change.rounding_s);
}

static void test_a_straight_piece_at_its_limits_keeps_nearly_the_nominal_rate(void)
{
    set_machine(100.0, 1000.0, 50000.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.0, rate_of(100.0, 0.0, 0.0));
    TEST_ASSERT_TRUE(rate_of(0.0, 1000.0, 0.0) > 0.99);
    TEST_ASSERT_TRUE(rate_of(0.0, 0.0, 50000.0) > 0.99);
}

/* from, and ever half as much again. */
static double grown(double from, unsigned times)
{
    for (unsigned i = 0; i < times; i++)
        from *= 1.5;
    return from;
}

static void check_half_used(double velocity, double acceleration, double jerk)
{
    set_machine(velocity, acceleration, jerk);
    const double first = 0.5 * velocity;
    const double second = 0.5 * maths_min(acceleration, jerk / change.by / 2.0);
    const double third = 0.5 * jerk;
    const double r = rate_of(first, second, third);

    TEST_ASSERT_TRUE(r >= 0.5);
    check_limits(r, first, second, third);
}

/*
 * Where A/J is long, or the acceleration high for the velocity, a change of rate alone could need
 * more than all of the jerk. What was left for the curve was nothing then: it stood for ever.
 */
static void test_no_machine_makes_a_curve_stand_that_needs_half_its_limits(void)
{
    for (unsigned v = 0; v < 8; v++)
        for (unsigned a = 0; a < 10; a++)
            for (unsigned j = 0; j < 14; j++)
                check_half_used(grown(20.0, v), grown(200.0, a), grown(5000.0, j));
}

static void test_the_rate_is_never_nothing(void)
{
    for (unsigned a = 0; a < 10; a++) {
        for (unsigned j = 0; j < 14; j++) {
            const double acceleration = grown(200.0, a);
            const double jerk = grown(5000.0, j);

            set_machine(20.0, acceleration, jerk);
            const double r = rate_of(20.0, acceleration, jerk);

            TEST_ASSERT_TRUE(r > 1e-3);
            check_limits(r, 20.0, acceleration, jerk);
        }
    }
}

/*
 * A line of 10 mm along X, and a window of samples that stand beside it at 5 mm; the last two lie a
 * mm off.
 */
static void stand_beside_a_line(struct window *w)
{
    static const struct move move = {.kind = MOVE_FEED, .feed_mm_s = 50.0, .tolerance_mm = 0.01};
    const struct point from = {{0}}, to = {{10.0}};
    const double here[] = {5.0, 0.0};
    const struct window_spot on = {.at = {0}};
    const struct window_spot off = {.at = {0, 1 << 24}};
    struct curve line;

    limits.axes = 3;
    limits.velocity_mm_s[AXIS_Y] = limits.velocity_mm_s[AXIS_X];
    limits.acceleration_mm_s2[AXIS_Y] = limits.acceleration_mm_s2[AXIS_X];
    limits.jerk_mm_s3[AXIS_Y] = limits.jerk_mm_s3[AXIS_X];
    takt_route_init(&route, &limits, 0.01);
    takt_curve_set_line(&line, &from, &to);
    takt_route_push(&route, &move, 0, &line);
    takt_window_init(w, &route, INTERVAL_S);
    takt_window_stand(w, &route, here, 5.0, 0);
    for (w->count = 3; w->count < 7; w->count++) {
        w->at_mm[w->count] = w->count < 4 ? 5.0 : 4.9;
        w->element[w->count] = 0;
        takt_window_set(w, &route, w->count, &off);
    }
    takt_window_set(w, &route, 3, &on);
    takt_window_set(w, &route, 4, &on);
}

/*
 * The last samples stay where they were thought to be, though those before may have come farther.
 */
static void test_a_piece_between_places_that_go_back_leaves_the_tolerance_by_what_it_is_off(void)
{
    static struct window w;
    struct verifier_verdict v;
    struct order order;

    set_machine(100.0, 1000.0, 50000.0);
    stand_beside_a_line(&w);
    takt_order_start(&order, 5.0, 0);
    takt_verifier_pieces(&w, &route, 4, 4, &order, &v);
    TEST_ASSERT_EQUAL_UINT(2, v.good);
    TEST_ASSERT_TRUE(v.beyond_mm > 0.0f);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_change_is_rounded_over_the_time_that_the_acceleration_takes);
    RUN_TEST(test_shorter_pieces_leave_more_for_changes_up_to_half);
    RUN_TEST(test_slow_axes_leave_what_a_stop_over_short_pieces_needs);
    RUN_TEST(test_on_a_short_way_changes_of_rate_are_rounded_over_less);
    RUN_TEST(test_acceleration_that_jerk_leaves_no_time_for_counts_for_nothing);
    RUN_TEST(test_a_straight_piece_at_its_limits_keeps_nearly_the_nominal_rate);
    RUN_TEST(test_no_machine_makes_a_curve_stand_that_needs_half_its_limits);
    RUN_TEST(test_the_rate_is_never_nothing);
    RUN_TEST(test_a_piece_between_places_that_go_back_leaves_the_tolerance_by_what_it_is_off);
    return UNITY_END();
}
