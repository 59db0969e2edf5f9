/* Block transfer of the SDO server. */
#include "sdo_server_bench.h"

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
    takt_sdo_server_go_on(&server, now_ns);
    TEST_ASSERT_EQUAL_UINT(15, sent_count);
    TEST_ASSERT_EQUAL_HEX8(0x8F, sent[14].data[0]);
    takt_sdo_server_go_on(&server, now_ns);
    TEST_ASSERT_EQUAL_UINT(15, sent_count);
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

static void test_a_block_upload_is_given_up_at_each_of_its_stages(void)
{
    fill(20);
    ask(0xA4, LONG, 2);
    assert_given_up_at(TIMEOUT_NS, LONG);
    ask(0xA4, LONG, 2);
    now_ns = 100;
    tell(0xA3, NULL, 0);
    assert_given_up_at(100 + TIMEOUT_NS, LONG);
    ask(0xA4, LONG, 127);
    tell(0xA3, NULL, 0);
    now_ns = 200;
    acknowledge(3, 127);
    TEST_ASSERT_EQUAL_INT(SDO_SERVER_ENDING, server.state);
    assert_given_up_at(200 + TIMEOUT_NS, LONG);
}

static void test_an_upload_gets_on_while_its_segments_find_room(void)
{
    fill(100);
    ask(0xA4, LONG, 127);
    room = 6;
    tell(0xA3, NULL, 0);
    now_ns = 100;
    takt_sdo_server_go_on(&server, now_ns);
    TEST_ASSERT_EQUAL_UINT64(TIMEOUT_NS, takt_sdo_server_due_ns(&server));
    room = 1;
    now_ns = 200;
    takt_sdo_server_go_on(&server, now_ns);
    room = UINT32_MAX;
    assert_given_up_at(200 + TIMEOUT_NS, LONG);
}

static void test_a_block_download_is_given_up_whatever_else_the_client_asks(void)
{
    const uint8_t *data = data_of(28);
    ask(0xC6, LONG, 28);
    now_ns = 100;
    send_segments(data, 1, 2, false);
    now_ns = 200;
    ask(0x40, NUMBER, 0); /* as a segment it is number 64 */
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    ask(0xC6, LONG, 28); /* number 70, the last */
    TEST_ASSERT_EQUAL_HEX8(0xA2, sent[0].data[0]);
    assert_given_up_at(100 + TIMEOUT_NS, LONG);
    ask(0xC6, LONG, 7);
    now_ns = 300;
    send_segments(data, 1, 1, true);
    TEST_ASSERT_EQUAL_INT(SDO_SERVER_TAKEN, server.state);
    assert_given_up_at(300 + TIMEOUT_NS, LONG);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_block_upload_says_everything_once_and_ends_with_its_checksum);
    RUN_TEST(test_lost_segments_of_an_upload_are_sent_again);
    RUN_TEST(test_a_block_that_finds_no_room_goes_on_later);
    RUN_TEST(test_wrong_block_sizes_and_acknowledgements_are_aborts);
    RUN_TEST(test_a_block_download_arrives_whole);
    RUN_TEST(test_a_lost_segment_of_a_download_is_asked_for_again);
    RUN_TEST(test_a_wrong_checksum_changes_nothing);
    RUN_TEST(test_a_client_without_checksum_is_believed);
    RUN_TEST(test_a_block_download_is_bounded_and_may_be_aborted);
    RUN_TEST(test_a_block_upload_is_given_up_at_each_of_its_stages);
    RUN_TEST(test_an_upload_gets_on_while_its_segments_find_room);
    RUN_TEST(test_a_block_download_is_given_up_whatever_else_the_client_asks);
    return UNITY_END();
}
