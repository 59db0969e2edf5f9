/* The virtual machine's errors, by figures worked out by hand. */
#include "deviation/deviation.h"
#include "unity.h"

#include <string.h>

static struct deviation_config config;
static struct deviation d;
static const double low[AXIS_COUNT] = {-100, -100, -100, -10, -10, -10};
static const double high[AXIS_COUNT] = {300, 300, 300, 10, 10, 10};

void setUp(void)
{
    memset(&config, 0, sizeof config);
    config.table_axis = AXIS_COUNT;
    config.head_axis = AXIS_COUNT;
    config.tool_direction[AXIS_Z] = 1;
}

void tearDown(void)
{
}

static struct point tool_at(struct point drives, double turn_rad)
{
    struct point tool;

    deviation_init(&d, &config, low, high);
    deviation_follow(&d, &drives, 0);
    deviation_tool_point(&d, &drives, turn_rad, &tool);
    return tool;
}

static void test_a_machine_without_errors_is_where_its_drives_are(void)
{
    const struct point at = {{12.5, -7, 30}};
    const struct point tool = tool_at(at, 0);

    TEST_ASSERT_FALSE(d.any);
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_DOUBLE(at.at[i], tool.at[i]);
}

static void test_a_curve_is_the_sum_of_its_parts_and_zero_at_zero(void)
{
    const double numbers[] = {40, 8, 5, 200, 90};

    /*
     * 40 um/m * 100 mm = 4; bow: s = 0 at 100, -0.5 at 0: -2; sine: sin(270 deg) - sin(90
     * deg) = -2, times 5
     */
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4 - 2 - 10, deviation_curve(numbers, 100, -100, 300));
    TEST_ASSERT_EQUAL_DOUBLE(0, deviation_curve(numbers, 0, -100, 300));
}

static void test_pitch_and_straightness_move_the_tool(void)
{
    struct point tool;

    config.axis[AXIS_X][0][DEVIATION_LINEAR_PER_M] = 30;
    config.axis[AXIS_X][2][DEVIATION_LINEAR_PER_M] = -10;
    tool = tool_at((struct point){{200}}, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 200.006, tool.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.002, tool.at[AXIS_Z]);
}

static void test_a_rotation_acts_on_the_arm_above_it(void)
{
    struct point tool;

    config.axis[AXIS_X][5][DEVIATION_LINEAR_PER_M] = 100; /* yaw of X: 20 urad at 200 */
    config.tool_mm[AXIS_Z] = -80;
    tool = tool_at((struct point){{200, 150, 0}}, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 200 - 150 * 20e-6, tool.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 150, tool.at[AXIS_Y]);
    config.axis[AXIS_X][4][DEVIATION_LINEAR_PER_M] = 50; /* pitch of X: 10 urad, on Z + tool */
    tool = tool_at((struct point){{200, 0, 30}}, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 200 + 10e-6 * (30 - 80), tool.at[AXIS_X]);
}

static void test_squareness_leans_an_axis(void)
{
    config.squareness_urad[0] = 40;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -0.004, tool_at((struct point){{0, 100}}, 0).at[AXIS_X]);
}

static void test_play_is_lost_at_reversals_alone(void)
{
    struct point tool;

    config.backlash_um[AXIS_X] = 20;
    deviation_init(&d, &config, low, high);
    for (int i = 0; i <= 1000; i++)
        deviation_follow(&d, &(struct point){{0.001 * i}}, 0);
    deviation_tool_point(&d, &(struct point){{1}}, 0, &tool);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.990, tool.at[AXIS_X]);
    deviation_follow(&d, &(struct point){{1.5}}, 0);
    deviation_follow(&d, &(struct point){{1.495}}, 0); /* inside the play: the table stands */
    deviation_tool_point(&d, &(struct point){{1.495}}, 0, &tool);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.490, tool.at[AXIS_X]);
    deviation_follow(&d, &(struct point){{1.4}}, 0);
    deviation_tool_point(&d, &(struct point){{1.4}}, 0, &tool);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.410, tool.at[AXIS_X]);
}

static void test_the_machine_warms_and_grows(void)
{
    struct point tool;
    const struct point at = {{0, 200}};

    config.growth_um_per_m_k[AXIS_Y] = 10;
    config.growth_reference_mm[AXIS_Y] = 100;
    config.warming_k = 15;
    config.warming_time_s = 60;
    config.sensor_step_k = 0.5;
    deviation_init(&d, &config, low, high);
    deviation_follow(&d, &at, 60);
    deviation_tool_point(&d, &at, 0, &tool);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 200 + 10e-6 * 15 * (1 - 0.36787944117) * 100, tool.at[AXIS_Y]);
    TEST_ASSERT_EQUAL_DOUBLE(9.5, deviation_sensor_k(&d));
}

static void test_a_table_that_turns_too_far_moves_the_tool_on_the_part(void)
{
    struct point tool;

    config.table_axis = AXIS_C;
    config.table_yaw[DEVIATION_LINEAR_PER_M] = 1000; /* urad per 1000 deg */
    config.table_centre_mm[AXIS_X] = 50;
    tool = tool_at((struct point){{150, 0, 0, 0, 0, 3.14159265358979}}, 3.14159265358979);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, -100 * 180e-6, tool.at[AXIS_Y]);
    /* the drive turned back by as much: the part is where it is wanted */
    tool = tool_at((struct point){{150, 0, 0, 0, 0, 3.14159265358979 - 180e-6}}, 3.14159265358979);
    TEST_ASSERT_DOUBLE_WITHIN(2e-6, 0, tool.at[AXIS_Y]);
}

static void test_a_worn_tool_is_shorter(void)
{
    struct point tool;

    config.wear_along_um_per_m = 3;
    config.wear_along_um_per_min = 1;
    deviation_init(&d, &config, low, high);
    deviation_set_wear(&d, 2000, 120);
    deviation_tool_point(&d, &(struct point){{0}}, 0, &tool);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.008, tool.at[AXIS_Z]);
}

/* B turns Z towards X: by 30 degrees a tool along 2 Z is shorter along (1/2, 0, sqrt(3)/2). */
static void test_a_worn_tool_is_shorter_along_its_own_direction(void)
{
    struct point tool;

    config.wear_along_um_per_m = 8;
    config.tool_direction[AXIS_Z] = 2;
    config.head_axis = AXIS_B;
    deviation_init(&d, &config, low, high);
    deviation_set_wear(&d, 1000, 0);
    deviation_tool_point(&d, &(struct point){{0, 0, 0, 0, 3.14159265358979 / 6}}, 0, &tool);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.004, tool.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, tool.at[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0069282032302755, tool.at[AXIS_Z]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_machine_without_errors_is_where_its_drives_are);
    RUN_TEST(test_a_curve_is_the_sum_of_its_parts_and_zero_at_zero);
    RUN_TEST(test_pitch_and_straightness_move_the_tool);
    RUN_TEST(test_a_rotation_acts_on_the_arm_above_it);
    RUN_TEST(test_squareness_leans_an_axis);
    RUN_TEST(test_play_is_lost_at_reversals_alone);
    RUN_TEST(test_the_machine_warms_and_grows);
    RUN_TEST(test_a_table_that_turns_too_far_moves_the_tool_on_the_part);
    RUN_TEST(test_a_worn_tool_is_shorter);
    RUN_TEST(test_a_worn_tool_is_shorter_along_its_own_direction);
    return UNITY_END();
}
