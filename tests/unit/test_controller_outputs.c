/*
 * What each event of a program does to the outputs.
 */
#include "controller/outputs.h"

#include "base/maths.h"

#include "unity.h"

#include <string.h>

static struct outputs outputs;
static struct outputs_surface surface;

void setUp(void)
{
    memset(&outputs, 0, sizeof(outputs));
    memset(&surface, 0, sizeof(surface));
}

void tearDown(void)
{
}

static void apply(const struct move *m)
{
    takt_outputs_apply(&outputs, &surface, m);
}

static void turn(enum spindle_direction direction, double speed_rpm)
{
    apply(&(struct move){.kind = MOVE_SPINDLE, .direction = direction, .speed_rpm = speed_rpm});
}

/* 120 m/min, the spindle's axis at X 10. */
static void turn_with_surface_speed(enum spindle_direction direction, double highest_rpm)
{
    apply(&(struct move){.kind = MOVE_SPINDLE,
                         .direction = direction,
                         .surface_mm_s = 2000.0,
                         .surface_x_mm = 10.0,
                         .speed_rpm = highest_rpm});
}

static double speed_at(double x_mm)
{
    outputs_follow(&outputs, &surface, &(struct point){{x_mm, 5.0, 6.0}});
    return outputs.spindle_speed_rpm;
}

static void test_the_spindle_turns_clockwise_or_the_other_way(void)
{
    turn(SPINDLE_CW, 1000.0);
    TEST_ASSERT_TRUE(outputs.spindle_speed_rpm == 1000.0);
    turn(SPINDLE_CCW, 800.0);
    TEST_ASSERT_TRUE(outputs.spindle_speed_rpm == -800.0);
    turn(SPINDLE_OFF, 0.0);
    TEST_ASSERT_TRUE(outputs.spindle_speed_rpm == 0.0);
}

/* 2000 mm/s around a circle of 100 mm radius are 3.18 revolutions a second. */
static void test_a_surface_speed_is_kept_at_every_diameter(void)
{
    turn_with_surface_speed(SPINDLE_CW, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 60.0 * 2000.0 / (MATHS_TWO_PI * 100.0), speed_at(110.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 60.0 * 2000.0 / (MATHS_TWO_PI * 50.0), speed_at(60.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 60.0 * 2000.0 / (MATHS_TWO_PI * 50.0), speed_at(-40.0));
}

static void test_a_surface_speed_turns_the_spindle_no_faster_than_its_maximum(void)
{
    turn_with_surface_speed(SPINDLE_CCW, 900.0);
    TEST_ASSERT_TRUE(speed_at(10.001) == -900.0);
    TEST_ASSERT_TRUE(speed_at(10.0) == -900.0);
    TEST_ASSERT_TRUE(speed_at(110.0) > -900.0);
}

static void test_a_surface_speed_without_a_maximum_stays_finite(void)
{
    turn_with_surface_speed(SPINDLE_CW, 0.0);
    TEST_ASSERT_TRUE(maths_is_finite(speed_at(10.0)));
}

static void test_a_surface_speed_ends_with_the_next_command_to_the_spindle(void)
{
    turn_with_surface_speed(SPINDLE_CW, 0.0);
    turn(SPINDLE_CW, 500.0);
    TEST_ASSERT_TRUE(speed_at(110.0) == 500.0);
    turn_with_surface_speed(SPINDLE_CW, 0.0);
    turn(SPINDLE_OFF, 0.0);
    TEST_ASSERT_TRUE(speed_at(110.0) == 0.0);
}

static void test_an_oriented_spindle_stands_and_holds_its_angle_until_it_turns_again(void)
{
    turn_with_surface_speed(SPINDLE_CW, 0.0);
    apply(&(struct move){.kind = MOVE_ORIENT, .orient_rad = 1.5});
    TEST_ASSERT_TRUE(outputs.spindle_orient && outputs.spindle_angle_rad == 1.5);
    TEST_ASSERT_TRUE(speed_at(110.0) == 0.0);
    turn(SPINDLE_CW, 500.0);
    TEST_ASSERT_FALSE(outputs.spindle_orient);
    apply(&(struct move){.kind = MOVE_ORIENT, .orient_rad = 1.5});
    turn(SPINDLE_OFF, 0.0);
    TEST_ASSERT_FALSE(outputs.spindle_orient);
}

static void test_coolants_are_as_the_event_says(void)
{
    apply(&(struct move){.kind = MOVE_COOLANT, .mist = true});
    TEST_ASSERT_TRUE(outputs.mist && !outputs.flood);
    apply(&(struct move){.kind = MOVE_COOLANT, .mist = true, .flood = true});
    TEST_ASSERT_TRUE(outputs.mist && outputs.flood);
    apply(&(struct move){.kind = MOVE_COOLANT});
    TEST_ASSERT_TRUE(!outputs.mist && !outputs.flood);
}

static void test_a_tool_is_in_the_spindle_when_it_is_changed_not_when_it_is_prepared(void)
{
    apply(&(struct move){.kind = MOVE_TOOL, .tool = 7});
    TEST_ASSERT_EQUAL_UINT32(0, outputs.tool);
    apply(&(struct move){.kind = MOVE_TOOL, .tool = 7, .tool_change = true});
    TEST_ASSERT_EQUAL_UINT32(7, outputs.tool);
    apply(&(struct move){.kind = MOVE_TOOL, .tool = 3, .tool_loaded = true});
    TEST_ASSERT_EQUAL_UINT32(3, outputs.tool);
}

static void test_digital_outputs_change_one_by_one(void)
{
    apply(&(struct move){.kind = MOVE_OUTPUT, .channel = 0, .output = 1.0});
    apply(&(struct move){.kind = MOVE_OUTPUT, .channel = 31, .output = 1.0, .with_motion = true});
    TEST_ASSERT_EQUAL_HEX32(0x80000001U, outputs.digital);
    apply(&(struct move){.kind = MOVE_OUTPUT, .channel = 0, .output = 0.0});
    TEST_ASSERT_EQUAL_HEX32(0x80000000U, outputs.digital);
}

static void test_analogue_outputs_take_any_value(void)
{
    apply(&(struct move){.kind = MOVE_OUTPUT, .channel = 3, .analogue = true, .output = -2.5});
    TEST_ASSERT_TRUE(outputs.analogue[3] == -2.5);
    TEST_ASSERT_EQUAL_HEX32(0U, outputs.digital);
}

static void test_the_end_turns_off_spindle_and_coolant_and_leaves_the_rest(void)
{
    turn_with_surface_speed(SPINDLE_CW, 0.0);
    apply(&(struct move){.kind = MOVE_COOLANT, .mist = true, .flood = true});
    apply(&(struct move){.kind = MOVE_OUTPUT, .channel = 2, .output = 1.0});
    apply(&(struct move){.kind = MOVE_TOOL, .tool = 3, .tool_loaded = true});
    apply(&(struct move){.kind = MOVE_END});
    TEST_ASSERT_TRUE(speed_at(110.0) == 0.0);
    TEST_ASSERT_TRUE(!outputs.mist && !outputs.flood);
    TEST_ASSERT_EQUAL_HEX32(4U, outputs.digital);
    TEST_ASSERT_EQUAL_UINT32(3, outputs.tool);
}

static void test_motions_dwells_inputs_and_stops_change_nothing(void)
{
    static const enum move_kind kinds[] = {MOVE_RAPID, MOVE_FEED,  MOVE_ARC_CW, MOVE_PROBE,
                                           MOVE_DWELL, MOVE_INPUT, MOVE_STOP};
    struct outputs before;

    turn(SPINDLE_CCW, 700.0);
    apply(&(struct move){.kind = MOVE_COOLANT, .flood = true});
    before = outputs;
    for (unsigned i = 0; i < sizeof(kinds) / sizeof(kinds[0]); i++) {
        apply(&(struct move){.kind = kinds[i], .output = 1.0, .tool_change = true, .tool = 9});
    }
    TEST_ASSERT_EQUAL_MEMORY(&before, &outputs, sizeof(before));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_spindle_turns_clockwise_or_the_other_way);
    RUN_TEST(test_a_surface_speed_is_kept_at_every_diameter);
    RUN_TEST(test_a_surface_speed_turns_the_spindle_no_faster_than_its_maximum);
    RUN_TEST(test_a_surface_speed_without_a_maximum_stays_finite);
    RUN_TEST(test_a_surface_speed_ends_with_the_next_command_to_the_spindle);
    RUN_TEST(test_an_oriented_spindle_stands_and_holds_its_angle_until_it_turns_again);
    RUN_TEST(test_coolants_are_as_the_event_says);
    RUN_TEST(test_a_tool_is_in_the_spindle_when_it_is_changed_not_when_it_is_prepared);
    RUN_TEST(test_digital_outputs_change_one_by_one);
    RUN_TEST(test_analogue_outputs_take_any_value);
    RUN_TEST(test_the_end_turns_off_spindle_and_coolant_and_leaves_the_rest);
    RUN_TEST(test_motions_dwells_inputs_and_stops_change_nothing);
    return UNITY_END();
}
