/*
 * Landing in motion: the trapezoidal reference's way to a junction on which a setpoint falls
 * exactly.
 */
#include "motion/landing.h"

#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* Mean of the trapezoidal reference's last window positions, the newest at the end of the run. */
static double setpoint_mm(const struct landing_run *run, unsigned window)
{
    double sum = 0.0;
    double feed;

    for (unsigned i = 0; i < window; i++) {
        sum += takt_landing_distance(run, run->total - i, &feed);
    }
    return sum / window;
}

static void check(const struct landing_case *l)
{
    struct landing_run run = {0};

    TEST_ASSERT_TRUE(takt_landing_solve(l, &run));
    TEST_ASSERT_EQUAL(run.ramp + (unsigned)l->window, run.total);
    TEST_ASSERT_TRUE(run.feed_end <= l->feed_max && run.feed_end <= l->feed && run.feed_end > 0.0);
    TEST_ASSERT_TRUE((l->feed - run.feed_end) / run.ramp <= l->acceleration * (1.0 + 1e-9));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, l->gap_mm, setpoint_mm(&run, (unsigned)l->window));
}

static void test_the_average_falls_on_the_junction_exactly(void)
{
    for (int i = 0; i < 200; i++) {
        const struct landing_case l = {.gap_mm = 4.0 + 0.0123 * i,
                                       .feed = 0.1,
                                       .feed_max = 0.08,
                                       .acceleration = 1e-3,
                                       .window = 1 + i % 40};

        check(&l);
    }
}

static void test_a_junction_that_is_too_near_is_refused(void)
{
    const struct landing_case near = {1.0, 0.1, 0.08, 1e-3, 20};
    const struct landing_case standing = {1.0, 0.0, 0.08, 1e-3, 20};
    struct landing_run run;

    TEST_ASSERT_FALSE(takt_landing_solve(&near, &run));
    TEST_ASSERT_FALSE(takt_landing_solve(&standing, &run));
}

static void test_the_run_starts_at_its_feed_and_ends_at_constant_feed(void)
{
    const struct landing_case l = {4.0, 0.1, 0.08, 1e-3, 20};
    struct landing_run run = {0};
    double feed;

    TEST_ASSERT_TRUE(takt_landing_solve(&l, &run));
    TEST_ASSERT_TRUE(takt_landing_distance(&run, 0, &feed) == 0.0 && feed == 0.1);
    (void)takt_landing_distance(&run, run.ramp, &feed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, run.feed_end, feed);
    const double step = takt_landing_distance(&run, run.total, &feed) -
                        takt_landing_distance(&run, run.total - 1, &feed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, run.feed_end, step);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_average_falls_on_the_junction_exactly);
    RUN_TEST(test_a_junction_that_is_too_near_is_refused);
    RUN_TEST(test_the_run_starts_at_its_feed_and_ends_at_constant_feed);
    return UNITY_END();
}
