#include "canopen/cia402.h"
#include "unity.h"

#include <string.h>

#define STATES (CIA402_FAULT + 1)

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_every_state_is_read_from_its_statusword_whatever_the_other_bits(void)
{
    for (unsigned state = 0; state < STATES; state++) {
        uint16_t word = takt_cia402_statusword((enum cia402_state)state);
        for (unsigned other = 0; other < 0x10000; other += 0x80) {
            TEST_ASSERT_EQUAL_INT(state, takt_cia402_state((uint16_t)(word | other)));
            TEST_ASSERT_EQUAL_INT(state, takt_cia402_state((uint16_t)(word | other | 0x10)));
        }
    }
}

/* Masks and values of the standard, written down a second time. */
static void test_statuswords_match_at_most_one_pattern_of_the_standard(void)
{
    static const struct {
        enum cia402_state state;
        unsigned mask, value;
    } patterns[] = {{CIA402_NOT_READY, 0x4F, 0x00},      {CIA402_SWITCH_ON_DISABLED, 0x4F, 0x40},
                    {CIA402_READY, 0x6F, 0x21},          {CIA402_SWITCHED_ON, 0x6F, 0x23},
                    {CIA402_ENABLED, 0x6F, 0x27},        {CIA402_QUICK_STOP, 0x6F, 0x07},
                    {CIA402_FAULT_REACTION, 0x4F, 0x0F}, {CIA402_FAULT, 0x4F, 0x08}};
    for (unsigned word = 0; word < 0x10000; word++) {
        enum cia402_state expected = CIA402_NOT_READY;
        for (unsigned i = 0; i < STATES; i++)
            if ((word & patterns[i].mask) == patterns[i].value)
                expected = patterns[i].state;
        TEST_ASSERT_EQUAL_INT(expected, takt_cia402_state((uint16_t)word));
    }
}

static void assert_step(enum cia402_state from, uint16_t controlword, enum cia402_state to)
{
    TEST_ASSERT_EQUAL_INT(to, takt_cia402_next_state(from, controlword, 0));
}

static void test_the_way_up_and_down_step_by_step(void)
{
    assert_step(CIA402_SWITCH_ON_DISABLED, CIA402_SHUTDOWN, CIA402_READY);
    assert_step(CIA402_READY, CIA402_SWITCH_ON, CIA402_SWITCHED_ON);
    assert_step(CIA402_SWITCHED_ON, CIA402_ENABLE_OPERATION, CIA402_ENABLED);
    assert_step(CIA402_ENABLED, CIA402_SWITCH_ON, CIA402_SWITCHED_ON);
    assert_step(CIA402_SWITCHED_ON, CIA402_SHUTDOWN, CIA402_READY);
    assert_step(CIA402_READY, CIA402_DISABLE_VOLTAGE, CIA402_SWITCH_ON_DISABLED);
    assert_step(CIA402_ENABLED, CIA402_SHUTDOWN, CIA402_READY);
    assert_step(CIA402_ENABLED, CIA402_DISABLE_VOLTAGE, CIA402_SWITCH_ON_DISABLED);
    assert_step(CIA402_READY, CIA402_ENABLE_OPERATION, CIA402_ENABLED);
}

static void test_a_drive_that_is_switched_off_leaves_only_by_shutdown(void)
{
    assert_step(CIA402_SWITCH_ON_DISABLED, CIA402_SWITCH_ON, CIA402_SWITCH_ON_DISABLED);
    assert_step(CIA402_SWITCH_ON_DISABLED, CIA402_ENABLE_OPERATION, CIA402_SWITCH_ON_DISABLED);
    assert_step(CIA402_SWITCH_ON_DISABLED, CIA402_QUICK_STOP_NOW, CIA402_SWITCH_ON_DISABLED);
}

static void test_quick_stop_brakes_an_enabled_drive_and_switches_off_others(void)
{
    assert_step(CIA402_ENABLED, CIA402_QUICK_STOP_NOW, CIA402_QUICK_STOP);
    assert_step(CIA402_SWITCHED_ON, CIA402_QUICK_STOP_NOW, CIA402_SWITCH_ON_DISABLED);
    assert_step(CIA402_READY, CIA402_QUICK_STOP_NOW, CIA402_SWITCH_ON_DISABLED);
    assert_step(CIA402_QUICK_STOP, CIA402_ENABLE_OPERATION, CIA402_QUICK_STOP);
    assert_step(CIA402_QUICK_STOP, CIA402_DISABLE_VOLTAGE, CIA402_SWITCH_ON_DISABLED);
}

static void test_fault_is_left_by_the_rising_edge_of_reset_alone(void)
{
    enum cia402_state next = takt_cia402_next_state(CIA402_FAULT, CIA402_FAULT_RESET, 0);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, next);
    next = takt_cia402_next_state(CIA402_FAULT, CIA402_FAULT_RESET, CIA402_FAULT_RESET);
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT, next);
    assert_step(CIA402_FAULT, CIA402_ENABLE_OPERATION, CIA402_FAULT);
    assert_step(CIA402_FAULT, CIA402_DISABLE_VOLTAGE, CIA402_FAULT);
    assert_step(CIA402_FAULT_REACTION, CIA402_FAULT_RESET, CIA402_FAULT_REACTION);
}

/*
 * Whatever state a drive begins in, following the advice ends in ENABLED: states that end by
 * themselves excepted.
 */
static void test_the_advised_steps_lead_to_enabled_in_at_most_four(void)
{
    static const enum cia402_state starts[] = {
        CIA402_SWITCH_ON_DISABLED, CIA402_READY, CIA402_SWITCHED_ON, CIA402_ENABLED, CIA402_FAULT,
        CIA402_QUICK_STOP};
    for (unsigned i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        enum cia402_state state = starts[i];
        uint16_t previous = 0;
        for (unsigned step = 0; step < 4; step++) {
            uint16_t controlword = takt_cia402_step_to_enabled(state);
            state = takt_cia402_next_state(state, controlword, previous);
            previous = controlword;
        }
        TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, state);
    }
}

static void test_the_short_test_for_enabled_agrees_with_the_state(void)
{
    for (unsigned word = 0; word <= 0xFFFF; word++)
        TEST_ASSERT_EQUAL_INT(takt_cia402_state((uint16_t)word) == CIA402_ENABLED,
                              cia402_is_enabled((uint16_t)word));
}

static void test_every_state_has_a_name(void)
{
    for (unsigned i = CIA402_NOT_READY; i <= CIA402_FAULT; i++)
        for (unsigned k = CIA402_NOT_READY; k < i; k++)
            TEST_ASSERT_NOT_EQUAL(0, strcmp(takt_cia402_state_text((enum cia402_state)i),
                                            takt_cia402_state_text((enum cia402_state)k)));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_state_is_read_from_its_statusword_whatever_the_other_bits);
    RUN_TEST(test_statuswords_match_at_most_one_pattern_of_the_standard);
    RUN_TEST(test_the_way_up_and_down_step_by_step);
    RUN_TEST(test_a_drive_that_is_switched_off_leaves_only_by_shutdown);
    RUN_TEST(test_quick_stop_brakes_an_enabled_drive_and_switches_off_others);
    RUN_TEST(test_fault_is_left_by_the_rising_edge_of_reset_alone);
    RUN_TEST(test_the_advised_steps_lead_to_enabled_in_at_most_four);
    RUN_TEST(test_the_short_test_for_enabled_agrees_with_the_state);
    RUN_TEST(test_every_state_has_a_name);
    return UNITY_END();
}
