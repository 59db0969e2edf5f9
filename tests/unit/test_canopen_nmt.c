#include "canopen/nmt.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static const enum nmt_command commands[] = {NMT_START, NMT_STOP, NMT_ENTER_PREOPERATIONAL,
                                            NMT_RESET_NODE, NMT_RESET_COMMUNICATION};

static void test_start_all_nodes_is_the_frame_of_the_standard(void)
{
    struct can_frame frame;
    takt_nmt_write_command(&frame, NMT_START, NMT_ALL_NODES);
    TEST_ASSERT_EQUAL_HEX16(0x000, frame.id);
    TEST_ASSERT_EQUAL_INT(2, frame.length);
    TEST_ASSERT_EQUAL_HEX8(0x01, frame.data[0]);
    TEST_ASSERT_EQUAL_HEX8(0x00, frame.data[1]);
}

static void test_every_command_for_every_node_reads_back(void)
{
    for (unsigned i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        for (unsigned node = 0; node <= 127; node++) {
            struct can_frame frame;
            enum nmt_command command;
            uint8_t read;
            takt_nmt_write_command(&frame, commands[i], (uint8_t)node);
            TEST_ASSERT_TRUE(takt_nmt_read_command(&frame, &command, &read));
            TEST_ASSERT_EQUAL_INT(commands[i], command);
            TEST_ASSERT_EQUAL_INT(node, read);
        }
    }
}

static void assert_no_command(uint16_t id, uint8_t length, uint8_t first, uint8_t second)
{
    struct can_frame frame = {.id = id, .length = length, .data = {first, second}};
    enum nmt_command command;
    uint8_t node;
    TEST_ASSERT_FALSE(takt_nmt_read_command(&frame, &command, &node));
}

static void test_what_is_no_command_is_refused(void)
{
    assert_no_command(0x001, 2, 0x01, 0);
    assert_no_command(0x000, 1, 0x01, 0);
    assert_no_command(0x000, 3, 0x01, 0);
    assert_no_command(0x000, 2, 0x03, 0);
    assert_no_command(0x000, 2, 0x00, 0);
    assert_no_command(0x000, 2, 0x01, 128);
}

static void test_a_heartbeat_reads_back_and_bootup_is_state_0(void)
{
    static const enum nmt_state states[] = {NMT_BOOTED, NMT_STOPPED, NMT_OPERATIONAL,
                                            NMT_PREOPERATIONAL};
    static const uint8_t bytes[] = {0x00, 0x04, 0x05, 0x7F};
    for (unsigned i = 0; i < 4; i++) {
        struct can_frame frame;
        enum nmt_state state;
        uint8_t node;
        takt_nmt_write_heartbeat(&frame, 42, states[i]);
        TEST_ASSERT_EQUAL_HEX16(0x72A, frame.id);
        TEST_ASSERT_EQUAL_INT(1, frame.length);
        TEST_ASSERT_EQUAL_HEX8(bytes[i], frame.data[0]);
        TEST_ASSERT_TRUE(takt_nmt_read_heartbeat(&frame, &node, &state));
        TEST_ASSERT_EQUAL_INT(42, node);
        TEST_ASSERT_EQUAL_INT(states[i], state);
    }
}

static void test_what_is_no_heartbeat_is_refused(void)
{
    static const struct can_frame frames[] = {{.id = 0x700, .length = 1},
                                              {.id = 0x681, .length = 1},
                                              {.id = 0x701, .length = 0},
                                              {.id = 0x701, .length = 1, .data = {0x01}}};
    for (unsigned i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        enum nmt_state state;
        uint8_t node;
        TEST_ASSERT_FALSE(takt_nmt_read_heartbeat(&frames[i], &node, &state));
    }
}

static void test_an_answer_to_guarding_is_a_heartbeat_whatever_its_toggle_bit(void)
{
    static const struct can_frame answer = {.id = 0x72A, .length = 1, .data = {0x85}};
    enum nmt_state state;
    uint8_t node;
    TEST_ASSERT_TRUE(takt_nmt_read_heartbeat(&answer, &node, &state));
    TEST_ASSERT_EQUAL_INT(42, node);
    TEST_ASSERT_EQUAL_INT(NMT_OPERATIONAL, state);
}

static void test_a_guarding_frame_is_remote_and_no_heartbeat(void)
{
    struct can_frame frame;
    enum nmt_state state;
    uint8_t node;
    takt_nmt_write_guard(&frame, 42);
    TEST_ASSERT_TRUE(can_is_remote(&frame));
    TEST_ASSERT_EQUAL_HEX16(0x72A, frame.id & CAN_ID_MASK);
    TEST_ASSERT_EQUAL_UINT(0, can_data_length(&frame));
    TEST_ASSERT_FALSE(takt_nmt_read_heartbeat(&frame, &node, &state));
    TEST_ASSERT_TRUE(nmt_is_guard(&frame, 42));
    TEST_ASSERT_FALSE(nmt_is_guard(&frame, 43));
    takt_nmt_write_heartbeat(&frame, 42, NMT_OPERATIONAL);
    TEST_ASSERT_FALSE(nmt_is_guard(&frame, 42));
}

static void test_commands_lead_to_their_states(void)
{
    static const enum nmt_state expected[] = {NMT_OPERATIONAL, NMT_STOPPED, NMT_PREOPERATIONAL,
                                              NMT_BOOTED, NMT_BOOTED};
    for (unsigned i = 0; i < sizeof commands / sizeof commands[0]; i++)
        TEST_ASSERT_EQUAL_INT(expected[i], takt_nmt_next_state(commands[i]));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_start_all_nodes_is_the_frame_of_the_standard);
    RUN_TEST(test_every_command_for_every_node_reads_back);
    RUN_TEST(test_what_is_no_command_is_refused);
    RUN_TEST(test_a_heartbeat_reads_back_and_bootup_is_state_0);
    RUN_TEST(test_what_is_no_heartbeat_is_refused);
    RUN_TEST(test_an_answer_to_guarding_is_a_heartbeat_whatever_its_toggle_bit);
    RUN_TEST(test_a_guarding_frame_is_remote_and_no_heartbeat);
    RUN_TEST(test_commands_lead_to_their_states);
    return UNITY_END();
}
