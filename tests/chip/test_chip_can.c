/* The CAN controller's driver on a model of its registers and of the bus. */
#include "can_bench.h"

static unsigned number_of(const struct can_frame *frame)
{
    return frame->data[0] | (unsigned)frame->data[1] << 8;
}

/* ---- sending ---- */

static void test_the_most_urgent_frame_is_sent_first(void)
{
    send(0x601, 1);
    send(0x201, 2);
    send(0x80, 3);
    expect(0x80, 3);
    expect(0x201, 2);
    expect(0x601, 1);
    expect_silence();
}

static void test_frames_of_one_identifier_keep_their_order(void)
{
    for (unsigned i = 0; i < 20; i++)
        TEST_ASSERT_TRUE(send(0x601, i));
    for (unsigned i = 0; i < 20; i++)
        expect(0x601, i);
    expect_silence();
}

static void test_two_of_one_identifier_are_never_in_mailboxes_at_once(void)
{
    send(0x601, 1);
    send(0x601, 2);
    TEST_ASSERT_EQUAL(1, can_model_waiting());
    send(0x602, 3);
    TEST_ASSERT_EQUAL(2, can_model_waiting());
}

static void test_an_urgent_frame_waits_for_one_other_at_most(void)
{
    struct can_frame frame;

    for (unsigned id = 0x601; id <= 0x606; id++)
        send(id, id);
    TEST_ASSERT_EQUAL(3, can_model_waiting());
    TEST_ASSERT_TRUE(can_model_begin(&frame)); /* 0x601 is under way */
    send(0x80, 9);
    interrupt();
    can_model_end(true);
    interrupt();
    expect(0x80, 9);
    for (unsigned id = 0x602; id <= 0x606; id++)
        expect(id, id);
    TEST_ASSERT_EQUAL(1, takt_can_controller_get_counts(&can)->taken_back);
}

static void test_what_is_taken_back_goes_before_others_of_its_identifier(void)
{
    send(0x601, 1);
    send(0x602, 2);
    send(0x606, 3);
    send(0x606, 4);
    send(0x80, 5); /* takes 0x606 back */
    interrupt();
    expect(0x80, 5);
    expect(0x601, 1);
    expect(0x602, 2);
    expect(0x606, 3);
    expect(0x606, 4);
}

/*
 * The least urgent frame is on the bus when it is wanted back, and gets through: it must not be
 * sent again.
 */
static void test_a_frame_that_gets_through_while_it_is_called_back_is_sent_once(void)
{
    struct can_frame frame;

    send(0x606, 1);
    TEST_ASSERT_TRUE(can_model_begin(&frame));
    send(0x605, 2);
    send(0x604, 3);
    send(0x80, 4);
    can_model_end(true);
    interrupt();
    expect(0x80, 4);
    expect(0x604, 3);
    expect(0x605, 2);
    expect_silence();
    TEST_ASSERT_EQUAL(0, takt_can_controller_get_counts(&can)->taken_back);
}

static void test_a_frame_without_acknowledge_is_repeated(void)
{
    struct can_frame frame;

    send(0x601, 1);
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_TRUE(can_model_begin(&frame));
        can_model_end(false);
        interrupt();
    }
    expect(0x601, 1);
    expect_silence();
}

static void test_a_full_queue_refuses_and_what_is_in_it_is_sent(void)
{
    unsigned taken = 0;

    while (send(0x601 + taken % 5, taken))
        taken++;
    TEST_ASSERT_EQUAL(CAN_QUEUE_MAX - 1 + CAN_MAILBOXES, taken);
    for (unsigned i = 0; i < taken; i++)
        (void)transfer();
    expect_silence();
    TEST_ASSERT_EQUAL(taken, takt_can_controller_get_counts(&can)->sent);
    TEST_ASSERT_TRUE(send(0x601, 0));
}

/* What a random run knows of its frames. */
struct run {
    unsigned next[8], seen[8]; /* number by identifier */
    unsigned inside[8];        /* frames of it that are waiting */
    unsigned most_urgent;      /* that was waiting when the last frame began; 8: none */
};

static unsigned most_urgent_of(const struct run *run)
{
    unsigned i = 0;

    while (i < 8 && run->inside[i] == 0)
        i++;
    return i;
}

/* Identifiers 0x100 ... 0x107. */
static void begin_any(struct run *run, bool acknowledged)
{
    const unsigned waited = run->most_urgent;
    struct can_frame frame;
    unsigned i;

    run->most_urgent = most_urgent_of(run);
    if (!can_model_begin(&frame)) {
        TEST_ASSERT_EQUAL(8, run->most_urgent);
        return;
    }
    i = frame.id - 0x100U;
    TEST_ASSERT_EQUAL_MESSAGE(run->seen[i] & 0xFFFFU, number_of(&frame), "order of an identifier");
    TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(waited, i, "a frame has waited for more than one other");
    if (rand() % 3 == 0 && run->inside[0] < 3 && send(0x100, run->next[0])) {
        run->next[0]++; /* comes while the other is on the bus */
        run->inside[0]++;
        interrupt();
    }
    can_model_end(acknowledged);
    if (acknowledged) {
        run->seen[i]++;
        run->inside[i]--;
    }
    interrupt();
    if (!acknowledged || run->most_urgent == i)
        run->most_urgent = 8;
}

static void test_random_traffic_loses_nothing_and_keeps_order_and_priority(void)
{
    struct run run = {.most_urgent = 8};
    unsigned sent = 0;

    srand(1);
    for (int step = 0; step < 200000; step++) {
        const unsigned i = (unsigned)rand() % 8;

        if (rand() % 2 == 0) {
            if (send(0x100 + i, run.next[i] & 0xFFFFU)) {
                run.next[i]++;
                run.inside[i]++;
                sent++;
            }
            interrupt();
        } else {
            begin_any(&run, rand() % 8 != 0);
        }
    }
    for (unsigned i = 0; i < 8; i++)
        TEST_ASSERT_EQUAL(run.next[i] - run.inside[i], run.seen[i]);
    TEST_ASSERT_GREATER_THAN(50000, sent);
    TEST_ASSERT_GREATER_THAN(1000, takt_can_controller_get_counts(&can)->taken_back);
}

/* ---- receiving ---- */

static bool hear(unsigned id, unsigned number)
{
    const struct can_frame frame = numbered(id, number);

    return can_model_hear(&frame);
}

static void expect_received(unsigned id, unsigned number)
{
    struct can_frame frame;
    const struct can_frame expected = numbered(id, number);

    TEST_ASSERT_TRUE(port.receive(port.context, &frame));
    TEST_ASSERT_EQUAL_HEX(expected.id, frame.id);
    TEST_ASSERT_EQUAL_MEMORY(expected.data, frame.data, 8);
}

static void test_frames_are_received_in_their_order(void)
{
    struct can_frame frame;

    for (unsigned i = 0; i < 1000; i++) {
        TEST_ASSERT_TRUE(hear(0x181 + i % 3, i));
        interrupt();
        expect_received(0x181 + i % 3, i);
    }
    TEST_ASSERT_FALSE(port.receive(port.context, &frame));
    TEST_ASSERT_EQUAL(1000, takt_can_controller_get_counts(&can)->received);
}

static void test_an_overrun_of_the_fifo_is_counted_and_the_rest_is_right(void)
{
    struct can_frame newest;

    for (unsigned i = 0; i < can_model_fifo + 2; i++)
        TEST_ASSERT_TRUE(hear(0x181, i));
    interrupt();
    for (unsigned i = 0; i + 1 < can_model_fifo; i++)
        expect_received(0x181, i);
    TEST_ASSERT_TRUE(port.receive(port.context, &newest)); /* some controllers write over it */
    TEST_ASSERT_EQUAL(1, takt_can_controller_get_counts(&can)->overruns);
    hear(0x181, 99);
    interrupt();
    expect_received(0x181, 99);
}

static void test_a_full_ring_keeps_the_oldest_and_counts_the_others(void)
{
    for (unsigned i = 0; i < 100; i++) {
        hear(0x181, i);
        interrupt();
    }
    TEST_ASSERT_EQUAL(100 - (CAN_RECEIVED_MAX - 1), takt_can_controller_get_counts(&can)->lost);
    for (unsigned i = 0; i < CAN_RECEIVED_MAX - 1; i++)
        expect_received(0x181, i);
}

static void test_only_the_nodes_of_the_machine_are_heard(void)
{
    static const uint8_t nodes[] = {1, 2, 5, 77, 127};
    bool listed[128] = {false};

    for (size_t i = 0; i < sizeof nodes; i++)
        listed[nodes[i]] = true;
    chip_model_reset();
    TEST_ASSERT_TRUE(open_for(sizeof nodes, nodes));
    for (unsigned id = 0; id < 0x800; id++) {
        struct can_frame frame;

        TEST_ASSERT_EQUAL(listed[id & 127U], hear(id, id));
        interrupt();
        while (port.receive(port.context, &frame)) {
        }
    }
}

static void test_as_many_nodes_are_heard_as_there_are_filters(void)
{
    uint8_t nodes[CAN_NODES_MAX + 1];

    for (unsigned i = 0; i < sizeof nodes; i++)
        nodes[i] = (uint8_t)(i + 1);
    chip_model_reset();
    TEST_ASSERT_TRUE(open_for(CAN_NODES_MAX, nodes));
    for (unsigned i = 1; i <= CAN_NODES_MAX; i++) {
        TEST_ASSERT_TRUE(hear(0x180 + i, i));
        interrupt();
    }
    TEST_ASSERT_FALSE(hear(0x180 + CAN_NODES_MAX + 1, 0));
    TEST_ASSERT_FALSE(open_for(CAN_NODES_MAX + 1, nodes));
}

static void test_a_remote_frame_is_sent_as_one_behind_more_urgent_ones(void)
{
    const struct can_frame guard = {.id = CAN_REMOTE | 0x181, .length = 1};
    struct can_frame frame;

    TEST_ASSERT_TRUE(port.send(port.context, &guard));
    TEST_ASSERT_TRUE(send(0x301, 1));
    TEST_ASSERT_TRUE(send(0x080, 2));
    expect(0x080, 2);
    frame = transfer();
    TEST_ASSERT_EQUAL_HEX(CAN_REMOTE | 0x181, frame.id);
    TEST_ASSERT_EQUAL(1, frame.length);
    expect(0x301, 1);
}

static void test_remote_frames_and_long_identifiers_are_not_heard(void)
{
    for (unsigned kind = 1; kind <= 2; kind++) {
        can_model.extended_or_remote = kind;
        TEST_ASSERT_FALSE(hear(0x181, 0));
    }
}

static void test_a_short_frame_has_zeros_behind_it_and_a_length_above_8_is_8(void)
{
    struct can_frame frame = numbered(0x181, 0xFFFF);

    frame.length = 2;
    can_model_hear(&frame);
    frame.length = 15;
    can_model_hear(&frame);
    interrupt();
    TEST_ASSERT_TRUE(port.receive(port.context, &frame));
    TEST_ASSERT_EQUAL(2, frame.length);
    TEST_ASSERT_EQUAL(0xFF, frame.data[1]);
    TEST_ASSERT_EQUAL(0, frame.data[2]);
    TEST_ASSERT_TRUE(port.receive(port.context, &frame));
    TEST_ASSERT_EQUAL(8, frame.length);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_most_urgent_frame_is_sent_first);
    RUN_TEST(test_frames_of_one_identifier_keep_their_order);
    RUN_TEST(test_two_of_one_identifier_are_never_in_mailboxes_at_once);
    RUN_TEST(test_an_urgent_frame_waits_for_one_other_at_most);
    RUN_TEST(test_what_is_taken_back_goes_before_others_of_its_identifier);
    RUN_TEST(test_a_frame_that_gets_through_while_it_is_called_back_is_sent_once);
    RUN_TEST(test_a_frame_without_acknowledge_is_repeated);
    RUN_TEST(test_a_full_queue_refuses_and_what_is_in_it_is_sent);
    RUN_TEST(test_random_traffic_loses_nothing_and_keeps_order_and_priority);
    RUN_TEST(test_frames_are_received_in_their_order);
    RUN_TEST(test_an_overrun_of_the_fifo_is_counted_and_the_rest_is_right);
    RUN_TEST(test_a_full_ring_keeps_the_oldest_and_counts_the_others);
    RUN_TEST(test_only_the_nodes_of_the_machine_are_heard);
    RUN_TEST(test_as_many_nodes_are_heard_as_there_are_filters);
    RUN_TEST(test_a_remote_frame_is_sent_as_one_behind_more_urgent_ones);
    RUN_TEST(test_remote_frames_and_long_identifiers_are_not_heard);
    RUN_TEST(test_a_short_frame_has_zeros_behind_it_and_a_length_above_8_is_8);
    return UNITY_END();
}
