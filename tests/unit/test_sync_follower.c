/*
 * The point that follows a target within limits, and its coming to rest.
 */
#include "base/maths.h"
#include "sync/follower.h"

#include <string.h>
#include <unity.h>

#define CYCLE_S 1e-3

static const struct brake_limits limits = {100.0, 1000.0, 50000.0};
static const struct follower_end nowhere = {1.0, 1e9};

static struct follower follower;
static double history[4];
static double most[3]; /* velocity, acceleration, jerk by differences, as ratios to the limits */

void setUp(void)
{
    takt_follower_init(&follower, CYCLE_S);
    takt_follower_tune(&follower, 0.2);
    takt_follower_start(&follower, &limits);
    memset(history, 0, sizeof(history));
    memset(most, 0, sizeof(most));
}

void tearDown(void)
{
}

static void verifier(double x)
{
    memmove(history + 1, history, 3 * sizeof(double));
    history[0] = x;
    const double v = (x - history[1]) / CYCLE_S;
    const double a = (x - 2 * history[1] + history[2]) / (CYCLE_S * CYCLE_S);
    const double j =
        (x - 3 * history[1] + 3 * history[2] - history[3]) / (CYCLE_S * CYCLE_S * CYCLE_S);

    most[0] = maths_max(most[0], maths_abs(v) / limits.velocity_mm_s);
    most[1] = maths_max(most[1], maths_abs(a) / limits.acceleration_mm_s2);
    most[2] = maths_max(most[2], maths_abs(j) / limits.jerk_mm_s3);
}

static void step(const struct follower_target *target, const struct follower_end *end)
{
    takt_follower_step(&follower, target, end);
    verifier(follower.at.x_mm);
}

static void check_limits(void)
{
    TEST_ASSERT_TRUE(most[0] <= 1.0001);
    TEST_ASSERT_TRUE(most[1] <= 1.0001);
    TEST_ASSERT_TRUE(most[2] <= 1.001);
}

static void test_a_small_step_of_the_target_is_settled_without_overshoot(void)
{
    const struct follower_target target = {.x_mm = 1e-4};

    for (int i = 0; i < 100; i++) {
        step(&target, &nowhere);
        TEST_ASSERT_TRUE(follower.at.x_mm <= 1e-4 * (1 + 1e-9));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-4, follower.at.x_mm);
    check_limits();
}

static void test_a_large_step_is_reached_within_limits(void)
{
    const struct follower_target target = {.x_mm = 5.0};

    for (int i = 0; i < 8000; i++) {
        step(&target, &nowhere);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0, follower.at.x_mm);
    check_limits();
}

/* J t^2 is 200 times V: what a cycle's jerk could round is taken off V, and was more than that. */
static void test_velocity_is_kept_where_the_jerk_of_a_cycle_is_far_more(void)
{
    const struct brake_limits stiff = {5.0, 1e5, 1e9};
    struct follower_target target = {.v_mm_s = 3.0};
    double before = 0.0;

    takt_follower_start(&follower, &stiff);
    for (int i = 0; i < 500; i++) {
        target.x_mm = 3.0 * CYCLE_S * i;
        takt_follower_step(&follower, &target, &nowhere);
        TEST_ASSERT_TRUE(maths_abs(follower.at.x_mm - before) <= 5.0 * CYCLE_S * 1.0001);
        before = follower.at.x_mm;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, target.x_mm + 3.0 * CYCLE_S, follower.at.x_mm);
}

/*
 * As a tap does: more than the jerk can follow, by which the point once went on to swing by 0.03
 * mm.
 */
static void test_a_target_that_turns_back_at_once_is_come_to_without_swinging(void)
{
    struct follower_target target = {.v_mm_s = 1.0};
    double turned = 0.0;

    for (int i = 0; i < 1500; i++) {
        const double before = follower.at.x_mm;

        target.v_mm_s = maths_clamp(0.2 * (505 - i), -1.0, 1.0);
        target.a_mm_s2 = maths_abs(target.v_mm_s) < 1.0 ? -200.0 : 0.0;
        target.x_mm += target.v_mm_s * CYCLE_S;
        step(&target, &nowhere);
        turned += i > 600 && follower.at.x_mm > before ? 1.0 : 0.0;
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, turned);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, target.x_mm + target.v_mm_s * CYCLE_S, follower.at.x_mm);
    check_limits();
}

static void test_a_target_faster_than_the_velocity_is_followed_at_the_velocity(void)
{
    struct follower_target target = {.v_mm_s = 150.0};

    for (int i = 0; i < 3000; i++) {
        target.x_mm = 150.0 * CYCLE_S * i;
        step(&target, &nowhere);
    }
    TEST_ASSERT_TRUE(follower.at.v_mm_s > 99.9);
    check_limits();
}

/*
 * Speeds that come to the end in every phase of a cycle, on the way up, at speed and on the way
 * down.
 */
static void test_an_end_is_come_to_rest_on_exactly(void)
{
    for (int n = 0; n < 400; n++) {
        const struct follower_end end = {n % 2 == 0 ? 1.0 : -1.0,
                                         (n % 2 == 0 ? 1.0 : -1.0) * (0.001 + 0.013 * n)};
        struct follower_target target = {0};

        setUp();
        for (int i = 0; i < 20000 && !follower_rests(&follower); i++) {
            target.v_mm_s = end.sense * (20.0 + 15.0 * takt_maths_sin(0.01 * (i + n)));
            target.x_mm += target.v_mm_s * CYCLE_S;
            step(&target, &end);
            TEST_ASSERT_TRUE(end.sense * follower.at.x_mm <= end.sense * end.x_mm + 1e-12);
        }
        TEST_ASSERT_TRUE(follower_rests(&follower));
        TEST_ASSERT_EQUAL_DOUBLE(end.x_mm, follower.at.x_mm);
        step(&target, &end);
        step(&target, &end);
        step(&target, &end);
        check_limits();
    }
}

/* With v0 = 37.5, A = 1000, J = 50,000: v/A + A/J = 57.5 ms, and v/2 times that far. */
static void test_braking_takes_the_least_time(void)
{
    struct brake brake;
    struct brake_state s = {.x_mm = 2.0, .v_mm_s = 37.5};
    int cycles = 0;

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0 + 0.5 * 37.5 * 0.0575, takt_brake_reach(&s, &limits));
    takt_brake_begin(&brake, &s, &limits);
    while (!brake_is_over(&brake)) {
        takt_brake_step(&brake, CYCLE_S, &s);
        cycles++;
    }
    TEST_ASSERT_EQUAL_INT(58, cycles);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0 + 0.5 * 37.5 * 0.0575, s.x_mm);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, s.v_mm_s);
}

/* From any velocity and acceleration: rest, and no farther on the way than was said. */
static void test_braking_reaches_no_farther_than_was_said(void)
{
    for (int n = 0; n < 2000; n++) {
        const double a = 1000.0 * takt_maths_sin(1.3 * n);
        const double v = 90.0 * takt_maths_sin(0.7 * n);
        struct brake_state s = {.v_mm_s = v, .a_mm_s2 = a};
        const double reach = takt_brake_reach(&s, &limits);
        double farthest = 0.0;
        struct brake brake;

        takt_brake_begin(&brake, &s, &limits);
        for (int i = 0; i < 1000 && !brake_is_over(&brake); i++) {
            takt_brake_step(&brake, CYCLE_S / 7.0, &s);
            farthest = maths_max(farthest, s.x_mm);
            TEST_ASSERT_TRUE(maths_abs(s.a_mm_s2) <= limits.acceleration_mm_s2 * (1 + 1e-9));
        }
        farthest = maths_max(farthest, s.x_mm);
        TEST_ASSERT_TRUE(farthest <= reach + 1e-9);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, reach, farthest);
    }
}

static void test_asked_to_brake_it_rests_wherever_that_is(void)
{
    struct follower_target target = {.v_mm_s = 20.0};

    for (int i = 0; i < 500; i++) {
        target.x_mm = 20.0 * CYCLE_S * i;
        step(&target, &nowhere);
    }
    takt_follower_brake(&follower);
    while (!follower_rests(&follower)) {
        step(&target, &nowhere);
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, follower.at.v_mm_s);
    check_limits();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_small_step_of_the_target_is_settled_without_overshoot);
    RUN_TEST(test_a_large_step_is_reached_within_limits);
    RUN_TEST(test_velocity_is_kept_where_the_jerk_of_a_cycle_is_far_more);
    RUN_TEST(test_a_target_that_turns_back_at_once_is_come_to_without_swinging);
    RUN_TEST(test_a_target_faster_than_the_velocity_is_followed_at_the_velocity);
    RUN_TEST(test_an_end_is_come_to_rest_on_exactly);
    RUN_TEST(test_braking_takes_the_least_time);
    RUN_TEST(test_braking_reaches_no_farther_than_was_said);
    RUN_TEST(test_asked_to_brake_it_rests_wherever_that_is);
    return UNITY_END();
}
