/*
 * The handshake of a tool change: request and answer rise, then both fall.
 */
#include "controller/tool_changer.h"
#include "unity.h"

#define CHANGE_CYCLES 100

static struct tool_changer changer;

void setUp(void)
{
    takt_tool_changer_init(&changer, 0.001, 0.001 * CHANGE_CYCLES);
    changer.is_there = true;
}

void tearDown(void)
{
}

static void cycle(bool is_changed, bool asks, bool waits)
{
    TEST_ASSERT_EQUAL_INT(TAKT_OK, takt_tool_changer_cycle(&changer, true, is_changed));
    TEST_ASSERT_EQUAL(asks, tool_changer_asks(&changer));
    TEST_ASSERT_EQUAL(waits, tool_changer_waits(&changer));
}

static void test_request_and_answer_rise_and_fall_before_the_program_goes_on(void)
{
    TEST_ASSERT_TRUE(tool_changer_waits(&changer));
    cycle(false, true, true);
    cycle(false, true, true);
    cycle(true, false, true);
    cycle(true, false, true);
    cycle(false, false, false);
    TEST_ASSERT_EQUAL_INT(TAKT_OK, takt_tool_changer_cycle(&changer, false, false));
    TEST_ASSERT_TRUE(tool_changer_waits(&changer));
    cycle(false, true, true);
}

static void test_an_old_answer_has_to_fall_first(void)
{
    cycle(true, false, true);
    cycle(true, false, true);
    cycle(false, true, true);
}

static void test_a_program_that_is_left_lets_go_of_the_changer(void)
{
    cycle(false, true, true);
    TEST_ASSERT_EQUAL_INT(TAKT_OK, takt_tool_changer_cycle(&changer, false, false));
    TEST_ASSERT_FALSE(tool_changer_asks(&changer));
}

static void test_a_change_has_its_time(void)
{
    for (unsigned i = 0; i < CHANGE_CYCLES; i++)
        TEST_ASSERT_EQUAL_INT(TAKT_OK, takt_tool_changer_cycle(&changer, true, false));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TOOL_CHANGE_SLOW,
                          takt_tool_changer_cycle(&changer, true, false));
}

static void test_without_a_changer_nothing_waits(void)
{
    changer.is_there = false;
    TEST_ASSERT_FALSE(tool_changer_waits(&changer));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_request_and_answer_rise_and_fall_before_the_program_goes_on);
    RUN_TEST(test_an_old_answer_has_to_fall_first);
    RUN_TEST(test_a_program_that_is_left_lets_go_of_the_changer);
    RUN_TEST(test_a_change_has_its_time);
    RUN_TEST(test_without_a_changer_nothing_waits);
    return UNITY_END();
}
