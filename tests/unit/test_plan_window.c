/*
 * The planner seen from outside: moves in, segments out.
 */
#include "base/maths.h"
#include "plan/window.h"

#include <string.h>
#include <unity.h>

#define CYCLE_S 1e-3

static struct window window;
static struct segment segment;
static struct point position;
static const struct plan_limits mill = {
    .axes = 7,
    .velocity_mm_s = {100, 100, 100},
    .acceleration_mm_s2 = {1000, 1000, 1000},
    .jerk_mm_s3 = {50000, 50000, 50000},
    .cycle_s = CYCLE_S,
    .chord_error_max_mm = 1e-3,
};

static void start_window(uint32_t capacity)
{
    memset(&position, 0, sizeof(position));
    window_init(&window, &mill, capacity, &position);
}

void setUp(void)
{
    start_window(WINDOW_BLOCKS_MAX);
}

void tearDown(void)
{
}

static struct move move_to(double x, double y, double feed_mm_s)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = feed_mm_s;
    m.end.at[AXIS_X] = x;
    m.end.at[AXIS_Y] = y;
    m.turns = 1;
    return m;
}

static struct move arc_to(double x, double y, double cx, double cy, bool clockwise,
                          double feed_mm_s)
{
    struct move m = move_to(x, y, feed_mm_s);

    m.kind = clockwise ? MOVE_ARC_CW : MOVE_ARC_CCW;
    m.centre_mm[0] = cx;
    m.centre_mm[1] = cy;
    return m;
}

static void push(struct move m)
{
    window_push(&window, &m);
}

static void take(void)
{
    TEST_ASSERT_TRUE(window_is_ready(&window));
    window_take(&window, &segment);
}

static void test_nothing_can_be_taken_before_the_window_is_full_or_finished(void)
{
    start_window(3);
    push(move_to(1, 0, 10));
    push(move_to(2, 0, 10));
    TEST_ASSERT_FALSE(window_is_ready(&window));
    push(move_to(3, 0, 10));
    TEST_ASSERT_TRUE(window_is_ready(&window));
    TEST_ASSERT_FALSE(window_has_room(&window));
    take();
    TEST_ASSERT_FALSE(window_is_ready(&window));
    window_finish(&window);
    TEST_ASSERT_TRUE(window_is_ready(&window));
}

static void test_a_long_move_takes_the_closed_form_time_from_rest_to_rest(void)
{
    push(move_to(200, 0, 100));
    window_finish(&window);
    take();
    /* two ramps of F/a + a/J, the rest at F */
    const double ramp = 100.0 / 1000.0 + 1000.0 / 50000.0;

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0 * ramp + (200.0 - 100.0 * ramp) / 100.0,
                              segment.profile.duration_s);
    TEST_ASSERT_EQUAL(JOINT_STOP, segment.end);
    TEST_ASSERT_EQUAL(GOVERNOR_PROGRAM, segment.governor);
}

static void test_a_short_move_is_governed_by_its_ramps(void)
{
    push(move_to(0.1, 0, 100));
    window_finish(&window);
    take();
    /* rest to rest with jerk alone: T = 4 cbrt(L / (2 J)) */
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.0 * maths_cbrt(0.1 / (2.0 * 50000.0)),
                              segment.profile.duration_s);
    TEST_ASSERT_EQUAL(GOVERNOR_RAMP, segment.governor);
}

static void test_a_diagonal_may_be_as_fast_as_both_axes_together(void)
{
    struct move m = move_to(200, 200, 0);

    m.kind = MOVE_RAPID;
    push(m);
    window_finish(&window);
    take();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 100.0 * maths_sqrt(2.0), segment.profile.feed_cruise_mm_s);
    TEST_ASSERT_EQUAL(GOVERNOR_VELOCITY, segment.governor);
}

static void test_a_corner_stops(void)
{
    push(move_to(100, 0, 100));
    push(move_to(100, 100, 100));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(JOINT_STOP, segment.end);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, segment.profile.feed_end_mm_s);
}

static void test_collinear_blocks_are_passed_at_full_feed(void)
{
    push(move_to(100, 0, 100));
    push(move_to(200, 0, 100));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(JOINT_PASSED, segment.end);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, segment.profile.feed_end_mm_s);
}

static void test_the_lower_feed_of_two_blocks_rules_their_joint(void)
{
    push(move_to(100, 0, 100));
    push(move_to(200, 0, 40));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(JOINT_PASSED, segment.end);
    TEST_ASSERT_EQUAL_DOUBLE(40.0, segment.profile.feed_end_mm_s);
}

static void test_exact_stop_mode_stops_even_on_a_straight_line(void)
{
    struct move m = move_to(100, 0, 100);

    m.path = PATH_EXACT_STOP;
    push(m);
    push(move_to(200, 0, 100));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(JOINT_STOP, segment.end);
}

static void test_a_line_into_an_arc_slows_to_what_the_step_of_curvature_allows_and_lands(void)
{
    const double radius = 20.0;

    push(move_to(100, 0, 100));
    push(arc_to(100, 2 * radius, 100, radius, false, 100));
    window_finish(&window);
    take();
    /* 3/4 v^2/R per cycle uses half of the jerk limit */
    const double joint = maths_sqrt(0.5 * 50000.0 * CYCLE_S * radius / 0.75);

    TEST_ASSERT_EQUAL(JOINT_REDUCED, segment.end);
    TEST_ASSERT_TRUE(segment.profile.feed_end_mm_s <= joint * (1.0 + 1e-12));
    TEST_ASSERT_TRUE(segment.profile.feed_end_mm_s > 0.9 * joint);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, segment.first_s + (double)(segment.cycles - 1) * CYCLE_S,
                              segment.profile.duration_s);
}

static void test_an_arc_is_limited_by_its_centripetal_acceleration(void)
{
    push(arc_to(0, 4, 0, 2, false, 100));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(GOVERNOR_ACCELERATION, segment.governor);
    TEST_ASSERT_TRUE(segment.profile.feed_cruise_mm_s <= maths_sqrt(1000.0 * 2.0));
}

static void test_the_chord_error_limits_the_feed_when_the_cycle_is_slow(void)
{
    struct plan_limits slow = mill;

    slow.cycle_s = 0.01;
    slow.acceleration_mm_s2[0] = slow.acceleration_mm_s2[1] = 1e5;
    slow.jerk_mm_s3[0] = slow.jerk_mm_s3[1] = 1e8;
    window_init(&window, &slow, 4, &position);
    push(arc_to(0, 0, 0, 10, false, 100));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(GOVERNOR_CHORD, segment.governor);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0 / 0.01 * maths_sqrt(2.0 * 10.0 * 1e-3 - 1e-6),
                              segment.profile.feed_cruise_mm_s);
}

static void test_the_whole_window_can_always_be_stopped(void)
{
    start_window(16);
    for (int i = 0; i < 200; i++) {
        if (!window_has_room(&window)) {
            take();
        }
        push(move_to(i + 1, 0, 100));
    }
    take();
    TEST_ASSERT_TRUE(segment.profile.feed_end_mm_s > 10.0);
    window_finish(&window);
    while (!window_is_empty(&window)) {
        struct profile_state end;

        take();
        profile_evaluate(&segment.profile, segment.profile.duration_s, &end);
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, segment.curve.length_mm, end.s_mm);
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, segment.profile.feed_end_mm_s);
}

static void test_every_profile_is_exactly_as_long_as_its_curve(void)
{
    start_window(8);
    for (int i = 0; i < 100; i++) {
        const double x = 0.01 * i * i;

        if (!window_has_room(&window)) {
            struct profile_state end;

            take();
            profile_evaluate(&segment.profile, segment.profile.duration_s, &end);
            TEST_ASSERT_DOUBLE_WITHIN(1e-10, segment.curve.length_mm, end.s_mm);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, segment.profile.feed_end_mm_s, end.v_mm_s);
        }
        push(move_to(x + 0.01, 1e-6 * x * x, 100));
    }
}

static void test_each_segment_begins_where_the_one_before_ended(void)
{
    struct point last = position;

    start_window(4);
    for (int i = 1; i < 20; i++) {
        if (!window_has_room(&window)) {
            take();
            TEST_ASSERT_EQUAL_MEMORY(&last, &segment.curve.start, sizeof(last));
            last = segment.curve.end;
        }
        push(move_to(i, i % 3, 50));
    }
}

static void test_a_motion_without_length_is_counted_and_dropped(void)
{
    push(move_to(0, 0, 100));
    push(move_to(1, 0, 100));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(2, segment.block);
    TEST_ASSERT_TRUE(window_is_empty(&window));
}

static void test_a_dwell_stops_before_and_rests_whole_cycles(void)
{
    struct move dwell;

    memset(&dwell, 0, sizeof(dwell));
    dwell.kind = MOVE_DWELL;
    dwell.dwell_s = 0.0105;
    push(move_to(10, 0, 100));
    push(dwell);
    push(move_to(20, 0, 100));
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(JOINT_STOP, segment.end);
    take();
    TEST_ASSERT_EQUAL(MOVE_DWELL, segment.move.kind);
    TEST_ASSERT_EQUAL(11, segment.cycles);
}

/*
 * A long ramp down through a short block: there the feed changes by less than a thousand units in its last place, and
 * the length of such a ramp is as uncertain.
 */
static void test_a_short_block_inside_a_long_ramp_is_passed_at_speed(void)
{
    struct plan_limits gentle = mill;

    gentle.velocity_mm_s[AXIS_X] = 835.345;
    gentle.jerk_mm_s3[AXIS_X] = 14.7596;
    window_init(&window, &gentle, WINDOW_BLOCKS_MAX, &position);
    push(move_to(9928.59923, 0, 376.223654));
    push(move_to(9928.59923 + 0.0708575466, 0, 501.605215));
    push(move_to(9928.59923 + 0.0708575466 + 1499.36618, 0, 128.921969));
    window_finish(&window);
    take();
    take();
    struct profile_state end;

    profile_evaluate(&segment.profile, segment.profile.duration_s, &end);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, segment.curve.length_mm, end.s_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-2, segment.profile.feed_start_mm_s, segment.profile.feed_end_mm_s);
    TEST_ASSERT_TRUE(segment.profile.feed_end_mm_s > 128.0);
}

/* 2 m at 1e-5 mm/s: 2e11 cycles. */
static void test_a_block_may_last_more_cycles_than_32_bits_count(void)
{
    push(move_to(2000, 0, 1e-5));
    window_finish(&window);
    take();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, (double)segment.cycles / 2e11);
}

static void test_of_many_events_in_a_row_one_in_five_takes_a_cycle(void)
{
    struct move event;
    uint64_t cycles = 0;

    memset(&event, 0, sizeof(event));
    event.kind = MOVE_COOLANT;
    for (int i = 0; i < 20; i++) {
        push(event);
    }
    window_finish(&window);
    for (int i = 1; i <= 20; i++) {
        take();
        cycles += segment.cycles;
        TEST_ASSERT_EQUAL(i / 5, cycles);
    }
}

static void test_linear_and_rotary_paths_do_not_run_into_each_other(void)
{
    struct plan_limits four = mill;
    struct move turn = move_to(10, 0, 1);

    four.axes = 15;
    four.velocity_mm_s[AXIS_A] = four.acceleration_mm_s2[AXIS_A] = four.jerk_mm_s3[AXIS_A] = 10;
    window_init(&window, &four, 8, &position);
    turn.end.at[AXIS_A] = 1.0;
    push(move_to(10, 0, 1));
    push(turn);
    window_finish(&window);
    take();
    TEST_ASSERT_EQUAL(JOINT_STOP, segment.end);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_can_be_taken_before_the_window_is_full_or_finished);
    RUN_TEST(test_a_long_move_takes_the_closed_form_time_from_rest_to_rest);
    RUN_TEST(test_a_short_move_is_governed_by_its_ramps);
    RUN_TEST(test_a_diagonal_may_be_as_fast_as_both_axes_together);
    RUN_TEST(test_a_corner_stops);
    RUN_TEST(test_collinear_blocks_are_passed_at_full_feed);
    RUN_TEST(test_the_lower_feed_of_two_blocks_rules_their_joint);
    RUN_TEST(test_exact_stop_mode_stops_even_on_a_straight_line);
    RUN_TEST(test_a_line_into_an_arc_slows_to_what_the_step_of_curvature_allows_and_lands);
    RUN_TEST(test_an_arc_is_limited_by_its_centripetal_acceleration);
    RUN_TEST(test_the_chord_error_limits_the_feed_when_the_cycle_is_slow);
    RUN_TEST(test_the_whole_window_can_always_be_stopped);
    RUN_TEST(test_every_profile_is_exactly_as_long_as_its_curve);
    RUN_TEST(test_each_segment_begins_where_the_one_before_ended);
    RUN_TEST(test_a_motion_without_length_is_counted_and_dropped);
    RUN_TEST(test_a_dwell_stops_before_and_rests_whole_cycles);
    RUN_TEST(test_a_short_block_inside_a_long_ramp_is_passed_at_speed);
    RUN_TEST(test_a_block_may_last_more_cycles_than_32_bits_count);
    RUN_TEST(test_of_many_events_in_a_row_one_in_five_takes_a_cycle);
    RUN_TEST(test_linear_and_rotary_paths_do_not_run_into_each_other);
    return UNITY_END();
}
