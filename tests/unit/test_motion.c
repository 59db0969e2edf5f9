#include "motion/motion.h"

#include <string.h>
#include <unity.h>

#define CYCLE_S 1e-3

static struct motion motion;
static struct cycle_record record;

void setUp(void)
{
    struct point start;

    memset(&start, 0, sizeof(start));
    motion_init(&motion, CYCLE_S, &start);
}

void tearDown(void)
{
}

/* A segment along X at constant feed, whose first cycle comes first_s after its start. */
static void push_line(double from, double to, double feed_mm_s, enum joint_kind end, double first_s,
                      uint32_t cycles)
{
    struct segment *s = motion_next_slot(&motion);
    const struct point start = {{from, 0, 0, 0, 0, 0}};
    const struct point stop = {{to, 0, 0, 0, 0, 0}};

    memset(s, 0, sizeof(*s));
    s->move.kind = MOVE_FEED;
    s->move.line = (uint32_t)to;
    s->end = end;
    s->cycles = cycles;
    s->first_s = first_s;
    TEST_ASSERT_TRUE(curve_set_line(&s->curve, &start, &stop));
    profile_append(&s->profile, (struct profile_state){0.0, feed_mm_s, 0.0},
                   s->curve.length_mm / feed_mm_s, 0.0);
    motion_push(&motion);
}

static void push_kind(enum move_kind kind, uint32_t cycles)
{
    struct segment *s = motion_next_slot(&motion);

    memset(s, 0, sizeof(*s));
    s->move.kind = kind;
    s->cycles = cycles;
    motion_push(&motion);
}

static double next_x(void)
{
    TEST_ASSERT_EQUAL(MOTION_CYCLE, motion_cycle(&motion, &record));
    return record.cmd.at[AXIS_X];
}

static void test_an_empty_queue_is_starvation(void)
{
    TEST_ASSERT_EQUAL(MOTION_STARVED, motion_cycle(&motion, &record));
}

static void test_the_end_of_the_program_ends_the_motion_for_ever(void)
{
    push_kind(MOVE_END, 0);
    TEST_ASSERT_EQUAL(MOTION_DONE, motion_cycle(&motion, &record));
    TEST_ASSERT_EQUAL(MOTION_DONE, motion_cycle(&motion, &record));
}

static void test_one_setpoint_a_cycle_along_the_profile(void)
{
    push_line(0, 3, 1000, JOINT_STOP, CYCLE_S, 3);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, next_x());
    TEST_ASSERT_EQUAL(0, record.cycle);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, next_x());
    TEST_ASSERT_FALSE(record.landed);
    TEST_ASSERT_EQUAL(1, record.cycle);
    TEST_ASSERT_EQUAL_DOUBLE(3.0, next_x());
    TEST_ASSERT_TRUE(record.landed);
    TEST_ASSERT_EQUAL(3, record.line);
}

static void test_a_passed_end_lies_between_two_cycles(void)
{
    push_line(0, 1.5, 1000, JOINT_PASSED, CYCLE_S, 1);
    push_line(1.5, 3, 1000, JOINT_STOP, 0.5 * CYCLE_S, 2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, next_x());
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, next_x());
    TEST_ASSERT_FALSE(record.landed);
    TEST_ASSERT_EQUAL_DOUBLE(3.0, next_x());
}

static void test_blocks_shorter_than_a_cycle_are_passed_inside_it(void)
{
    for (int i = 0; i < 4; i++) {
        push_line(0.25 * i, 0.25 * (i + 1), 1000, i < 3 ? JOINT_PASSED : JOINT_STOP, CYCLE_S,
                  i < 3 ? 0 : 1);
    }
    TEST_ASSERT_EQUAL_DOUBLE(1.0, next_x());
    TEST_ASSERT_TRUE(record.landed);
    TEST_ASSERT_EQUAL(MOTION_STARVED, motion_cycle(&motion, &record));
}

static void test_a_dwell_holds_the_position_and_an_event_takes_no_cycle(void)
{
    push_line(0, 1, 1000, JOINT_STOP, CYCLE_S, 1);
    push_kind(MOVE_SPINDLE, 0);
    push_kind(MOVE_DWELL, 2);
    push_kind(MOVE_END, 0);
    next_x();
    TEST_ASSERT_EQUAL_DOUBLE(1.0, next_x());
    TEST_ASSERT_EQUAL_DOUBLE(0.0, record.feed_mm_s);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, next_x());
    TEST_ASSERT_EQUAL(MOTION_DONE, motion_cycle(&motion, &record));
}

static void test_the_queue_has_room_for_its_size_and_no_more(void)
{
    for (int i = 0; i < MOTION_QUEUE_MAX; i++) {
        TEST_ASSERT_TRUE(motion_has_room(&motion));
        push_kind(MOVE_DWELL, 1);
    }
    TEST_ASSERT_FALSE(motion_has_room(&motion));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_empty_queue_is_starvation);
    RUN_TEST(test_the_end_of_the_program_ends_the_motion_for_ever);
    RUN_TEST(test_one_setpoint_a_cycle_along_the_profile);
    RUN_TEST(test_a_passed_end_lies_between_two_cycles);
    RUN_TEST(test_blocks_shorter_than_a_cycle_are_passed_inside_it);
    RUN_TEST(test_a_dwell_holds_the_position_and_an_event_takes_no_cycle);
    RUN_TEST(test_the_queue_has_room_for_its_size_and_no_more);
    return UNITY_END();
}
