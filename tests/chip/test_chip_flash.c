/* Erasing and programming by the flash controller; the watchdog; the crash record. */
#include "chip_model.h"
#include "flash_model.h"
#include "stm32/crash.h"
#include "stm32/flash.h"
#include "stm32/watchdog.h"
#include "unity.h"

#include <string.h>

static struct flash flash;
static struct flash_port port;

void setUp(void)
{
    chip_model_reset();
    flash_model_blank();
    port = takt_flash_get_port(&flash, flash_model_memory);
}

void tearDown(void)
{
    TEST_ASSERT_NULL_MESSAGE(chip_model_broken(), chip_model_broken());
    TEST_ASSERT_TRUE_MESSAGE(flash_model_is_locked(), "the controller is left unlocked");
}

/* Words of which each is filled with one letter of the text. */
static bool program(unsigned sector, uint32_t offset, const char *text)
{
    uint8_t words[4][FLASH_WORD_BYTES];
    uint32_t count = 0;

    for (; text[count] != '\0'; count++)
        memset(words[count], text[count], FLASH_WORD_BYTES);
    return port.program(port.context, sector, offset, words[0], count);
}

static void expect(unsigned sector, uint32_t offset, const char *text)
{
    const uint8_t *at = port.sector[sector] + offset;

    for (; *text != '\0'; text++, at += FLASH_WORD_BYTES)
        TEST_ASSERT_EACH_EQUAL_HEX8(*text, at, FLASH_WORD_BYTES);
    TEST_ASSERT_EACH_EQUAL_HEX8(0xFF, at, FLASH_WORD_BYTES);
}

static void test_words_are_programmed_where_they_belong(void)
{
    TEST_ASSERT_TRUE(program(0, 0, "takt"));
    TEST_ASSERT_TRUE(program(1, 0x1F000, "012"));
    expect(0, 0, "takt");
    expect(1, 0x1F000, "012");
}

static void test_erasing_a_sector_leaves_the_other_alone(void)
{
    TEST_ASSERT_TRUE(program(0, 0, "1") && program(1, 0, "2"));
    TEST_ASSERT_TRUE(port.erase(port.context, 0));
    expect(0, 0, "");
    expect(1, 0, "2");
    TEST_ASSERT_TRUE(program(0, 0, "3"));
    expect(0, 0, "3");
}

static void test_what_is_not_erased_is_found_to_differ(void)
{
    TEST_ASSERT_TRUE(program(0, 0, "a"));
    TEST_ASSERT_FALSE(program(0, 0, "b"));
    TEST_ASSERT_EQUAL(FLASH_DIFFERS, flash.problem);
    TEST_ASSERT_FALSE(program(0, 0, "b"));
}

static void test_a_bad_cell_is_found(void)
{
    static const uint8_t zeros[FLASH_WORD_BYTES] = {0};

    flash_model.has_bad_cell = true;
    TEST_ASSERT_FALSE(port.program(port.context, 0, 0x1220, zeros, 1));
    TEST_ASSERT_EQUAL(FLASH_DIFFERS, flash.problem);
}

static void test_write_protection_is_reported_and_the_next_try_works(void)
{
    flash_model.is_protected = true;
    TEST_ASSERT_FALSE(program(0, 0, "a"));
    TEST_ASSERT_EQUAL(FLASH_REFUSED, flash.problem);
    TEST_ASSERT_FALSE(port.erase(port.context, 0));
    flash_model.is_protected = false;
    TEST_ASSERT_TRUE(port.erase(port.context, 0));
    TEST_ASSERT_TRUE(program(0, 0, "a"));
}

static void test_a_controller_that_never_ends_is_given_up(void)
{
    flash_model.never_ends = true;
    TEST_ASSERT_FALSE(program(0, 0, "a"));
    TEST_ASSERT_EQUAL(FLASH_BUSY, flash.problem);
    TEST_ASSERT_LESS_THAN(100000, chip_model_reads());
    /* what it leaves is not locked: the model refuses to be written while busy */
    chip_model_reset();
}

static void test_the_watchdog_has_time_for_an_erase_and_is_short_again_afterwards(void)
{
    TEST_ASSERT_TRUE(takt_watchdog_start(FLASH_WATCHDOG_MS_RUN));
    TEST_ASSERT_EQUAL(FLASH_WATCHDOG_MS_RUN, watchdog_model_ms());
    TEST_ASSERT_TRUE(port.erase(port.context, 1));
    TEST_ASSERT_EQUAL(FLASH_WATCHDOG_MS, watchdog_model_longest_ms());
    TEST_ASSERT_EQUAL(FLASH_WATCHDOG_MS_RUN, watchdog_model_ms());
}

static void test_watchdog_times_are_those_asked_for(void)
{
    for (uint32_t ms = 2; ms <= WATCHDOG_MS_MAX; ms += 2) {
        TEST_ASSERT_TRUE(takt_watchdog_start(ms));
        TEST_ASSERT_EQUAL(ms, watchdog_model_ms());
    }
    TEST_ASSERT_FALSE(takt_watchdog_start(0));
    TEST_ASSERT_FALSE(takt_watchdog_start(WATCHDOG_MS_MAX + 1));
}

static void test_a_watchdog_that_does_not_answer_runs_all_the_same(void)
{
    watchdog_model_stick();
    TEST_ASSERT_FALSE(takt_watchdog_start(250));
    TEST_ASSERT_NOT_EQUAL(0, watchdog_model_ms());
}

static void test_a_crash_record_is_told_once_and_only_if_it_is_one(void)
{
    const struct crash_record record = {.cause = CRASH_BUS_FAULT, .address = 0x08001234};
    struct crash_record read;
    struct crash_memory memory;

    memset(&memory, 0xA5, sizeof memory); /* RAM after power-on */
    TEST_ASSERT_FALSE(takt_crash_take(&memory, &read));
    takt_crash_keep(&memory, &record);
    TEST_ASSERT_TRUE(takt_crash_take(&memory, &read));
    TEST_ASSERT_EQUAL_MEMORY(&record, &read, sizeof read);
    TEST_ASSERT_FALSE(takt_crash_take(&memory, &read));
    takt_crash_keep(&memory, &record);
    memory.record.status ^= 1U;
    TEST_ASSERT_FALSE(takt_crash_take(&memory, &read));
}

static void test_every_cause_of_a_crash_has_a_name(void)
{
    for (uint32_t i = 0; i <= CRASH_CAUSES; i++)
        TEST_ASSERT_NOT_NULL(takt_crash_name(i));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_words_are_programmed_where_they_belong);
    RUN_TEST(test_erasing_a_sector_leaves_the_other_alone);
    RUN_TEST(test_what_is_not_erased_is_found_to_differ);
    RUN_TEST(test_a_bad_cell_is_found);
    RUN_TEST(test_write_protection_is_reported_and_the_next_try_works);
    RUN_TEST(test_a_controller_that_never_ends_is_given_up);
    RUN_TEST(test_the_watchdog_has_time_for_an_erase_and_is_short_again_afterwards);
    RUN_TEST(test_watchdog_times_are_those_asked_for);
    RUN_TEST(test_a_watchdog_that_does_not_answer_runs_all_the_same);
    RUN_TEST(test_a_crash_record_is_told_once_and_only_if_it_is_one);
    RUN_TEST(test_every_cause_of_a_crash_has_a_name);
    return UNITY_END();
}
