/*
 * firmware/servo/between.h: the polynomial between targets, against the course that the targets are
 * taken from.
 */
#include "servo/between.h"
#include "unity.h"

#include <math.h>
#include <string.h>

static struct between between;
static double piece[BETWEEN_COEFFICIENTS];

void setUp(void)
{
    memset(&between, 0, sizeof between);
}

void tearDown(void)
{
}

/* A target of a motion that stands until cycle 0; where its piece is at u. */
static double course(double t)
{
    return t <= 0 ? 0 : 20 * (1 - cos(t / 40)) + 0.001 * t * t * t / 100;
}

static void take(int k)
{
    double at[3] = {0, 0, 0};
    if (k > 0)
        takt_between_at(piece, 1, at);
    takt_between_take(&between, k > 0 ? between.target_mm[2] : 0, course(k), piece);
}

static void test_position_velocity_and_acceleration_are_continuous(void)
{
    double end[3] = {0, 0, 0};
    for (int k = 0; k < 300; k++) {
        double begin[3];
        take(k);
        takt_between_at(piece, 0, begin);
        for (int i = 0; i < 3; i++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-11, end[i], begin[i]);
        takt_between_at(piece, 1, end);
        TEST_ASSERT_DOUBLE_WITHIN(1e-11, course(k - 1), end[0]);
    }
}

/*
 * Between them it is where the course is, a cycle later: straight lines are off by
 * acceleration / 8.
 */
static void test_between_targets_it_follows_the_course_a_cycle_late(void)
{
    double off = 0, straight = 0;
    for (int k = 0; k < 300; k++) {
        double at[3];
        take(k);
        takt_between_at(piece, 0.5, at);
        if (k > 5) {
            off = fmax(off, fabs(at[0] - course(k - 1.5)));
            straight = fmax(straight, fabs((course(k - 2) + course(k - 1)) / 2 - course(k - 1.5)));
        }
    }
    TEST_ASSERT_TRUE(straight > 1.5e-3);
    TEST_ASSERT_TRUE(off < straight / 100);
}

static void test_a_parabola_stays_one(void)
{
    double at[3];
    takt_between_take(&between, 0, 0, piece);
    for (int k = 1; k < 20; k++)
        takt_between_take(&between, between.target_mm[2], 0.5 * k * k, piece);
    for (int i = 0; i <= 8; i++) {
        double u = i / 8.0;
        takt_between_at(piece, u, at);
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, 0.5 * (17 + u) * (17 + u), at[0]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, 17 + u, at[1]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, 1, at[2]);
    }
}

static void test_it_begins_at_rest_where_somebody_else_has_left_the_command(void)
{
    double at[3];
    take(0);
    take(1);
    takt_between_take(&between, 7, 7.5, piece);
    takt_between_at(piece, 0, at);
    TEST_ASSERT_EQUAL_DOUBLE(7, at[0]);
    TEST_ASSERT_EQUAL_DOUBLE(0, at[1]);
    takt_between_at(piece, 1, at);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 7, at[0]);
    takt_between_take(&between, 7, 7.5, piece);
    takt_between_at(piece, 1, at);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 7.5, at[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_position_velocity_and_acceleration_are_continuous);
    RUN_TEST(test_between_targets_it_follows_the_course_a_cycle_late);
    RUN_TEST(test_a_parabola_stays_one);
    RUN_TEST(test_it_begins_at_rest_where_somebody_else_has_left_the_command);
    return UNITY_END();
}
