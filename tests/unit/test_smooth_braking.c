/*
 * The way that slowing down takes under an acceleration and a jerk, against the same gone in small
 * steps.
 */
#include "smooth/braking.h"

#include "base/maths.h"

#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static double grown(double from, double times, unsigned steps)
{
    for (unsigned i = 0; i < steps; i++)
        from *= times;
    return from;
}

static double braked(const struct braking_limits *l, double feed, double acceleration, double to)
{
    return (double)takt_braking_way(l, (float)feed, (float)acceleration, (float)to);
}

/* 2 sqrt(V/J) of a half V at no limit of acceleration; V^2/2A + V A/2J with one. */
static void test_braking_to_rest_takes_the_way_of_the_closed_form(void)
{
    const struct braking_limits weak = {1e6f, 1e4f};
    const struct braking_limits stiff = {250.0f, 1e6f};

    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 100.0 * maths_sqrt(100.0 / 1e4), braked(&weak, 100, 0, 0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 100.0 * 100.0 / 500.0 + 100.0 * 250.0 / 2e6,
                              braked(&stiff, 100, 0, 0));
}

/*
 * The same in steps of a 4,000th of the time: jerk down, hold, jerk up, each as late as it may be.
 */
static double gone(const struct braking_limits *l, double feed, double acceleration, double to)
{
    const double t = 5e-6;
    double way = 0.0;
    double a = acceleration;
    double v = feed;

    while (v > to || a < -1e-9) {
        const double left = v + a * t - to;
        const bool ends = a < 0.0 && a * a / (2.0 * (double)l->jerk) >= left;
        const double j = ends ? (double)l->jerk : -(double)l->jerk;

        a = maths_max(-(double)l->acceleration, a + j * t);
        a = ends ? maths_min(a, 0.0) : a;
        if (ends && a == 0.0)
            break;
        v += a * t;
        way += v * t;
    }
    return way;
}

static void test_braking_from_any_acceleration_is_that_of_the_motion_gone_in_steps(void)
{
    for (unsigned i = 0; i < 5; i++)
        for (unsigned k = 0; k < 4; k++)
            for (int part = -3; part <= 3; part++) {
                const double j = grown(5e3, 3.7, i);
                const double a = grown(100.0, 2.9, k);
                const struct braking_limits l = {(float)a, (float)j};
                const double begin = 0.3 * part * maths_min(a, maths_sqrt(j * 40.0));

                TEST_ASSERT_DOUBLE_WITHIN(0.05, gone(&l, 60.0, begin, 10.0),
                                          braked(&l, 60.0, begin, 10.0));
            }
}

static void test_nothing_is_to_brake_for_a_feed_that_is_higher(void)
{
    const struct braking_limits l = {1000.0f, 5e4f};

    TEST_ASSERT_EQUAL_FLOAT(0.0f, takt_braking_way(&l, 20.0f, 0.0f, 30.0f));
}

static void test_a_higher_limit_never_takes_a_longer_way(void)
{
    for (unsigned i = 0; i < 6; i++)
        for (unsigned k = 0; k < 10; k++) {
            const float a = (float)grown(100.0, 2.0, i);
            const float j = (float)grown(1e3, 2.0, k);
            const struct braking_limits less = {a, j};
            const struct braking_limits more = {2.0f * a, j};
            const struct braking_limits sharper = {a, 2.0f * j};
            const float way = takt_braking_way(&less, 80.0f, 0.0f, 5.0f) * 1.0001f;

            TEST_ASSERT_TRUE(takt_braking_way(&more, 80.0f, 0.0f, 5.0f) <= way);
            TEST_ASSERT_TRUE(takt_braking_way(&sharper, 80.0f, 0.0f, 5.0f) <= way);
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_braking_to_rest_takes_the_way_of_the_closed_form);
    RUN_TEST(test_braking_from_any_acceleration_is_that_of_the_motion_gone_in_steps);
    RUN_TEST(test_nothing_is_to_brake_for_a_feed_that_is_higher);
    RUN_TEST(test_a_higher_limit_never_takes_a_longer_way);
    return UNITY_END();
}
