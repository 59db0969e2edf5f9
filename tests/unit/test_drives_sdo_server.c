/*
 * The SDO server by itself, frame by frame, with an owner of three objects: a number, a short text
 * and a long one.
 */
#include "sdo_server_bench.h"

static void test_a_number_is_uploaded_in_one_frame(void)
{
    ask(0x40, NUMBER, 0);
    assert_answer(0x4B, NUMBER, 0x1234);
}

static void test_a_number_is_downloaded_in_one_frame(void)
{
    ask(0x2B, NUMBER, 0x000F);
    assert_answer(0x60, NUMBER, 0);
    TEST_ASSERT_EQUAL_UINT(2, stored_length);
    TEST_ASSERT_EQUAL_HEX16(0x000F, little_endian_read16(stored));
}

static void test_without_a_size_a_number_takes_as_many_bytes_as_it_has(void)
{
    ask(0x22, NUMBER, 0xAAAA000F);
    assert_answer(0x60, NUMBER, 0);
    TEST_ASSERT_EQUAL_UINT(2, stored_length);
    TEST_ASSERT_EQUAL_HEX16(0x000F, little_endian_read16(stored));
    ask(0x23, NUMBER, 0xAAAA000F);
    assert_answer(0x80, NUMBER, 0x06070010);
}

static void test_without_a_size_four_bytes_of_a_text_are_meant(void)
{
    ask(0x22, TEXT, 0x44434241);
    assert_answer(0x60, TEXT, 0);
    TEST_ASSERT_EQUAL_UINT(4, stored_length);
    TEST_ASSERT_EQUAL_MEMORY("ABCD", stored, 4);
}

static void test_refusals_name_the_object_and_the_reason(void)
{
    ask(0x40, MISSING, 0);
    assert_answer(0x80, MISSING, 0x06020000);
    ask(0x2B, READONLY, 1);
    assert_answer(0x80, READONLY, 0x06010002);
    ask(0x2F, NUMBER, 1);
    assert_answer(0x80, NUMBER, 0x06070010);
    ask(0x21, READONLY, 20);
    assert_answer(0x80, READONLY, 0x06010002);
    ask(0x21, LONG, SDO_SERVER_WRITE_MAX + 1);
    assert_answer(0x80, LONG, 0x06070012);
}

/* "takt virtual drive": 18 bytes in three segments of 7, 7 and 4. */
static void test_a_text_is_uploaded_in_segments(void)
{
    static const char text[] = "takt virtual drive";
    stored_length = strlen(text);
    memcpy(stored, text, stored_length);
    ask(0x40, TEXT, 0);
    assert_answer(0x41, TEXT, 18);
    tell(0x60, NULL, 0);
    TEST_ASSERT_EQUAL_HEX8(0x00, sent[0].data[0]);
    TEST_ASSERT_EQUAL_MEMORY("takt vi", sent[0].data + 1, 7);
    tell(0x70, NULL, 0);
    TEST_ASSERT_EQUAL_HEX8(0x10, sent[0].data[0]);
    TEST_ASSERT_EQUAL_MEMORY("rtual d", sent[0].data + 1, 7);
    tell(0x60, NULL, 0);
    TEST_ASSERT_EQUAL_HEX8(0x00 | 3 << 1 | 1, sent[0].data[0]);
    TEST_ASSERT_EQUAL_MEMORY("rive", sent[0].data + 1, 4);
    tell(0x70, NULL, 0);
    TEST_ASSERT_EQUAL_HEX32(0x05040001, little_endian_read32(sent[0].data + 4));
}

static void test_an_empty_value_is_uploaded_as_one_empty_segment(void)
{
    ask(0x40, TEXT, 0);
    assert_answer(0x41, TEXT, 0);
    tell(0x60, NULL, 0);
    TEST_ASSERT_EQUAL_HEX8(7 << 1 | 1, sent[0].data[0]);
}

static void test_a_text_is_downloaded_in_segments(void)
{
    ask(0x21, TEXT, 10);
    assert_answer(0x60, TEXT, 0);
    tell(0x00, "left ax", 7);
    TEST_ASSERT_EQUAL_HEX8(0x20, sent[0].data[0]);
    TEST_ASSERT_EQUAL_UINT32(0, stored_object);
    tell(0x10 | 4 << 1 | 1, "is ", 3);
    TEST_ASSERT_EQUAL_HEX8(0x30, sent[0].data[0]);
    TEST_ASSERT_EQUAL_UINT(10, stored_length);
    TEST_ASSERT_EQUAL_MEMORY("left axis ", stored, 10);
}

static void test_a_segment_twice_is_an_abort(void)
{
    ask(0x21, TEXT, 14);
    tell(0x00, "1234567", 7);
    tell(0x00, "1234567", 7);
    TEST_ASSERT_EQUAL_HEX32(0x05030000, little_endian_read32(sent[0].data + 4));
    fill(30);
    ask(0x40, TEXT, 0);
    tell(0x60, NULL, 0);
    tell(0x60, NULL, 0);
    TEST_ASSERT_EQUAL_HEX32(0x05030000, little_endian_read32(sent[0].data + 4));
}

static void test_a_value_of_another_length_than_announced_is_refused(void)
{
    ask(0x21, TEXT, 9);
    tell(0x01, "1234567", 7);
    TEST_ASSERT_EQUAL_HEX32(0x06070013, little_endian_read32(sent[0].data + 4));
    ask(0x21, TEXT, 5);
    tell(0x01, "1234567", 7);
    TEST_ASSERT_EQUAL_HEX32(0x06070012, little_endian_read32(sent[0].data + 4));
}

static void test_a_download_without_announced_length_is_bounded(void)
{
    ask(0x20, LONG, 0);
    for (unsigned i = 0; i < SDO_SERVER_WRITE_MAX / 7; i++)
        tell(i % 2 ? 0x10 : 0x00, "abcdefg", 7);
    TEST_ASSERT_EQUAL_HEX8(0x20, sent[0].data[0] & 0xE0);
    tell(SDO_SERVER_WRITE_MAX / 7 % 2 ? 0x10 : 0x00, "abcdefg", 7);
    TEST_ASSERT_EQUAL_HEX32(0x06070012, little_endian_read32(sent[0].data + 4));
}

static void test_a_new_request_ends_the_transfer_before(void)
{
    ask(0x21, TEXT, 14);
    tell(0x00, "1234567", 7);
    ask(0x40, NUMBER, 0);
    assert_answer(0x4B, NUMBER, 0x1234);
    tell(0x11, "1234567", 7);
    TEST_ASSERT_EQUAL_HEX32(0x05040001, little_endian_read32(sent[0].data + 4));
}

static void test_a_segmented_transfer_is_given_up_when_it_has_not_moved_for_the_timeout(void)
{
    now_ns = 1000;
    ask(0x21, TEXT, 14);
    TEST_ASSERT_EQUAL_UINT64(1000 + TIMEOUT_NS, takt_sdo_server_due_ns(&server));
    now_ns = 5000;
    tell(0x00, "1234567", 7);
    assert_given_up_at(5000 + TIMEOUT_NS, TEXT);
    fill(30);
    ask(0x40, LONG, 0);
    now_ns = 9000;
    tell(0x60, NULL, 0);
    assert_given_up_at(9000 + TIMEOUT_NS, LONG);
}

static void test_a_transfer_that_has_ended_waits_for_nobody(void)
{
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, takt_sdo_server_due_ns(&server));
    ask(0x2B, NUMBER, 1);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, takt_sdo_server_due_ns(&server));
    ask(0x21, TEXT, 7);
    tell(0x01, "1234567", 7);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, takt_sdo_server_due_ns(&server));
    ask(0x21, TEXT, 7);
    ask(0x80, TEXT, 0x08000000);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, takt_sdo_server_due_ns(&server));
}

static void test_an_abort_of_the_client_is_not_answered(void)
{
    ask(0x21, TEXT, 14);
    ask(0x80, TEXT, 0x05040000);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_EQUAL_INT(SDO_SERVER_IDLE, server.state);
}

static void test_an_unknown_command_is_an_abort(void)
{
    ask(0xE0, TEXT, 0);
    TEST_ASSERT_EQUAL_HEX32(0x05040001, little_endian_read32(sent[0].data + 4));
}

static void test_a_value_below_the_threshold_is_uploaded_the_common_way(void)
{
    ask(0xA4, NUMBER, 127 | 20u << 8);
    assert_answer(0x4B, NUMBER, 0x1234);
}

static void test_a_frame_of_another_length_is_no_request(void)
{
    struct can_frame frame;
    takt_sdo_write_initiate(&frame, SDO_REQUEST_FUNCTION + NODE, 0x40, NUMBER, 0);
    frame.length = 7;
    takt_sdo_server_take(&server, &frame, now_ns);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

static uint32_t seed;

static uint32_t lcg(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

/* Any frames at all: whatever is delivered is within bounds, and a plain request still works. */
static void test_a_million_random_frames_leave_a_working_server(void)
{
    static const uint32_t objects[] = {NUMBER, TEXT, LONG, READONLY, MISSING};
    seed = 5;
    for (unsigned n = 0; n < 1000000; n++) {
        uint8_t command = (uint8_t)lcg();
        if (lcg() % 4 == 0)
            ask(command, objects[lcg() % 5], lcg() % 64);
        else
            tell(command, data_of(7), 7);
        TEST_ASSERT_TRUE(stored_length <= sizeof stored);
        if (n % 1000 == 999) {
            ask(0x80, NUMBER, 0);
            ask(0x40, NUMBER, 0);
            assert_answer(0x4B, NUMBER, 0x1234);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_number_is_uploaded_in_one_frame);
    RUN_TEST(test_a_number_is_downloaded_in_one_frame);
    RUN_TEST(test_without_a_size_a_number_takes_as_many_bytes_as_it_has);
    RUN_TEST(test_without_a_size_four_bytes_of_a_text_are_meant);
    RUN_TEST(test_refusals_name_the_object_and_the_reason);
    RUN_TEST(test_a_text_is_uploaded_in_segments);
    RUN_TEST(test_an_empty_value_is_uploaded_as_one_empty_segment);
    RUN_TEST(test_a_text_is_downloaded_in_segments);
    RUN_TEST(test_a_segment_twice_is_an_abort);
    RUN_TEST(test_a_value_of_another_length_than_announced_is_refused);
    RUN_TEST(test_a_download_without_announced_length_is_bounded);
    RUN_TEST(test_a_new_request_ends_the_transfer_before);
    RUN_TEST(test_a_segmented_transfer_is_given_up_when_it_has_not_moved_for_the_timeout);
    RUN_TEST(test_a_transfer_that_has_ended_waits_for_nobody);
    RUN_TEST(test_an_abort_of_the_client_is_not_answered);
    RUN_TEST(test_an_unknown_command_is_an_abort);
    RUN_TEST(test_a_value_below_the_threshold_is_uploaded_the_common_way);
    RUN_TEST(test_a_frame_of_another_length_is_no_request);
    RUN_TEST(test_a_million_random_frames_leave_a_working_server);
    return UNITY_END();
}
