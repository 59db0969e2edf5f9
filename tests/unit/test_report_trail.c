#include "report/trail.h"

#include "base/maths.h"
#include "unity.h"

#include <stdlib.h>

static struct trail trail;

void setUp(void)
{
    TEST_ASSERT_TRUE(trail_open(&trail, 500.0));
}

void tearDown(void)
{
    trail_close(&trail);
}

static struct trail_point point_at(uint32_t cycle, double x, double y, double z)
{
    return (struct trail_point){.at_mm = {x, y, z}, .feed_mm_s = 20.0, .cycle = cycle, .line = 1};
}

static void add(struct trail_point point)
{
    trail_add(&trail, &point);
}

/* Distance of p from the way between two kept points. */
static double distance_from_way(const double *p, const double *a, const double *b)
{
    double length2 = 0.0;
    double along = 0.0;
    for (int i = 0; i < 3; i++) {
        length2 += (b[i] - a[i]) * (b[i] - a[i]);
        along += (p[i] - a[i]) * (b[i] - a[i]);
    }
    const double share = length2 > 0.0 ? maths_clamp(along / length2, 0.0, 1.0) : 0.0;
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        const double off = p[i] - a[i] - share * (b[i] - a[i]);
        sum += off * off;
    }
    return maths_sqrt(sum);
}

/* Largest distance of the points added from the way drawn over their cycle. */
static double largest_distance(const struct trail_point *added, uint32_t count)
{
    double largest = 0.0;
    uint32_t k = 1;
    for (uint32_t i = 0; i < count; i++) {
        while (k + 1 < trail.count && trail.kept[k].cycle < added[i].cycle)
            k++;
        const double distance =
            distance_from_way(added[i].at_mm, trail.kept[k - 1].at_mm, trail.kept[k].at_mm);
        largest = maths_max(largest, distance);
    }
    return largest;
}

static void test_a_straight_way_needs_its_ends_alone(void)
{
    for (uint32_t k = 0; k <= 1000; k++)
        add(point_at(k, 0.02 * k, 0.01 * k, 0.0));
    trail_finish(&trail);
    TEST_ASSERT_EQUAL_UINT32(2, trail.count);
    TEST_ASSERT_EQUAL_UINT32(1000, trail.kept[1].cycle);
}

static void test_a_way_back_along_the_same_line_keeps_the_turn(void)
{
    for (uint32_t k = 0; k <= 200; k++)
        add(point_at(k, 5.0, 5.0, k <= 100 ? -0.1 * k : -0.1 * (200 - k)));
    trail_finish(&trail);
    TEST_ASSERT_EQUAL_UINT32(3, trail.count);
    TEST_ASSERT_EQUAL_UINT32(100, trail.kept[1].cycle);
}

static void test_a_corner_is_kept(void)
{
    for (uint32_t k = 0; k <= 200; k++)
        add(point_at(k, k < 100 ? 0.1 * k : 10.0, k < 100 ? 0.0 : 0.1 * (k - 100), 0.0));
    trail_finish(&trail);
    TEST_ASSERT_EQUAL_UINT32(3, trail.count);
    TEST_ASSERT_EQUAL_UINT32(100, trail.kept[1].cycle);
}

static void test_rapid_and_feed_on_one_line_stay_apart(void)
{
    for (uint32_t k = 0; k <= 100; k++) {
        struct trail_point point = point_at(k, 0.1 * k, 0.0, 0.0);
        point.rapid = k > 40;
        add(point);
    }
    trail_finish(&trail);
    TEST_ASSERT_EQUAL_UINT32(3, trail.count);
    TEST_ASSERT_EQUAL_UINT32(40, trail.kept[1].cycle);
    TEST_ASSERT_FALSE(trail.kept[1].rapid);
    TEST_ASSERT_TRUE(trail.kept[2].rapid);
}

static void test_a_change_of_feed_or_line_is_kept(void)
{
    for (uint32_t k = 0; k <= 100; k++) {
        struct trail_point point = point_at(k, 0.1 * k, 0.0, 0.0);
        point.feed_mm_s = k > 30 ? 40.0 : 20.0;
        point.line = k > 70 ? 2 : 1;
        add(point);
    }
    trail_finish(&trail);
    TEST_ASSERT_EQUAL_UINT32(5, trail.count);
    TEST_ASSERT_EQUAL_UINT32(30, trail.kept[1].cycle);
    TEST_ASSERT_EQUAL_UINT32(31, trail.kept[2].cycle);
    TEST_ASSERT_EQUAL_UINT32(70, trail.kept[3].cycle);
    TEST_ASSERT_EQUAL_UINT32(2, trail.kept[4].line);
}

/* A rising flower: bends everywhere, never twice the same. */
static struct trail_point flower(uint32_t k)
{
    const double angle = 0.003 * k;
    const double radius = 40.0 + 25.0 * takt_maths_sin(7.1 * angle);
    return point_at(k, radius * takt_maths_cos(angle), radius * takt_maths_sin(angle), 0.0001 * k);
}

static void test_no_point_is_farther_from_the_trail_than_stated(void)
{
    const uint32_t counts[] = {1000, 100000, 1000000};
    const double errors_mm[] = {0.003, 0.1,
                                6.0}; /* thinning may not be coarser than it has to be */
    struct trail_point *added = malloc(counts[2] * sizeof *added);
    TEST_ASSERT_NOT_NULL(added);
    for (uint32_t i = 0; i < 3; i++) {
        tearDown();
        setUp();
        for (uint32_t k = 0; k < counts[i]; k++) {
            added[k] = flower(k);
            trail_add(&trail, &added[k]);
        }
        trail_finish(&trail);
        TEST_ASSERT_LESS_OR_EQUAL_UINT32(TRAIL_POINTS_MAX, trail.count);
        TEST_ASSERT_EQUAL_UINT32(counts[i] - 1, trail.kept[trail.count - 1].cycle);
        TEST_ASSERT_TRUE(largest_distance(added, counts[i]) <= trail_get_error_mm(&trail));
        TEST_ASSERT_TRUE(trail_get_error_mm(&trail) <= errors_mm[i]);
    }
    free(added);
}

static void test_a_path_that_changes_every_cycle_is_thinned_too(void)
{
    for (uint32_t k = 0; k < 1000000; k++) {
        struct trail_point point = point_at(k, k % 2, (k / 2) % 2, (k / 4) % 2);
        point.rapid = k % 3 == 0;
        point.line = k;
        point.feed_mm_s = 1.0 + k % 7;
        add(point);
        TEST_ASSERT_TRUE(trail.count < TRAIL_POINTS_MAX);
    }
    TEST_ASSERT_TRUE(trail.count > 0);
}

static void test_a_path_that_stands_is_one_point(void)
{
    for (uint32_t k = 0; k < 100; k++)
        add(point_at(k, 1.0, 2.0, 3.0));
    TEST_ASSERT_EQUAL_UINT32(1, trail.count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_straight_way_needs_its_ends_alone);
    RUN_TEST(test_a_way_back_along_the_same_line_keeps_the_turn);
    RUN_TEST(test_a_corner_is_kept);
    RUN_TEST(test_rapid_and_feed_on_one_line_stay_apart);
    RUN_TEST(test_a_change_of_feed_or_line_is_kept);
    RUN_TEST(test_no_point_is_farther_from_the_trail_than_stated);
    RUN_TEST(test_a_path_that_changes_every_cycle_is_thinned_too);
    RUN_TEST(test_a_path_that_stands_is_one_point);
    return UNITY_END();
}
