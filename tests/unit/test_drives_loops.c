/*
 * Object 2020: gains of the loops and the inertia they are told, while they run; and a torque that
 * comes late. 10 mm a turn, a cycle of 1 ms of four steps.
 */
#include "lone_drive.h"

#include <math.h>

#define CSP 8
#define CST 10

#define LOOPS 0x2020

#define TOO_HIGH 0x06090031u
#define TOO_LOW  0x06090032u

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone.config.increments_per_mm = 1e5;
    lone.config.plant.viscous_friction_nm_s_per_rad = 0;
}

void tearDown(void)
{
}

static void set(uint8_t sub, uint32_t value)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, LOOPS, sub, sub < 5 ? 4 : 2, value));
}

static void test_it_says_what_the_machine_has(void)
{
    lone.config.plant.torque_feed_forward_ratio = 0.25;
    lone_start(&lone);
    TEST_ASSERT_EQUAL_UINT32(300000, lone_read(&lone, LOOPS, 1)); /* g mm2 */
    TEST_ASSERT_EQUAL_UINT32(100000, lone_read(&lone, LOOPS, 2)); /* mHz */
    TEST_ASSERT_EQUAL_UINT32(20000, lone_read(&lone, LOOPS, 3));  /* us */
    TEST_ASSERT_EQUAL_UINT32(100000, lone_read(&lone, LOOPS, 4)); /* 0.001/s */
    TEST_ASSERT_EQUAL_UINT32(1000, lone_read(&lone, LOOPS, 5));
    TEST_ASSERT_EQUAL_UINT32(250, lone_read(&lone, LOOPS, 6));
}

/* 10 mm/s to and on, without feed-forward: the lag is v / Kv. */
static double lag_mm(void)
{
    const double at = lone_actual(&lone) / 1e5;

    for (int k = 1; k <= 1500; k++) {
        const int32_t target = (int32_t)lround(1e5 * (at + 0.01 * k));

        TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x607A, 0, 4, (uint32_t)target));
        lone_sync(&lone);
        lone_step(&lone, 1);
    }
    return (int32_t)lone_read(&lone, 0x60F4, 0) / 1e5;
}

static void test_a_gain_is_in_force_when_it_is_written(void)
{
    lone_start(&lone);
    lone_enable(&lone, CSP);
    set(5, 0);
    TEST_ASSERT_DOUBLE_WITHIN(2e-4, 0.1, lag_mm());
    set(4, 50000);
    TEST_ASSERT_DOUBLE_WITHIN(2e-4, 0.2, lag_mm());
}

/*
 * As the torque is what the loops are told of the inertia, times an acceleration: told twice of it
 * is twice the bandwidth.
 */
static void test_what_is_told_of_the_inertia_scales_the_gain(void)
{
    lone_start(&lone);
    lone_enable(&lone, CSP);
    const double gain = lone.drive.servo.loop.velocity_gain_per_s;

    set(1, 600000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * gain, 2 * gain, lone.drive.servo.loop.velocity_gain_per_s);
    set(2, 50000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * gain, gain, lone.drive.servo.loop.velocity_gain_per_s);
}

static void test_what_makes_no_sense_is_not_taken(void)
{
    lone_start(&lone);
    TEST_ASSERT_EQUAL_HEX32(TOO_LOW, lone_write(&lone, LOOPS, 1, 4, 0));
    TEST_ASSERT_EQUAL_HEX32(TOO_LOW, lone_write(&lone, LOOPS, 4, 4, 0));
    TEST_ASSERT_EQUAL_HEX32(TOO_HIGH, lone_write(&lone, LOOPS, 5, 2, 1001));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, LOOPS, 2, 4, 318310)); /* 2 pi f 250 us = 0.5 */
    TEST_ASSERT_EQUAL_HEX32(TOO_HIGH, lone_write(&lone, LOOPS, 2, 4, 318311));
}

static void test_what_is_stored_comes_back_with_a_reset(void)
{
    lone_start(&lone);
    set(4, 77000);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1010, 1, 4, 0x65766173)); /* save */
    set(4, 88000);
    lone_nmt(&lone, NMT_RESET_NODE);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT32(77000, lone_read(&lone, LOOPS, 4));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 77, lone.drive.servo.loop.config.position_gain_per_s);
}

/* Half of the rated torque, six steps late: v = a t from there on, which is 1.5 cycles. */
static void test_a_torque_that_comes_late(void)
{
    const double a = 10 / 6.283185307179586 * 0.635 / 3e-4;

    lone.config.plant.torque_delay_steps = 6;
    lone_start(&lone);
    lone_enable(&lone, CST);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6071, 0, 2, 500));
    lone_step(&lone, 1);
    TEST_ASSERT_TRUE(lone.drive.plant.velocity_mm_s == 0);
    lone_step(&lone, 3);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, a * 2.5e-3, lone.drive.plant.velocity_mm_s);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_says_what_the_machine_has);
    RUN_TEST(test_a_gain_is_in_force_when_it_is_written);
    RUN_TEST(test_what_is_told_of_the_inertia_scales_the_gain);
    RUN_TEST(test_what_makes_no_sense_is_not_taken);
    RUN_TEST(test_what_is_stored_comes_back_with_a_reset);
    RUN_TEST(test_a_torque_that_comes_late);
    return UNITY_END();
}
