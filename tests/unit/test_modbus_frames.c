#include "modbus/crc.h"
#include "modbus/rtu.h"
#include "modbus/tcp.h"
#include "unity.h"

#include <string.h>

#define UNIT    17
#define GAP_US  2000
#define BYTE_US 100

static uint16_t word[4];
static struct modbus_rtu rtu;
static struct modbus_tcp tcp;
static uint32_t now_us;
static uint8_t reply[MODBUS_TCP_MAX];
static size_t length;

static enum modbus_exception read_map(void *context, enum modbus_table table, uint16_t address,
                                      uint16_t count, uint8_t *data)
{
    (void)context;
    if (table == MODBUS_COILS || address + count > 4)
        return MODBUS_ADDRESS;
    for (unsigned i = 0; i < count; i++)
        modbus_write16(data + (size_t)2 * i, word[address + i]);
    return MODBUS_GOOD;
}

static enum modbus_exception write_map(void *context, enum modbus_table table, uint16_t address,
                                       uint16_t count, const uint8_t *data)
{
    (void)context;
    if (table == MODBUS_COILS || address + count > 4)
        return MODBUS_ADDRESS;
    for (unsigned i = 0; i < count; i++)
        word[address + i] = modbus_read16(data + (size_t)2 * i);
    return MODBUS_GOOD;
}

static const struct modbus_map map = {read_map, write_map, NULL};

void setUp(void)
{
    memset(word, 0, sizeof word);
    takt_modbus_rtu_init(&rtu, &map, UNIT, GAP_US);
    takt_modbus_tcp_init(&tcp);
    now_us = 0xFFFFF000U; /* the clock wraps in every test */
    length = 0;
}

void tearDown(void)
{
}

static void send_bytes(const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        const size_t answered = takt_modbus_rtu_take(&rtu, bytes[i], now_us, reply);

        if (answered > 0)
            length = answered;
        now_us += BYTE_US;
    }
}

/* Appends the checksum and sends. */
static void send_frame(const uint8_t *bytes, size_t size)
{
    uint8_t frame[300];
    const uint16_t crc = takt_crc16(bytes, size);

    length = 0;
    memcpy(frame, bytes, size);
    frame[size] = (uint8_t)crc;
    frame[size + 1] = (uint8_t)(crc >> 8);
    send_bytes(frame, size + 2);
}

#define SEND(...)                                                                                  \
    do {                                                                                           \
        const uint8_t bytes[] = {__VA_ARGS__};                                                     \
        send_frame(bytes, sizeof bytes);                                                           \
    } while (0)

static void pass_gap(void)
{
    now_us += GAP_US;
    length = takt_modbus_rtu_idle(&rtu, now_us, reply);
}

static void expect_reply(const uint8_t *bytes, size_t size)
{
    const uint16_t crc = takt_crc16(bytes, size);

    TEST_ASSERT_EQUAL_UINT(size + 2, length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes, reply, size);
    TEST_ASSERT_EQUAL_HEX8(crc & 0xFF, reply[size]);
    TEST_ASSERT_EQUAL_HEX8(crc >> 8, reply[size + 1]);
}

#define EXPECT(...)                                                                                \
    do {                                                                                           \
        const uint8_t expected[] = {__VA_ARGS__};                                                  \
        expect_reply(expected, sizeof expected);                                                   \
    } while (0)

/*
 * Two checksums that others have published: of "123456789", and of a request of the standard's
 * appendix.
 */
static void test_the_checksum_is_that_of_the_standard(void)
{
    static const uint8_t request[] = {0x02, 0x07};

    TEST_ASSERT_EQUAL_HEX16(0x4B37, takt_crc16((const uint8_t *)"123456789", 9));
    TEST_ASSERT_EQUAL_HEX16(0x1241, takt_crc16(request, sizeof request));
}

/* 3.5 characters of 11 bits at 9600 baud are 4010.4 us; above 19200 baud it is always 1750. */
static void test_the_gap_is_three_and_a_half_characters(void)
{
    TEST_ASSERT_EQUAL_UINT32(4011, takt_modbus_rtu_gap_us(9600, 11));
    TEST_ASSERT_EQUAL_UINT32(1823, takt_modbus_rtu_gap_us(19200, 10));
    TEST_ASSERT_EQUAL_UINT32(1750, takt_modbus_rtu_gap_us(115200, 11));
}

static void test_a_request_is_answered_at_its_last_byte(void)
{
    word[1] = 0x0203;
    SEND(UNIT, 3, 0, 1, 0, 1);
    EXPECT(UNIT, 3, 2, 2, 3);
}

static void test_two_requests_without_a_gap_are_both_answered(void)
{
    SEND(UNIT, 6, 0, 0, 0, 7);
    EXPECT(UNIT, 6, 0, 0, 0, 7);
    SEND(UNIT, 3, 0, 0, 0, 1);
    EXPECT(UNIT, 3, 2, 0, 7);
}

static void test_a_function_we_do_not_have_is_refused_after_the_gap(void)
{
    SEND(UNIT, 43, 14, 1, 0);
    TEST_ASSERT_EQUAL_UINT(0, length);
    pass_gap();
    EXPECT(UNIT, 43 | 0x80, 1);
}

static void test_the_first_byte_after_a_gap_ends_the_frame_before_it(void)
{
    SEND(UNIT, 43, 14, 1, 0);
    now_us += GAP_US;
    length = takt_modbus_rtu_take(&rtu, UNIT, now_us, reply);
    EXPECT(UNIT, 43 | 0x80, 1);
}

static void test_a_wrong_checksum_is_not_answered_and_changes_nothing(void)
{
    const uint8_t frame[] = {UNIT, 6, 0, 0, 0, 7, 0, 0};

    send_bytes(frame, sizeof frame);
    pass_gap();
    TEST_ASSERT_EQUAL_UINT(0, length);
    TEST_ASSERT_EQUAL_UINT16(0, word[0]);
}

static void test_after_noise_and_a_gap_the_next_request_is_answered(void)
{
    static const uint8_t noise[] = {0xFF, UNIT, 3, 0};

    send_bytes(noise, sizeof noise);
    pass_gap();
    SEND(UNIT, 3, 0, 0, 0, 1);
    EXPECT(UNIT, 3, 2, 0, 0);
}

static void test_half_a_request_is_forgotten_after_the_gap(void)
{
    static const uint8_t half[] = {UNIT, 16, 0, 0, 0};

    send_bytes(half, sizeof half);
    pass_gap();
    SEND(UNIT, 6, 0, 2, 0, 9);
    EXPECT(UNIT, 6, 0, 2, 0, 9);
}

static void test_requests_to_others_are_not_answered(void)
{
    SEND(UNIT + 1, 6, 0, 0, 0, 7);
    pass_gap();
    TEST_ASSERT_EQUAL_UINT(0, length);
    TEST_ASSERT_EQUAL_UINT16(0, word[0]);
}

static void test_a_broadcast_is_done_and_not_answered(void)
{
    SEND(MODBUS_RTU_BROADCAST, 6, 0, 0, 0, 7);
    pass_gap();
    TEST_ASSERT_EQUAL_UINT(0, length);
    TEST_ASSERT_EQUAL_UINT16(7, word[0]);
}

static void test_more_bytes_than_any_frame_has_are_dropped_until_a_gap(void)
{
    for (unsigned i = 0; i < 1000; i++)
        (void)takt_modbus_rtu_take(&rtu, UNIT, now_us, reply);
    pass_gap();
    TEST_ASSERT_EQUAL_UINT(0, length);
    SEND(UNIT, 3, 0, 0, 0, 1);
    EXPECT(UNIT, 3, 2, 0, 0);
}

static enum modbus_tcp_result feed(const uint8_t **bytes, size_t *size)
{
    return takt_modbus_tcp_take(&tcp, &map, bytes, size, reply, &length);
}

static enum modbus_tcp_result feed_all(const uint8_t *bytes, size_t size)
{
    return feed(&bytes, &size);
}

static const uint8_t tcp_request[] = {0x12, 0x34, 0, 0, 0, 6, 99, 3, 0, 1, 0, 1};

static void test_a_tcp_reply_has_the_transaction_and_unit_of_its_request(void)
{
    static const uint8_t expected[] = {0x12, 0x34, 0, 0, 0, 5, 99, 3, 2, 0, 0};

    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_REPLY, feed_all(tcp_request, sizeof tcp_request));
    TEST_ASSERT_EQUAL_UINT(sizeof expected, length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, reply, sizeof expected);
}

static void test_a_tcp_request_may_come_byte_by_byte(void)
{
    for (size_t i = 0; i + 1 < sizeof tcp_request; i++)
        TEST_ASSERT_EQUAL_INT(MODBUS_TCP_MORE, feed_all(tcp_request + i, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_REPLY, feed_all(tcp_request + sizeof tcp_request - 1, 1));
}

static void test_tcp_requests_sent_together_are_answered_one_by_one(void)
{
    uint8_t both[2 * sizeof tcp_request];
    const uint8_t *bytes = both;
    size_t size = sizeof both;

    memcpy(both, tcp_request, sizeof tcp_request);
    memcpy(both + sizeof tcp_request, tcp_request, sizeof tcp_request);
    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_REPLY, feed(&bytes, &size));
    TEST_ASSERT_EQUAL_UINT(sizeof tcp_request, size);
    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_REPLY, feed(&bytes, &size));
    TEST_ASSERT_EQUAL_UINT(0, size);
}

static void test_a_header_without_sense_ends_the_connection(void)
{
    static const uint8_t protocol[] = {0, 1, 0, 1, 0, 6};
    static const uint8_t too_short[] = {0, 1, 0, 0, 0, 1};
    static const uint8_t too_long[] = {0, 1, 0, 0, 0, 255};

    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_BROKEN, feed_all(protocol, sizeof protocol));
    takt_modbus_tcp_init(&tcp);
    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_BROKEN, feed_all(too_short, sizeof too_short));
    takt_modbus_tcp_init(&tcp);
    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_BROKEN, feed_all(too_long, sizeof too_long));
}

/*
 * A length that is right for the frame and wrong for the function does not put the stream out of
 * step.
 */
static void test_a_wrong_length_is_answered_and_the_stream_goes_on(void)
{
    static const uint8_t wrong[] = {0, 1, 0, 0, 0, 9, 1, 3, 0, 1, 0, 1, 7, 7, 7};

    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_REPLY, feed_all(wrong, sizeof wrong));
    TEST_ASSERT_EQUAL_HEX8(0x83, reply[7]);
    TEST_ASSERT_EQUAL_HEX8(3, reply[8]);
    TEST_ASSERT_EQUAL_INT(MODBUS_TCP_REPLY, feed_all(tcp_request, sizeof tcp_request));
    TEST_ASSERT_EQUAL_HEX8(3, reply[7]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_checksum_is_that_of_the_standard);
    RUN_TEST(test_the_gap_is_three_and_a_half_characters);
    RUN_TEST(test_a_request_is_answered_at_its_last_byte);
    RUN_TEST(test_two_requests_without_a_gap_are_both_answered);
    RUN_TEST(test_a_function_we_do_not_have_is_refused_after_the_gap);
    RUN_TEST(test_the_first_byte_after_a_gap_ends_the_frame_before_it);
    RUN_TEST(test_a_wrong_checksum_is_not_answered_and_changes_nothing);
    RUN_TEST(test_after_noise_and_a_gap_the_next_request_is_answered);
    RUN_TEST(test_half_a_request_is_forgotten_after_the_gap);
    RUN_TEST(test_requests_to_others_are_not_answered);
    RUN_TEST(test_a_broadcast_is_done_and_not_answered);
    RUN_TEST(test_more_bytes_than_any_frame_has_are_dropped_until_a_gap);
    RUN_TEST(test_a_tcp_reply_has_the_transaction_and_unit_of_its_request);
    RUN_TEST(test_a_tcp_request_may_come_byte_by_byte);
    RUN_TEST(test_tcp_requests_sent_together_are_answered_one_by_one);
    RUN_TEST(test_a_header_without_sense_ends_the_connection);
    RUN_TEST(test_a_wrong_length_is_answered_and_the_stream_goes_on);
    return UNITY_END();
}
