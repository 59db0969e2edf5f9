/*
 * CAN FD: two rates, long frames, filters. What classical frames do is in test_chip_can.c, which
 * runs on this model too.
 */
#include "chip_model.h"
#include "fdcan_model.h"
#include "stm32/can_controller.h"
#include "unity.h"

#include <string.h>

static struct can_controller can;
static struct can_port port;

static bool open_at(uint32_t nominal, uint32_t data)
{
    const struct can_config config = {.clock_hz = can_model_clock_hz, .rates = {nominal, data}};
    const bool good = takt_can_controller_open(&can, &config);

    port = takt_can_controller_get_port(&can);
    return good;
}

void setUp(void)
{
    chip_model_reset();
    TEST_ASSERT_TRUE(open_at(1000000, 5000000));
    TEST_ASSERT_EQUAL(CAN_ON, takt_can_controller_get_state(&can));
}

void tearDown(void)
{
    TEST_ASSERT_NULL_MESSAGE(chip_model_broken(), chip_model_broken());
    TEST_ASSERT_EQUAL(0, chip_model_locks());
}

static struct can_frame of_length(uint8_t length)
{
    struct can_frame frame = {.id = 0x201, .length = length};

    for (unsigned i = 0; i < length; i++)
        frame.data[i] = (uint8_t)(3 * i + 1);
    return frame;
}

static void check_same(const struct can_frame *expected, const struct can_frame *frame)
{
    TEST_ASSERT_EQUAL_HEX(expected->id, frame->id);
    TEST_ASSERT_EQUAL(expected->length, frame->length);
    TEST_ASSERT_EQUAL_MEMORY(expected->data, frame->data, sizeof expected->data);
}

static const uint8_t lengths[] = {0, 1, 7, 8, 12, 16, 20, 24, 32, 48, 64};

static void test_frames_of_every_length_are_sent_as_fd_with_fast_data(void)
{
    for (size_t i = 0; i < sizeof lengths; i++) {
        const struct can_frame frame = of_length(lengths[i]);
        struct can_frame sent;

        TEST_ASSERT_TRUE(port.send(port.context, &frame));
        TEST_ASSERT_TRUE(can_model_transfer(&sent));
        takt_can_controller_interrupt_sent(&can);
        check_same(&frame, &sent);
        TEST_ASSERT_TRUE(fdcan_model.sent_fd && fdcan_model.sent_fast);
    }
    TEST_ASSERT_EQUAL(sizeof lengths, takt_can_controller_get_counts(&can)->sent);
}

static void test_frames_of_every_length_are_received_with_zeros_behind_them(void)
{
    fdcan_model.hears_fd = true;
    for (size_t i = 0; i < sizeof lengths; i++) {
        const struct can_frame frame = of_length(lengths[i]);
        struct can_frame received;

        memset(&received, 0x55, sizeof received);
        TEST_ASSERT_TRUE(can_model_hear(&frame));
        takt_can_controller_interrupt_received(&can);
        TEST_ASSERT_TRUE(port.receive(port.context, &received));
        check_same(&frame, &received);
    }
}

static void test_remote_frames_are_classical(void)
{
    const struct can_frame guard = {.id = CAN_REMOTE | 0x701, .length = 1};
    struct can_frame sent;

    TEST_ASSERT_TRUE(port.send(port.context, &guard));
    TEST_ASSERT_TRUE(can_model_transfer(&sent));
    check_same(&guard, &sent);
    TEST_ASSERT_FALSE(fdcan_model.sent_fd);
}

static void test_without_a_data_rate_all_frames_are_classical(void)
{
    const struct can_frame frame = of_length(8);
    struct can_model_bit bit;
    struct can_frame sent;
    unsigned offset;

    chip_model_reset();
    TEST_ASSERT_TRUE(open_at(1000000, 0));
    TEST_ASSERT_FALSE(fdcan_model_get_data_bit(&bit, &offset));
    TEST_ASSERT_TRUE(port.send(port.context, &frame));
    TEST_ASSERT_TRUE(can_model_transfer(&sent));
    check_same(&frame, &sent);
    TEST_ASSERT_FALSE(fdcan_model.sent_fd);
}

/*
 * Both rates exact, of the same quanta, sampled where SocketCAN does; the delay is made up for at
 * that point.
 */
static void check_rates(uint32_t nominal, double nominal_sample, uint32_t data, double data_sample)
{
    struct can_model_bit slow, fast;
    unsigned offset;

    chip_model_reset();
    TEST_ASSERT_TRUE(open_at(nominal, data));
    can_model_get_bit(&slow);
    TEST_ASSERT_TRUE(fdcan_model_get_data_bit(&fast, &offset));
    TEST_ASSERT_EQUAL(can_model_clock_hz, nominal * slow.quanta * slow.divider);
    TEST_ASSERT_EQUAL(can_model_clock_hz, data * fast.quanta * fast.divider);
    TEST_ASSERT_EQUAL(slow.divider, fast.divider);
    TEST_ASSERT_DOUBLE_WITHIN(0.51 / slow.quanta, nominal_sample,
                              (double)slow.sampled / slow.quanta);
    TEST_ASSERT_DOUBLE_WITHIN(0.51 / fast.quanta, data_sample, (double)fast.sampled / fast.quanta);
    TEST_ASSERT_EQUAL(slow.quanta - slow.sampled, slow.jump);
    TEST_ASSERT_EQUAL(fast.quanta - fast.sampled, fast.jump);
    TEST_ASSERT_EQUAL(fast.divider <= 2 ? fast.sampled * fast.divider : 0, offset);
}

static void test_the_rates_of_canopen_fd_are_exact_and_sampled_where_socketcan_does(void)
{
    check_rates(1000000, 0.75, 1000000, 0.75);
    check_rates(1000000, 0.75, 2000000, 0.75);
    check_rates(1000000, 0.75, 4000000, 0.75);
    check_rates(1000000, 0.75, 5000000, 0.75);
    check_rates(1000000, 0.75, 8000000, 0.75);
    check_rates(500000, 0.875, 2000000, 0.75);
    check_rates(250000, 0.875, 1000000, 0.75);
    check_rates(125000, 0.875, 500000, 0.875);
}

static void test_a_data_rate_that_cannot_be_made_is_named(void)
{
    const struct can_rates odd = {1000000, 3000000}, fast = {1000000, 20000000};
    const struct can_rates none = {810000, 5000000};

    TEST_ASSERT_EQUAL(3000000, takt_can_hardware_find_impossible(can_model_clock_hz, &odd));
    TEST_ASSERT_EQUAL(20000000, takt_can_hardware_find_impossible(can_model_clock_hz, &fast));
    TEST_ASSERT_EQUAL(810000, takt_can_hardware_find_impossible(can_model_clock_hz, &none));
    TEST_ASSERT_FALSE(open_at(1000000, 3000000));
    TEST_ASSERT_EQUAL(CAN_ABSENT, takt_can_controller_get_state(&can));
}

static void test_errors_in_fast_data_are_counted_by_their_code(void)
{
    fdcan_model_set_data_error(6);
    for (int i = 0; i < 5; i++)
        takt_can_controller_poll(&can);
    TEST_ASSERT_EQUAL(1, takt_can_controller_get_counts(&can)->error[6]);
}

static void test_after_bus_off_frames_are_fd_as_before(void)
{
    const struct can_frame frame = of_length(64);
    struct can_frame sent;

    TEST_ASSERT_TRUE(port.send(port.context, &frame));
    can_model_lose_bus();
    for (int i = 0; i < 100; i++) {
        takt_can_controller_poll(&can);
        can_model_calm();
    }
    TEST_ASSERT_EQUAL(CAN_ON, takt_can_controller_get_state(&can));
    TEST_ASSERT_EQUAL(1, takt_can_controller_get_counts(&can)->dropped);
    TEST_ASSERT_FALSE(can_model_begin(&sent));
    TEST_ASSERT_TRUE(port.send(port.context, &frame));
    TEST_ASSERT_TRUE(can_model_transfer(&sent));
    check_same(&frame, &sent);
    TEST_ASSERT_TRUE(fdcan_model.sent_fast);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_frames_of_every_length_are_sent_as_fd_with_fast_data);
    RUN_TEST(test_frames_of_every_length_are_received_with_zeros_behind_them);
    RUN_TEST(test_remote_frames_are_classical);
    RUN_TEST(test_without_a_data_rate_all_frames_are_classical);
    RUN_TEST(test_the_rates_of_canopen_fd_are_exact_and_sampled_where_socketcan_does);
    RUN_TEST(test_a_data_rate_that_cannot_be_made_is_named);
    RUN_TEST(test_errors_in_fast_data_are_counted_by_their_code);
    RUN_TEST(test_after_bus_off_frames_are_fd_as_before);
    return UNITY_END();
}
