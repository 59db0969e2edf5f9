#include "base/maths.h"
#include "plan/ramp.h"

#include <stdint.h>
#include <string.h>
#include <unity.h>

static const struct ramp_limits mill = {1000.0, 50000.0};

static uint64_t seed;

void setUp(void)
{
    seed = 20260101;
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/* From 0.0001 to 1000, every decade as likely as the others. */
static double random_decade(void)
{
    return maths_power(10.0, random_between(-4.0, 3.0));
}

static struct ramp_limits random_limits(void)
{
    return (struct ramp_limits){10.0 * random_decade(), 1000.0 * random_decade()};
}

static void test_a_small_change_of_feed_takes_twice_the_root_of_its_ratio_to_jerk(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 2.0 * maths_sqrt(5.0 / 50000.0), ramp_duration(5.0, &mill));
}

static void test_a_large_change_of_feed_holds_the_acceleration(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 100.0 / 1000.0 + 1000.0 / 50000.0,
                              ramp_duration(100.0, &mill));
}

static void test_both_laws_meet_where_the_acceleration_is_just_reached(void)
{
    const double meeting = 1000.0 * 1000.0 / 50000.0;

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, ramp_duration(meeting * (1.0 - 1e-12), &mill),
                              ramp_duration(meeting, &mill));
}

static void test_reach_is_the_inverse_of_length(void)
{
    for (int i = 0; i < 20000; i++) {
        const struct ramp_limits limits = random_limits();
        const double low = random_between(0.0, 1.0) < 0.2 ? 0.0 : random_decade();
        const double length = random_decade();
        const double high = ramp_reach(low, length, &limits);

        TEST_ASSERT_TRUE(high >= low);
        if (high - low > 1e-6 * high) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-9 * length, length, ramp_length(low, high, &limits));
        }
    }
}

static void test_reach_grows_with_length(void)
{
    for (int i = 0; i < 2000; i++) {
        const struct ramp_limits limits = random_limits();
        const double low = random_decade();
        const double length = random_decade();

        TEST_ASSERT_TRUE(ramp_reach(low, 1.01 * length, &limits) >=
                         ramp_reach(low, length, &limits));
    }
}

static void test_no_length_reaches_no_higher_feed(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(12.5, ramp_reach(12.5, 0.0, &mill));
}

static void test_the_pieces_of_a_ramp_keep_acceleration_and_jerk_and_end_at_the_feed(void)
{
    for (int i = 0; i < 5000; i++) {
        const struct ramp_limits limits = random_limits();
        const double from = random_decade();
        const double to = random_decade();
        struct profile p;
        struct profile_state end;
        double s;

        memset(&p, 0, sizeof(p));
        s = ramp_append(&p, 1.0, from, to, &limits);
        profile_evaluate(&p, p.duration_s, &end);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * (from + to), to, end.v_mm_s);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * limits.a_mm_s2 + 1e-15 * p.duration_s * limits.j_mm_s3,
                                  0.0, end.a_mm_s2);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12 * s, s, end.s_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * s, 1.0 + ramp_length(from, to, &limits), s);
        for (unsigned k = 0; k < p.count; k++) {
            TEST_ASSERT_TRUE(maths_abs(p.piece[k].a_mm_s2) <= limits.a_mm_s2 * (1.0 + 1e-12));
            TEST_ASSERT_TRUE(maths_abs(p.piece[k].j_mm_s3) <= limits.j_mm_s3);
        }
    }
}

static void test_a_profile_is_smooth_in_feed_across_its_pieces(void)
{
    struct profile p;
    struct profile_state last;

    memset(&p, 0, sizeof(p));
    ramp_append(&p, 0.0, 0.0, 80.0, &mill);
    profile_evaluate(&p, 0.0, &last);
    for (int i = 1; i <= 1000; i++) {
        const double step_s = p.duration_s / 1000.0;
        struct profile_state now;

        profile_evaluate(&p, step_s * i, &now);
        TEST_ASSERT_TRUE(now.v_mm_s - last.v_mm_s >= -1e-12);
        TEST_ASSERT_TRUE(now.v_mm_s - last.v_mm_s <= mill.a_mm_s2 * step_s * (1.0 + 1e-9));
        last = now;
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_small_change_of_feed_takes_twice_the_root_of_its_ratio_to_jerk);
    RUN_TEST(test_a_large_change_of_feed_holds_the_acceleration);
    RUN_TEST(test_both_laws_meet_where_the_acceleration_is_just_reached);
    RUN_TEST(test_reach_is_the_inverse_of_length);
    RUN_TEST(test_reach_grows_with_length);
    RUN_TEST(test_no_length_reaches_no_higher_feed);
    RUN_TEST(test_the_pieces_of_a_ramp_keep_acceleration_and_jerk_and_end_at_the_feed);
    RUN_TEST(test_a_profile_is_smooth_in_feed_across_its_pieces);
    return UNITY_END();
}
