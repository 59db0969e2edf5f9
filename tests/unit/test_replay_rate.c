/*
 * The rate of a compiled program: whatever is asked for, what the axes need for it stays within what the curve leaves
 * them, on machines of any kind; and every rate is come to.
 */
#include "base/maths.h"
#include "replay/rate.h"

#include <stdint.h>
#include <string.h>
#include <unity.h>

#define KEPT     0.996
#define MACHINES 60
#define ORDERS   60
#define SETTLED  20000
#define ROUNDING 1e-9
#define CYCLE_S  1e-3

static uint64_t seed;

void setUp(void)
{
    seed = 1;
}

void tearDown(void)
{
}

static double between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/* Jerk reaches the acceleration in 5 cycles or more. */
static struct plan_limits random_machine(void)
{
    struct plan_limits l;

    memset(&l, 0, sizeof(l));
    l.axes = 7;
    l.cycle_s = CYCLE_S;
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        l.velocity_mm_s[i] = maths_power(10.0, between(1.3, 2.7));
        l.acceleration_mm_s2[i] = maths_power(10.0, between(2.3, 4.0));
        l.jerk_mm_s3[i] = l.acceleration_mm_s2[i] / (CYCLE_S * between(5.0, 100.0));
    }
    return l;
}

/* Of one axis, at a place of the curve that needs all it may: acceleration and jerk over the limits (rate.h). */
static double need(const struct plan_limits *l, int axis, double r, double change, double bend)
{
    const double v = l->velocity_mm_s[axis] * l->cycle_s;
    const double a = l->acceleration_mm_s2[axis] * l->cycle_s * l->cycle_s;
    const double j = l->jerk_mm_s3[axis] * l->cycle_s * l->cycle_s * l->cycle_s;
    const double by_acceleration = KEPT * r * r + v / a * change;
    const double by_jerk = KEPT * r * r * r + 3.0 * a / j * r * change + v / j * bend;

    return maths_max(by_acceleration, by_jerk);
}

/* One cycle, judged with the largest of what the rate was and is. */
static double judged_step(struct rate *r, const struct plan_limits *l, double to)
{
    const struct rate before = *r;
    double most = 0.0;

    (void)rate_step(r, to);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        most = maths_max(most, need(l, i, maths_max(before.now, r->now),
                                    maths_max(maths_abs(before.change), maths_abs(r->change)),
                                    maths_abs(r->change - before.change)));
    }
    return most;
}

static void test_no_change_of_the_rate_needs_more_than_the_limits(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_machine();
        struct rate r;

        rate_init(&r, &limits, KEPT);
        for (int order = 0; order < ORDERS; order++) {
            const double to = between(0, 1) < 0.3 ? 0.0 : maths_min(1.0, between(0, 1.3));
            const int cycles = (int)maths_power(10.0, between(0, 3.3));

            for (int i = 0; i < cycles; i++) {
                TEST_ASSERT_TRUE(judged_step(&r, &limits, to) <= 1.0 + ROUNDING);
                TEST_ASSERT_TRUE(r.now >= 0.0 && r.now <= 1.0);
            }
        }
    }
}

static void test_every_rate_is_come_to_and_kept(void)
{
    static const double wanted[] = {0.0, 1.0, 0.37, 0.01, 0.99, 0.0};
    const struct plan_limits limits = random_machine();
    struct rate r;

    rate_init(&r, &limits, KEPT);
    for (unsigned i = 0; i < sizeof(wanted) / sizeof(wanted[0]); i++) {
        for (int k = 0; k < SETTLED; k++) {
            (void)rate_step(&r, wanted[i]);
        }
        TEST_ASSERT_EQUAL_DOUBLE(wanted[i], r.now);
        TEST_ASSERT_EQUAL_DOUBLE(wanted[i], rate_step(&r, wanted[i]));
    }
}

static void test_coming_to_rest_leads_no_farther_than_said(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_machine();
        struct rate r;
        double way = 0.0;

        rate_init(&r, &limits, KEPT);
        for (int i = 0; i < SETTLED && !rate_rests(&r); i++) {
            way += rate_step(&r, 0.0);
        }
        TEST_ASSERT_TRUE(rate_rests(&r));
        TEST_ASSERT_TRUE(way <= rate_brake_cycles(&r));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_change_of_the_rate_needs_more_than_the_limits);
    RUN_TEST(test_every_rate_is_come_to_and_kept);
    RUN_TEST(test_coming_to_rest_leads_no_farther_than_said);
    return UNITY_END();
}
