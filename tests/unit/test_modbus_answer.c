#include "modbus/modbus.h"
#include "unity.h"

#include <string.h>

/* A map of 100 registers of each table; it counts its calls. */
#define SIZE 100

static uint16_t word[SIZE];
static bool bit[SIZE];
static unsigned reads, writes;
static enum modbus_exception refusal; /* of writes */
static uint8_t reply[MODBUS_PDU_MAX];
static size_t length;

static enum modbus_exception read_map(void *context, enum modbus_table table, uint16_t address,
                                      uint16_t count, uint8_t *data)
{
    (void)context;
    reads++;
    if (address + count > SIZE)
        return MODBUS_ADDRESS;
    if (table == MODBUS_COILS)
        memset(data, 0, (size_t)(count + 7) / 8);
    for (unsigned i = 0; i < count; i++) {
        if (table != MODBUS_COILS)
            modbus_write16(data + (size_t)2 * i, word[address + i]);
        else if (bit[address + i])
            data[i / 8] = (uint8_t)(data[i / 8] | 1U << i % 8);
    }
    return MODBUS_GOOD;
}

static enum modbus_exception write_map(void *context, enum modbus_table table, uint16_t address,
                                       uint16_t count, const uint8_t *data)
{
    (void)context;
    if (refusal != MODBUS_GOOD)
        return refusal;
    if (address + count > SIZE)
        return MODBUS_ADDRESS;
    writes++;
    for (unsigned i = 0; i < count; i++) {
        if (table == MODBUS_COILS)
            bit[address + i] = ((unsigned)data[i / 8] >> i % 8 & 1U) != 0;
        else
            word[address + i] = modbus_read16(data + (size_t)2 * i);
    }
    return MODBUS_GOOD;
}

static const struct modbus_map map = {read_map, write_map, NULL};

void setUp(void)
{
    memset(word, 0, sizeof word);
    memset(bit, 0, sizeof bit);
    reads = writes = 0;
    refusal = MODBUS_GOOD;
}

void tearDown(void)
{
}

static void ask(const uint8_t *request, size_t size)
{
    memset(reply, 0xEE, sizeof reply);
    length = takt_modbus_answer(&map, request, size, reply);
}

#define ASK(...)                                                                                   \
    do {                                                                                           \
        const uint8_t request[] = {__VA_ARGS__};                                                   \
        ask(request, sizeof request);                                                              \
    } while (0)

#define EXPECT(...)                                                                                \
    do {                                                                                           \
        const uint8_t expected[] = {__VA_ARGS__};                                                  \
        TEST_ASSERT_EQUAL_UINT(sizeof expected, length);                                           \
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, reply, sizeof expected);                            \
    } while (0)

static void test_words_are_read_high_byte_first(void)
{
    word[7] = 0x1234;
    word[8] = 0x00FF;
    ASK(3, 0, 7, 0, 2);
    EXPECT(3, 4, 0x12, 0x34, 0x00, 0xFF);
    ASK(4, 0, 8, 0, 1);
    EXPECT(4, 2, 0x00, 0xFF);
}

/* The example of the specification: coils 20 to 38 as CD 6B 05. */
static void test_coils_are_read_eight_to_a_byte(void)
{
    const uint8_t coils[] = {0xCD, 0x6B, 0x05};

    for (unsigned i = 0; i < 19; i++)
        bit[19 + i] = ((unsigned)coils[i / 8] >> i % 8 & 1U) != 0;
    ASK(1, 0, 19, 0, 19);
    EXPECT(1, 3, 0xCD, 0x6B, 0x05);
}

static void test_one_coil_is_on_by_ff00_and_off_by_0(void)
{
    ASK(5, 0, 3, 0xFF, 0);
    EXPECT(5, 0, 3, 0xFF, 0);
    TEST_ASSERT_TRUE(bit[3]);
    ASK(5, 0, 3, 0, 0);
    TEST_ASSERT_FALSE(bit[3]);
    ASK(5, 0, 3, 0, 1);
    EXPECT(0x85, 3);
    ASK(5, 0, 3, 0xFF, 1);
    EXPECT(0x85, 3);
    TEST_ASSERT_FALSE(bit[3]);
}

static void test_one_word_is_written(void)
{
    ASK(6, 0, 9, 0xAB, 0xCD);
    EXPECT(6, 0, 9, 0xAB, 0xCD);
    TEST_ASSERT_EQUAL_HEX16(0xABCD, word[9]);
}

static void test_several_coils_are_written(void)
{
    ASK(15, 0, 10, 0, 10, 2, 0xCD, 0x01);
    EXPECT(15, 0, 10, 0, 10);
    TEST_ASSERT_TRUE(bit[10]);
    TEST_ASSERT_FALSE(bit[11]);
    TEST_ASSERT_TRUE(bit[18]);
    TEST_ASSERT_FALSE(bit[19]);
}

static void test_several_words_are_written(void)
{
    ASK(16, 0, 1, 0, 2, 4, 0, 10, 1, 2);
    EXPECT(16, 0, 1, 0, 2);
    TEST_ASSERT_EQUAL_HEX16(0x000A, word[1]);
    TEST_ASSERT_EQUAL_HEX16(0x0102, word[2]);
}

static void test_an_exchange_writes_before_it_reads(void)
{
    ASK(23, 0, 4, 0, 2, 0, 5, 0, 1, 2, 0x77, 0x88);
    EXPECT(23, 4, 0, 0, 0x77, 0x88);
    TEST_ASSERT_EQUAL_HEX16(0x7788, word[5]);
}

static void test_an_exchange_whose_reading_fails_writes_nothing(void)
{
    ASK(23, 0, 99, 0, 2, 0, 5, 0, 1, 2, 0x77, 0x88);
    EXPECT(0x97, 2);
    TEST_ASSERT_EQUAL_UINT(0, writes);
}

static void test_functions_that_are_not_there_are_exception_1(void)
{
    for (unsigned function = 0; function < 256; function++) {
        const uint8_t request[] = {(uint8_t)function, 0, 0, 0, 1};
        static const uint8_t known[] = {1, 2, 3, 4, 5, 6, 15, 16, 23};

        if (memchr(known, (int)function, sizeof known) != NULL)
            continue;
        ask(request, sizeof request);
        EXPECT((uint8_t)(function | 0x80), 1);
    }
    TEST_ASSERT_EQUAL_UINT(0, reads + writes);
}

static void test_quantities_out_of_range_are_exception_3(void)
{
    ASK(1, 0, 0, 0, 0);
    EXPECT(0x81, 3);
    ASK(1, 0, 0, 0x07, 0xD1);
    EXPECT(0x81, 3);
    ASK(3, 0, 0, 0, 0);
    EXPECT(0x83, 3);
    ASK(3, 0, 0, 0, 126);
    EXPECT(0x83, 3);
    ASK(4, 0, 0, 0xFF, 0xFF);
    EXPECT(0x84, 3);
    ASK(16, 0, 0, 0, 0, 0, 0);
    EXPECT(0x90, 3);
    ASK(16, 0, 0, 0xFF, 0xFF, 2, 0, 0);
    EXPECT(0x90, 3);
    TEST_ASSERT_EQUAL_UINT(0, reads + writes);
}

static void test_ranges_beyond_the_last_address_are_exception_2(void)
{
    ASK(3, 0xFF, 0xFF, 0, 2);
    EXPECT(0x83, 2);
    ASK(16, 0xFF, 0xFF, 0, 2, 4, 0, 0, 0, 0);
    EXPECT(0x90, 2);
    TEST_ASSERT_EQUAL_UINT(0, reads + writes);
    ASK(3, 0, 99, 0, 2);
    EXPECT(0x83, 2);
}

static void test_lengths_that_do_not_fit_are_exception_3(void)
{
    ASK(3);
    EXPECT(0x83, 3);
    ASK(3, 0, 0, 0);
    EXPECT(0x83, 3);
    ASK(3, 0, 0, 0, 1, 0);
    EXPECT(0x83, 3);
    ASK(6, 0, 0, 0);
    EXPECT(0x86, 3);
    ASK(15, 0, 0, 0, 9, 1, 0xFF);
    EXPECT(0x8F, 3);
    ASK(16, 0, 0, 0, 2, 4, 0, 0, 0);
    EXPECT(0x90, 3);
    ASK(16, 0, 0, 0, 2, 3, 0, 0, 0);
    EXPECT(0x90, 3);
    ASK(23, 0, 4, 0, 2, 0, 5, 0, 1, 2, 0x77);
    EXPECT(0x97, 3);
    ASK(23, 0, 4, 0, 2, 0, 5);
    EXPECT(0x97, 3);
    TEST_ASSERT_EQUAL_UINT(0, reads + writes);
}

static void test_a_refusal_of_the_map_is_the_exception(void)
{
    refusal = MODBUS_STATE;
    ASK(6, 0, 0, 0, 1);
    EXPECT(0x86, 4);
    refusal = MODBUS_BUSY;
    ASK(5, 0, 0, 0xFF, 0);
    EXPECT(0x85, 6);
}

static void test_the_longest_read_fills_the_reply(void)
{
    ASK(3, 0, 0, 0, 100);
    TEST_ASSERT_EQUAL_UINT(202, length);
    TEST_ASSERT_EQUAL_UINT(MODBUS_PDU_MAX - 1, 2 + 2 * MODBUS_READ_WORDS_MAX);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_words_are_read_high_byte_first);
    RUN_TEST(test_coils_are_read_eight_to_a_byte);
    RUN_TEST(test_one_coil_is_on_by_ff00_and_off_by_0);
    RUN_TEST(test_one_word_is_written);
    RUN_TEST(test_several_coils_are_written);
    RUN_TEST(test_several_words_are_written);
    RUN_TEST(test_an_exchange_writes_before_it_reads);
    RUN_TEST(test_an_exchange_whose_reading_fails_writes_nothing);
    RUN_TEST(test_functions_that_are_not_there_are_exception_1);
    RUN_TEST(test_quantities_out_of_range_are_exception_3);
    RUN_TEST(test_ranges_beyond_the_last_address_are_exception_2);
    RUN_TEST(test_lengths_that_do_not_fit_are_exception_3);
    RUN_TEST(test_a_refusal_of_the_map_is_the_exception);
    RUN_TEST(test_the_longest_read_fills_the_reply);
    return UNITY_END();
}
