/* Machines that cannot work, and why. */
#include "machine/machine_check.h"
#include "unity.h"

static struct machine machine;
static struct diagnostic wrong;

void setUp(void)
{
    takt_machine_set_default(&machine);
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
}

void tearDown(void)
{
}

static struct machine_axis *axis_y(void)
{
    return &machine.axis[AXIS_Y];
}

static void expect(enum takt_error code, const char *text)
{
    char said[DIAGNOSTIC_TEXT_MAX];

    TEST_ASSERT_FALSE(takt_machine_check(&machine, &wrong));
    (void)takt_diagnostic_text(&wrong, said);
    TEST_ASSERT_EQUAL_STRING(text, said);
    TEST_ASSERT_EQUAL(code, wrong.code);
    takt_machine_set_default(&machine);
}

static void test_a_travel_has_two_ends_and_zero_between_them(void)
{
    axis_y()->travel_min_mm = axis_y()->travel_max_mm = 0;
    expect(TAKT_ERROR_MACHINE_TRAVEL, "axis Y: its travel ends before it begins");
    axis_y()->travel_min_mm = 10;
    expect(TAKT_ERROR_MACHINE_TRAVEL_ZERO,
           "axis Y: its travel must include 0, where the drives start");
}

static void test_positions_fit_the_drives_32_bits(void)
{
    axis_y()->travel_max_mm = 21475;
    expect(TAKT_ERROR_MACHINE_INCREMENTS,
           "axis Y: at increments_per_mm 100000 its travel does not fit a drive's 32 bits");
    axis_y()->drive_type = MACHINE_DRIVE_STEP;
    axis_y()->increments_per_mm = 1;
    axis_y()->travel_max_mm = 2147484;
    expect(TAKT_ERROR_MACHINE_STEPS, "axis Y: its travel does not fit 32 bits of steps");
    axis_y()->home_offset_mm = -21475;
    expect(
        TAKT_ERROR_MACHINE_HOME,
        "axis Y: its home_offset_mm does not fit a drive's 32 bits (home_offset_deg when rotary)");
}

/* X = 500 mm, t = 1 ms: 5e-12 X / t^2 = 0.0025, 1e-12 X / t^3 = 0.5. */
static void test_data_of_can_fd_are_as_fast_as_the_rest(void)
{
    machine.can_data_bitrate = machine.can_bitrate / 2;
    expect(TAKT_ERROR_MACHINE_DATA_RATE,
           "data_bitrate 500000 is below bitrate: data of CAN FD are as fast at least");
}

static void test_limits_stand_above_the_rounding_of_setpoints(void)
{
    axis_y()->max_acceleration_mm_s2 = 0.0024;
    expect(TAKT_ERROR_MACHINE_ACCELERATION,
           "axis Y: max_acceleration is too low for so short a cycle: at least 0.0025");
    axis_y()->max_jerk_mm_s3 = 0.4;
    expect(TAKT_ERROR_MACHINE_JERK,
           "axis Y: max_jerk is too low for so short a cycle: at least 0.5");
}

static void test_steps_come_no_faster_than_the_drive_takes_them(void)
{
    axis_y()->drive_type = MACHINE_DRIVE_STEP;
    axis_y()->steps_per_mm = 2500;
    expect(TAKT_ERROR_MACHINE_STEP_RATE,
           "axis Y: at max_velocity its steps come at 250000 Hz, above its step_rate_max_hz of "
           "200000");
}

static void test_every_node_has_its_own_number(void)
{
    axis_y()->drive_node = 1;
    expect(TAKT_ERROR_MACHINE_NODES, "axes X and Y have the same drive_node 1");
    machine.controller_node = 2;
    expect(TAKT_ERROR_MACHINE_CONTROLLER_NODE, "controller_node 2 is the drive_node of axis Y");
}

static void test_a_node_id_is_free_on_another_bus(void)
{
    axis_y()->drive_node = 1;
    axis_y()->drive_bus = 1;
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
    machine.io[0].node = 1;
    expect(TAKT_ERROR_MACHINE_IO_NODE, "io 1: another node on the bus has its id 1");
    machine.io[0].node = 3;
    machine.io[0].bus = 1;
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
    machine.io[0].bus = CAN_BUSES_MAX;
    expect(TAKT_ERROR_MACHINE_BUS, "CAN bus 2: the buses of this build are 0 ... 1");
}

static void test_the_bus_carries_the_cycle(void)
{
    machine.can_bitrate = 500000;
    expect(TAKT_ERROR_BUS_OVERLOAD,
           "the bus cannot carry a cycle: it takes 810 of 500 bits at worst, 162 percent");
}

static void test_a_machine_has_an_axis(void)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        machine.axis[i].present = false;
    expect(TAKT_ERROR_MACHINE_NO_AXIS, "the machine has no axis");
}

static void test_io_nodes_follow_each_other_and_have_ids_of_their_own(void)
{
    machine.io[1].node = 20;
    expect(TAKT_ERROR_MACHINE_IO,
           "io 2 is wired wrongly, or has no node before it: the first is io 1");
    machine.io[0] = (struct io_wiring){.node = 20, .output = {IO_STOP}};
    expect(TAKT_ERROR_MACHINE_IO,
           "io 1 is wired wrongly, or has no node before it: the first is io 1");
    machine.io[0] = (struct io_wiring){.node = 128};
    expect(TAKT_ERROR_MACHINE_IO,
           "io 1 is wired wrongly, or has no node before it: the first is io 1");
    machine.io[0].node = machine.controller_node;
    expect(TAKT_ERROR_MACHINE_IO_NODE, "io 1: another node on the bus has its id 127");
}

static void expect_gantry_refused(void)
{
    expect(TAKT_ERROR_MACHINE_GANTRY, "a gantry needs X, Y or Z on CAN, a free node, skew_max_mm, "
                                      "no gap; 6 drives at most");
}

static void test_gantries_follow_each_other_on_axes_and_nodes_of_their_own(void)
{
    const struct machine_gantry y = {.axis = AXIS_Y, .drive_node = 9, .skew_max_mm = 1};
    const struct machine_gantry x = {.axis = AXIS_X, .drive_node = 8, .skew_max_mm = 1};
    const struct machine_gantry none = machine.gantry[0];

    machine.cycle_us = 2000;
    machine.gantry[0] = y;
    machine.gantry[1] = x;
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
    machine.gantry[1].axis = AXIS_Y;
    expect_gantry_refused();
    machine.gantry[1] = x;
    machine.gantry[1].drive_node = 9;
    expect_gantry_refused();
    machine.gantry[1] = x;
    machine.gantry[0] = none;
    expect_gantry_refused();
}

static void test_a_home_of_the_makers_method_is_told_for_a_reversed_motor(void)
{
    machine.gantry[0] = (struct machine_gantry){.axis = AXIS_Y, .drive_node = 9, .skew_max_mm = 1};
    machine.axis[AXIS_Y].home_method = -3;
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
    machine.gantry[0].is_reversed = 1;
    expect(TAKT_ERROR_MACHINE_GANTRY_HOME, "gantry of axis Y: a maker's home_method and a reversed "
                                           "motor need one in [gantry], too");
    machine.gantry[0].home_method = -4;
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
    machine.axis[AXIS_Z].home_method = 0;
    expect(TAKT_ERROR_MACHINE_HOME_METHOD,
           "axis Z: home_method is 1 ... 37, or below 0 a method of the drive's maker");
}

static void test_a_gantry_has_a_second_drive_on_can_and_an_alarm(void)
{
    const struct machine_gantry good = {.axis = AXIS_Y, .drive_node = 9, .skew_max_mm = 1};

    machine.gantry[0] = good;
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
    machine.gantry[0].skew_max_mm = 0;
    expect_gantry_refused();
    machine.gantry[0] = good;
    machine.gantry[0].drive_node = 2;
    expect_gantry_refused();
    machine.gantry[0] = good;
    machine.axis[AXIS_Y].drive_type = MACHINE_DRIVE_STEP;
    expect_gantry_refused();
    machine.gantry[0] = good;
    machine.gantry[0].axis = AXIS_A;
    expect_gantry_refused();
    machine.gantry[0] = good;
    machine.io[0].node = 9;
    expect(TAKT_ERROR_MACHINE_IO_NODE, "io 1: another node on the bus has its id 9");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_io_nodes_follow_each_other_and_have_ids_of_their_own);
    RUN_TEST(test_gantries_follow_each_other_on_axes_and_nodes_of_their_own);
    RUN_TEST(test_a_home_of_the_makers_method_is_told_for_a_reversed_motor);
    RUN_TEST(test_a_gantry_has_a_second_drive_on_can_and_an_alarm);
    RUN_TEST(test_a_travel_has_two_ends_and_zero_between_them);
    RUN_TEST(test_positions_fit_the_drives_32_bits);
    RUN_TEST(test_data_of_can_fd_are_as_fast_as_the_rest);
    RUN_TEST(test_limits_stand_above_the_rounding_of_setpoints);
    RUN_TEST(test_steps_come_no_faster_than_the_drive_takes_them);
    RUN_TEST(test_every_node_has_its_own_number);
    RUN_TEST(test_a_node_id_is_free_on_another_bus);
    RUN_TEST(test_the_bus_carries_the_cycle);
    RUN_TEST(test_a_machine_has_an_axis);
    return UNITY_END();
}
