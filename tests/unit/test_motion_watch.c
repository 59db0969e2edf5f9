/* The watch over a path that is not gone on along: what is an alarm, and what explains any time. */
#include "motion/motion.h"
#include "plan/path.h"

#include <string.h>
#include <unity.h>

#define LONG_CYCLES 300000U

static const struct plan_limits limits = {
    7,    {100, 100, 100},   {1000, 1000, 1000}, {50000, 50000, 50000}, 1e-3,
    1e-3, RAMP_PROFILE_JERK, LANDING_SPAN};

static struct path path;
static struct motion motion;
static struct cycle_record record;
static struct motion_operator asked;
static bool background;

static void push(enum move_kind kind, double x, double feed_mm_s)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = kind;
    m.line = 7;
    m.end.at[AXIS_X] = x;
    m.feed_mm_s = feed_mm_s;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    takt_path_push(&path, &m);
}

void setUp(void)
{
    const struct point start = {{0}};

    takt_path_init(&path, &limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    asked = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    background = true;
}

void tearDown(void)
{
}

static enum motion_result cycle(void)
{
    if (background && takt_motion_wanted(&motion) != NULL) {
        takt_motion_build(&motion);
    }
    return takt_motion_cycle(&motion, &asked, &record);
}

static void run(uint32_t cycles)
{
    for (uint32_t i = 0; i < cycles; i++) {
        TEST_ASSERT_EQUAL_INT(MOTION_CYCLE, cycle());
    }
}

/* Cycles until the result is another one. */
static uint64_t run_to_alarm(void (*spoil)(void))
{
    enum motion_result result = MOTION_CYCLE;

    while (result == MOTION_CYCLE && motion.cycles < LONG_CYCLES) {
        spoil();
        result = cycle();
    }
    TEST_ASSERT_EQUAL_INT(MOTION_STALLED, result);
    TEST_ASSERT_EQUAL_INT(MOTION_STALLED, cycle());
    TEST_ASSERT_EQUAL_UINT32(7, takt_motion_stalled_line(&motion));
    TEST_ASSERT_TRUE(takt_motion_rests(&motion));
    return motion.cycles;
}

static void never_leave_a_stop(void)
{
    motion.reference.since_minus = -1;
}

static void never_speed_up(void)
{
    if (motion.cycles > 2) {
        motion.reference.since_minus = 0;
    }
}

/* 1000 cycles at the feed, 200 of ramps, 64 of exchanges; 16 times as many at most. */
static void test_standing_for_no_reason_is_an_alarm(void)
{
    push(MOVE_FEED, 100.0, 100.0);
    takt_path_finish(&path);
    TEST_ASSERT_UINT64_WITHIN(3000, 18000, run_to_alarm(never_leave_a_stop));
}

static void test_creeping_for_no_reason_is_an_alarm_at_rest(void)
{
    push(MOVE_FEED, 100.0, 100.0);
    takt_path_finish(&path);
    TEST_ASSERT_UINT64_WITHIN(3000, 20000, run_to_alarm(never_speed_up));
    TEST_ASSERT_TRUE(motion.at.at[AXIS_X] > 0.0 && motion.at.at[AXIS_X] < 100.0);
}

static void test_a_slow_feed_explains_its_time(void)
{
    push(MOVE_FEED, 1e-6, 1e-8);
    push(MOVE_FEED, 1.0, 1.0);
    takt_path_finish(&path);
    for (enum motion_result result = MOTION_CYCLE; result == MOTION_CYCLE; result = cycle()) {
    }
    TEST_ASSERT_EQUAL_INT(MOTION_EMPTY, cycle());
    TEST_ASSERT_UINT64_WITHIN(3000, 101000, motion.cycles);
}

static void test_a_hold_and_an_override_of_0_explain_any_time(void)
{
    push(MOVE_FEED, 100.0, 100.0);
    takt_path_finish(&path);
    run(100);
    asked.hold = true;
    run(LONG_CYCLES);
    asked.hold = false;
    asked.feed_ratio = 0.0;
    run(LONG_CYCLES);
}

static void test_a_low_override_explains_as_much_more_time(void)
{
    push(MOVE_FEED, 100.0, 100.0);
    takt_path_finish(&path);
    asked.feed_ratio = 0.003;
    run(LONG_CYCLES);
}

static void test_a_stop_that_may_not_be_left_explains_any_time(void)
{
    push(MOVE_FEED, 100.0, 100.0);
    takt_path_finish(&path);
    asked.wait = true;
    run(LONG_CYCLES);
}

static void test_a_background_that_does_not_come_explains_any_time(void)
{
    push(MOVE_FEED, 1.0, 100.0);
    push(MOVE_FEED, 2.0, 90.0);
    run(20);
    push(MOVE_FEED, 3.0, 100.0);
    takt_path_finish(&path);
    background = false;
    run(LONG_CYCLES);
    TEST_ASSERT_TRUE(takt_motion_rests(&motion));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_standing_for_no_reason_is_an_alarm);
    RUN_TEST(test_creeping_for_no_reason_is_an_alarm_at_rest);
    RUN_TEST(test_a_slow_feed_explains_its_time);
    RUN_TEST(test_a_hold_and_an_override_of_0_explain_any_time);
    RUN_TEST(test_a_low_override_explains_as_much_more_time);
    RUN_TEST(test_a_stop_that_may_not_be_left_explains_any_time);
    RUN_TEST(test_a_background_that_does_not_come_explains_any_time);
    return UNITY_END();
}
