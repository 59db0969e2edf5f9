/* Start of the clock, with a crystal and without. */
#include "chip_model.h"
#include "clock_model.h"
#include "flash_model.h"
#include "stm32/clock.h"
#include "stm32/flash.h"
#include "unity.h"

static struct clock clock;

void setUp(void)
{
    chip_model_reset();
}

void tearDown(void)
{
    TEST_ASSERT_NULL_MESSAGE(chip_model_broken(), chip_model_broken());
}

static void test_every_crystal_of_whole_megahertz_makes_168(void)
{
    for (uint32_t mhz = 4; mhz <= 26; mhz++) {
        chip_model_reset();
        clock_model.crystal_hz = mhz * 1000000U;
        takt_clock_start(&clock, mhz * 1000000U);
        TEST_ASSERT_EQUAL(CLOCK_CRYSTAL, clock.source);
        TEST_ASSERT_EQUAL(168000000, clock_model_core_hz());
        TEST_ASSERT_EQUAL(clock_model_core_hz(), clock.core_hz);
        TEST_ASSERT_EQUAL(clock_model_bus1_hz(), clock.bus1_hz);
        TEST_ASSERT_NULL(chip_model_broken());
    }
}

static void test_without_a_crystal_the_chip_runs_at_168_on_its_own_oscillator(void)
{
    clock_model.crystal_hz = 0;
    takt_clock_start(&clock, 8000000);
    TEST_ASSERT_EQUAL(CLOCK_INTERNAL, clock.source);
    TEST_ASSERT_EQUAL(168000000, clock_model_core_hz());
    TEST_ASSERT_LESS_THAN(1000000, chip_model_reads());
}

static void test_when_nothing_locks_the_chip_runs_at_16(void)
{
    clock_model.pll_locks = false;
    takt_clock_start(&clock, 8000000);
    TEST_ASSERT_EQUAL(CLOCK_SLOW, clock.source);
    TEST_ASSERT_EQUAL(16000000, clock_model_core_hz());
    TEST_ASSERT_EQUAL(16000000, clock_model_bus1_hz());
    TEST_ASSERT_EQUAL(16000000, clock.bus1_hz);
}

static void test_when_the_core_does_not_take_the_pll_it_stays_at_16(void)
{
    clock_model.switches = false;
    takt_clock_start(&clock, 8000000);
    TEST_ASSERT_EQUAL(CLOCK_SLOW, clock.source);
    TEST_ASSERT_EQUAL(16000000, clock.core_hz);
}

static void test_a_chip_whose_clock_control_answers_nothing_still_comes_up(void)
{
    clock_model.is_dead = true;
    takt_clock_start(&clock, 8000000);
    TEST_ASSERT_EQUAL(CLOCK_SLOW, clock.source);
    TEST_ASSERT_LESS_THAN(1000000, chip_model_reads());
}

static void test_a_crystal_that_does_not_divide_is_not_used(void)
{
    takt_clock_start(&clock, 8192000);
    TEST_ASSERT_EQUAL(CLOCK_INTERNAL, clock.source);
    chip_model_reset();
    takt_clock_start(&clock, 30000000);
    TEST_ASSERT_EQUAL(CLOCK_INTERNAL, clock.source);
}

static bool program_word(uint32_t offset)
{
    static const uint8_t word[FLASH_WORD_BYTES] = {0};
    struct flash flash;
    const struct flash_port port = takt_flash_get_port(&flash, flash_model_memory);

    return port.program(port.context, 0, offset, word, 1);
}

static void test_after_programming_the_data_cache_is_as_it_was(void)
{
    flash_model_blank();
    clock_model_write_acr(0x705);
    TEST_ASSERT_TRUE(program_word(0));
    TEST_ASSERT_EQUAL_HEX(0x705, clock_model_read_acr());
    clock_model_write_acr(0x305);
    TEST_ASSERT_TRUE(program_word(FLASH_WORD_BYTES));
    TEST_ASSERT_EQUAL_HEX(0x305, clock_model_read_acr());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_crystal_of_whole_megahertz_makes_168);
    RUN_TEST(test_without_a_crystal_the_chip_runs_at_168_on_its_own_oscillator);
    RUN_TEST(test_when_nothing_locks_the_chip_runs_at_16);
    RUN_TEST(test_when_the_core_does_not_take_the_pll_it_stays_at_16);
    RUN_TEST(test_a_chip_whose_clock_control_answers_nothing_still_comes_up);
    RUN_TEST(test_a_crystal_that_does_not_divide_is_not_used);
    RUN_TEST(test_after_programming_the_data_cache_is_as_it_was);
    return UNITY_END();
}
