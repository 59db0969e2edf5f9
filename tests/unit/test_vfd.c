/*
 * firmware/vfd/vfd.h against the registers of the virtual spindle: the line in between is the
 * test's.
 */
#include "base/maths.h"
#include "spindle/vfd_registers.h"
#include "unity.h"
#include "vfd/vfd.h"

#include <string.h>

#define CYCLE_S  0.001
#define CYCLE_US 1000U

/* Cycles from a request to its answer. */
#define LATENCY 3

static struct vfd vfd;
static struct vfd_registers registers;
static struct modbus_map map;
static struct spindle_feedback feedback;

/* The line. */
static unsigned left; /* cycles until the answer; 0: there is no request */
static bool good, is_cut;
static uint16_t answer[REGISTERS_MAX];
static unsigned requests, commands, resets;
static bool refuses_reset;

static void begin(enum modbus_exception exception)
{
    requests++;
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, left, "one request at a time");
    left = LATENCY;
    good = exception == MODBUS_GOOD;
}

static void line_read(void *context, uint16_t address, uint16_t count)
{
    uint8_t data[2 * REGISTERS_MAX] = {0};

    (void)context;
    begin(is_cut ? MODBUS_BUSY : map.read(map.context, MODBUS_HOLDINGS, address, count, data));
    for (unsigned i = 0; i < count; i++)
        answer[i] = modbus_read16(data + (size_t)2 * i);
}

static void line_write(void *context, uint16_t address, uint16_t count, const uint16_t *word)
{
    uint8_t data[2 * REGISTERS_MAX];

    (void)context;
    commands++;
    for (unsigned i = 0; i < count; i++)
        modbus_write16(data + (size_t)2 * i, word[i]);
    resets += address == VFD_CONTROL;
    if (refuses_reset && address == VFD_CONTROL) {
        begin(MODBUS_BUSY);
        return;
    }
    begin(is_cut ? MODBUS_BUSY : map.write(map.context, MODBUS_HOLDINGS, address, count, data));
}

static enum registers_answer line_take(void *context, uint16_t *word)
{
    (void)context;
    if (left > 1) {
        left--;
        return REGISTERS_WAITING;
    }
    left = 0;
    memcpy(word, answer, sizeof answer);
    return good ? REGISTERS_DONE : REGISTERS_FAILED;
}

static const struct registers_port port = {line_read, line_write, line_take, NULL};

void setUp(void)
{
    const struct vfd_config config = {
        .cycle_us = CYCLE_US,
        .pole_pairs = 1.0,
        .max_hz = 400.0,
        .ramp_rpm_s = 24000.0,
        .at_speed_percent = 2.0,
        .silent_after_us = 100000,
    };
    struct virtual_spindle_config spindle;

    virtual_spindle_set_default(&spindle);
    vfd_registers_init(&registers, &spindle);
    map = vfd_registers_get_map(&registers);
    takt_vfd_init(&vfd, &config);
    left = 0;
    is_cut = false;
    requests = commands = resets = 0;
    refuses_reset = false;
    memset(&feedback, 0, sizeof feedback);
}

void tearDown(void)
{
}

static void run_for(double time_s, double commanded_rpm)
{
    const int cycles = (int)(time_s / CYCLE_S + 0.5);

    for (int i = 0; i < cycles; i++) {
        feedback = takt_vfd_cycle(&vfd, &port, commanded_rpm);
        vfd_registers_step(&registers, CYCLE_S);
    }
}

static void test_it_brings_the_spindle_to_speed_either_way(void)
{
    run_for(3, 12000);
    TEST_ASSERT_DOUBLE_WITHIN(20, 12000, registers.feedback.speed_rpm);
    TEST_ASSERT_DOUBLE_WITHIN(20, 12000, feedback.speed_rpm);
    TEST_ASSERT_TRUE(feedback.at_speed);
    run_for(4, -6000);
    TEST_ASSERT_DOUBLE_WITHIN(20, -6000, registers.feedback.speed_rpm);
    TEST_ASSERT_DOUBLE_WITHIN(20, -6000, feedback.speed_rpm);
    run_for(3, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1, 0, feedback.speed_rpm);
    TEST_ASSERT_EQUAL_HEX16(VFD_STOP, registers.command);
}

static void test_at_speed_is_told_at_speed_and_not_before(void)
{
    run_for(0.5, 12000);
    TEST_ASSERT_FALSE(feedback.at_speed);
    TEST_ASSERT_GREATER_THAN(1000, feedback.speed_rpm);
}

/* The converter could do 12,000 rpm/s; the commanded speed is given 2400. */
static void test_the_commanded_speed_follows_the_ramp(void)
{
    vfd.config.ramp_rpm_s = 2400;
    run_for(1, 12000);
    TEST_ASSERT_DOUBLE_WITHIN(100, 2400, feedback.speed_rpm);
}

static void test_a_command_that_stays_is_written_once(void)
{
    run_for(3, 6000);
    commands = requests = 0;
    run_for(1, 6000);
    TEST_ASSERT_EQUAL_UINT(0, commands);
    TEST_ASSERT_GREATER_THAN(200, requests);
}

static void test_the_load_is_the_converters_torque(void)
{
    run_for(3, 12000);
    registers.cut = 400;
    run_for(1, 12000);
    TEST_ASSERT_DOUBLE_WITHIN(1, registers.feedback.load_percent, feedback.load_percent);
    TEST_ASSERT_GREATER_THAN(39, feedback.load_percent);
}

static void test_a_trip_is_told_and_reset_when_acknowledged(void)
{
    run_for(3, 12000);
    virtual_spindle_set_trip(&registers.spindle, VIRTUAL_SPINDLE_OVERHEAT);
    run_for(0.1, 12000);
    TEST_ASSERT_TRUE(feedback.tripped);
    TEST_ASSERT_FALSE(feedback.at_speed);
    TEST_ASSERT_EQUAL_UINT16(VIRTUAL_SPINDLE_OVERHEAT, vfd.error);
    takt_vfd_reset(&vfd);
    run_for(3, 12000);
    TEST_ASSERT_FALSE(feedback.tripped);
    TEST_ASSERT_TRUE(feedback.at_speed);
}

/* A trip that stays: the register of the reset answers with an exception, all others as ever. */
static void test_a_refused_reset_silences_neither_reports_nor_stop(void)
{
    run_for(3, 3000);
    refuses_reset = true;
    takt_vfd_reset(&vfd);
    takt_vfd_stop(&vfd);
    run_for(1, 0);
    TEST_ASSERT_EQUAL_HEX16(VFD_STOP, registers.command);
    TEST_ASSERT_TRUE(takt_vfd_is_stopped(&vfd));
    TEST_ASSERT_FALSE(feedback.silent);
    TEST_ASSERT_TRUE(resets >= 1 && resets <= 3);
}

static void test_a_line_that_is_cut_is_told_and_mended(void)
{
    run_for(3, 12000);
    is_cut = true;
    run_for(0.09, 12000);
    TEST_ASSERT_FALSE(feedback.silent);
    run_for(0.05, 12000);
    TEST_ASSERT_TRUE(feedback.silent);
    TEST_ASSERT_FALSE(feedback.at_speed);
    is_cut = false;
    run_for(0.1, 12000);
    TEST_ASSERT_FALSE(feedback.silent);
}

/* A converter that has been off has forgotten that it was to run. */
static void test_a_converter_that_comes_back_gets_its_command_again(void)
{
    run_for(3, 12000);
    is_cut = true;
    run_for(1, 12000);
    registers.command = VFD_STOP;
    registers.frequency = 0;
    is_cut = false;
    run_for(3, 12000);
    TEST_ASSERT_TRUE(feedback.at_speed);
}

static void test_a_converter_that_never_answers_is_silent(void)
{
    is_cut = true;
    run_for(1, 0);
    TEST_ASSERT_TRUE(feedback.silent);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_brings_the_spindle_to_speed_either_way);
    RUN_TEST(test_at_speed_is_told_at_speed_and_not_before);
    RUN_TEST(test_the_commanded_speed_follows_the_ramp);
    RUN_TEST(test_a_command_that_stays_is_written_once);
    RUN_TEST(test_the_load_is_the_converters_torque);
    RUN_TEST(test_a_trip_is_told_and_reset_when_acknowledged);
    RUN_TEST(test_a_refused_reset_silences_neither_reports_nor_stop);
    RUN_TEST(test_a_line_that_is_cut_is_told_and_mended);
    RUN_TEST(test_a_converter_that_comes_back_gets_its_command_again);
    RUN_TEST(test_a_converter_that_never_answers_is_silent);
    return UNITY_END();
}
