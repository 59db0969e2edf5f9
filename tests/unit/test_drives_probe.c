/*
 * Touch probes of a virtual drive: which edge is latched, when, and as what. 1000 increments/mm, a
 * cycle of 1 ms.
 */
#include "lone_drive.h"

#define CSP 8

#define ENABLE     0x01u
#define CONTINUOUS 0x02u
#define INDEX      0x04u
#define RISE       0x10u
#define FALL       0x20u

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
}

static void set_function(unsigned function)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x60B8, 0, 2, function));
}

static unsigned status(void)
{
    return lone_read(&lone, 0x60B9, 0);
}

static int32_t latched(unsigned number)
{
    return (int32_t)lone_read(&lone, (uint16_t)(0x60B9 + number), 0);
}

/* The encoder says so at the beginning and at the end of a cycle. */
static void move(double from_mm, double to_mm)
{
    lone.drive.servo.probe.begin_mm = from_mm;
    lone.drive.servo.loop.measured_mm = to_mm;
}

static void test_the_position_is_that_of_the_moment_within_the_cycle(void)
{
    set_function(ENABLE | RISE);
    TEST_ASSERT_EQUAL_HEX32(1, status());
    move(2, 3);
    takt_servo_touch(&lone.drive.servo, true, 0.25);
    TEST_ASSERT_EQUAL_HEX32(1 | 2, status());
    TEST_ASSERT_EQUAL_INT(2250, latched(1));
    TEST_ASSERT_EQUAL_HEX32(0x10000, lone_read(&lone, 0x60FD, 0) & 0x10000);
}

static void test_each_edge_has_its_own_value_and_bit(void)
{
    set_function(ENABLE | RISE | FALL);
    move(2, 3);
    takt_servo_touch(&lone.drive.servo, true, 1);
    move(3, 4);
    takt_servo_touch(&lone.drive.servo, false, 1);
    TEST_ASSERT_EQUAL_HEX32(1 | 2 | 4, status());
    TEST_ASSERT_EQUAL_INT(3000, latched(1));
    TEST_ASSERT_EQUAL_INT(4000, latched(2));
}

static void test_an_edge_that_is_not_looked_for_is_not_latched(void)
{
    set_function(ENABLE | FALL);
    move(2, 3);
    takt_servo_touch(&lone.drive.servo, true, 1);
    TEST_ASSERT_EQUAL_HEX32(1, status());
    set_function(0);
    TEST_ASSERT_EQUAL_HEX32(0, status());
    takt_servo_touch(&lone.drive.servo, false, 1);
    TEST_ASSERT_EQUAL_HEX32(0, status());
}

static void bounce(void)
{
    for (unsigned i = 0; i < 2; i++) {
        move(i, i + 1);
        takt_servo_touch(&lone.drive.servo, true, 1);
        takt_servo_touch(&lone.drive.servo, false, 1);
    }
}

static void test_the_first_edge_counts_or_in_continuous_mode_the_last(void)
{
    set_function(ENABLE | RISE);
    bounce();
    TEST_ASSERT_EQUAL_INT(1000, latched(1));
    set_function(0);
    set_function(ENABLE | RISE | CONTINUOUS);
    bounce();
    TEST_ASSERT_EQUAL_INT(2000, latched(1));
}

static void test_enabling_begins_anew_and_writing_the_same_again_does_not(void)
{
    set_function(ENABLE | RISE);
    bounce();
    set_function(ENABLE | RISE);
    TEST_ASSERT_EQUAL_HEX32(1 | 2, status());
    set_function(0);
    set_function(ENABLE | RISE);
    TEST_ASSERT_EQUAL_HEX32(1, status());
}

static void test_touch_probe_2_is_the_same_eight_bits_higher(void)
{
    set_function((ENABLE | RISE) << 8 | ENABLE | FALL);
    move(2, 3);
    takt_servo_touch(&lone.drive.servo, true, 1);
    TEST_ASSERT_EQUAL_HEX32(0x0300 | 1, status());
    TEST_ASSERT_EQUAL_INT(3000, latched(3));
    TEST_ASSERT_EQUAL_INT(0, latched(4));
}

/* 10 mm a turn: a pulse at every 10 mm, whatever the probe does. */
static void test_the_index_pulse_is_latched_where_it_is(void)
{
    lone.config.plant.start_mm = 9.99;
    lone_start(&lone);
    set_function(ENABLE | INDEX | RISE);
    lone_enable(&lone, CSP);
    lone_step(&lone, 100);
    takt_servo_touch(&lone.drive.servo, true, 1);
    TEST_ASSERT_EQUAL_HEX32(1, status());
    (void)lone_write(&lone, 0x607A, 0, 4, 10007);
    lone_step(&lone, 200);
    TEST_ASSERT_EQUAL_HEX32(1 | 2, status());
    TEST_ASSERT_EQUAL_INT(10000, latched(1));
}

static void test_a_motor_that_turns_the_other_way_latches_what_its_position_is(void)
{
    lone.config.increments_per_mm = -1000;
    lone_start(&lone);
    set_function(ENABLE | RISE);
    move(2, 3);
    takt_servo_touch(&lone.drive.servo, true, 0.5);
    TEST_ASSERT_EQUAL_INT(-2500, latched(1));
}

static void test_a_reset_forgets_the_function(void)
{
    set_function(ENABLE | RISE);
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_EQUAL_HEX32(0, lone_read(&lone, 0x60B8, 0));
    TEST_ASSERT_EQUAL_HEX32(0, status());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_position_is_that_of_the_moment_within_the_cycle);
    RUN_TEST(test_each_edge_has_its_own_value_and_bit);
    RUN_TEST(test_an_edge_that_is_not_looked_for_is_not_latched);
    RUN_TEST(test_the_first_edge_counts_or_in_continuous_mode_the_last);
    RUN_TEST(test_enabling_begins_anew_and_writing_the_same_again_does_not);
    RUN_TEST(test_touch_probe_2_is_the_same_eight_bits_higher);
    RUN_TEST(test_the_index_pulse_is_latched_where_it_is);
    RUN_TEST(test_a_motor_that_turns_the_other_way_latches_what_its_position_is);
    RUN_TEST(test_a_reset_forgets_the_function);
    return UNITY_END();
}
