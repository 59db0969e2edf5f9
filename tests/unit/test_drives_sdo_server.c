/*
 * The SDO server by itself, frame by frame, with an owner of three objects: a number, a short text
 * and a long one.
 */
#include "canopen/little_endian.h"
#include "canopen/sdo_server.h"
#include "unity.h"

#include <string.h>

#define NODE       9
#define FRAMES_MAX 512

#define NUMBER   SDO_OBJECT(0x6040, 0)
#define TEXT     SDO_OBJECT(0x2000, 0)
#define LONG     SDO_OBJECT(0x2001, 0)
#define READONLY SDO_OBJECT(0x6041, 0)
#define MISSING  SDO_OBJECT(0x5000, 1)

static struct sdo_server server;
static struct can_frame sent[FRAMES_MAX];
static unsigned sent_count;
static unsigned room; /* frames that may still be sent */

static uint8_t stored[SDO_SERVER_WRITE_MAX];
static size_t stored_length;
static uint32_t stored_object;

static uint32_t owner_read(void *context, uint32_t object, uint8_t number[4], const uint8_t **bytes,
                           size_t *length)
{
    (void)context;
    if (object == MISSING)
        return SDO_ABORT_NO_OBJECT;
    *bytes = stored;
    *length = stored_length;
    if (object == NUMBER) {
        little_endian_write16(number, 0x1234);
        *bytes = number;
        *length = 2;
    }
    return SDO_ABORT_NONE;
}

static uint32_t owner_may_write(void *context, uint32_t object)
{
    (void)context;
    return object == READONLY ? SDO_ABORT_READ_ONLY : SDO_ABORT_NONE;
}

static uint32_t owner_write(void *context, uint32_t object, const uint8_t *bytes, size_t length)
{
    (void)context;
    if (object == NUMBER && length != 2)
        return SDO_ABORT_LENGTH;
    stored_object = object;
    stored_length = length;
    memcpy(stored, bytes, length);
    return SDO_ABORT_NONE;
}

static bool owner_send(void *context, const struct can_frame *frame)
{
    (void)context;
    if (room == 0)
        return false;
    room--;
    TEST_ASSERT_TRUE(sent_count < FRAMES_MAX);
    sent[sent_count++] = *frame;
    return true;
}

void setUp(void)
{
    const struct sdo_server_owner owner = {owner_read, owner_may_write, owner_write, owner_send,
                                           NULL};
    takt_sdo_server_init(&server, NODE, &owner);
    sent_count = 0;
    room = UINT32_MAX;
    stored_length = 0;
    stored_object = 0;
}

void tearDown(void)
{
}

static void ask(uint8_t command, uint32_t object, uint32_t value)
{
    struct can_frame frame;
    takt_sdo_write_initiate(&frame, SDO_REQUEST_FUNCTION + NODE, command, object, value);
    sent_count = 0;
    takt_sdo_server_take(&server, &frame);
}

/* A frame that is not the first of a transfer. */
static void tell(uint8_t command, const void *bytes, size_t length)
{
    struct can_frame frame = {.id = SDO_REQUEST_FUNCTION + NODE, .length = 8};
    frame.data[0] = command;
    if (length > 0)
        memcpy(frame.data + 1, bytes, length);
    sent_count = 0;
    takt_sdo_server_take(&server, &frame);
}

static void assert_answer(uint8_t command, uint32_t object, uint32_t value)
{
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_HEX16(SDO_RESPONSE_FUNCTION + NODE, sent[0].id);
    TEST_ASSERT_EQUAL_UINT8(8, sent[0].length);
    TEST_ASSERT_EQUAL_HEX8(command, sent[0].data[0]);
    TEST_ASSERT_EQUAL_HEX32(object, takt_sdo_read_object(&sent[0]));
    TEST_ASSERT_EQUAL_HEX32(value, little_endian_read32(sent[0].data + 4));
}

static void fill(size_t length)
{
    stored_length = length;
    for (size_t i = 0; i < length; i++)
        stored[i] = (uint8_t)(i * 7 + 1);
}

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

static void test_without_a_size_four_bytes_are_meant(void)
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

/* ---- Blocks ---- */

/* CRC-16 of CiA 301, bit by bit from its definition, to verify the server's. */
static uint16_t crc_of(const uint8_t *bytes, size_t length)
{
    uint32_t remainder = 0;
    for (size_t i = 0; i < length * 8 + 16; i++) {
        uint32_t bit = i < length * 8 ? (uint32_t)bytes[i / 8] >> (7 - i % 8) & 1u : 0;
        remainder = remainder << 1 | bit;
        if (remainder & 0x10000)
            remainder ^= 0x11021;
    }
    return (uint16_t)remainder;
}

static void acknowledge(uint8_t sequence, uint8_t block_size)
{
    const uint8_t bytes[] = {sequence, block_size};
    tell(0xA2, bytes, 2);
}

/* 100 bytes are 15 segments; in blocks of 4: 4, 4, 4, 3. */
static void test_a_block_upload_says_everything_once_and_ends_with_its_checksum(void)
{
    uint8_t got[120];
    size_t segments = 0;
    fill(100);
    ask(0xA4, LONG, 4);
    assert_answer(0xC6, LONG, 100);
    tell(0xA3, NULL, 0);
    for (unsigned block = 0; block < 4; block++) {
        TEST_ASSERT_EQUAL_UINT(block < 3 ? 4 : 3, sent_count);
        for (unsigned i = 0; i < sent_count; i++) {
            bool is_last = block == 3 && i == 2;
            TEST_ASSERT_EQUAL_HEX8((i + 1) | (is_last ? 0x80 : 0), sent[i].data[0]);
            memcpy(got + 7 * segments++, sent[i].data + 1, 7);
        }
        acknowledge((uint8_t)sent_count, 4);
    }
    TEST_ASSERT_EQUAL_MEMORY(stored, got, 100);
    TEST_ASSERT_EQUAL_HEX8(0xC1 | 5 << 2, sent[0].data[0]);
    TEST_ASSERT_EQUAL_HEX16(crc_of(stored, 100), little_endian_read16(sent[0].data + 1));
    tell(0xA1, NULL, 0);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_EQUAL_INT(SDO_SERVER_IDLE, server.state);
}

static void test_lost_segments_of_an_upload_are_sent_again(void)
{
    fill(100);
    ask(0xA4, LONG, 10);
    tell(0xA3, NULL, 0);
    TEST_ASSERT_EQUAL_UINT(10, sent_count);
    acknowledge(6, 20);
    TEST_ASSERT_EQUAL_UINT(9, sent_count);
    TEST_ASSERT_EQUAL_MEMORY(stored + 42, sent[0].data + 1, 7);
    TEST_ASSERT_EQUAL_HEX8(0x89, sent[8].data[0]);
}

static void test_a_block_that_finds_no_room_goes_on_later(void)
{
    fill(100);
    ask(0xA4, LONG, 127);
    room = 6;
    tell(0xA3, NULL, 0);
    TEST_ASSERT_EQUAL_UINT(6, sent_count);
    room = UINT32_MAX;
    takt_sdo_server_go_on(&server);
    TEST_ASSERT_EQUAL_UINT(15, sent_count);
    TEST_ASSERT_EQUAL_HEX8(0x8F, sent[14].data[0]);
    takt_sdo_server_go_on(&server);
    TEST_ASSERT_EQUAL_UINT(15, sent_count);
}

static void test_a_value_below_the_threshold_is_uploaded_the_common_way(void)
{
    ask(0xA4, NUMBER, 127 | 20u << 8);
    assert_answer(0x4B, NUMBER, 0x1234);
}

static void test_wrong_block_sizes_and_acknowledgements_are_aborts(void)
{
    fill(100);
    ask(0xA4, LONG, 0);
    TEST_ASSERT_EQUAL_HEX32(0x05040002, little_endian_read32(sent[0].data + 4));
    ask(0xA4, LONG, 128);
    TEST_ASSERT_EQUAL_HEX32(0x05040002, little_endian_read32(sent[0].data + 4));
    ask(0xA4, LONG, 4);
    tell(0xA3, NULL, 0);
    acknowledge(5, 4);
    TEST_ASSERT_EQUAL_HEX32(0x05040003, little_endian_read32(sent[0].data + 4));
    ask(0xA4, LONG, 4);
    acknowledge(1, 4);
    TEST_ASSERT_EQUAL_HEX32(0x05040001, little_endian_read32(sent[0].data + 4));
}

static const uint8_t *data_of(size_t length)
{
    static uint8_t data[SDO_SERVER_WRITE_MAX + 16];
    for (size_t i = 0; i < length; i++)
        data[i] = (uint8_t)(i * 11 + 3);
    return data;
}

static void send_segments(const uint8_t *data, unsigned from, unsigned to, bool with_last)
{
    for (unsigned i = from; i <= to; i++)
        tell((uint8_t)(i | (with_last && i == to ? 0x80 : 0)), data + 7 * (size_t)(i - 1), 7);
}

static void end_block(unsigned unused, uint16_t crc)
{
    const uint8_t bytes[] = {(uint8_t)crc, (uint8_t)(crc >> 8)};
    tell((uint8_t)(0xC1 | unused << 2), bytes, 2);
}

static void test_a_block_download_arrives_whole(void)
{
    const uint8_t *data = data_of(50);
    ask(0xC6, LONG, 50);
    assert_answer(0xA4, LONG, 127);
    send_segments(data, 1, 8, true);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_HEX8(0xA2, sent[0].data[0]);
    TEST_ASSERT_EQUAL_UINT8(8, sent[0].data[1]);
    TEST_ASSERT_EQUAL_UINT8(127, sent[0].data[2]);
    end_block(6, crc_of(data, 50));
    TEST_ASSERT_EQUAL_HEX8(0xA1, sent[0].data[0]);
    TEST_ASSERT_EQUAL_UINT(50, stored_length);
    TEST_ASSERT_EQUAL_MEMORY(data, stored, 50);
}

static void test_a_lost_segment_of_a_download_is_asked_for_again(void)
{
    const uint8_t *data = data_of(56);
    ask(0xC6, LONG, 56);
    send_segments(data, 1, 3, false);
    send_segments(data, 5, 8, true);
    TEST_ASSERT_EQUAL_HEX8(0xA2, sent[0].data[0]);
    TEST_ASSERT_EQUAL_UINT8(3, sent[0].data[1]);
    send_segments(data + 21, 1, 5, true);
    TEST_ASSERT_EQUAL_UINT8(5, sent[0].data[1]);
    end_block(0, crc_of(data, 56));
    TEST_ASSERT_EQUAL_HEX8(0xA1, sent[0].data[0]);
    TEST_ASSERT_EQUAL_MEMORY(data, stored, 56);
}

static void test_a_wrong_checksum_changes_nothing(void)
{
    const uint8_t *data = data_of(50);
    ask(0xC6, LONG, 50);
    send_segments(data, 1, 8, true);
    end_block(6, (uint16_t)(crc_of(data, 50) ^ 1));
    TEST_ASSERT_EQUAL_HEX32(0x05040004, little_endian_read32(sent[0].data + 4));
    TEST_ASSERT_EQUAL_UINT32(0, stored_object);
}

static void test_a_client_without_checksum_is_believed(void)
{
    const uint8_t *data = data_of(7);
    ask(0xC2, LONG, 7);
    send_segments(data, 1, 1, true);
    end_block(0, 0);
    TEST_ASSERT_EQUAL_HEX8(0xA1, sent[0].data[0]);
    TEST_ASSERT_EQUAL_UINT(7, stored_length);
}

static void test_a_block_download_is_bounded_and_may_be_aborted(void)
{
    const uint8_t *data = data_of(7);
    ask(0xC4, LONG, 0);
    for (unsigned n = 0; n < SDO_SERVER_WRITE_MAX / 7 + 2; n++) {
        uint8_t sequence = (uint8_t)(n % 127 + 1);
        tell(sequence, data, 7);
        if (server.state == SDO_SERVER_IDLE)
            break;
    }
    TEST_ASSERT_EQUAL_HEX32(0x06070012, little_endian_read32(sent[0].data + 4));
    ask(0xC6, LONG, 50);
    ask(0x80, LONG, 0x08000000);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_EQUAL_INT(SDO_SERVER_IDLE, server.state);
}

static void test_a_frame_of_another_length_is_no_request(void)
{
    struct can_frame frame;
    takt_sdo_write_initiate(&frame, SDO_REQUEST_FUNCTION + NODE, 0x40, NUMBER, 0);
    frame.length = 7;
    takt_sdo_server_take(&server, &frame);
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
    RUN_TEST(test_without_a_size_four_bytes_are_meant);
    RUN_TEST(test_refusals_name_the_object_and_the_reason);
    RUN_TEST(test_a_text_is_uploaded_in_segments);
    RUN_TEST(test_an_empty_value_is_uploaded_as_one_empty_segment);
    RUN_TEST(test_a_text_is_downloaded_in_segments);
    RUN_TEST(test_a_segment_twice_is_an_abort);
    RUN_TEST(test_a_value_of_another_length_than_announced_is_refused);
    RUN_TEST(test_a_download_without_announced_length_is_bounded);
    RUN_TEST(test_a_new_request_ends_the_transfer_before);
    RUN_TEST(test_an_abort_of_the_client_is_not_answered);
    RUN_TEST(test_an_unknown_command_is_an_abort);
    RUN_TEST(test_a_block_upload_says_everything_once_and_ends_with_its_checksum);
    RUN_TEST(test_lost_segments_of_an_upload_are_sent_again);
    RUN_TEST(test_a_block_that_finds_no_room_goes_on_later);
    RUN_TEST(test_a_value_below_the_threshold_is_uploaded_the_common_way);
    RUN_TEST(test_wrong_block_sizes_and_acknowledgements_are_aborts);
    RUN_TEST(test_a_block_download_arrives_whole);
    RUN_TEST(test_a_lost_segment_of_a_download_is_asked_for_again);
    RUN_TEST(test_a_wrong_checksum_changes_nothing);
    RUN_TEST(test_a_client_without_checksum_is_believed);
    RUN_TEST(test_a_block_download_is_bounded_and_may_be_aborted);
    RUN_TEST(test_a_frame_of_another_length_is_no_request);
    RUN_TEST(test_a_million_random_frames_leave_a_working_server);
    return UNITY_END();
}
