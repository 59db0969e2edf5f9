/* The ring of blocks: room, positions, junctions, waits, restart. */
#include "plan/path.h"

#include "plan/path_unit.h"

#include <string.h>
#include <unity.h>

static const struct plan_limits limits = {
    7,    {100, 100, 100},   {1000, 1000, 1000}, {50000, 50000, 50000}, 1e-3,
    1e-3, RAMP_PROFILE_JERK, LANDING_SPAN};

static struct path path;

void setUp(void)
{
    const struct point start = {{0}};

    takt_path_init(&path, &limits, &start);
}

void tearDown(void)
{
}

static void push(enum move_kind kind, double x, double y)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = kind;
    m.feed_mm_s = 50.0;
    m.turns = 1;
    m.end.at[AXIS_X] = x;
    m.end.at[AXIS_Y] = y;
    takt_path_push(&path, &m);
}

static void test_blocks_lie_end_to_end(void)
{
    push(MOVE_FEED, 10.0, 0.0);
    push(MOVE_FEED, 10.0, 5.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(2, path.closed);
    TEST_ASSERT_EQUAL_UINT64(path_units(10.0), path_at(&path, 1)->start);
    TEST_ASSERT_EQUAL_UINT64(path_units(15.0), path.position);
}

static void test_a_block_is_closed_when_its_end_is_known(void)
{
    push(MOVE_FEED, 10.0, 0.0);
    TEST_ASSERT_EQUAL(0, path.closed);
    push(MOVE_FEED, 20.0, 0.0);
    TEST_ASSERT_EQUAL(1, path.closed);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(2, path.closed);
}

static void test_a_straight_junction_is_passed_and_a_corner_is_a_stop(void)
{
    push(MOVE_FEED, 10.0, 0.0);
    push(MOVE_FEED, 20.0, 0.0);
    push(MOVE_FEED, 20.0, 10.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(JUNCTION_PASSED, path_at(&path, 0)->end);
    TEST_ASSERT_EQUAL(JUNCTION_STOP, path_at(&path, 1)->end);
    TEST_ASSERT_EQUAL(JUNCTION_STOP, path_at(&path, 2)->end);
}

static void test_a_wait_stops_the_block_before_it(void)
{
    push(MOVE_FEED, 10.0, 0.0);
    push(MOVE_DWELL, 0.0, 0.0);
    push(MOVE_FEED, 20.0, 0.0);
    TEST_ASSERT_EQUAL(2, path.closed);
    TEST_ASSERT_EQUAL(JUNCTION_STOP, path_at(&path, 0)->end);
    TEST_ASSERT_EQUAL_UINT64(0, path_end(&path, 1) - path_at(&path, 1)->start);
    TEST_ASSERT_EQUAL(1, path_read(&path, 1)->number);
}

static void test_a_motion_without_length_is_counted_and_dropped(void)
{
    push(MOVE_FEED, 10.0, 0.0);
    push(MOVE_FEED, 10.0, 0.0);
    push(MOVE_FEED, 20.0, 0.0);
    TEST_ASSERT_EQUAL(2, path.pushed);
    TEST_ASSERT_EQUAL(3, path_read(&path, 1)->number);
}

/* What the cycle has passed may be overwritten only when the background has been told so. */
static void test_room_is_bounded_by_what_must_be_kept(void)
{
    double x = 0.0;

    while (takt_path_has_room(&path)) {
        x += 1.0;
        push(MOVE_FEED, x, 0.0);
    }
    TEST_ASSERT_EQUAL(PATH_BLOCKS_MAX - RECORD_BEFORE, path.pushed);
    takt_path_pass(&path);
    TEST_ASSERT_FALSE(takt_path_has_room(&path));
    path.kept = path.first;
    TEST_ASSERT_TRUE(takt_path_has_room(&path));
}

static void test_a_restart_forgets_all_blocks(void)
{
    const struct point at = {{3.0}};

    push(MOVE_FEED, 10.0, 0.0);
    push(MOVE_FEED, 20.0, 0.0);
    takt_path_restart(&path, &at, path_units(3.0));
    TEST_ASSERT_EQUAL(path.pushed, path.first);
    push(MOVE_FEED, 4.0, 0.0);
    takt_path_finish(&path);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, takt_path_length(&path, path.first));
    TEST_ASSERT_EQUAL_UINT64(path_units(3.0), path_at(&path, path.first)->start);
}

static void push_blend(double x, double y)
{
    const struct move line = {.kind = MOVE_FEED,
                              .path = PATH_BLEND,
                              .tolerance_mm = 0.01,
                              .feed_mm_s = 50.0,
                              .turns = 1,
                              .end = {{x, y}}};

    takt_path_push(&path, &line);
}

/* Both ceilings are in use: what smoothing would compute in is one of them. */
static void test_motions_are_smoothed_as_soon_as_there_is_a_place_for_it(void)
{
    path.spare = PATH_NO_SPARE;
    push_blend(10.0, 0.0);
    push_blend(10.0, 10.0);
    takt_path_finish(&path);
    takt_path_go_on(&path);
    TEST_ASSERT_EQUAL(0, path.pushed);
    path.spare = 1;
    takt_path_go_on(&path);
    TEST_ASSERT_GREATER_THAN(1, path.pushed);
    TEST_ASSERT_EQUAL(path.pushed, path.closed);
}

/*
 * Smoothed, it would be a curve of many pieces, slower than the line; before and behind it the axes
 * stand.
 */
static void test_one_line_within_a_tolerance_is_planned_like_an_exact_one(void)
{
    path.spare = 1;
    push(MOVE_FEED, 10.0, 0.0);
    push_blend(20.0, 0.0);
    push(MOVE_FEED, 30.0, 0.0);
    TEST_ASSERT_EQUAL(3, path.pushed);
    TEST_ASSERT_EQUAL(2, path.closed);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(3, path.pushed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, takt_path_length(&path, 1));
}

/* The motions without length are known before the line is pushed, and counted. */
static void test_one_line_has_its_number_whatever_has_no_length_behind_it(void)
{
    path.spare = 1;
    push_blend(20.0, 0.0);
    push_blend(20.0, 0.0);
    push_blend(20.0, 0.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(1, path.pushed);
    TEST_ASSERT_EQUAL_UINT32(1, path_read(&path, 0)->number);
    TEST_ASSERT_EQUAL_UINT32(3, path.motions);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_blocks_lie_end_to_end);
    RUN_TEST(test_a_block_is_closed_when_its_end_is_known);
    RUN_TEST(test_a_straight_junction_is_passed_and_a_corner_is_a_stop);
    RUN_TEST(test_a_wait_stops_the_block_before_it);
    RUN_TEST(test_a_motion_without_length_is_counted_and_dropped);
    RUN_TEST(test_room_is_bounded_by_what_must_be_kept);
    RUN_TEST(test_a_restart_forgets_all_blocks);
    RUN_TEST(test_motions_are_smoothed_as_soon_as_there_is_a_place_for_it);
    RUN_TEST(test_one_line_within_a_tolerance_is_planned_like_an_exact_one);
    RUN_TEST(test_one_line_has_its_number_whatever_has_no_length_behind_it);
    return UNITY_END();
}
