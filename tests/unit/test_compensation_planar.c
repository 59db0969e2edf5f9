/*
 * Lines and arcs in a plane: moved aside, crossed, cut, measured. Figures by hand.
 */
#include "cutter_compensation/planar.h"

#include "base/maths.h"

#include "unity.h"

#define NEAR 1e-12

static struct planar line(double x0, double y0, double x1, double y1)
{
    const double from[2] = {x0, y0};
    const double to[2] = {x1, y1};
    struct planar c;

    TEST_ASSERT_TRUE(takt_planar_set_line(&c, from, to));
    return c;
}

/* About (0, 0), radius 10, between two angles in degrees. */
static struct planar arc(double from_deg, double to_deg, double sense, unsigned turns)
{
    const double rad = MATHS_PI / 180.0;
    const double from[2] = {10.0 * takt_maths_cos(from_deg * rad),
                            10.0 * takt_maths_sin(from_deg * rad)};
    const double to[2] = {10.0 * takt_maths_cos(to_deg * rad), 10.0 * takt_maths_sin(to_deg * rad)};
    const double centre[2] = {0.0, 0.0};
    struct planar c;

    takt_planar_set_arc(&c, from, to, centre, sense, turns);
    return c;
}

static void expect_point(const double point[2], double x, double y)
{
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, x, point[0]);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, y, point[1]);
}

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_a_line_moves_to_its_left(void)
{
    const struct planar c = line(0.0, 0.0, 10.0, 0.0);
    struct planar moved;
    double lack;

    TEST_ASSERT_TRUE(takt_planar_offset(&c, 3.0, &moved, &lack));
    expect_point(moved.from, 0.0, 3.0);
    expect_point(moved.to, 10.0, 3.0);
}

static void test_left_of_a_counter_clockwise_arc_is_inside(void)
{
    const struct planar c = arc(0.0, 90.0, 1.0, 1);
    struct planar moved;
    double lack;

    TEST_ASSERT_TRUE(takt_planar_offset(&c, 3.0, &moved, &lack));
    expect_point(moved.from, 7.0, 0.0);
    expect_point(moved.to, 0.0, 7.0);
    TEST_ASSERT_TRUE(takt_planar_offset(&c, -3.0, &moved, &lack));
    expect_point(moved.from, 13.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 13.0 * MATHS_HALF_PI, takt_planar_length(&moved));
}

static void test_an_arc_smaller_than_the_tool_lacks_the_difference(void)
{
    const struct planar c = arc(0.0, -90.0, -1.0, 1);
    struct planar moved;
    double lack = 0.0;

    TEST_ASSERT_FALSE(takt_planar_offset(&c, -12.5, &moved, &lack));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 2.5, lack);
    TEST_ASSERT_FALSE(takt_planar_offset(&c, -10.0, &moved, &lack));
}

static void test_sweeps_count_turns(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, MATHS_HALF_PI, arc(0.0, 90.0, 1.0, 1).sweep_rad);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 3.0 * MATHS_HALF_PI, arc(0.0, 90.0, -1.0, 1).sweep_rad);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, MATHS_TWO_PI, arc(30.0, 30.0, 1.0, 1).sweep_rad);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 3.0 * MATHS_TWO_PI, arc(30.0, 30.0, -1.0, 3).sweep_rad);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, MATHS_TWO_PI + MATHS_HALF_PI, arc(0.0, 90.0, 1.0, 2).sweep_rad);
}

static void test_tangents_and_bends(void)
{
    const struct planar c = arc(0.0, 90.0, -1.0, 1);
    double tangent[2];

    takt_planar_tangent_from(&c, tangent);
    expect_point(tangent, 0.0, -1.0);
    takt_planar_tangent_to(&c, tangent);
    expect_point(tangent, 1.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, -0.1, takt_planar_curvature_to(&c));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, -0.1, takt_planar_curvature_from(&c));
}

static void test_two_lines_cross_once_and_parallels_never(void)
{
    const struct planar a = line(0.0, 0.0, 1.0, 0.0);
    const struct planar b = line(5.0, -1.0, 5.0, 4.0);
    const struct planar c = line(0.0, 1.0, 1.0, 1.0);
    double points[2][2];

    TEST_ASSERT_EQUAL_UINT(1, takt_planar_cross(&a, &b, points));
    expect_point(points[0], 5.0, 0.0);
    TEST_ASSERT_EQUAL_UINT(0, takt_planar_cross(&a, &c, points));
}

static void test_a_line_crosses_touches_or_misses_a_circle(void)
{
    const struct planar circle = arc(0.0, 0.0, 1.0, 1);
    const struct planar through = line(0.0, 6.0, 1.0, 6.0);
    const struct planar touching = line(-3.0, 10.0, 1.0, 10.0);
    const struct planar beside = line(-3.0, 10.001, 1.0, 10.001);
    double points[2][2];

    TEST_ASSERT_EQUAL_UINT(2, takt_planar_cross(&through, &circle, points));
    expect_point(points[0], -8.0, 6.0);
    expect_point(points[1], 8.0, 6.0);
    TEST_ASSERT_EQUAL_UINT(1, takt_planar_cross(&circle, &touching, points));
    expect_point(points[0], 0.0, 10.0);
    TEST_ASSERT_EQUAL_UINT(0, takt_planar_cross(&circle, &beside, points));
}

static void test_circles_cross_touch_or_miss(void)
{
    const struct planar a = arc(0.0, 0.0, 1.0, 1);
    struct planar b = a;
    double points[2][2];

    b.centre[0] = 12.0;
    TEST_ASSERT_EQUAL_UINT(2, takt_planar_cross(&a, &b, points));
    expect_point(points[0], 6.0, -8.0);
    expect_point(points[1], 6.0, 8.0);
    b.centre[0] = 20.0;
    TEST_ASSERT_EQUAL_UINT(1, takt_planar_cross(&a, &b, points));
    expect_point(points[0], 10.0, 0.0);
    b.centre[0] = 6.0;
    b.radius_from = 4.0;
    TEST_ASSERT_EQUAL_UINT(1, takt_planar_cross(&a, &b, points));
    expect_point(points[0], 10.0, 0.0);
    b.centre[0] = 21.0;
    b.radius_from = 10.0;
    TEST_ASSERT_EQUAL_UINT(0, takt_planar_cross(&a, &b, points));
    TEST_ASSERT_EQUAL_UINT(0, takt_planar_cross(&a, &a, points));
}

static void test_places_on_an_arc_are_lengths_from_its_start(void)
{
    const struct planar c = arc(0.0, 90.0, 1.0, 1);
    const double middle[2] = {10.0 * maths_sqrt(0.5), 10.0 * maths_sqrt(0.5)};
    const double before[2] = {10.0 * takt_maths_cos(0.1), -10.0 * takt_maths_sin(0.1)};

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.5 * MATHS_PI, takt_planar_place(&c, middle));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -1.0, takt_planar_place(&c, before));
}

static void test_the_ends_of_a_full_circle_are_told_apart(void)
{
    const struct planar c = arc(0.0, 0.0, 1.0, 2);
    const double end[2] = {10.0, 0.0};

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, takt_planar_place_near_from(&c, end));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 40.0 * MATHS_PI, takt_planar_place_near_to(&c, end));
}

static void test_a_cut_arc_is_shorter_by_what_was_cut(void)
{
    struct planar c = arc(0.0, 90.0, 1.0, 1);
    const double begin[2] = {10.0 * takt_maths_cos(0.2), 10.0 * takt_maths_sin(0.2)};
    const double end[2] = {10.0 * takt_maths_cos(1.2), 10.0 * takt_maths_sin(1.2)};

    takt_planar_end_at(&c, 12.0, end);
    takt_planar_begin_at(&c, 2.0, begin);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 1.0, c.sweep_rad);
    expect_point(c.from, begin[0], begin[1]);
    expect_point(c.to, end[0], end[1]);
}

static void test_distances_between_ways(void)
{
    const struct planar half = arc(0.0, 180.0, 1.0, 1);
    const struct planar above = line(-20.0, 15.0, 20.0, 15.0);
    const struct planar below = line(-20.0, -4.0, 20.0, -4.0);
    const struct planar through = line(-20.0, 5.0, 20.0, 5.0);
    struct planar beside = half;
    const double inside[2] = {0.0, 1.0};

    beside.centre[0] = beside.from[0] = 25.0;
    beside.from[0] = 35.0;
    beside.to[0] = 15.0;
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 5.0, takt_planar_distance(&half, &above));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 4.0, takt_planar_distance(&below, &half));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 0.0, takt_planar_distance(&through, &half));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 5.0, takt_planar_distance(&half, &beside));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 9.0, takt_planar_distance_point(&half, inside));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR, 5.0, takt_planar_distance_point(&below, inside));
}

/*
 * Of the circle with radius 1 about (x, 0), between two unrolled angles, with its string along
 * Y = 1 at a third one.
 */
static struct planar involute(double x, int8_t hand, double from, double to, double along)
{
    struct planar c = {.centre = {x, 0.0}, .base_mm = 1.0, .involute = true, .hand = hand};
    double *const end[2] = {c.from, c.to};
    const double phi[2] = {from, to};

    c.heading_rad = MATHS_HALF_PI - hand * along;
    c.unrolled_from = from;
    c.unrolled_to = to;
    for (unsigned i = 0; i < 2; i++) {
        const double t = c.heading_rad + hand * phi[i];

        end[i][0] = x + takt_maths_cos(t) + hand * phi[i] * takt_maths_sin(t);
        end[i][1] = takt_maths_sin(t) - hand * phi[i] * takt_maths_cos(t);
    }
    return c;
}

/* Strings of 3 and 4 mm from (0, 1) and (10, 1) towards each other leave 3 mm. */
static void test_two_involutes_are_nearest_on_the_tangent_of_both_base_circles(void)
{
    const struct planar a = involute(0.0, 1, 2.0, 4.0, 3.0);
    const struct planar b = involute(10.0, -1, 3.0, 5.0, 4.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.0, takt_planar_distance(&a, &b));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.0, takt_planar_distance(&b, &a));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_line_moves_to_its_left);
    RUN_TEST(test_left_of_a_counter_clockwise_arc_is_inside);
    RUN_TEST(test_an_arc_smaller_than_the_tool_lacks_the_difference);
    RUN_TEST(test_sweeps_count_turns);
    RUN_TEST(test_tangents_and_bends);
    RUN_TEST(test_two_lines_cross_once_and_parallels_never);
    RUN_TEST(test_a_line_crosses_touches_or_misses_a_circle);
    RUN_TEST(test_circles_cross_touch_or_miss);
    RUN_TEST(test_places_on_an_arc_are_lengths_from_its_start);
    RUN_TEST(test_the_ends_of_a_full_circle_are_told_apart);
    RUN_TEST(test_a_cut_arc_is_shorter_by_what_was_cut);
    RUN_TEST(test_distances_between_ways);
    RUN_TEST(test_two_involutes_are_nearest_on_the_tangent_of_both_base_circles);
    return UNITY_END();
}
