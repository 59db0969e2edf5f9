#define _XOPEN_SOURCE 700 /* mkstemp, mkdtemp */

#include "config/machine_file.h"
#include "config/machine_keys.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define DEGREE (3.14159265358979323846 / 180.0)

static struct machine_setup setup, again;
static char path[32];

void setUp(void)
{
    int descriptor;

    machine_setup_set_default(&setup);
    (void)snprintf(path, sizeof path, "/tmp/takt-machine-XXXXXX");
    descriptor = mkstemp(path);
    TEST_ASSERT_GREATER_OR_EQUAL(0, descriptor);
    (void)close(descriptor);
}

void tearDown(void)
{
    (void)unlink(path);
}

static bool read_text(const char *text)
{
    FILE *file = fopen(path, "wb");

    TEST_ASSERT_NOT_NULL(file);
    (void)fputs(text, file);
    (void)fclose(file);
    return machine_file_read(&setup, path);
}

/* Every field that a file can set: comparing memory would compare padding. */
static void expect_same_values(void)
{
    char a[MACHINE_SETUP_PATH_MAX + 1], b[MACHINE_SETUP_PATH_MAX + 1];

    for (size_t k = 0; k < machine_keys_count; k++) {
        const struct machine_key *key = &machine_keys[k];
        const unsigned places = key->section == SECTION_IO       ? IO_NODES_MAX
                                : key->section == SECTION_GANTRY ? MACHINE_GANTRIES_MAX
                                                                 : AXIS_COUNT;

        for (unsigned i = 0; i < places; i++) {
            struct machine_place place = {key->section, i};

            machine_key_get(&setup, place, key, a, sizeof a);
            machine_key_get(&again, place, key, b, sizeof b);
            if (setup.machine.axis[i].present)
                TEST_ASSERT_EQUAL_STRING_MESSAGE(a, b, key->name);
        }
    }
    TEST_ASSERT_EQUAL_UINT(takt_machine_axes(&setup.machine), takt_machine_axes(&again.machine));
}

static void test_a_machine_that_is_written_reads_as_the_same_machine(void)
{
    FILE *file = fopen(path, "wb");

    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_TRUE(machine_file_assign(&setup, "axis.B.max_velocity_deg_s=33.3"));
    TEST_ASSERT_TRUE(machine_file_assign(&setup, "axis.B.increments_per_deg=12345.6"));
    TEST_ASSERT_TRUE(machine_file_assign(&setup, "axis.Z.drive_node=77"));
    TEST_ASSERT_TRUE(machine_file_assign(&setup, "drive.77.inertia_kg_m2=0.1"));
    TEST_ASSERT_TRUE(machine_file_assign(&setup, "machine.name=a mill"));
    machine_file_write(file, &setup);
    (void)fclose(file);
    machine_setup_set_default(&again);
    TEST_ASSERT_TRUE(machine_file_read(&again, path));
    expect_same_values();
    TEST_ASSERT_EQUAL_STRING("a mill", again.machine.name);
    TEST_ASSERT_TRUE(setup.machine.axis[AXIS_B].max_velocity_mm_s ==
                     again.machine.axis[AXIS_B].max_velocity_mm_s);
}

static void test_the_default_machine_is_that_of_the_controller(void)
{
    struct machine machine;

    takt_machine_set_default(&machine);
    TEST_ASSERT_NULL(machine_setup_check(&setup));
    TEST_ASSERT_EQUAL_UINT(7, takt_machine_axes(&setup.machine));
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        TEST_ASSERT_EQUAL_MEMORY(&machine.axis[i], &setup.machine.axis[i], sizeof machine.axis[i]);
}

static void test_a_file_that_names_axes_has_no_others(void)
{
    TEST_ASSERT_TRUE(read_text("[axis Y]\n[axis C]\n"));
    TEST_ASSERT_EQUAL_UINT(1u << AXIS_Y | 1u << AXIS_C, takt_machine_axes(&setup.machine));
    TEST_ASSERT_EQUAL_DOUBLE(100, setup.machine.axis[AXIS_Y].max_velocity_mm_s);
}

static void test_a_file_that_names_no_axis_keeps_the_default_ones(void)
{
    TEST_ASSERT_TRUE(read_text("[spindle]\nmax_rpm = 6000\n"));
    TEST_ASSERT_EQUAL_UINT(7, takt_machine_axes(&setup.machine));
    TEST_ASSERT_EQUAL_DOUBLE(6000, setup.machine.spindle_max_rpm);
}

static void test_rotary_values_are_degrees_outside_and_radians_inside(void)
{
    TEST_ASSERT_TRUE(
        read_text("[axis A]\nmax_velocity_deg_s = 180\nincrements_per_deg = 1000\n[drive 4]\n"
                  "travel_per_revolution_deg = 3\n"));
    TEST_ASSERT_EQUAL_DOUBLE(180 * DEGREE, setup.machine.axis[AXIS_A].max_velocity_mm_s);
    TEST_ASSERT_EQUAL_DOUBLE(1000 / DEGREE, setup.machine.axis[AXIS_A].increments_per_mm);
    TEST_ASSERT_EQUAL_DOUBLE(3 * DEGREE, setup.drive[AXIS_A].plant.travel_per_revolution_mm);
}

static void test_a_refused_value_changes_nothing(void)
{
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "axis.X.max_jerk_mm_s3=-1"));
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "axis.X.max_jerk_mm_s3=1e999"));
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "axis.X.max_jerk_mm_s3=nan"));
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "axis.X.max_jerk_mm_s3="));
    TEST_ASSERT_EQUAL_DOUBLE(50000, setup.machine.axis[AXIS_X].max_jerk_mm_s3);
    TEST_ASSERT_TRUE(machine_file_assign(&setup, "axis.X.max_jerk_mm_s3=20000"));
    TEST_ASSERT_EQUAL_DOUBLE(20000, setup.machine.axis[AXIS_X].max_jerk_mm_s3);
}

static void test_a_text_that_no_line_of_a_file_holds_is_refused(void)
{
    TEST_ASSERT_TRUE(machine_file_assign(&setup, "machine.name= a;b # [c] = d\t"));
    TEST_ASSERT_EQUAL_STRING("a;b # [c] = d", setup.machine.name);
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "machine.name=a\n[axis A]"));
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "machine.name=a\rb"));
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "machine.name=a ; b"));
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "machine.name= ;"));
    TEST_ASSERT_FALSE(machine_file_assign(&setup, "machine.tool_table=a\nb"));
    TEST_ASSERT_EQUAL_STRING("a;b # [c] = d", setup.machine.name);
}

static void test_every_key_refuses_what_is_below_and_above_its_range(void)
{
    struct machine_problem wrong;
    char text[64];

    for (size_t k = 0; k < machine_keys_count; k++) {
        const struct machine_key *key = &machine_keys[k];
        struct machine_place place = {key->section, 0};

        if (key->type != KEY_UINT32 && key->type != KEY_UINT8 && key->type != KEY_DOUBLE)
            continue;
        (void)snprintf(text, sizeof text, "%.17g", key->min - 1);
        TEST_ASSERT_FALSE_MESSAGE(machine_key_set(&setup, place, key, text, &wrong), key->name);
        (void)snprintf(text, sizeof text, "%.17g", key->max + 1);
        TEST_ASSERT_FALSE_MESSAGE(machine_key_set(&setup, place, key, text, &wrong), key->name);
        (void)snprintf(text, sizeof text, "%.17g", key->max);
        TEST_ASSERT_TRUE_MESSAGE(machine_key_set(&setup, place, key, text, &wrong), key->name);
    }
}

static void test_the_checks_of_the_whole_machine(void)
{
    setup.machine.axis[AXIS_Y].drive_node = 1;
    TEST_ASSERT_NOT_NULL(strstr(machine_setup_check(&setup), "same drive_node 1"));
    machine_setup_set_default(&setup);
    setup.machine.axis[AXIS_X].travel_min_mm = 1;
    TEST_ASSERT_NOT_NULL(strstr(machine_setup_check(&setup), "axis X"));
    machine_setup_set_default(&setup);
    setup.machine.cycle_us = 250;
    TEST_ASSERT_NOT_NULL(strstr(machine_setup_check(&setup), "bus cannot carry"));
}

/* 500 mm from zero, a cycle of 0.1 ms: doubles are too coarse for a jerk below 500 mm/s3. */
static void test_limits_below_the_rounding_of_setpoints_are_refused(void)
{
    setup.machine.cycle_us = 100;
    setup.machine.can_bitrate = 10000000;
    setup.machine.axis[AXIS_Y].max_jerk_mm_s3 = 499;
    TEST_ASSERT_NOT_NULL(strstr(machine_setup_check(&setup), "axis Y: max_jerk is too low"));
    setup.machine.axis[AXIS_Y].max_jerk_mm_s3 = 501;
    TEST_ASSERT_NULL(machine_setup_check(&setup));
    setup.machine.axis[AXIS_Z].max_acceleration_mm_s2 = 0.24;
    TEST_ASSERT_NOT_NULL(
        strstr(machine_setup_check(&setup), "axis Z: max_acceleration is too low"));
}

/*
 * SYNC 55, three TPDO1 of 6 bytes 3 * 115, a pair of targets 135, one target 95, a TPDO2 115 and a
 * heartbeat 65 now and then: 810 bits of 1000.
 */
static void test_the_predicted_load_of_three_axes_is_81_percent(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(81.0, machine_setup_predict_load_percent(&setup.machine, 0));
}

static const char *check_io(const char *text)
{
    setUp();
    return read_text(text) ? machine_setup_check(&setup) : "unreadable";
}

static void test_the_bits_of_an_io_node_are_read_by_their_names(void)
{
    static const uint8_t outputs[IO_BITS_MAX] = {IO_FLOOD, IO_FREE, IO_PROGRAM + 31,
                                                 IO_SPINDLE_CCW | IO_INVERTED};
    static const uint8_t inputs[IO_BITS_MAX] = {IO_STOP, IO_LIMIT | IO_INVERTED, IO_PROGRAM};

    TEST_ASSERT_NULL(check_io("[io 1]\nnode = 20\noutputs = flood - P31 !ccw\n"
                              "inputs = stop, !limit, P0\n"));
    TEST_ASSERT_EQUAL_UINT(1, takt_machine_io_count(&setup.machine));
    TEST_ASSERT_EQUAL_UINT8_ARRAY(outputs, setup.machine.io[0].output, IO_BITS_MAX);
    TEST_ASSERT_EQUAL_UINT8_ARRAY(inputs, setup.machine.io[0].input, IO_BITS_MAX);
}

static void test_a_gantry_and_io_nodes_that_are_written_read_as_the_same(void)
{
    FILE *file = fopen(path, "wb");

    TEST_ASSERT_NOT_NULL(file);
    setup.machine.gantry[0] = (struct machine_gantry){.axis = AXIS_Y,
                                                      .drive_node = 9,
                                                      .drive_bus = 1,
                                                      .is_reversed = 1,
                                                      .home_method = -3,
                                                      .home_offset_mm = -99.4,
                                                      .skew_max_mm = 0.8};
    setup.drive[MACHINE_SECOND_DRIVE].plant.inertia_kg_m2 = 0.125;
    setup.machine.io[0] =
        (struct io_wiring){20, {IO_FLOOD, IO_FREE, IO_MIST | IO_INVERTED}, {0}, {0x04, 0x10}, 1};
    setup.machine.io[1] = (struct io_wiring){21, {0}, {IO_STOP, IO_PROGRAM + 31}, {0}, 0};
    machine_file_write(file, &setup);
    (void)fclose(file);
    machine_setup_set_default(&again);
    TEST_ASSERT_TRUE(machine_file_read(&again, path));
    TEST_ASSERT_EQUAL_MEMORY(setup.machine.io, again.machine.io, sizeof again.machine.io);
    TEST_ASSERT_EQUAL_UINT(AXIS_Y, again.machine.gantry[0].axis);
    TEST_ASSERT_EQUAL_UINT(9, again.machine.gantry[0].drive_node);
    TEST_ASSERT_EQUAL_UINT(1, again.machine.gantry[0].is_reversed);
    TEST_ASSERT_EQUAL_INT(-3, again.machine.gantry[0].home_method);
    TEST_ASSERT_EQUAL_DOUBLE(-99.4, again.machine.gantry[0].home_offset_mm);
    TEST_ASSERT_EQUAL_DOUBLE(0.8, again.machine.gantry[0].skew_max_mm);
    TEST_ASSERT_EQUAL_DOUBLE(0.125, again.drive[MACHINE_SECOND_DRIVE].plant.inertia_kg_m2);
}

static void test_io_nodes_that_cannot_be_are_refused(void)
{
    static const char *const unreadable[] = {
        "[io 3]\nnode = 20\n",
        "[io 1]\nnode = 0\n",
        "[io 1]\noutputs = stop\n",
        "[io 1]\ninputs = flood\n",
        "[io 1]\ninputs = P32\n",
        "[io 1]\ninputs = P\n",
        "[io 1]\ninputs = P1x\n",
        "[io 1]\ninputs = P0 P1 P2 P3 P4 P5 P6 P7 P8 P9 P10 P11 P12 P13 P14 P15 P16\n"};

    for (size_t i = 0; i < sizeof unreadable / sizeof unreadable[0]; i++)
        TEST_ASSERT_EQUAL_STRING_MESSAGE("unreadable", check_io(unreadable[i]), unreadable[i]);
    TEST_ASSERT_EQUAL_STRING("io 2 is wired wrongly, or has no node before it: the first is io 1",
                             check_io("[io 2]\nnode = 20\n"));
    TEST_ASSERT_EQUAL_STRING("io 1: another node on the bus has its id 2",
                             check_io("[io 1]\nnode = 2\n"));
    TEST_ASSERT_EQUAL_STRING("io 2: another node on the bus has its id 20",
                             check_io("[io 1]\nnode = 20\n[io 2]\nnode = 20\n"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_bits_of_an_io_node_are_read_by_their_names);
    RUN_TEST(test_a_gantry_and_io_nodes_that_are_written_read_as_the_same);
    RUN_TEST(test_io_nodes_that_cannot_be_are_refused);
    RUN_TEST(test_a_machine_that_is_written_reads_as_the_same_machine);
    RUN_TEST(test_the_default_machine_is_that_of_the_controller);
    RUN_TEST(test_a_file_that_names_axes_has_no_others);
    RUN_TEST(test_a_file_that_names_no_axis_keeps_the_default_ones);
    RUN_TEST(test_rotary_values_are_degrees_outside_and_radians_inside);
    RUN_TEST(test_a_refused_value_changes_nothing);
    RUN_TEST(test_a_text_that_no_line_of_a_file_holds_is_refused);
    RUN_TEST(test_every_key_refuses_what_is_below_and_above_its_range);
    RUN_TEST(test_the_checks_of_the_whole_machine);
    RUN_TEST(test_limits_below_the_rounding_of_setpoints_are_refused);
    RUN_TEST(test_the_predicted_load_of_three_axes_is_81_percent);
    return UNITY_END();
}
