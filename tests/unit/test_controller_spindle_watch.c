/*
 * What the spindle's feedback does to the feed.
 */
#include "controller/spindle_watch.h"

#include "unity.h"

#define CYCLE_S 1e-3

static struct spindle_watch watch;
static struct spindle_feedback spindle;

void setUp(void)
{
    takt_spindle_watch_init(&watch, CYCLE_S, 80.0, 1.0);
    spindle = (struct spindle_feedback){0};
}

void tearDown(void)
{
}

static void run(unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++) {
        TEST_ASSERT_TRUE(spindle_watch_cycle(&watch, &spindle));
    }
}

static void turn(enum spindle_direction direction)
{
    const struct move m = {.kind = MOVE_SPINDLE, .direction = direction, .speed_rpm = 1000.0};

    takt_spindle_watch_pass(&watch, &m);
}

static void test_feeds_per_revolution_go_by_the_measured_speed_and_not_by_its_ripple(void)
{
    spindle.speed_rpm = -600.0;
    run(500);
    TEST_ASSERT_DOUBLE_WITHIN(0.03, 10.0, watch.rev_s);
    const double told = watch.rev_s;

    for (unsigned i = 0; i < 100; i++) {
        spindle.speed_rpm = -600.0 + (i % 2 == 0 ? 1.0 : -1.0);
        run(1);
        TEST_ASSERT_EQUAL_DOUBLE(told, watch.rev_s);
    }
    spindle.speed_rpm = 0.0;
    run(500);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, watch.rev_s);
}

static void test_a_load_within_its_limit_leaves_the_feed_alone(void)
{
    spindle.load_percent = 80.0;
    run(1000);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, watch.ratio);
}

static void test_a_load_beyond_its_limit_lowers_the_feed_the_faster_the_more_it_is(void)
{
    spindle.load_percent = 88.0;
    run(500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.9, watch.ratio);
    spindle.load_percent = 96.0;
    run(500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.7, watch.ratio);
}

static void test_the_feed_is_never_lowered_to_nothing_and_comes_back_when_the_load_is_gone(void)
{
    spindle.load_percent = 300.0;
    run(2000);
    TEST_ASSERT_EQUAL_DOUBLE(SPINDLE_RATIO_MIN, watch.ratio);
    spindle.load_percent = 20.0;
    run(900);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, SPINDLE_RATIO_MIN + 0.45, watch.ratio);
    run(2000);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, watch.ratio);
}

static void test_without_a_limit_the_load_changes_nothing(void)
{
    takt_spindle_watch_init(&watch, CYCLE_S, 0.0, 0.0);
    spindle.load_percent = 500.0;
    run(1000);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, watch.ratio);
}

static void test_a_commanded_speed_is_waited_for(void)
{
    turn(SPINDLE_CW);
    TEST_ASSERT_TRUE(watch.waits);
    run(500);
    TEST_ASSERT_TRUE(watch.waits);
    spindle.at_speed = true;
    run(1);
    TEST_ASSERT_FALSE(watch.waits);
}

static void test_feedback_from_before_the_command_is_not_taken_for_its_answer(void)
{
    spindle.at_speed = true;
    turn(SPINDLE_CCW);
    run(1);
    TEST_ASSERT_TRUE(watch.waits);
}

static void test_a_speed_that_is_not_reached_in_time_is_told(void)
{
    turn(SPINDLE_CW);
    run(1000);
    TEST_ASSERT_FALSE(spindle_watch_cycle(&watch, &spindle));
}

static void test_a_spindle_that_is_switched_off_is_not_waited_for(void)
{
    turn(SPINDLE_CW);
    turn(SPINDLE_OFF);
    TEST_ASSERT_FALSE(watch.waits);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_feeds_per_revolution_go_by_the_measured_speed_and_not_by_its_ripple);
    RUN_TEST(test_a_load_within_its_limit_leaves_the_feed_alone);
    RUN_TEST(test_a_load_beyond_its_limit_lowers_the_feed_the_faster_the_more_it_is);
    RUN_TEST(test_the_feed_is_never_lowered_to_nothing_and_comes_back_when_the_load_is_gone);
    RUN_TEST(test_without_a_limit_the_load_changes_nothing);
    RUN_TEST(test_a_commanded_speed_is_waited_for);
    RUN_TEST(test_feedback_from_before_the_command_is_not_taken_for_its_answer);
    RUN_TEST(test_a_speed_that_is_not_reached_in_time_is_told);
    RUN_TEST(test_a_spindle_that_is_switched_off_is_not_waited_for);
    return UNITY_END();
}
