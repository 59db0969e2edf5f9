/*
 * Virtual step drives: what they count.
 */
#include "stepper/virtual_steppers.h"
#include "unity.h"

static struct virtual_steppers steppers;
static struct step_port port;

void setUp(void)
{
    struct virtual_stepper_config config[AXIS_COUNT] = {
        {true, 1, 100000}, {true, 0, 100000}, {false, 1, 100000}};

    virtual_steppers_init(&steppers, config, 1000000);
    port = virtual_steppers_get_port(&steppers);
}

void tearDown(void)
{
}

static void pulse(uint32_t time_ns, uint8_t axes, uint8_t direction)
{
    const struct step_pulse p = {time_ns, axes, direction};

    TEST_ASSERT_TRUE(port.pulse(port.context, &p));
}

static void test_steps_forth_and_back_are_counted(void)
{
    pulse(0, 3, 2);
    pulse(20000, 1, 0);
    pulse(40000, 1, 1);
    TEST_ASSERT_EQUAL_INT32(1, steppers.axis[0].position_steps);
    TEST_ASSERT_EQUAL_UINT64(3, steppers.axis[0].steps);
    TEST_ASSERT_EQUAL_UINT64(1, steppers.axis[0].reversals);
    TEST_ASSERT_EQUAL_INT32(-1, steppers.axis[1].position_steps);
}

static void test_a_step_faster_than_the_motor_follows_is_missed_and_moves_nothing(void)
{
    pulse(0, 1, 0);
    pulse(10000, 1, 0); /* 100 kHz: it follows */
    pulse(19000, 1, 0); /* 111 kHz */
    TEST_ASSERT_EQUAL_INT32(2, steppers.axis[0].position_steps);
    TEST_ASSERT_EQUAL_UINT64(1, steppers.axis[0].missed);
    TEST_ASSERT_EQUAL_UINT64(3, steppers.axis[0].steps);
    TEST_ASSERT_DOUBLE_WITHIN(1, 111111, steppers.axis[0].rate_peak_hz);
}

static void test_time_goes_on_over_cycles(void)
{
    pulse(995000, 1, 0);
    virtual_steppers_end_cycle(&steppers);
    pulse(5000, 1, 0); /* 10 us later */
    TEST_ASSERT_EQUAL_UINT64(0, steppers.axis[0].missed);
    TEST_ASSERT_DOUBLE_WITHIN(1, 100000, steppers.axis[0].rate_peak_hz);
}

static void test_pulses_out_of_order_or_beyond_the_cycle_are_counted(void)
{
    pulse(500, 1, 0);
    pulse(400, 2, 0);
    pulse(1000000, 2, 0);
    TEST_ASSERT_EQUAL_UINT64(2, steppers.disordered);
}

static void test_an_encoder_is_there_or_not(void)
{
    int32_t steps = -1;

    pulse(0, 7, 0);
    TEST_ASSERT_TRUE(port.read(port.context, AXIS_X, &steps));
    TEST_ASSERT_EQUAL_INT32(1, steps);
    TEST_ASSERT_FALSE(port.read(port.context, AXIS_Y, &steps));
    TEST_ASSERT_FALSE(port.read(port.context, AXIS_Z, &steps));
    TEST_ASSERT_EQUAL_UINT64(0, steppers.axis[2].steps); /* no such axis */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_steps_forth_and_back_are_counted);
    RUN_TEST(test_a_step_faster_than_the_motor_follows_is_missed_and_moves_nothing);
    RUN_TEST(test_time_goes_on_over_cycles);
    RUN_TEST(test_pulses_out_of_order_or_beyond_the_cycle_are_counted);
    RUN_TEST(test_an_encoder_is_there_or_not);
    return UNITY_END();
}
