/*
 * Touch probes of the drives, by the master: what they are told and asked, and what becomes of a
 * drive that has none, is not wired to the probe, or does not answer.
 */
#include "starting_master.h"

static const struct point nowhere = {.at = {7, 7, 7}};

static void start(void)
{
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void run_probe(void)
{
    for (unsigned i = 0; i < 100 && drives_probe_is_busy(&drives); i++)
        cycle();
    TEST_ASSERT_FALSE(drives_probe_is_busy(&drives));
}

static struct point probe(bool falls)
{
    struct point latched = nowhere;
    takt_drives_arm_probe(&drives, falls);
    run_probe();
    takt_drives_read_probe(&drives);
    run_probe();
    takt_drives_get_latched(&drives, &latched);
    return latched;
}

static void show(uint8_t node, uint32_t status, uint16_t index, int32_t latched_inc)
{
    set_rule((struct fake_rule){.node = node, .object = SDO_OBJECT(0x60B9, 0), .value = status});
    set_rule((struct fake_rule){
        .node = node, .object = SDO_OBJECT(index, 0), .value = (uint32_t)latched_inc});
}

static void test_the_edge_is_looked_for_anew_and_its_positions_are_taken(void)
{
    start();
    show(1, 1 | 2, 0x60BA, -2500);
    show(3, 1 | 2, 0x60BA, 125);
    struct point latched = probe(false);
    const struct fake_written *told = fake_nodes_told(&nodes, 3, SDO_OBJECT(0x60B8, 0));
    TEST_ASSERT_EQUAL_HEX32(0x11, told->value);
    TEST_ASSERT_EQUAL_UINT(2, told->length);
    TEST_ASSERT_EQUAL_HEX32(0x60B8, told[-1].object >> 16);
    TEST_ASSERT_EQUAL_HEX32(0, told[-1].value);
    TEST_ASSERT_TRUE(latched.at[AXIS_X] == -2.5);
    TEST_ASSERT_TRUE(latched.at[AXIS_Y] == 7); /* it has seen nothing */
    TEST_ASSERT_TRUE(latched.at[AXIS_Z] == 0.125);
}

static void test_the_loss_of_contact_is_the_falling_edge(void)
{
    start();
    show(2, 1 | 4, 0x60BB, 3000);
    show(3, 1 | 2, 0x60BB, 3000); /* that is another edge */
    struct point latched = probe(true);
    TEST_ASSERT_EQUAL_HEX32(0x21, fake_nodes_told(&nodes, 2, SDO_OBJECT(0x60B8, 0))->value);
    TEST_ASSERT_TRUE(latched.at[AXIS_Y] == 3);
    TEST_ASSERT_TRUE(latched.at[AXIS_Z] == 7);
}

static void test_a_drive_that_refuses_is_told_and_not_asked_again(void)
{
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x60B8, 0), .abort_code = 0x06020000});
    start();
    TEST_ASSERT_EQUAL_HEX32(0, takt_drives_get_all_given_up(&drives) & 1u << DRIVES_NO_TOUCH_PROBE);
    TEST_ASSERT_TRUE(takt_drives_have_probe(&drives));
    TEST_ASSERT_TRUE(probe(false).at[AXIS_X] == 7);
    TEST_ASSERT_EQUAL_HEX32(1u << DRIVES_NO_TOUCH_PROBE, takt_drives_get_given_up(&drives, AXIS_Z) &
                                                             1u << DRIVES_NO_TOUCH_PROBE);
    TEST_ASSERT_FALSE(takt_drives_have_probe(&drives));
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_a_drive_that_does_not_answer_is_gone_past(void)
{
    start();
    show(3, 1 | 2, 0x60BA, 125);
    set_rule((struct fake_rule){.node = 1, .object = SDO_OBJECT(0x60B8, 0), .silent = 99});
    struct point latched = probe(false);
    TEST_ASSERT_TRUE(latched.at[AXIS_X] == 7);
    TEST_ASSERT_TRUE(latched.at[AXIS_Z] == 0.125);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_HEX32(1u << DRIVES_NO_TOUCH_PROBE, takt_drives_get_given_up(&drives, AXIS_X) &
                                                             1u << DRIVES_NO_TOUCH_PROBE);
}

static void test_what_gets_lost_is_asked_and_told_again(void)
{
    for (unsigned i = 0; i < 3; i++) {
        setUp();
        config.sdo_timeout_cycles = 5;
        start();
        show(1, 1 | 2, 0x60BA, 125);
        if (i == 0)
            set_rule((struct fake_rule){.object = SDO_OBJECT(0x60B8, 0), .silent = 2});
        else
            nodes.rule[i - 1].silent = 2;
        TEST_ASSERT_TRUE(probe(false).at[AXIS_X] == 0.125);
    }
}

static void test_what_was_latched_before_is_forgotten(void)
{
    start();
    show(1, 1 | 2, 0x60BA, 125);
    TEST_ASSERT_TRUE(probe(false).at[AXIS_X] == 0.125);
    nodes.rule[0].value = 1;
    TEST_ASSERT_TRUE(probe(false).at[AXIS_X] == 7);
}

static void test_a_fault_ends_it(void)
{
    start();
    takt_drives_arm_probe(&drives, false);
    takt_drives_stop_at_once(&drives, TAKT_ERROR_DRIVE_FAULT);
    TEST_ASSERT_FALSE(drives_probe_is_busy(&drives));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_edge_is_looked_for_anew_and_its_positions_are_taken);
    RUN_TEST(test_the_loss_of_contact_is_the_falling_edge);
    RUN_TEST(test_a_drive_that_refuses_is_told_and_not_asked_again);
    RUN_TEST(test_a_drive_that_does_not_answer_is_gone_past);
    RUN_TEST(test_what_gets_lost_is_asked_and_told_again);
    RUN_TEST(test_what_was_latched_before_is_forgotten);
    RUN_TEST(test_a_fault_ends_it);
    return UNITY_END();
}
