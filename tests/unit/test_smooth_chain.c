/* Which motions a chain takes in: one interval serves all of it. */
#include "smooth/smooth.h"

#include <string.h>
#include <unity.h>

#define TOLERANCE_MM 0.01

/* Z takes twenty times as long to its velocity as the others. */
static const struct smooth_limits mill = {
    .axes = 7,
    .velocity_mm_s = {100.0, 100.0, 100.0},
    .acceleration_mm_s2 = {1000.0, 1000.0, 50.0},
    .jerk_mm_s3 = {50000.0, 50000.0, 2500.0},
    .chord_error_max_mm = 1e-3,
    .cycle_s = 1e-3,
    .windows = 1.0,
};

static struct smooth smooth;
static union smooth_scratch scratch;
static struct point at;
static struct move move;
static struct curve curve;

void setUp(void)
{
    takt_smooth_init(&smooth, &mill);
    memset(&at, 0, sizeof at);
}

void tearDown(void)
{
}

static void take_all(void)
{
    struct smooth_piece piece;
    struct curve taken;

    while (takt_smooth_take(&smooth, &scratch, &piece, &taken) != SMOOTH_NONE) {
    }
}

/* By so much from where the last one pushed has come to. */
static void set_line(enum axis axis, double by_mm)
{
    move = (struct move){.kind = MOVE_FEED,
                         .path = PATH_BLEND,
                         .feed_mm_s = 100.0,
                         .tolerance_mm = TOLERANCE_MM,
                         .end = at};
    move.end.at[axis] += by_mm;
    TEST_ASSERT_TRUE(takt_curve_set_line(&curve, &at, &move.end));
}

static bool joins(enum axis axis)
{
    set_line(axis, 1.0);
    return takt_smooth_joins(&smooth, &move, &curve);
}

static void push(enum axis axis, double by_mm)
{
    set_line(axis, by_mm);
    while (!takt_smooth_has_room(&smooth)) {
        take_all();
    }
    takt_smooth_push(&smooth, &move, 1, &curve);
    take_all();
    at = move.end;
}

/* So far that pieces come, and all that can be known is. */
static void go_around_by(double side_mm)
{
    for (unsigned i = 0; i < 40; i++) {
        push(AXIS_X, side_mm);
        push(AXIS_Y, side_mm);
        push(AXIS_X, -side_mm);
        push(AXIS_Y, -side_mm);
    }
}

static void go_around(void)
{
    go_around_by(10.0);
}

static void end_chain(void)
{
    takt_smooth_finish(&smooth);
    take_all();
    TEST_ASSERT_FALSE(smooth_is_open(&smooth));
}

static void test_an_axis_that_needs_a_longer_interval_does_not_join_a_chain_that_has_begun(void)
{
    go_around();
    TEST_ASSERT_FALSE(joins(AXIS_Z));
    TEST_ASSERT_TRUE(joins(AXIS_X));
}

static void test_axes_that_are_known_before_the_first_piece_share_one_chain(void)
{
    push(AXIS_X, 1.0);
    TEST_ASSERT_TRUE(joins(AXIS_Z));
    push(AXIS_Z, 1.0);
    go_around();
    TEST_ASSERT_TRUE(joins(AXIS_Z));
}

/* Of what comes behind a curve might be found that is quicker, or slower. */
static void test_nothing_is_taken_before_all_is_known_that_can_be(void)
{
    struct smooth_piece piece;
    struct curve taken;

    while (takt_smooth_has_room(&smooth)) {
        TEST_ASSERT_EQUAL(SMOOTH_NONE, takt_smooth_take(&smooth, &scratch, &piece, &taken));
        set_line(smooth.merge.number % 2 == 0 ? AXIS_X : AXIS_Y, 10.0);
        takt_smooth_push(&smooth, &move, smooth.merge.number + 1, &curve);
        at = move.end;
    }
    TEST_ASSERT_EQUAL(SMOOTH_PIECE, takt_smooth_take(&smooth, &scratch, &piece, &taken));
}

/* Half a circle. */
static void set_arc(enum move_kind kind, enum plane plane)
{
    enum axis first;
    enum axis second;

    takt_plane_axes(plane, &first, &second);
    set_line(first, 2.0);
    move.kind = kind;
    move.plane = plane;
    move.turns = 1;
    move.centre_mm[0] = at.at[first] + 1.0;
    move.centre_mm[1] = at.at[second];
    TEST_ASSERT_TRUE(takt_move_curve(&move, &at, &curve));
}

static void push_next(void)
{
    TEST_ASSERT_TRUE(takt_smooth_has_room(&smooth));
    takt_smooth_push(&smooth, &move, smooth.merge.number + 1, &curve);
    at = move.end;
}

/* Each was kept like a change of the tool, and the fifth was waited for. */
static void test_planes_and_senses_of_arcs_and_rapids_are_no_end_of_what_can_be_known(void)
{
    static const enum plane planes[] = {PLANE_XY, PLANE_ZX, PLANE_YZ};

    for (unsigned i = 0; i < 3; i++) {
        set_arc(MOVE_ARC_CW, planes[i]);
        push_next();
        set_arc(MOVE_ARC_CCW, planes[i]);
        push_next();
        set_line(AXIS_X, 10.0);
        move.kind = i == 1 ? MOVE_RAPID : MOVE_FEED;
        push_next();
    }
    take_all();
    TEST_ASSERT_EQUAL_UINT(0, smooth.route.first);
    TEST_ASSERT_TRUE(takt_smooth_has_room(&smooth));
}

/* An arc is one of its plane and sense, a line a rapid or not, whatever the others are. */
static void test_a_motion_is_told_as_it_was_pushed(void)
{
    struct move told;

    set_line(AXIS_X, 10.0);
    move.kind = MOVE_RAPID;
    push_next();
    set_arc(MOVE_ARC_CCW, PLANE_ZX);
    push_next();
    set_line(AXIS_Y, 10.0);
    push_next();
    takt_smooth_finish(&smooth);
    takt_route_move(&smooth.route, 0, &told);
    TEST_ASSERT_EQUAL(MOVE_RAPID, told.kind);
    TEST_ASSERT_TRUE(told.feed_mm_s == 0.0);
    takt_route_move(&smooth.route, 1, &told);
    TEST_ASSERT_EQUAL(MOVE_ARC_CCW, told.kind);
    TEST_ASSERT_EQUAL(PLANE_ZX, told.plane);
    takt_route_move(&smooth.route, 2, &told);
    TEST_ASSERT_EQUAL(MOVE_FEED, told.kind);
    TEST_ASSERT_EQUAL(PLANE_XY, told.plane);
    TEST_ASSERT_TRUE(told.feed_mm_s == 100.0);
}

/*
 * Four times as fast with the same jerk: what changes of the rate are rounded over on a short way
 * leaves it too little.
 */
static void test_an_axis_that_needs_more_jerk_for_changes_of_rate_does_not_join_a_short_chain(void)
{
    struct smooth_limits fast = mill;

    fast.velocity_mm_s[AXIS_Z] = 400.0;
    fast.acceleration_mm_s2[AXIS_Z] = 1000.0;
    fast.jerk_mm_s3[AXIS_Z] = 50000.0;
    takt_smooth_init(&smooth, &fast);
    go_around_by(0.5);
    TEST_ASSERT_FALSE(joins(AXIS_Z));
}

static void test_the_next_chain_serves_the_axes_of_both(void)
{
    go_around();
    const double before_s = smooth.window.interval_s;

    TEST_ASSERT_FALSE(joins(AXIS_Z));
    end_chain();
    go_around();
    TEST_ASSERT_TRUE(smooth.window.interval_s > 2.0 * before_s);
    TEST_ASSERT_TRUE(joins(AXIS_Z));
}

static void test_a_chain_that_ends_by_itself_leaves_no_axes_to_the_next(void)
{
    push(AXIS_X, 1.0);
    push(AXIS_Z, 1.0);
    go_around();
    end_chain();
    go_around();
    TEST_ASSERT_FALSE(joins(AXIS_Z));
}

static void test_after_a_reset_no_axes_are_expected(void)
{
    go_around();
    TEST_ASSERT_FALSE(joins(AXIS_Z));
    takt_smooth_reset(&smooth);
    go_around();
    TEST_ASSERT_FALSE(joins(AXIS_Z));
}

/* The next motion of the path itself, of which nothing is known before. */
static bool next_motion_starts(bool before)
{
    struct smooth_piece piece = {.starts = before};
    struct curve taken;

    TEST_ASSERT_EQUAL(SMOOTH_MOTION, takt_smooth_take(&smooth, &scratch, &piece, &taken));
    return piece.starts;
}

/* A line of two feeds is quickest as it is. */
static void test_the_first_motion_that_is_taken_as_programmed_begins_at_rest_and_no_other(void)
{
    for (unsigned i = 0; i < 2; i++) {
        set_line(AXIS_X, 10.0);
        move.feed_mm_s = i == 0 ? 100.0 : 50.0;
        takt_smooth_push(&smooth, &move, i, &curve);
        at = move.end;
    }
    takt_smooth_finish(&smooth);
    TEST_ASSERT_TRUE(next_motion_starts(false));
    TEST_ASSERT_FALSE(next_motion_starts(true));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_axis_that_needs_a_longer_interval_does_not_join_a_chain_that_has_begun);
    RUN_TEST(test_axes_that_are_known_before_the_first_piece_share_one_chain);
    RUN_TEST(test_nothing_is_taken_before_all_is_known_that_can_be);
    RUN_TEST(test_planes_and_senses_of_arcs_and_rapids_are_no_end_of_what_can_be_known);
    RUN_TEST(test_a_motion_is_told_as_it_was_pushed);
    RUN_TEST(test_an_axis_that_needs_more_jerk_for_changes_of_rate_does_not_join_a_short_chain);
    RUN_TEST(test_the_next_chain_serves_the_axes_of_both);
    RUN_TEST(test_a_chain_that_ends_by_itself_leaves_no_axes_to_the_next);
    RUN_TEST(test_after_a_reset_no_axes_are_expected);
    RUN_TEST(test_the_first_motion_that_is_taken_as_programmed_begins_at_rest_and_no_other);
    return UNITY_END();
}
