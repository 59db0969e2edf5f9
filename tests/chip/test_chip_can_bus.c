/* The CAN driver and its bus: bit rates, what it does when the bus is lost, errors. */
#include "can_bench.h"

/* ---- bit timing ---- */

static bool open_at(uint32_t clock_hz, uint32_t bitrate)
{
    const struct can_config config = {.clock_hz = clock_hz, .rates = {bitrate, 0}};

    return takt_can_controller_open(&can, &config);
}

static void check_timing(uint32_t clock_hz, uint32_t bitrate)
{
    struct can_model_bit bit;

    TEST_ASSERT_TRUE(open_at(clock_hz, bitrate));
    can_model_get_bit(&bit);
    TEST_ASSERT_EQUAL(clock_hz, bitrate * bit.quanta * bit.divider);
    TEST_ASSERT_DOUBLE_WITHIN(0.04, 0.875, (double)bit.sampled / bit.quanta);
    TEST_ASSERT_LESS_OR_EQUAL(bit.quanta - bit.sampled, bit.jump);
}

static void test_the_bit_rates_of_canopen_are_exact_and_sampled_near_seven_eighths(void)
{
    static const uint32_t rates[] = {1000000, 500000, 250000, 125000, 50000, 20000, 10000};

    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        check_timing(can_model_clock_hz, rates[i]);
        check_timing(16000000, rates[i]);
    }
}

static void check_refused(uint32_t bitrate)
{
    const struct can_rates rates = {bitrate, 0};

    TEST_ASSERT_EQUAL(bitrate, takt_can_hardware_find_impossible(can_model_clock_hz, &rates));
    TEST_ASSERT_FALSE(open_at(can_model_clock_hz, bitrate));
    TEST_ASSERT_EQUAL(CAN_ABSENT, takt_can_controller_get_state(&can));
}

static void test_a_rate_the_clock_cannot_be_divided_into_is_refused(void)
{
    check_refused(810000); /* 51.9 and 98.8 */
    check_refused(30000000);
    TEST_ASSERT_FALSE(open_at(can_model_clock_hz, 0));
}

/* ---- the bus ---- */

static void test_after_bus_off_what_was_to_be_sent_is_dropped_and_the_bus_joined_again(void)
{
    struct can_frame frame;

    for (unsigned i = 0; i < 10; i++)
        send(0x201 + i, i);
    TEST_ASSERT_TRUE(can_model_begin(&frame));
    can_model_lose_bus();
    takt_can_controller_poll(&can);
    interrupt();
    TEST_ASSERT_EQUAL(CAN_BUS_OFF, takt_can_controller_get_state(&can));
    TEST_ASSERT_FALSE(send(0x80, 1));
    for (int i = 0; i < 100; i++)
        takt_can_controller_poll(&can);
    TEST_ASSERT_EQUAL(CAN_REJOINING, takt_can_controller_get_state(&can));
    TEST_ASSERT_FALSE(send(0x80, 1));
    can_model_calm();
    for (int i = 0; i < 100; i++)
        takt_can_controller_poll(&can);
    TEST_ASSERT_EQUAL(CAN_ON, takt_can_controller_get_state(&can));
    expect_silence();
    TEST_ASSERT_EQUAL(10, takt_can_controller_get_counts(&can)->dropped);
    TEST_ASSERT_EQUAL(1, takt_can_controller_get_counts(&can)->bus_offs);
    TEST_ASSERT_TRUE(send(0x80, 7));
    expect(0x80, 7);
}

static void test_a_bus_lost_a_hundred_times_is_joined_a_hundred_times(void)
{
    for (unsigned i = 0; i < 100; i++) {
        send(0x201, i);
        send(0x80, i);
        can_model_lose_bus();
        for (int polls = 0; polls < 150; polls++) {
            takt_can_controller_poll(&can);
            interrupt();
            if (polls == 100)
                can_model_calm();
        }
        TEST_ASSERT_EQUAL(CAN_ON, takt_can_controller_get_state(&can));
        TEST_ASSERT_TRUE(send(0x80, i));
        expect(0x80, i);
    }
    TEST_ASSERT_EQUAL(100, takt_can_controller_get_counts(&can)->bus_offs);
}

static void test_a_frame_called_back_when_the_bus_is_lost_is_dropped_too(void)
{
    struct can_frame frame;

    for (unsigned id = 0x601; id <= 0x603; id++)
        send(id, id);
    TEST_ASSERT_TRUE(can_model_begin(&frame));
    send(0x80, 1);
    can_model_lose_bus();
    takt_can_controller_poll(&can);
    interrupt();
    can_model_calm();
    for (int i = 0; i < 200; i++) {
        takt_can_controller_poll(&can);
        can_model_calm();
    }
    TEST_ASSERT_EQUAL(CAN_ON, takt_can_controller_get_state(&can));
    expect_silence();
    TEST_ASSERT_EQUAL(4, takt_can_controller_get_counts(&can)->dropped);
}

static void test_without_a_controller_opening_ends_and_says_so(void)
{
    chip_model_reset();
    can_model.is_absent = true;
    TEST_ASSERT_FALSE(open_for(0, NULL));
    TEST_ASSERT_EQUAL(CAN_ABSENT, takt_can_controller_get_state(&can));
    TEST_ASSERT_LESS_THAN(100000, chip_model_reads());
    TEST_ASSERT_FALSE(send(0x80, 1));
    takt_can_controller_poll(&can);
    TEST_ASSERT_EQUAL(CAN_ABSENT, takt_can_controller_get_state(&can));
}

static void test_a_bus_that_is_not_idle_is_waited_for_without_standing_still(void)
{
    chip_model_reset();
    can_model.bus_is_idle = false;
    TEST_ASSERT_TRUE(open_for(0, NULL));
    TEST_ASSERT_LESS_THAN(100000, chip_model_reads());
    TEST_ASSERT_EQUAL(CAN_WAITING, takt_can_controller_get_state(&can));
    TEST_ASSERT_FALSE(send(0x80, 1));
    takt_can_controller_poll(&can);
    TEST_ASSERT_EQUAL(CAN_WAITING, takt_can_controller_get_state(&can));
    can_model.bus_is_idle = true;
    takt_can_controller_poll(&can);
    TEST_ASSERT_EQUAL(CAN_ON, takt_can_controller_get_state(&can));
    TEST_ASSERT_TRUE(send(0x80, 1));
    expect(0x80, 1);
}

static void test_errors_are_counted_by_their_code(void)
{
    unsigned sending, receiving;

    can_model_set_errors(3, 128, 7);
    for (int i = 0; i < 5; i++)
        takt_can_controller_poll(&can); /* the same error is counted once */
    takt_can_hardware_get_errors(&sending, &receiving);
    TEST_ASSERT_EQUAL(128, sending);
    TEST_ASSERT_EQUAL(7, receiving);
    TEST_ASSERT_EQUAL(1, takt_can_controller_get_counts(&can)->error[3]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_bit_rates_of_canopen_are_exact_and_sampled_near_seven_eighths);
    RUN_TEST(test_a_rate_the_clock_cannot_be_divided_into_is_refused);
    RUN_TEST(test_after_bus_off_what_was_to_be_sent_is_dropped_and_the_bus_joined_again);
    RUN_TEST(test_a_bus_lost_a_hundred_times_is_joined_a_hundred_times);
    RUN_TEST(test_a_frame_called_back_when_the_bus_is_lost_is_dropped_too);
    RUN_TEST(test_without_a_controller_opening_ends_and_says_so);
    RUN_TEST(test_a_bus_that_is_not_idle_is_waited_for_without_standing_still);
    RUN_TEST(test_errors_are_counted_by_their_code);
    return UNITY_END();
}
