/* The programmed path itself: where it comes to rest, and how long it takes. */
#include "smooth/exact_time.h"

#include "base/maths.h"

#include <string.h>
#include <unity.h>

#define JERK_MM_S3 50000.0
#define CYCLE_S    1e-4
#define RADIUS_MM  10.0

/* V^2 K <= 1/2 J cycle / (3/4): the acceleration of an arc that begins at once. */
#define JOINT_MM_S (maths_sqrt(0.5 * JERK_MM_S3 * CYCLE_S * RADIUS_MM / 0.75))

static struct smooth_limits limits;
static struct route route;
static struct exact_work work;

void setUp(void)
{
    memset(&limits, 0, sizeof limits);
    limits.axes = 3;
    limits.chord_error_max_mm = 1e-3;
    limits.cycle_s = CYCLE_S;
    limits.windows = 1.0;
    for (int i = 0; i < 2; i++) {
        limits.velocity_mm_s[i] = 100.0;
        limits.acceleration_mm_s2[i] = 1000.0;
        limits.jerk_mm_s3[i] = JERK_MM_S3;
    }
}

void tearDown(void)
{
}

/* Along X for 20 mm, and by a quarter of a circle into Y. */
static void push_line_and_arc(double feed_mm_s)
{
    static const struct point at[3] = {{{0}}, {{20.0}}, {{20.0 + RADIUS_MM, RADIUS_MM}}};
    static const double centre_mm[2] = {20.0, RADIUS_MM};
    const struct move move = {.kind = MOVE_FEED, .feed_mm_s = feed_mm_s, .tolerance_mm = 0.01};
    struct curve line, arc;

    takt_route_init(&route, &limits, 0.01);
    route.moved = 3;
    TEST_ASSERT_TRUE(takt_curve_set_line(&line, &at[0], &at[1]));
    TEST_ASSERT_TRUE(takt_curve_set_arc(&arc, &at[1], &at[2], PLANE_XY, centre_mm, false, 1));
    takt_route_push(&route, &move, 0, &line);
    takt_route_push(&route, &move, 1, &arc);
}

static bool rests_at(double feed_mm_s)
{
    push_line_and_arc(feed_mm_s);
    return takt_exact_rests(&route, &limits, 1);
}

static void test_a_tangent_arc_is_rested_at_where_its_acceleration_would_have_to_come_at_once(void)
{
    TEST_ASSERT_FALSE(rests_at(JOINT_MM_S));
    TEST_ASSERT_TRUE(rests_at(5.0 * JOINT_MM_S));
}

/* Too slow to brake to exactly, but nobody must: both sides are slower. */
static void test_a_junction_that_is_faster_than_both_sides_is_passed(void)
{
    limits.cycle_s = 0.004;
    limits.jerk_mm_s3[0] = limits.jerk_mm_s3[1] = 2e6;
    TEST_ASSERT_FALSE(rests_at(50.0));
}

static double seconds_of_line(double length_mm)
{
    const struct point from = {{0}};
    const struct point to = {{length_mm}};
    const struct move move = {.kind = MOVE_FEED, .feed_mm_s = 50.0, .tolerance_mm = 0.01};
    struct curve line;

    takt_route_init(&route, &limits, 0.01);
    route.moved = 1;
    TEST_ASSERT_TRUE(takt_curve_set_line(&line, &from, &to));
    takt_route_push(&route, &move, 0, &line);
    return (double)takt_exact_time(&route, &limits, 0.0, 0, 1, &work);
}

/* L/v + v/a + a/J, a = A; and cbrt(32 L/J): four ramps of acceleration without a plateau. */
static void test_a_line_takes_its_way_at_the_feed_and_a_ramp_or_four_of_acceleration(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 100.0 / 50.0 + 50.0 / 1000.0 + 1000.0 / JERK_MM_S3,
                              seconds_of_line(100.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-2 * takt_maths_cbrt(32.0 * 0.05 / JERK_MM_S3),
                              takt_maths_cbrt(32.0 * 0.05 / JERK_MM_S3), seconds_of_line(0.05));
}

/* At v^3/R^2 = J/2 or v^2/R = 0.9 A, whichever is less, and up to it and down with what is left. */
static void test_a_circle_takes_its_way_at_the_feed_that_its_curvature_allows(void)
{
    static const struct point at = {{RADIUS_MM}};
    static const double centre_mm[2] = {0.0, 0.0};
    const struct move move = {.kind = MOVE_FEED, .feed_mm_s = 500.0, .tolerance_mm = 0.01};
    const double top = maths_min(maths_sqrt(0.9 * 1000.0 * RADIUS_MM),
                                 takt_maths_cbrt(0.5 * JERK_MM_S3 * RADIUS_MM * RADIUS_MM));
    struct curve arc;

    takt_route_init(&route, &limits, 0.01);
    route.moved = 3;
    TEST_ASSERT_TRUE(takt_curve_set_arc(&arc, &at, &at, PLANE_XY, centre_mm, false, 100));
    takt_route_push(&route, &move, 0, &arc);
    const double way_s = 200.0 * MATHS_PI * RADIUS_MM / top;
    const double time_s = (double)takt_exact_time(&route, &limits, 0.0, 0, 1, &work);

    TEST_ASSERT_TRUE(time_s > way_s && time_s < way_s + 0.5);
}

/* From rest at a corner, which the window has on the element before it. */
static void test_from_the_end_of_an_element_on_the_next_one_alone_counts(void)
{
    static const struct point at[2][3] = {{{{0}}, {{20.0}}, {{30.0}}},
                                          {{{0}}, {{20.0}}, {{20.0, 10.0}}}};
    const struct move move = {.kind = MOVE_FEED, .feed_mm_s = 50.0, .tolerance_mm = 0.01};

    for (unsigned k = 0; k < 2; k++) {
        struct curve line[2];

        takt_route_init(&route, &limits, 0.01);
        route.moved = 3;
        for (unsigned i = 0; i < 2; i++) {
            TEST_ASSERT_TRUE(takt_curve_set_line(&line[i], &at[k][i], &at[k][i + 1]));
            takt_route_push(&route, &move, i, &line[i]);
        }
        const float next = takt_exact_time(&route, &limits, 20.0, 1, 2, &work);

        TEST_ASSERT_TRUE(next > 0.2f);
        TEST_ASSERT_EQUAL_FLOAT(next, takt_exact_time(&route, &limits, 20.0, 0, 2, &work));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tangent_arc_is_rested_at_where_its_acceleration_would_have_to_come_at_once);
    RUN_TEST(test_a_junction_that_is_faster_than_both_sides_is_passed);
    RUN_TEST(test_a_line_takes_its_way_at_the_feed_and_a_ramp_or_four_of_acceleration);
    RUN_TEST(test_a_circle_takes_its_way_at_the_feed_that_its_curvature_allows);
    RUN_TEST(test_from_the_end_of_an_element_on_the_next_one_alone_counts);
    return UNITY_END();
}
