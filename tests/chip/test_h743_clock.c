/* Start of the STM32H743's clock, with a crystal and without. */
#include "chip_model.h"
#include "clock_model.h"
#include "stm32/clock.h"
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

static void test_every_crystal_that_divides_800_makes_400_and_80_for_can(void)
{
    for (uint32_t mhz = 4; mhz <= 48; mhz++) {
        if (mhz % 2 != 0 && mhz % 5 != 0)
            continue;
        chip_model_reset();
        clock_model.crystal_hz = mhz * 1000000U;
        takt_clock_start(&clock, mhz * 1000000U);
        TEST_ASSERT_EQUAL(CLOCK_CRYSTAL, clock.source);
        TEST_ASSERT_EQUAL(400000000, clock_model_core_hz());
        TEST_ASSERT_EQUAL(clock_model_core_hz(), clock.core_hz);
        TEST_ASSERT_EQUAL(clock_model_bus1_hz(), clock.bus1_hz);
        TEST_ASSERT_EQUAL(80000000, clock_model_can_hz());
        TEST_ASSERT_EQUAL(clock_model_can_hz(), clock.can_hz);
        TEST_ASSERT_NULL(chip_model_broken());
    }
}

static void test_without_a_crystal_the_chip_runs_at_400_on_its_own_oscillator(void)
{
    clock_model.crystal_hz = 0;
    takt_clock_start(&clock, 25000000);
    TEST_ASSERT_EQUAL(CLOCK_INTERNAL, clock.source);
    TEST_ASSERT_EQUAL(400000000, clock_model_core_hz());
    TEST_ASSERT_LESS_THAN(3000000, chip_model_reads());
}

static void test_when_nothing_locks_the_chip_runs_at_64(void)
{
    clock_model.pll_locks = false;
    takt_clock_start(&clock, 25000000);
    TEST_ASSERT_EQUAL(CLOCK_SLOW, clock.source);
    TEST_ASSERT_EQUAL(64000000, clock_model_core_hz());
    TEST_ASSERT_EQUAL(64000000, clock_model_bus1_hz());
    TEST_ASSERT_EQUAL(64000000, clock.bus1_hz);
}

static void test_when_the_core_does_not_take_the_pll_it_stays_at_64(void)
{
    clock_model.switches = false;
    takt_clock_start(&clock, 25000000);
    TEST_ASSERT_EQUAL(CLOCK_SLOW, clock.source);
    TEST_ASSERT_EQUAL(64000000, clock.core_hz);
}

static void test_a_chip_whose_clock_control_answers_nothing_still_comes_up(void)
{
    clock_model.is_dead = true;
    takt_clock_start(&clock, 25000000);
    TEST_ASSERT_EQUAL(CLOCK_SLOW, clock.source);
    TEST_ASSERT_LESS_THAN(3000000, chip_model_reads());
}

static void test_a_crystal_that_does_not_divide_is_not_used(void)
{
    takt_clock_start(&clock, 8192000);
    TEST_ASSERT_EQUAL(CLOCK_INTERNAL, clock.source);
    chip_model_reset();
    takt_clock_start(&clock, 13000000);
    TEST_ASSERT_EQUAL(CLOCK_INTERNAL, clock.source);
    chip_model_reset();
    takt_clock_start(&clock, 50000000);
    TEST_ASSERT_EQUAL(CLOCK_INTERNAL, clock.source);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_crystal_that_divides_800_makes_400_and_80_for_can);
    RUN_TEST(test_without_a_crystal_the_chip_runs_at_400_on_its_own_oscillator);
    RUN_TEST(test_when_nothing_locks_the_chip_runs_at_64);
    RUN_TEST(test_when_the_core_does_not_take_the_pll_it_stays_at_64);
    RUN_TEST(test_a_chip_whose_clock_control_answers_nothing_still_comes_up);
    RUN_TEST(test_a_crystal_that_does_not_divide_is_not_used);
    return UNITY_END();
}
