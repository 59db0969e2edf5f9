/*
 * From the end of the configuration to "operation enabled": drives that take their time, have to be
 * told more than once, or lose an answer.
 */
#include "starting_master.h"

static void test_lost_answers_while_a_mode_is_waited_for_count_one_by_one(void)
{
    set_rule((struct fake_rule){.node = 2, .object = SDO_OBJECT(0x6061, 0), .value = 0});
    takt_drives_init(&drives, &config);
    while (shown[2] != CIA402_ENABLED)
        cycle();
    for (unsigned i = 0; i < 600; i++) {
        if (i % 100 == 0)
            nodes.rule[0].silent = 1;
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
    nodes.rule[0].value = 8;
    run_until(DRIVES_ENABLED);
}

/* Sixteen hundred cycles for each of its three steps, of two thousand. */
static void test_a_drive_that_takes_long_over_each_state_is_waited_for(void)
{
    slow_cycles = 1600;
    takt_drives_init(&drives, &config);
    for (unsigned i = 0; i < 3 * START_CYCLES && drives_get_state(&drives) == DRIVES_STARTING; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_a_drive_that_falls_back_again_and_again_is_not_waited_for(void)
{
    takt_drives_init(&drives, &config);
    while (nodes.starts[1] == 0)
        cycle();
    for (unsigned i = 0; i < START_CYCLES + 100; i++) {
        if (shown[2] == CIA402_SWITCHED_ON)
            shown[2] = CIA402_SWITCH_ON_DISABLED;
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_NOT_ENABLED, takt_drives_get_fault(&drives)->code);
}

/* Some drives want to see the bit for nearly so long. */
static void test_a_fault_reset_stands_for_a_while(void)
{
    held_cycles = 90;
    shown[2] = CIA402_FAULT;
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_a_fault_is_reset_by_as_many_edges_as_the_drive_needs(void)
{
    for (unsigned edges = 1; edges <= 5; edges += 2) {
        setUp();
        shown[2] = CIA402_FAULT;
        deaf_edges = edges - 1;
        run_start();
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
        TEST_ASSERT_EQUAL_UINT(0, deaf_edges);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lost_answers_while_a_mode_is_waited_for_count_one_by_one);
    RUN_TEST(test_a_drive_that_takes_long_over_each_state_is_waited_for);
    RUN_TEST(test_a_drive_that_falls_back_again_and_again_is_not_waited_for);
    RUN_TEST(test_a_fault_reset_stands_for_a_while);
    RUN_TEST(test_a_fault_is_reset_by_as_many_edges_as_the_drive_needs);
    return UNITY_END();
}
