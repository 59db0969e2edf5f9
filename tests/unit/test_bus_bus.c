#include "bus/bus.h"
#include "unity.h"

#include <string.h>

#define BIT_NS UINT64_C(1000)

static struct bus bus;

/* What an observer or a node has seen. */
struct record {
    unsigned count;
    struct can_frame frame[512];
    uint64_t time_ns[512];
};

static struct record seen;

static void record_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    struct record *record = context;
    if (record->count < 512) {
        record->frame[record->count] = *frame;
        record->time_ns[record->count] = time_ns;
    }
    record->count++;
}

void setUp(void)
{
    TEST_ASSERT_TRUE(bus_init(&bus, 1000000));
    memset(&seen, 0, sizeof seen);
    bus_observe(&bus, &(struct bus_listener){record_frame, &seen});
}

void tearDown(void)
{
}

static bool send_frame(const struct can_port *port, unsigned id, unsigned length)
{
    struct can_frame frame = {.id = (uint16_t)id, .length = (uint8_t)length};
    return port->send(port->context, &frame);
}

static bool receive(const struct can_port *port, struct can_frame *frame)
{
    return port->receive(port->context, frame);
}

static uint64_t length_ns(unsigned id, unsigned length)
{
    struct can_frame frame = {.id = (uint16_t)id, .length = (uint8_t)length};
    return frame_bits_count(&bus.tables, &frame) * BIT_NS;
}

static void test_a_frame_ends_after_its_exact_length(void)
{
    struct can_port port = bus_attach(&bus, NULL);
    uint64_t end_ns = length_ns(0x123, 8);
    TEST_ASSERT_TRUE(send_frame(&port, 0x123, 8));
    bus_run_until(&bus, end_ns - 1);
    TEST_ASSERT_EQUAL_UINT(0, seen.count);
    TEST_ASSERT_FALSE(bus_is_quiet(&bus));
    bus_run_until(&bus, end_ns);
    TEST_ASSERT_EQUAL_UINT(1, seen.count);
    TEST_ASSERT_TRUE(seen.time_ns[0] == end_ns);
    TEST_ASSERT_TRUE(bus_is_quiet(&bus));
}

static void test_all_other_ports_receive_and_the_sender_does_not(void)
{
    struct can_port first = bus_attach(&bus, NULL), second = bus_attach(&bus, NULL);
    struct can_port third = bus_attach(&bus, NULL);
    struct can_frame frame;
    TEST_ASSERT_TRUE(send_frame(&second, 0x55, 2));
    bus_run_until(&bus, 1000000);
    TEST_ASSERT_TRUE(receive(&first, &frame));
    TEST_ASSERT_EQUAL_HEX16(0x55, frame.id);
    TEST_ASSERT_EQUAL_INT(2, frame.length);
    TEST_ASSERT_FALSE(receive(&first, &frame));
    TEST_ASSERT_FALSE(receive(&second, &frame));
    TEST_ASSERT_TRUE(receive(&third, &frame));
}

static void test_the_lowest_identifier_goes_first_whoever_asked_first(void)
{
    struct can_port first = bus_attach(&bus, NULL), second = bus_attach(&bus, NULL);
    TEST_ASSERT_TRUE(send_frame(&first, 0x300, 8));
    TEST_ASSERT_TRUE(send_frame(&second, 0x200, 0));
    TEST_ASSERT_TRUE(send_frame(&first, 0x100, 1));
    TEST_ASSERT_TRUE(send_frame(&second, 0x180, 1));
    bus_run_until(&bus, 1000000);
    TEST_ASSERT_EQUAL_UINT(4, seen.count);
    TEST_ASSERT_EQUAL_HEX16(0x100, seen.frame[0].id);
    TEST_ASSERT_EQUAL_HEX16(0x180, seen.frame[1].id);
    TEST_ASSERT_EQUAL_HEX16(0x200, seen.frame[2].id);
    TEST_ASSERT_EQUAL_HEX16(0x300, seen.frame[3].id);
}

static void
test_a_remote_frame_goes_behind_the_frame_it_asks_for_and_before_the_next_identifier(void)
{
    struct can_port first = bus_attach(&bus, NULL), second = bus_attach(&bus, NULL);
    TEST_ASSERT_TRUE(send_frame(&first, 0x301, 0));
    TEST_ASSERT_TRUE(send_frame(&first, CAN_REMOTE | 0x300, 1));
    TEST_ASSERT_TRUE(send_frame(&second, 0x300, 1));
    bus_run_until(&bus, 1000000);
    TEST_ASSERT_EQUAL_HEX16(0x300, seen.frame[0].id);
    TEST_ASSERT_EQUAL_HEX16(CAN_REMOTE | 0x300, seen.frame[1].id);
    TEST_ASSERT_EQUAL_HEX16(0x301, seen.frame[2].id);
}

static void test_frames_of_one_identifier_keep_their_order(void)
{
    struct can_port port = bus_attach(&bus, NULL);
    for (unsigned length = 0; length <= 8; length++)
        TEST_ASSERT_TRUE(send_frame(&port, 0x222, length));
    bus_run_until(&bus, 10000000);
    for (unsigned length = 0; length <= 8; length++)
        TEST_ASSERT_EQUAL_INT(length, seen.frame[length].length);
}

static void test_a_frame_on_the_wire_is_not_overtaken(void)
{
    struct can_port port = bus_attach(&bus, NULL);
    TEST_ASSERT_TRUE(send_frame(&port, 0x700, 8));
    bus_run_until(&bus, 10000);
    TEST_ASSERT_TRUE(send_frame(&port, 0x001, 0));
    bus_run_until(&bus, 1000000);
    TEST_ASSERT_EQUAL_HEX16(0x700, seen.frame[0].id);
    TEST_ASSERT_EQUAL_HEX16(0x001, seen.frame[1].id);
}

static void test_frames_follow_each_other_after_three_bits(void)
{
    struct can_port port = bus_attach(&bus, NULL);
    TEST_ASSERT_TRUE(send_frame(&port, 0x100, 3));
    TEST_ASSERT_TRUE(send_frame(&port, 0x101, 5));
    bus_run_until(&bus, 1000000);
    uint64_t expected_ns = length_ns(0x100, 3) + 3 * BIT_NS + length_ns(0x101, 5);
    TEST_ASSERT_TRUE(seen.time_ns[1] == expected_ns);
}

static void test_an_idle_bus_begins_at_once(void)
{
    struct can_port port = bus_attach(&bus, NULL);
    bus_run_until(&bus, 777);
    TEST_ASSERT_TRUE(send_frame(&port, 0x100, 3));
    bus_run_until(&bus, 1000000);
    TEST_ASSERT_TRUE(seen.time_ns[0] == 777 + length_ns(0x100, 3));
}

static void test_a_slower_bus_takes_longer_in_proportion(void)
{
    TEST_ASSERT_TRUE(bus_init(&bus, 125000));
    bus_observe(&bus, &(struct bus_listener){record_frame, &seen});
    struct can_port port = bus_attach(&bus, NULL);
    TEST_ASSERT_TRUE(send_frame(&port, 0x100, 3));
    bus_run_until(&bus, 10000000);
    TEST_ASSERT_TRUE(seen.time_ns[0] == 8 * length_ns(0x100, 3));
}

static void test_a_bit_rate_out_of_range_is_refused(void)
{
    TEST_ASSERT_FALSE(bus_init(&bus, 0));
    TEST_ASSERT_FALSE(bus_init(&bus, BUS_BITRATE_MIN - 1));
    TEST_ASSERT_FALSE(bus_init(&bus, BUS_BITRATE_MAX + 1));
}

/* A node that answers each frame of identifier 0x080 by its own. */
struct node {
    struct can_port port;
    uint16_t answer;
};

static void answer_sync(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    const struct node *node = context;
    (void)time_ns;
    if (frame->id == 0x080) {
        TEST_ASSERT_TRUE(send_frame(&node->port, node->answer, 6));
    }
}

static void test_nodes_answer_when_the_frame_ends_and_their_answers_compete(void)
{
    struct node nodes[2] = {{.answer = 0x182}, {.answer = 0x181}};
    struct can_port controller = bus_attach(&bus, NULL);
    for (unsigned i = 0; i < 2; i++)
        nodes[i].port = bus_attach(&bus, &(struct bus_listener){answer_sync, &nodes[i]});
    TEST_ASSERT_TRUE(send_frame(&controller, 0x301, 8));
    TEST_ASSERT_TRUE(send_frame(&controller, 0x080, 0));
    bus_run_until(&bus, 1000000);
    TEST_ASSERT_EQUAL_UINT(4, seen.count);
    TEST_ASSERT_EQUAL_HEX16(0x080, seen.frame[0].id);
    TEST_ASSERT_EQUAL_HEX16(0x181, seen.frame[1].id);
    TEST_ASSERT_EQUAL_HEX16(0x182, seen.frame[2].id);
    TEST_ASSERT_EQUAL_HEX16(0x301, seen.frame[3].id);
}

static void test_a_filter_lets_its_identifiers_through_and_may_change(void)
{
    static struct record heard;
    static uint32_t filter[CAN_FILTER_WORDS];
    struct can_port sender = bus_attach(&bus, NULL);
    (void)bus_attach_filtered(&bus, &(struct bus_listener){record_frame, &heard}, filter);
    memset(&heard, 0, sizeof heard);
    filter[0x123 >> 5] = 1u << (0x123 & 31);
    for (unsigned id = 0; id < 0x200; id += 3)
        TEST_ASSERT_TRUE(
            (bus_run_until(&bus, bus_now_ns(&bus) + 100 * BIT_NS), send_frame(&sender, id, 1)));
    TEST_ASSERT_TRUE(send_frame(&sender, CAN_REMOTE | 0x123, 2));
    bus_run_until(&bus, bus_now_ns(&bus) + 1000 * BIT_NS);
    TEST_ASSERT_EQUAL_UINT(2, heard.count);
    TEST_ASSERT_EQUAL_HEX16(0x123, heard.frame[0].id);
    TEST_ASSERT_EQUAL_HEX16(CAN_REMOTE | 0x123, heard.frame[1].id);
    memset(filter, 0, sizeof filter);
    TEST_ASSERT_TRUE(send_frame(&sender, 0x123, 1));
    bus_run_until(&bus, bus_now_ns(&bus) + 1000 * BIT_NS);
    TEST_ASSERT_EQUAL_UINT(2, heard.count);
}

/* Of 64 bytes, 8 and none: what counts of a frame comes through, and it does not grow. */
static void test_frames_keep_their_data(void)
{
    struct can_port port[2];
    struct can_frame frame, got;
    TEST_ASSERT_TRUE(bus_init_rates(&bus, &(struct frame_rates){1000000, 4000000}));
    for (unsigned i = 0; i < 2; i++)
        port[i] = bus_attach(&bus, NULL);
    const uint8_t lengths[] = {64, 0, 8, 12, 3};
    for (unsigned k = 0; k < sizeof lengths; k++) {
        frame = (struct can_frame){.id = 0x200, .length = lengths[k]};
        for (unsigned i = 0; i < lengths[k]; i++)
            frame.data[i] = (uint8_t)(7 * i + k + 1);
        TEST_ASSERT_TRUE(port[0].send(port[0].context, &frame));
        bus_run_until(&bus, bus_now_ns(&bus) + 1000 * BIT_NS);
        TEST_ASSERT_TRUE(receive(&port[1], &got));
        TEST_ASSERT_EQUAL_UINT(lengths[k], got.length);
        if (lengths[k] > 0)
            TEST_ASSERT_EQUAL_MEMORY(frame.data, got.data, lengths[k]);
    }
}

static void test_a_full_transmit_queue_refuses_and_is_counted(void)
{
    struct can_port port = bus_attach(&bus, NULL);
    for (unsigned i = 0; i < BUS_TRANSMIT_MAX; i++)
        TEST_ASSERT_TRUE(send_frame(&port, 0x100, 0));
    TEST_ASSERT_FALSE(send_frame(&port, 0x100, 0));
    TEST_ASSERT_TRUE(bus.counts.refused == 1);
    bus_run_until(&bus, 10000000);
    TEST_ASSERT_EQUAL_UINT(BUS_TRANSMIT_MAX, seen.count);
    TEST_ASSERT_TRUE(send_frame(&port, 0x100, 0));
}

static void test_a_full_bus_refuses_and_stays_whole(void)
{
    struct can_port port[BUS_WAITING_MAX / BUS_TRANSMIT_MAX + 1];
    unsigned accepted = 0;
    for (unsigned p = 0; p < sizeof port / sizeof port[0]; p++) {
        port[p] = bus_attach(&bus, NULL);
        for (unsigned i = 0; i < BUS_TRANSMIT_MAX; i++)
            accepted += send_frame(&port[p], 0x7FF - accepted, 0);
    }
    TEST_ASSERT_EQUAL_UINT(BUS_WAITING_MAX, accepted);
    bus_run_until(&bus, 100000000);
    TEST_ASSERT_EQUAL_UINT(BUS_WAITING_MAX, seen.count);
    for (unsigned i = 1; i < seen.count; i++)
        TEST_ASSERT_TRUE(seen.frame[i - 1].id < seen.frame[i].id);
}

static void test_a_full_receive_queue_keeps_the_oldest_and_counts_the_rest(void)
{
    struct can_port sender = bus_attach(&bus, NULL), reader = bus_attach(&bus, NULL);
    struct can_frame frame;
    for (unsigned i = 0; i < BUS_RECEIVE_MAX + 10; i++) {
        TEST_ASSERT_TRUE(send_frame(&sender, i, 0));
        bus_run_until(&bus, bus_now_ns(&bus) + 100000);
    }
    TEST_ASSERT_TRUE(bus.counts.receive_lost == 10);
    for (unsigned i = 0; i < BUS_RECEIVE_MAX; i++) {
        TEST_ASSERT_TRUE(receive(&reader, &frame));
        TEST_ASSERT_EQUAL_HEX16(i, frame.id);
    }
    TEST_ASSERT_FALSE(receive(&reader, &frame));
}

static void test_load_is_the_occupied_part_of_the_time(void)
{
    struct can_port port = bus_attach(&bus, NULL);
    TEST_ASSERT_TRUE(bus_load_percent(&bus) == 0);
    TEST_ASSERT_TRUE(send_frame(&port, 0x155, 8));
    TEST_ASSERT_TRUE(send_frame(&port, 0x155, 8));
    bus_run_until(&bus, 1000000);
    uint64_t busy_ns = 2 * (length_ns(0x155, 8) + 3 * BIT_NS);
    TEST_ASSERT_TRUE(bus.counts.busy_ns == busy_ns);
    TEST_ASSERT_TRUE(bus.counts.frames == 2);
    TEST_ASSERT_TRUE(bus_load_percent(&bus) == 100.0 * (double)busy_ns / 1000000);
}

static void test_predicted_load_of_four_axes_is_785_bits_of_1000(void)
{
    static const uint8_t lengths[] = {0, 8, 8, 6, 6, 6, 6};
    unsigned bits = 0;
    for (unsigned i = 0; i < sizeof lengths; i++)
        bits += frame_bits_worst(lengths[i], false).nominal;
    TEST_ASSERT_EQUAL_UINT(785, bits);
}

/* However the time is cut into calls, the same frames end at the same time. */
static void test_the_size_of_the_steps_does_not_matter(void)
{
    static struct record whole;
    struct can_port port = bus_attach(&bus, NULL);
    for (unsigned id = 20; id > 0; id--)
        TEST_ASSERT_TRUE(send_frame(&port, id, id % 9));
    bus_run_until(&bus, 4000000);
    whole = seen;
    setUp();
    port = bus_attach(&bus, NULL);
    for (unsigned id = 20; id > 0; id--)
        TEST_ASSERT_TRUE(send_frame(&port, id, id % 9));
    for (uint64_t time_ns = 0; time_ns <= 4000000; time_ns += 613)
        bus_run_until(&bus, time_ns);
    TEST_ASSERT_EQUAL_UINT(20, whole.count);
    TEST_ASSERT_EQUAL_UINT(20, seen.count);
    TEST_ASSERT_EQUAL_INT(0, memcmp(whole.time_ns, seen.time_ns, 20 * sizeof seen.time_ns[0]));
}

static void test_responses_count_from_one_moment_to_another(void)
{
    struct can_port port = bus_attach(&bus, NULL);

    TEST_ASSERT_TRUE(send_frame(&port, 0x123, 8));
    bus_run_until(&bus, 1000 * BIT_NS);
    bus_clear_responses(&bus);
    TEST_ASSERT_TRUE(send_frame(&port, 0x124, 8));
    bus_run_until(&bus, 2000 * BIT_NS);
    bus_end_responses(&bus);
    TEST_ASSERT_TRUE(send_frame(&port, 0x125, 8));
    bus_run_until(&bus, 3000 * BIT_NS);
    TEST_ASSERT_EQUAL_UINT(3, seen.count);
    TEST_ASSERT_EQUAL_UINT32(0, bus_get_response_max_ns(&bus, 0x123));
    TEST_ASSERT_EQUAL_UINT32(length_ns(0x124, 8), bus_get_response_max_ns(&bus, 0x124));
    TEST_ASSERT_EQUAL_UINT32(0, bus_get_response_max_ns(&bus, 0x125));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_frame_ends_after_its_exact_length);
    RUN_TEST(test_all_other_ports_receive_and_the_sender_does_not);
    RUN_TEST(test_the_lowest_identifier_goes_first_whoever_asked_first);
    RUN_TEST(test_a_remote_frame_goes_behind_the_frame_it_asks_for_and_before_the_next_identifier);
    RUN_TEST(test_frames_of_one_identifier_keep_their_order);
    RUN_TEST(test_a_frame_on_the_wire_is_not_overtaken);
    RUN_TEST(test_frames_follow_each_other_after_three_bits);
    RUN_TEST(test_an_idle_bus_begins_at_once);
    RUN_TEST(test_a_slower_bus_takes_longer_in_proportion);
    RUN_TEST(test_a_bit_rate_out_of_range_is_refused);
    RUN_TEST(test_nodes_answer_when_the_frame_ends_and_their_answers_compete);
    RUN_TEST(test_a_filter_lets_its_identifiers_through_and_may_change);
    RUN_TEST(test_frames_keep_their_data);
    RUN_TEST(test_a_full_transmit_queue_refuses_and_is_counted);
    RUN_TEST(test_a_full_bus_refuses_and_stays_whole);
    RUN_TEST(test_a_full_receive_queue_keeps_the_oldest_and_counts_the_rest);
    RUN_TEST(test_load_is_the_occupied_part_of_the_time);
    RUN_TEST(test_predicted_load_of_four_axes_is_785_bits_of_1000);
    RUN_TEST(test_the_size_of_the_steps_does_not_matter);
    RUN_TEST(test_responses_count_from_one_moment_to_another);
    return UNITY_END();
}
