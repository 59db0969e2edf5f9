/*
 * The node of a drive's image (hal/stm32drive/drive_node.h) on the chip's model: over its CAN
 * controller, with its flash.
 */
#include "can_model.h"
#include "canopen/sdo.h"
#include "chip_model.h"
#include "flash_model.h"
#include "stm32/timers.h"
#include "stm32drive/drive_node.h"
#include "timer_model.h"
#include "unity.h"

#include <string.h>

#define BUS_HZ    84000000U
#define PERIOD_US 250U
#define NODE      3U

#define SAVE 0x65766173U
#define LOAD 0x64616F6CU

static struct drive_node node;
static struct can_frame heard[64]; /* what the drive has sent */
static unsigned heard_count;

static void interrupt(void)
{
    while (can_model_asks_sent())
        takt_can_controller_interrupt_sent(&node.can);
    while (can_model_asks_received())
        takt_can_controller_interrupt_received(&node.can);
}

static void listen(void)
{
    struct can_frame frame;

    while (can_model_transfer(&frame)) {
        if (heard_count < sizeof heard / sizeof heard[0])
            heard[heard_count++] = frame;
        interrupt();
    }
}

static void cycles(unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        takt_drive_node_cycle(&node);
        listen();
    }
}

static void start(bool has_crashed)
{
    const struct drive_node_config config = {
        .servo = {.node = NODE,
                  .increments_per_mm = 1000,
                  .quick_stop_deceleration_mm_s2 = 2000,
                  .loop = {.travel_per_revolution_mm = 10,
                           .inertia_kg_m2 = 3e-4,
                           .torque_max_nm = 3.8,
                           .torque_rated_nm = 1.27,
                           .encoder_counts_per_revolution = 10000,
                           .loop_period_us = PERIOD_US,
                           .position_gain_per_s = 100,
                           .velocity_bandwidth_hz = 100}},
        .motor = {.timer_hz = 2 * BUS_HZ,
                  .pulses_hz = 20000,
                  .whole_mm_s2 = 20000,
                  .encoder_step_mm = 0.001,
                  .switches = {{GPIO_C, 0}, {GPIO_C, 1}, {GPIO_B, 1}}},
        .can = {.clock_hz = can_model_clock_hz, .rates = {.nominal = 1000000}},
        .enable = {GPIO_C, 5},
        .mapped = flash_model_memory,
        .has_crashed = has_crashed,
    };

    heard_count = 0;
    TEST_ASSERT_TRUE(takt_drive_node_open(&node, &config));
    takt_timers_start_cycle(BUS_HZ, PERIOD_US);
    listen();
}

void setUp(void)
{
    chip_model_reset();
    flash_model_blank();
    can_model.bus_is_idle = true;
}

void tearDown(void)
{
    TEST_ASSERT_NULL_MESSAGE(chip_model_broken(), chip_model_broken());
}

/* The last frame of this identifier; without one it is empty. */
static struct can_frame find(unsigned id)
{
    for (unsigned i = heard_count; i-- > 0;) {
        if (heard[i].id == id)
            return heard[i];
    }
    return (struct can_frame){.length = 0};
}

static void say(unsigned id, unsigned length, uint32_t low, uint32_t high)
{
    struct can_frame frame = {.id = (uint16_t)id, .length = (uint8_t)length};

    for (unsigned i = 0; i < 4; i++) {
        frame.data[i] = (uint8_t)(low >> 8 * i);
        frame.data[4 + i] = (uint8_t)(high >> 8 * i);
    }
    heard_count = 0;
    TEST_ASSERT_TRUE(can_model_hear(&frame));
    interrupt();
    cycles(1);
}

static uint32_t word_at(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* The abort code; 0: it has been written. */
static uint32_t write(uint32_t index, uint32_t sub, unsigned bytes, uint32_t value)
{
    say(0x600 + NODE, 8, 0x23U | (4U - bytes) << 2 | index << 8 | sub << 24, value);
    const struct can_frame answer = find(0x580 + NODE);
    TEST_ASSERT_EQUAL_UINT8(8, answer.length);
    return answer.data[0] == 0x80 ? word_at(answer.data + 4) : 0;
}

static uint32_t read(uint32_t index, uint32_t sub)
{
    say(0x600 + NODE, 8, 0x40U | index << 8 | sub << 24, 0);
    const struct can_frame answer = find(0x580 + NODE);
    TEST_ASSERT_EQUAL_UINT8(8, answer.length);
    TEST_ASSERT_NOT_EQUAL(0x80, answer.data[0]);
    return word_at(answer.data + 4);
}

static unsigned emergency(void)
{
    const struct can_frame frame = find(0x80 + NODE);

    return frame.data[0] | (unsigned)frame.data[1] << 8;
}

static void enable(void)
{
    say(0, 2, 1U | NODE << 8, 0);
    for (uint32_t word = 6; word <= 15; word += word == 6 ? 1 : 8)
        say(0x200 + NODE, 3, word | 8U << 16, 0);
    TEST_ASSERT_EQUAL(CIA402_ENABLED, takt_servo_get_state(&node.servo));
}

static void test_it_boots_and_answers(void)
{
    start(false);
    const struct can_frame boot = find(0x700 + NODE);
    TEST_ASSERT_EQUAL_UINT8(1, boot.length);
    TEST_ASSERT_EQUAL_UINT8(0, boot.data[0]);
    TEST_ASSERT_EQUAL_HEX32(0x00020192, read(0x1000, 0));
    TEST_ASSERT_EQUAL_UINT(0, emergency());
    TEST_ASSERT_TRUE(watchdog_model_fed() > 0);
}

static void test_what_1010_stores_is_there_after_power_off_and_gone_by_1011(void)
{
    start(false);
    TEST_ASSERT_EQUAL_HEX32(0, write(0x2010, 4, 4, 12000));
    TEST_ASSERT_EQUAL_HEX32(0, write(0x6081, 0, 4, 777));
    TEST_ASSERT_EQUAL_HEX32(0, write(0x1017, 0, 2, 50));
    TEST_ASSERT_EQUAL_HEX32(0, write(0x1010, 1, 4, SAVE));
    TEST_ASSERT_EQUAL_HEX32(0, write(0x6081, 0, 4, 888));
    start(false);
    TEST_ASSERT_EQUAL_UINT32(12000, read(0x2010, 4));
    TEST_ASSERT_EQUAL_UINT32(777, read(0x6081, 0));
    TEST_ASSERT_EQUAL_UINT32(50, read(0x1017, 0) & 0xFFFF);
    TEST_ASSERT_EQUAL_HEX32(0, write(0x1011, 1, 4, LOAD));
    start(false);
    TEST_ASSERT_EQUAL_UINT32(0, read(0x2010, 4));
    TEST_ASSERT_EQUAL_UINT32(50000, read(0x6081, 0));
    TEST_ASSERT_EQUAL_UINT(0, emergency());
}

static void test_a_flash_that_fails_and_a_motor_with_torque_store_nothing(void)
{
    start(false);
    TEST_ASSERT_EQUAL_HEX32(0, write(0x6081, 0, 4, 777));
    flash_model.is_protected = true;
    TEST_ASSERT_EQUAL_HEX32(0x06060000, write(0x1010, 1, 4, SAVE));
    flash_model.is_protected = false;
    enable();
    TEST_ASSERT_EQUAL_HEX32(0x06060000, write(0x1010, 1, 4, SAVE));
    start(false);
    TEST_ASSERT_EQUAL_UINT32(50000, read(0x6081, 0));
}

static void test_what_is_stored_by_another_firmware_is_told(void)
{
    static const uint8_t foreign[] = {NODE, 0x00, 0x50, 1, 4, 1, 2, 3, 4};

    start(false);
    TEST_ASSERT_TRUE(takt_store_begin(&node.store, sizeof foreign) &&
                     takt_store_write(&node.store, foreign, sizeof foreign) &&
                     takt_store_commit(&node.store));
    start(false);
    TEST_ASSERT_EQUAL_HEX(0x6310, emergency());
    TEST_ASSERT_EQUAL_UINT32(50000, read(0x6081, 0));
}

static void test_the_power_stage_is_on_while_the_drive_has_torque(void)
{
    start(false);
    cycles(10);
    TEST_ASSERT_FALSE(timer_model_pin_is_high(5));
    enable();
    cycles(10);
    TEST_ASSERT_TRUE(timer_model_pin_is_high(5));
    timer_model_turn(-300);
    cycles(1);
    cycles(1);
    TEST_ASSERT_TRUE(timer_model_get_torque() > 0);
    say(0x200 + NODE, 3, 0, 0);
    cycles(1);
    TEST_ASSERT_FALSE(timer_model_pin_is_high(5));
    TEST_ASSERT_TRUE(timer_model_get_torque() == 0);
}

static void test_a_power_stage_that_fails_is_a_fault_until_it_is_reset(void)
{
    start(false);
    enable();
    cycles(10);
    heard_count = 0;
    timer_model_hold_break(true);
    cycles(200);
    TEST_ASSERT_EQUAL_HEX(0x5400, emergency());
    TEST_ASSERT_EQUAL(CIA402_FAULT, takt_servo_get_state(&node.servo));
    timer_model_hold_break(false);
    say(0x200 + NODE, 3, 0x80 | 8U << 16, 0);
    enable();
    cycles(200);
    TEST_ASSERT_EQUAL(CIA402_ENABLED, takt_servo_get_state(&node.servo));
}

static void test_a_step_that_is_late_is_a_fault_where_there_is_torque(void)
{
    start(false);
    timer_model_hurry();
    cycles(2);
    TEST_ASSERT_EQUAL_UINT(0, emergency());
    enable();
    heard_count = 0;
    timer_model_hurry();
    cycles(200);
    TEST_ASSERT_EQUAL_HEX(0x6100, emergency());
    TEST_ASSERT_EQUAL(CIA402_FAULT, takt_servo_get_state(&node.servo));
}

static void test_after_a_crash_it_starts_in_fault(void)
{
    start(true);
    TEST_ASSERT_EQUAL_HEX(0x6100, emergency());
    cycles(200);
    TEST_ASSERT_EQUAL(CIA402_FAULT, takt_servo_get_state(&node.servo));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_boots_and_answers);
    RUN_TEST(test_what_1010_stores_is_there_after_power_off_and_gone_by_1011);
    RUN_TEST(test_a_flash_that_fails_and_a_motor_with_torque_store_nothing);
    RUN_TEST(test_what_is_stored_by_another_firmware_is_told);
    RUN_TEST(test_the_power_stage_is_on_while_the_drive_has_torque);
    RUN_TEST(test_a_power_stage_that_fails_is_a_fault_until_it_is_reset);
    RUN_TEST(test_a_step_that_is_late_is_a_fault_where_there_is_torque);
    RUN_TEST(test_after_a_crash_it_starts_in_fault);
    return UNITY_END();
}
