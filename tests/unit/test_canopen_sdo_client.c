/*
 * The client's end of SDO against frames written by hand, byte for byte as CiA 301, 7.2.4.3 has
 * them.
 */
#include "canopen/sdo_client.h"
#include "unity.h"

#include <string.h>

#define TIMEOUT 5

static struct sdo_client client;
static struct can_frame frame;

void setUp(void)
{
    memset(&client, 0, sizeof client);
}

void tearDown(void)
{
}

static void assert_sent_first(const uint8_t bytes[8])
{
    TEST_ASSERT_TRUE(takt_sdo_client_next(&client, &frame));
    TEST_ASSERT_EQUAL_HEX16(0x605, frame.id);
    TEST_ASSERT_EQUAL_UINT(8, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes, frame.data, 8);
    takt_sdo_client_sent(&client);
}

static void assert_sent(const uint8_t bytes[8])
{
    assert_sent_first(bytes);
    TEST_ASSERT_FALSE(takt_sdo_client_next(&client, &frame));
}

static void take(const uint8_t bytes[8])
{
    struct can_frame answer = {.id = 0x585, .length = 8};
    memcpy(answer.data, bytes, 8);
    takt_sdo_client_take(&client, &answer);
}

#define SENT(...) assert_sent((const uint8_t[8]){__VA_ARGS__})
#define TAKE(...) take((const uint8_t[8]){__VA_ARGS__})

static void assert_done(void)
{
    TEST_ASSERT_EQUAL_INT(SDO_DONE, client.result);
    TEST_ASSERT_FALSE(sdo_client_is_busy(&client));
}

static void test_numbers_of_each_width_are_written_in_one_frame(void)
{
    takt_sdo_client_download_number(&client, 5, SDO_OBJECT(0x1017, 0), 0x1234, 2, TIMEOUT);
    SENT(0x2B, 0x17, 0x10, 0x00, 0x34, 0x12, 0, 0);
    TAKE(0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0);
    assert_done();
    takt_sdo_client_download_number(&client, 5, SDO_OBJECT(0x1A01, 2), 0x60F40020, 4, TIMEOUT);
    SENT(0x23, 0x01, 0x1A, 0x02, 0x20, 0x00, 0xF4, 0x60);
    TAKE(0x60, 0x01, 0x1A, 0x02, 0, 0, 0, 0);
    assert_done();
    takt_sdo_client_download_number(&client, 5, SDO_OBJECT(0x1A01, 0), 2, 1, TIMEOUT);
    SENT(0x2F, 0x01, 0x1A, 0x00, 2, 0, 0, 0);
}

static void test_a_number_is_read_from_one_frame(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1000, 0), TIMEOUT);
    SENT(0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0);
    TAKE(0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00);
    assert_done();
    TEST_ASSERT_EQUAL_HEX32(0x00020192, takt_sdo_client_number(&client));
    TEST_ASSERT_EQUAL_UINT(4, client.length);
}

static void test_bytes_beyond_a_short_number_do_not_count(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x6061, 0), TIMEOUT);
    SENT(0x40, 0x61, 0x60, 0x00, 0, 0, 0, 0);
    TAKE(0x4F, 0x61, 0x60, 0x00, 0x08, 0xAA, 0xBB, 0xCC);
    assert_done();
    TEST_ASSERT_EQUAL_HEX32(8, takt_sdo_client_number(&client));
    TEST_ASSERT_EQUAL_UINT(1, client.length);
}

static void test_a_long_value_is_read_in_segments(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1008, 0), TIMEOUT);
    SENT(0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0);
    TAKE(0x41, 0x08, 0x10, 0x00, 10, 0, 0, 0);
    SENT(0x60, 0, 0, 0, 0, 0, 0, 0);
    TAKE(0x00, 't', 'a', 'k', 't', ' ', 'd', 'r');
    SENT(0x70, 0, 0, 0, 0, 0, 0, 0);
    TAKE(0x19, 'i', 'v', 'e', 0, 0, 0, 0);
    assert_done();
    TEST_ASSERT_EQUAL_UINT(10, client.length);
    TEST_ASSERT_EQUAL_MEMORY("takt drive", client.value, 10);
}

static void test_a_long_value_is_written_in_segments(void)
{
    takt_sdo_client_download(&client, 5, SDO_OBJECT(0x2000, 0), (const uint8_t *)"gantry left", 11,
                             TIMEOUT);
    SENT(0x21, 0x00, 0x20, 0x00, 11, 0, 0, 0);
    TAKE(0x60, 0x00, 0x20, 0x00, 0, 0, 0, 0);
    SENT(0x00, 'g', 'a', 'n', 't', 'r', 'y', ' ');
    TAKE(0x20, 0, 0, 0, 0, 0, 0, 0);
    SENT(0x17, 'l', 'e', 'f', 't', 0, 0, 0);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client));
    TAKE(0x30, 0, 0, 0, 0, 0, 0, 0);
    assert_done();
}

static void test_an_abort_ends_a_transfer_with_its_code(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x5FFF, 0), TIMEOUT);
    SENT(0x40, 0xFF, 0x5F, 0x00, 0, 0, 0, 0);
    TAKE(0x80, 0xFF, 0x5F, 0x00, 0x00, 0x00, 0x02, 0x06);
    TEST_ASSERT_EQUAL_INT(SDO_ABORTED, client.result);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_OBJECT, client.abort_code);
    TEST_ASSERT_FALSE(takt_sdo_client_next(&client, &frame));
}

static void test_answers_of_others_are_passed_over(void)
{
    struct can_frame other = {.id = 0x586, .length = 8, .data = {0x60, 0x17, 0x10}};
    takt_sdo_client_download_number(&client, 5, SDO_OBJECT(0x1017, 0), 100, 2, TIMEOUT);
    TAKE(0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client)); /* nothing has been asked yet */
    SENT(0x2B, 0x17, 0x10, 0x00, 100, 0, 0, 0);
    takt_sdo_client_take(&client, &other);
    TAKE(0x60, 0x16, 0x10, 0x01, 0, 0, 0, 0);
    TAKE(0x80, 0x16, 0x10, 0x01, 0, 0, 2, 6);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client));
    TAKE(0x60, 0x17, 0x10, 0x00, 0, 0, 0, 0);
    assert_done();
}

static void test_an_answer_shorter_than_8_bytes_is_none(void)
{
    struct can_frame answer = {.id = 0x585, .length = 7, .data = {0x60, 0x17, 0x10}};
    takt_sdo_client_download_number(&client, 5, SDO_OBJECT(0x1017, 0), 100, 2, TIMEOUT);
    SENT(0x2B, 0x17, 0x10, 0x00, 100, 0, 0, 0);
    takt_sdo_client_take(&client, &answer);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client));
}

static void test_a_doubled_segment_counts_once(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1008, 0), TIMEOUT);
    SENT(0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0);
    TAKE(0x41, 0x08, 0x10, 0x00, 9, 0, 0, 0);
    SENT(0x60, 0, 0, 0, 0, 0, 0, 0);
    TAKE(0x00, '1', '2', '3', '4', '5', '6', '7');
    TAKE(0x00, '1', '2', '3', '4', '5', '6', '7');
    SENT(0x70, 0, 0, 0, 0, 0, 0, 0);
    TAKE(0x00, '1', '2', '3', '4', '5', '6', '7');
    TAKE(0x1B, '8', '9', 0, 0, 0, 0, 0);
    assert_done();
    TEST_ASSERT_EQUAL_MEMORY("123456789", client.value, 9);
}

static void test_a_value_without_an_end_is_given_up_and_the_node_told(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1008, 0), TIMEOUT);
    SENT(0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0);
    TAKE(0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0);
    for (unsigned i = 0; i < SDO_CLIENT_VALUE_MAX / 7; i++) {
        SENT((uint8_t)(0x60 | (i % 2) << 4), 0, 0, 0, 0, 0, 0, 0);
        TAKE((uint8_t)((i % 2) << 4), 1, 2, 3, 4, 5, 6, 7);
    }
    SENT(0x70, 0, 0, 0, 0, 0, 0, 0);
    TAKE(0x10, 1, 2, 3, 4, 5, 6, 7);
    TEST_ASSERT_EQUAL_INT(SDO_ABORTED, client.result);
    SENT(0x80, 0x08, 0x10, 0x00, 0x05, 0x00, 0x04, 0x05);
}

static void test_an_answer_that_no_request_has_is_given_up(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1000, 0), TIMEOUT);
    SENT(0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0);
    TAKE(0xC0, 0x00, 0x10, 0x00, 0, 0, 0, 0);
    TEST_ASSERT_EQUAL_INT(SDO_ABORTED, client.result);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_COMMAND, client.abort_code);
}

static void test_a_late_answer_to_a_transfer_of_another_kind_is_passed_over(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1401, 1), TIMEOUT);
    SENT(0x40, 0x01, 0x14, 0x01, 0, 0, 0, 0);
    TAKE(0x60, 0x01, 0x14, 0x01, 0, 0, 0, 0);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client));
    TAKE(0x43, 0x01, 0x14, 0x01, 1, 3, 0, 0);
    assert_done();
    TEST_ASSERT_EQUAL_HEX32(0x301, takt_sdo_client_number(&client));
}

static void test_a_doubled_answer_does_not_end_the_segments(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1008, 0), TIMEOUT);
    SENT(0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0);
    TAKE(0x41, 0x08, 0x10, 0x00, 5, 0, 0, 0);
    SENT(0x60, 0, 0, 0, 0, 0, 0, 0);
    TAKE(0x41, 0x08, 0x10, 0x00, 5, 0, 0, 0);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client));
    TAKE(0x05, 'd', 'r', 'i', 'v', 'e', 0, 0);
    assert_done();
}

static void test_the_abort_of_a_transfer_is_sent_before_it_is_repeated(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1000, 0), TIMEOUT);
    SENT(0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0);
    for (unsigned i = 0; i <= TIMEOUT; i++)
        takt_sdo_client_tick(&client);
    TEST_ASSERT_EQUAL_INT(SDO_UNANSWERED, client.result);
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1000, 0), TIMEOUT);
    assert_sent_first((const uint8_t[8]){0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05});
    TAKE(0x43, 0x00, 0x10, 0x00, 1, 0, 0, 0);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client)); /* that was the answer to the one before */
    SENT(0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0);
    TAKE(0x43, 0x00, 0x10, 0x00, 2, 0, 0, 0);
    assert_done();
    TEST_ASSERT_EQUAL_UINT32(2, takt_sdo_client_number(&client));
}

static void test_silence_ends_a_transfer_after_the_timeout_and_not_before(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1000, 0), TIMEOUT);
    SENT(0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0);
    for (unsigned i = 0; i < TIMEOUT; i++) {
        takt_sdo_client_tick(&client);
        TEST_ASSERT_TRUE(sdo_client_is_busy(&client));
    }
    takt_sdo_client_tick(&client);
    TEST_ASSERT_EQUAL_INT(SDO_UNANSWERED, client.result);
    SENT(0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05);
}

static void test_every_segment_has_the_whole_timeout(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1008, 0), TIMEOUT);
    SENT(0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0);
    for (unsigned i = 0; i < TIMEOUT; i++)
        takt_sdo_client_tick(&client);
    TAKE(0x41, 0x08, 0x10, 0x00, 9, 0, 0, 0);
    for (unsigned i = 0; i < TIMEOUT; i++)
        takt_sdo_client_tick(&client);
    TEST_ASSERT_TRUE(sdo_client_is_busy(&client));
}

static void test_a_request_that_could_not_be_sent_is_given_again(void)
{
    takt_sdo_client_upload(&client, 5, SDO_OBJECT(0x1000, 0), TIMEOUT);
    TEST_ASSERT_TRUE(takt_sdo_client_next(&client, &frame));
    TEST_ASSERT_TRUE(takt_sdo_client_next(&client, &frame));
    SENT(0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0);
}

static void test_abort_codes_have_a_meaning(void)
{
    TEST_ASSERT_EQUAL_STRING("object does not exist", takt_sdo_abort_text(0x06020000));
    TEST_ASSERT_EQUAL_STRING("object can only be read", takt_sdo_abort_text(0x06010002));
    TEST_ASSERT_EQUAL_STRING("unknown abort code", takt_sdo_abort_text(0x12345678));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_numbers_of_each_width_are_written_in_one_frame);
    RUN_TEST(test_a_number_is_read_from_one_frame);
    RUN_TEST(test_bytes_beyond_a_short_number_do_not_count);
    RUN_TEST(test_a_long_value_is_read_in_segments);
    RUN_TEST(test_a_long_value_is_written_in_segments);
    RUN_TEST(test_an_abort_ends_a_transfer_with_its_code);
    RUN_TEST(test_answers_of_others_are_passed_over);
    RUN_TEST(test_an_answer_shorter_than_8_bytes_is_none);
    RUN_TEST(test_a_doubled_segment_counts_once);
    RUN_TEST(test_a_value_without_an_end_is_given_up_and_the_node_told);
    RUN_TEST(test_an_answer_that_no_request_has_is_given_up);
    RUN_TEST(test_a_late_answer_to_a_transfer_of_another_kind_is_passed_over);
    RUN_TEST(test_a_doubled_answer_does_not_end_the_segments);
    RUN_TEST(test_the_abort_of_a_transfer_is_sent_before_it_is_repeated);
    RUN_TEST(test_silence_ends_a_transfer_after_the_timeout_and_not_before);
    RUN_TEST(test_every_segment_has_the_whole_timeout);
    RUN_TEST(test_a_request_that_could_not_be_sent_is_given_again);
    RUN_TEST(test_abort_codes_have_a_meaning);
    return UNITY_END();
}
