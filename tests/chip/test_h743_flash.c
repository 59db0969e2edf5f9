/*
 * Settings in the flash of an STM32H743: power that fails in a word. What both chips do is in
 * test_chip_flash.c.
 */
#include "chip_model.h"
#include "flash_model.h"
#include "h743_flash_model.h"
#include "stm32/flash.h"
#include "stm32h743/peripherals.h"
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

static bool program(unsigned sector, uint32_t offset)
{
    uint8_t word[FLASH_WORD_BYTES];

    memset(word, 'a', sizeof word);
    return port.program(port.context, sector, offset, word, 1);
}

static void test_sectors_that_are_sound_are_left_as_they_are(void)
{
    TEST_ASSERT_TRUE(program(0, 0) && program(1, 0x1FFE0));
    port = takt_flash_get_port(&flash, flash_model_memory);
    TEST_ASSERT_EQUAL(0, flash_model.erased);
    TEST_ASSERT_EQUAL('a', port.sector[0][0]);
    TEST_ASSERT_EQUAL('a', port.sector[1][0x1FFFF]);
}

static void test_a_sector_with_a_word_beyond_repair_is_erased_and_the_other_is_not(void)
{
    for (unsigned torn = 0; torn < FLASH_SECTORS; torn++) {
        setUp();
        TEST_ASSERT_TRUE(program(1 - torn, 0));
        h743_flash_model_tear(torn * FLASH_SECTOR_BYTES + 0x1FFE0);
        port = takt_flash_get_port(&flash, flash_model_memory);
        TEST_ASSERT_EQUAL(1, flash_model.erased);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xFF, port.sector[torn], FLASH_SECTOR_BYTES);
        TEST_ASSERT_EQUAL('a', port.sector[1 - torn][0]);
        TEST_ASSERT_TRUE(program(torn, 0));
    }
}

static void test_a_word_is_programmed_once_between_two_erasures(void)
{
    TEST_ASSERT_TRUE(program(0, 0));
    TEST_ASSERT_FALSE(program(0, 0));
    TEST_ASSERT_EQUAL(FLASH_DIFFERS, flash.problem);
    TEST_ASSERT_TRUE(port.erase(port.context, 0));
    TEST_ASSERT_TRUE(program(0, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sectors_that_are_sound_are_left_as_they_are);
    RUN_TEST(test_a_sector_with_a_word_beyond_repair_is_erased_and_the_other_is_not);
    RUN_TEST(test_a_word_is_programmed_once_between_two_erasures);
    return UNITY_END();
}
