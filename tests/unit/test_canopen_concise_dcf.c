/*
 * Concise configurations: entries one after the other, and what is none.
 */
#include "canopen/concise_dcf.h"
#include "canopen/sdo.h"
#include "unity.h"

static const uint8_t two[] = {2,    0,    0, 0,                  /* entries */
                              0x17, 0x10, 0, 2, 0, 0, 0, 100, 0, /* 1017:00 = 100 */
                              0x00, 0x20, 1, 1, 0, 0, 0, 7};     /* 2000:01 = 7 */

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_entries_come_in_their_order(void)
{
    const struct concise_dcf dcf = {two, sizeof two};
    struct concise_dcf_entry entry;
    uint32_t at = CONCISE_DCF_FIRST, object;
    TEST_ASSERT_TRUE(takt_concise_dcf_is_well(&dcf, &object));
    TEST_ASSERT_TRUE(takt_concise_dcf_next(&dcf, &at, &entry));
    TEST_ASSERT_EQUAL_HEX32(SDO_OBJECT(0x1017, 0), entry.object);
    TEST_ASSERT_EQUAL_UINT32(2, entry.size);
    TEST_ASSERT_EQUAL_UINT(100, entry.value[0]);
    TEST_ASSERT_FALSE(takt_concise_dcf_has(&dcf, at, entry.object));
    TEST_ASSERT_TRUE(takt_concise_dcf_has(&dcf, at, SDO_OBJECT(0x2000, 1)));
    TEST_ASSERT_TRUE(takt_concise_dcf_next(&dcf, &at, &entry));
    TEST_ASSERT_EQUAL_HEX32(SDO_OBJECT(0x2000, 1), entry.object);
    TEST_ASSERT_FALSE(takt_concise_dcf_next(&dcf, &at, &entry));
}

static void test_one_that_is_cut_off_anywhere_is_none(void)
{
    uint32_t object;
    for (uint32_t length = 0; length < sizeof two; length++)
        TEST_ASSERT_FALSE(
            takt_concise_dcf_is_well(&(const struct concise_dcf){two, length}, &object));
}

static void check_byte(unsigned place, uint8_t value, uint32_t expected)
{
    uint8_t bytes[sizeof two];
    uint32_t object;
    for (unsigned i = 0; i < sizeof two; i++)
        bytes[i] = two[i];
    bytes[place] = value;
    TEST_ASSERT_FALSE(
        takt_concise_dcf_is_well(&(const struct concise_dcf){bytes, sizeof two}, &object));
    TEST_ASSERT_EQUAL_HEX32(expected, object);
}

static void test_what_is_wrong_is_named(void)
{
    check_byte(0, 3, 0);
    check_byte(0, 1, 0);
    check_byte(7, 0, SDO_OBJECT(0x1017, 0));     /* no value */
    check_byte(7, 65, SDO_OBJECT(0x1017, 0));    /* longer than a transfer */
    check_byte(10, 0xFF, SDO_OBJECT(0x1017, 0)); /* longer than all */
    check_byte(16, 2, SDO_OBJECT(0x2000, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_entries_come_in_their_order);
    RUN_TEST(test_one_that_is_cut_off_anywhere_is_none);
    RUN_TEST(test_what_is_wrong_is_named);
    return UNITY_END();
}
