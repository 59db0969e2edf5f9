#include "smooth/merge.h"
#include "unity.h"

#include <string.h>

static struct merge merge;
static struct point at;

void setUp(void)
{
    memset(&merge, 0, sizeof merge);
    memset(&at, 0, sizeof at);
}

void tearDown(void)
{
}

/* A line of feed 100 mm/s to x, y. True: it has become part of the one before. */
static bool line_to(double x, double y, double within_mm)
{
    struct move move = {.kind = MOVE_FEED, .feed_mm_s = 100.0};
    struct curve curve;
    bool taken;

    move.end.at[AXIS_X] = x;
    move.end.at[AXIS_Y] = y;
    TEST_ASSERT_TRUE(takt_curve_set_line(&curve, &at, &move.end));
    at = move.end;
    taken = takt_merge_take(&merge, &move, 1, &curve, within_mm);
    if (!taken) {
        takt_merge_open(&merge, &move, 1, &curve);
    }
    return taken;
}

static void test_lines_in_one_direction_become_one(void)
{
    TEST_ASSERT_FALSE(line_to(1, 0, 0.001));
    TEST_ASSERT_TRUE(line_to(2, 0, 0.001));
    TEST_ASSERT_TRUE(line_to(3, 0.0005, 0.001));
    TEST_ASSERT_EQUAL_DOUBLE(0, merge.curve.start.at[AXIS_X]);
    TEST_ASSERT_EQUAL_DOUBLE(3, merge.curve.end.at[AXIS_X]);
}

static void test_an_end_that_would_be_left_too_far_aside_ends_the_line(void)
{
    (void)line_to(1, 0, 0.001);
    TEST_ASSERT_FALSE(line_to(2, 0.01, 0.001));
    TEST_ASSERT_EQUAL_DOUBLE(1, merge.curve.start.at[AXIS_X]);
}

static void test_a_way_back_is_never_merged(void)
{
    (void)line_to(1, 0, 0.001);
    TEST_ASSERT_FALSE(line_to(0.5, 0, 0.001));
}

static void test_a_curve_of_chords_keeps_every_programmed_end_within_the_bound(void)
{
    unsigned merged = 0;

    (void)line_to(0.1, 0.0005, 0.0002);
    for (int k = 2; k <= 30; k++) {
        merged += line_to(0.1 * k, 0.0005 * k * k, 0.0002) ? 1U : 0U;
        TEST_ASSERT_TRUE(merge.lines <= MERGE_POINTS_MAX + 1);
    }
    TEST_ASSERT_EQUAL_UINT(0, merged); /* a step aside of 0.0005 from chord to chord is too much */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lines_in_one_direction_become_one);
    RUN_TEST(test_an_end_that_would_be_left_too_far_aside_ends_the_line);
    RUN_TEST(test_a_way_back_is_never_merged);
    RUN_TEST(test_a_curve_of_chords_keeps_every_programmed_end_within_the_bound);
    return UNITY_END();
}
