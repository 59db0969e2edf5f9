/* The programmed path itself: where it comes to rest. */
#include "smooth/exact.h"

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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tangent_arc_is_rested_at_where_its_acceleration_would_have_to_come_at_once);
    return UNITY_END();
}
