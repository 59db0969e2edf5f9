/*
 * The rate of a compiled program: whatever is asked for, what the axes need for it stays within
 * what the curve leaves them, on machines of any kind; and every rate is come to.
 */
#include "base/maths.h"
#include "random_rate.h"
#include "replay/rate.h"

#include <stdint.h>
#include <unity.h>

#define MACHINES 60
#define ORDERS   60
#define SETTLED  20000
#define ROUNDING 1e-9

void setUp(void)
{
    random_rate_seed = 1;
}

void tearDown(void)
{
}

/* One cycle, verified with the largest of what the rate was and is. */
static double verified_step(struct rate *r, const struct plan_limits *l, double to)
{
    const struct rate before = *r;
    double most = 0.0;

    (void)takt_rate_step(r, to);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        most = maths_max(most, random_rate_need(l, i, &before, r));
    }
    return most;
}

static void test_no_change_of_the_rate_needs_more_than_the_limits(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_rate_machine();
        struct rate r;

        takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
        for (int order = 0; order < ORDERS; order++) {
            const double to =
                random_rate_between(0, 1) < 0.3 ? 0.0 : maths_min(1.0, random_rate_between(0, 1.3));
            const int cycles = (int)takt_maths_power(10.0, random_rate_between(0, 3.3));

            for (int i = 0; i < cycles; i++) {
                TEST_ASSERT_TRUE(verified_step(&r, &limits, to) <= 1.0 + ROUNDING);
                TEST_ASSERT_TRUE(r.now >= 0.0 && r.now <= 1.0);
            }
        }
    }
}

static void test_every_rate_is_come_to_and_kept(void)
{
    static const double wanted[] = {0.0, 1.0, 0.37, 0.01, 0.99, 0.0};
    const struct plan_limits limits = random_rate_machine();
    struct rate r;

    takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
    for (unsigned i = 0; i < sizeof(wanted) / sizeof(wanted[0]); i++) {
        for (int k = 0; k < SETTLED; k++) {
            (void)takt_rate_step(&r, wanted[i]);
        }
        TEST_ASSERT_EQUAL_DOUBLE(wanted[i], r.now);
        TEST_ASSERT_EQUAL_DOUBLE(wanted[i], takt_rate_step(&r, wanted[i]));
    }
}

static void test_coming_to_rest_leads_no_farther_than_said(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_rate_machine();
        struct rate r;
        double way = 0.0;

        takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
        for (int i = 0; i < SETTLED && !rate_rests(&r); i++) {
            way += takt_rate_step(&r, 0.0);
        }
        TEST_ASSERT_TRUE(rate_rests(&r));
        TEST_ASSERT_TRUE(way <= takt_rate_brake_cycles(&r));
    }
}

/* A stream of which so much is known need not be slower than that, either. */
static void test_from_the_highest_rate_it_comes_to_rest_on_the_way_that_is_known(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_rate_machine();
        const double known = random_rate_between(500.0, 4000.0);
        struct rate r;
        double way = 0.0;

        takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
        const double highest = takt_rate_highest(&r, known);

        TEST_ASSERT_TRUE(highest > 0.0);
        TEST_ASSERT_EQUAL(takt_rate_brake_cycles(&r) <= known, highest == 1.0);
        takt_rate_set(&r, highest);
        for (int i = 0; i < SETTLED && !rate_rests(&r); i++) {
            way += takt_rate_step(&r, 0.0);
        }
        TEST_ASSERT_TRUE(rate_rests(&r));
        TEST_ASSERT_TRUE(way <= known);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_change_of_the_rate_needs_more_than_the_limits);
    RUN_TEST(test_every_rate_is_come_to_and_kept);
    RUN_TEST(test_coming_to_rest_leads_no_farther_than_said);
    RUN_TEST(test_from_the_highest_rate_it_comes_to_rest_on_the_way_that_is_known);
    return UNITY_END();
}
