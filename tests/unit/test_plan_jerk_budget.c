/* What blocks leave of the jerk limit to the junctions near them, and when they are closed. */
#include "plan/path.h"

#include "base/maths.h"
#include "plan/junction.h"

#include <string.h>
#include <unity.h>

/* At 100 mm/s a cycle's way is 0.1 mm. */
static const struct plan_limits limits = {
    7,    {100, 100, 100},   {1000, 1000, 1000}, {50000, 50000, 50000}, 1e-3,
    1e-3, RAMP_PROFILE_JERK, LANDING_SPAN};

/* Rounding of the shares of straight lines: that of their directions. */
#define NOTHING 1e-6

static struct path path;
static struct point at;

void setUp(void)
{
    memset(&at, 0, sizeof(at));
    takt_path_init(&path, &limits, &at);
}

void tearDown(void)
{
}

/* A line in a direction of the plane. */
static void push(double length_mm, double heading_rad, double feed_mm_s)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = feed_mm_s;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    at.at[AXIS_X] += length_mm * takt_maths_cos(heading_rad);
    at.at[AXIS_Y] += length_mm * takt_maths_sin(heading_rad);
    m.end = at;
    takt_path_push(&path, &m);
}

/* What a line among the first blocks leaves to junctions of its jerk. */
static double jerk_budget_of(uint32_t index)
{
    return 1.0 - (double)path_at(&path, index)->j_mm_s3 / path.open[index].shape.line_j_mm_s3;
}

static void test_a_straight_line_of_short_blocks_leaves_nothing(void)
{
    push(10.0, 0.3, 100.0);
    for (int i = 0; i < 20; i++) {
        push(0.05, 0.3, 100.0);
    }
    push(10.0, 0.3, 100.0);
    takt_path_finish(&path);
    for (uint32_t i = 0; i < path.pushed; i++) {
        TEST_ASSERT_TRUE(jerk_budget_of(i) < NOTHING);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 50000.0 / takt_maths_cos(0.3),
                              (double)path_at(&path, 0)->j_mm_s3);
}

/* A turn that a junction between blocks of 6 cycles and more takes half of its share for. */
static void test_a_junction_takes_what_its_turn_costs(void)
{
    const double turn_rad = 0.25 * 50000.0 * 1e-6 / 10.0; /* D v = J tau^2 / 4 at 10 mm/s */

    push(1.0, 0.0, 10.0);
    push(1.0, turn_rad, 10.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(JUNCTION_PASSED, path_at(&path, 0)->end);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.25 * BLOCK_OVERRIDE_MAX, path.open[0].jerk_budget_junction);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.25 * BLOCK_OVERRIDE_MAX, jerk_budget_of(0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.25 * BLOCK_OVERRIDE_MAX, jerk_budget_of(1));
}

/* Blocks of one cycle each at 10 mm/s; the turn is between the fifth and the sixth of them. */
static void test_a_junction_is_told_to_blocks_nearer_than_three_cycles(void)
{
    const double length_mm = 10.0 * 1e-3 * BLOCK_OVERRIDE_MAX * 1.001;
    const double turn_rad = 1e-5;

    for (int i = 0; i < 10; i++) {
        push(length_mm, i < 5 ? 0.0 : turn_rad, 10.0);
    }
    takt_path_finish(&path);
    const double jerk_budget = path.open[4].jerk_budget_junction;

    TEST_ASSERT_TRUE(jerk_budget > 1e-4);
    for (uint32_t i = 0; i < 10; i++) {
        const double expected = i >= 2 && i < 8 ? jerk_budget : 0.0;

        TEST_ASSERT_DOUBLE_WITHIN(NOTHING, expected, jerk_budget_of(i));
    }
}

static void test_a_block_is_closed_when_three_cycles_are_known_behind_it(void)
{
    push(10.0, 0.0, 100.0);
    push(0.101, 0.0, 100.0);
    push(0.101, 0.0, 100.0);
    TEST_ASSERT_EQUAL(0, path.closed);
    push(0.101, 0.0, 100.0);
    TEST_ASSERT_EQUAL(1, path.closed);
    push(10.0, 0.0, 100.0);
    TEST_ASSERT_EQUAL(4, path.closed);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(5, path.closed);
}

static void test_a_block_counts_as_leaving_the_largest_share_until_it_is_closed(void)
{
    push(10.0, 0.0, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(NOTHING, BLOCK_JERK_BUDGET_MAX, jerk_budget_of(0));
    push(10.0, 0.0, 100.0);
    TEST_ASSERT_TRUE(jerk_budget_of(0) < NOTHING);
    TEST_ASSERT_DOUBLE_WITHIN(NOTHING, BLOCK_JERK_BUDGET_MAX, jerk_budget_of(1));
}

static void test_a_stop_closes_what_is_before_it(void)
{
    push(0.1, 0.0, 100.0);
    push(0.1, 0.0, 100.0);
    push(0.1, 1.5, 100.0);
    TEST_ASSERT_EQUAL(JUNCTION_STOP, path_at(&path, 1)->end);
    TEST_ASSERT_EQUAL(2, path.closed);
    TEST_ASSERT_TRUE(jerk_budget_of(1) < NOTHING);
}

/*
 * To slow down to a tenth of the feed and leave half of the jerk costs more than to stop with all
 * of it.
 */
static void test_a_turn_that_costs_more_than_a_stop_is_stopped_at(void)
{
    const double half_rad =
        0.5 * 50000.0 * 1e-6; /* of a turn that takes half of the jerk at 1 mm/s */

    push(10.0, 0.0, 100.0);
    push(10.0, half_rad / 10.0, 100.0);
    push(10.0, half_rad / 10.0 + half_rad / 50.0, 100.0);
    push(10.0, half_rad / 10.0 + half_rad / 50.0, 100.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(JUNCTION_STOP, path_at(&path, 0)->end);
    TEST_ASSERT_EQUAL(JUNCTION_REDUCED, path_at(&path, 1)->end);
    TEST_ASSERT_EQUAL(JUNCTION_PASSED, path_at(&path, 2)->end);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 50.0, (double)path_at(&path, 1)->feed_junction_mm_s);
}

/* To land there would cost every feed up to 100 % what an override above that may ask for. */
static void test_a_turn_that_is_fast_enough_for_the_programmed_feed_is_not_landed_on(void)
{
    const double half_rad = 0.5 * 50000.0 * 1e-6;

    push(10.0, 0.0, 80.0);
    push(10.0, half_rad / 90.0, 80.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(JUNCTION_PASSED, path_at(&path, 0)->end);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 90.0, takt_path_block_top(path_at(&path, 0)));
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 96.0, takt_path_block_top(path_at(&path, 1)));
}

/* It is too short for more than the junction's feed and to land again. */
static void test_a_short_block_is_gone_along_at_the_feed_of_the_turn_beside_it(void)
{
    const double half_rad = 0.5 * 50000.0 * 1e-6;

    push(10.0, 0.0, 100.0);
    push(0.5, half_rad / 50.0, 100.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(JUNCTION_PASSED, path_at(&path, 0)->end);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 50.0, takt_path_block_top(path_at(&path, 1)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_straight_line_of_short_blocks_leaves_nothing);
    RUN_TEST(test_a_junction_takes_what_its_turn_costs);
    RUN_TEST(test_a_junction_is_told_to_blocks_nearer_than_three_cycles);
    RUN_TEST(test_a_block_is_closed_when_three_cycles_are_known_behind_it);
    RUN_TEST(test_a_block_counts_as_leaving_the_largest_share_until_it_is_closed);
    RUN_TEST(test_a_stop_closes_what_is_before_it);
    RUN_TEST(test_a_turn_that_costs_more_than_a_stop_is_stopped_at);
    RUN_TEST(test_a_turn_that_is_fast_enough_for_the_programmed_feed_is_not_landed_on);
    RUN_TEST(test_a_short_block_is_gone_along_at_the_feed_of_the_turn_beside_it);
    return UNITY_END();
}
