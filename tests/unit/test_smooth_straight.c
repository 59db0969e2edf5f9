/* From rest, where no curve is found: back to the path and along it, from rest to rest, in any tolerance. */
#include "smooth/straight.h"

#include "smooth/judge.h"

#include <math.h>
#include <string.h>
#include <unity.h>

static struct smooth_limits limits;
static struct route route;
static struct window window;
static struct judge_change change;

void setUp(void)
{
}

void tearDown(void)
{
}

/* Two axes, a line of 200 mm along X. */
static void set_machine(double velocity, double acceleration, double jerk, double interval_s)
{
    struct move move = {.kind = MOVE_FEED, .feed_mm_s = velocity, .tolerance_mm = 1.0};
    struct point end = {{200.0}};
    struct curve line;

    memset(&limits, 0, sizeof limits);
    limits.axes = 3;
    limits.cycle_s = 1e-3;
    for (int i = 0; i < 2; i++) {
        limits.velocity_mm_s[i] = velocity;
        limits.acceleration_mm_s2[i] = acceleration;
        limits.jerk_mm_s3[i] = jerk;
    }
    route_init(&route, &limits, 1.0);
    judge_change(&limits, interval_s, &change);
    TEST_ASSERT_TRUE(curve_set_line(&line, &(struct point){{0}}, &end));
    route_push(&route, &move, 0, &line);
    window_init(&window, &route, interval_s);
    memset(window.origin, 0, sizeof window.origin);
}

/* The axes rest at a place of the path's, so far beside it. */
static void rest(double at_mm, double x_mm, double y_mm)
{
    const double p[AXIS_COUNT] = {x_mm, y_mm};
    struct window_spot spot;

    window_nearest(&window, &route, p, &spot);
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        window.at_mm[i] = at_mm;
        window.element[i] = 0;
        window_set(&window, &route, i, &spot);
    }
    window.count = SMOOTH_FIXED;
}

/* One way from rest to rest. Returns the lowest rate of its pieces. */
static float go_straight_on(void)
{
    const unsigned pieces = straight_on(&window, &route);
    float lowest = 1.0f;
    double p[AXIS_COUNT];

    for (unsigned i = 0; i < pieces; i++) {
        struct judge_need need;
        struct judge_rate rate;

        judge_need(&window, &route, i, &need);
        judge_rate(&need, &route, 0, &change, &rate);
        lowest = rate.most < lowest ? rate.most : lowest;
    }
    window_sample(&window, &route, window.count - 1, p);
    rest(window.at_mm[window.count - 1], p[0], p[1]);
    return lowest;
}

static double beside_mm(void)
{
    double p[AXIS_COUNT];

    window_sample(&window, &route, 0, p);
    return fabs(p[1]);
}

/* Intervals from 1 ms to what a way of the tolerance takes, V of 1 ... 1000 intervals beside it. */
static void test_it_comes_back_to_the_path_however_short_an_interval_is(void)
{
    for (double velocity = 2.0; velocity < 2000.0; velocity *= 3.0) {
        for (double interval_s = 1e-3; interval_s < 0.1; interval_s *= 2.0) {
            unsigned ways = 0;

            set_machine(velocity, 300.0, 400.0, interval_s);
            rest(50.0, 50.0, 0.95);
            while (beside_mm() > 1e-6) {
                TEST_ASSERT_TRUE(go_straight_on() > 1e-3f);
                TEST_ASSERT_TRUE(ways++ < 1000);
            }
        }
    }
}

static void test_on_the_path_it_goes_along_it(void)
{
    set_machine(100.0, 1000.0, 50000.0, 4e-3);
    rest(50.0, 50.0, 0.0);
    TEST_ASSERT_TRUE(go_straight_on() > 1e-3f);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50.4, window.at_mm[0]);
    TEST_ASSERT_TRUE(beside_mm() < 1e-6);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_comes_back_to_the_path_however_short_an_interval_is);
    RUN_TEST(test_on_the_path_it_goes_along_it);
    return UNITY_END();
}
