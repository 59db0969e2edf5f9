/*
 * The drives that follow from a machine: a gantry has two of them for an axis.
 */
#include "controller/controller.h"
#include "unity.h"

static struct machine machine;
static struct drives_config config;

void setUp(void)
{
    takt_machine_set_default(&machine);
    machine.gantry[0] = (struct machine_gantry){
        .axis = AXIS_Y, .drive_node = 9, .home_offset_mm = 2.5, .skew_max_mm = 0.5};
    machine.axis[AXIS_Y].home_offset_mm = 2;
    machine.axis[AXIS_Y].home_order = 1;
}

void tearDown(void)
{
}

static void test_the_second_drive_of_a_gantry_is_the_last_and_like_the_first(void)
{
    takt_controller_drives_config(&machine, NULL, &config);
    TEST_ASSERT_EQUAL_UINT(4, config.count);
    TEST_ASSERT_EQUAL_INT(AXIS_Y, config.axis[3].axis);
    TEST_ASSERT_EQUAL_UINT(9, config.axis[3].node);
    TEST_ASSERT_EQUAL_UINT(1, config.axis[3].homing.order);
    TEST_ASSERT_EQUAL_DOUBLE(100000, config.axis[3].increments_per_mm);
    TEST_ASSERT_EQUAL_DOUBLE(2, config.axis[AXIS_Y].homing.offset_mm);
    TEST_ASSERT_EQUAL_DOUBLE(2.5, config.axis[3].homing.offset_mm);
    TEST_ASSERT_EQUAL_UINT(1, config.gantry_count);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, config.gantry[0].skew_max_mm);
    machine.gantry[0].axis = AXIS_COUNT;
    takt_controller_drives_config(&machine, NULL, &config);
    TEST_ASSERT_EQUAL_UINT(3, config.count);
    TEST_ASSERT_EQUAL_UINT(0, config.gantry_count);
}

static int8_t second_method(int8_t method)
{
    machine.axis[AXIS_Y].home_method = method;
    takt_controller_drives_config(&machine, NULL, &config);
    TEST_ASSERT_EQUAL_UINT(method, config.axis[AXIS_Y].homing.method);
    return config.axis[3].homing.method;
}

/* CiA 402-2, 6098: which method is the mirror image of which. */
static void test_a_reversed_second_drive_looks_for_its_home_on_the_same_side(void)
{
    static const uint8_t mirrored[] = {0,  2,  1,  5,  6,  3,  4,  11, 12, 13, 14, 7,  8,
                                       9,  10, 15, 16, 18, 17, 21, 22, 19, 20, 27, 28, 29,
                                       30, 23, 24, 25, 26, 31, 32, 34, 33, 35, 36, 37};

    for (uint8_t method = 1; method <= 37; method++)
        TEST_ASSERT_EQUAL_UINT(method, second_method((int8_t)method));
    machine.gantry[0].is_reversed = 1;
    for (uint8_t method = 1; method <= 37; method++)
        TEST_ASSERT_EQUAL_UINT(mirrored[method], second_method((int8_t)method));
    TEST_ASSERT_EQUAL_DOUBLE(-100000, config.axis[3].increments_per_mm);
}

static double gain_per_s(void)
{
    takt_controller_drives_config(&machine, NULL, &config);
    return config.position_gain_per_s;
}

/* K = 1 / (4 T), T the loop's own time and A/J of the slowest axis. */
static void test_the_position_gain_is_that_of_the_slowest_axis_with_a_drive_on_can(void)
{
    const double loop_s = 1e-3 * (DRIVES_LATENCY_CYCLES - 0.5);
    struct machine_axis *slow = &machine.axis[AXIS_Z];

    TEST_ASSERT_EQUAL_DOUBLE(0.25 / (loop_s + 1000.0 / 50000), gain_per_s());
    slow->max_jerk_mm_s3 = 10000;
    TEST_ASSERT_EQUAL_DOUBLE(0.25 / (loop_s + 1000.0 / 10000), gain_per_s());
    slow->drive_type = MACHINE_DRIVE_STEP;
    TEST_ASSERT_EQUAL_DOUBLE(0.25 / (loop_s + 1000.0 / 50000), gain_per_s());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_second_drive_of_a_gantry_is_the_last_and_like_the_first);
    RUN_TEST(test_a_reversed_second_drive_looks_for_its_home_on_the_same_side);
    RUN_TEST(test_the_position_gain_is_that_of_the_slowest_axis_with_a_drive_on_can);
    return UNITY_END();
}
