/* What is found at the start and forbids to move. */
#include "stm32/findings.h"
#include "unity.h"

#include <string.h>

static struct findings found;

/* A board with everything, and a machine that needs all of it. */
void setUp(void)
{
    found = (struct findings){.needs_can = true,
                              .clock = CLOCK_CRYSTAL,
                              .can = CAN_ON,
                              .needs_steps = true,
                              .has_steps = true};
}

void tearDown(void)
{
}

static void expect(enum takt_error code, const char *text)
{
    struct diagnostic problem;
    char said[DIAGNOSTIC_TEXT_MAX];
    unsigned at = 0;

    TEST_ASSERT_TRUE_MESSAGE(takt_findings_next(&found, &at, &problem), text);
    (void)takt_diagnostic_text(&problem, said);
    TEST_ASSERT_EQUAL_STRING(text, said);
    TEST_ASSERT_EQUAL(code, problem.code);
    TEST_ASSERT_FALSE_MESSAGE(takt_findings_next(&found, &at, &problem),
                              "one problem is told as two");
}

static void test_a_board_with_everything_may_move(void)
{
    struct diagnostic problem;
    unsigned at = 0;

    TEST_ASSERT_FALSE(takt_findings_next(&found, &at, &problem));
}

static void test_a_missing_crystal_is_a_problem_for_can(void)
{
    found.clock = CLOCK_INTERNAL;
    expect(TAKT_ERROR_CRYSTAL_ABSENT,
           "the crystal does not oscillate, and without it the CAN bus has no rate");
    found.clock = CLOCK_SLOW;
    expect(TAKT_ERROR_CRYSTAL_ABSENT,
           "the crystal does not oscillate, and without it the CAN bus has no rate");
    found.needs_can = false;
    test_a_board_with_everything_may_move();
}

static void test_every_way_can_is_missing_is_told(void)
{
    found.can = CAN_ABSENT;
    expect(TAKT_ERROR_CAN_ABSENT, "the CAN controller does not answer");
    found.can = CAN_WAITING;
    expect(TAKT_ERROR_CAN_BUS,
           "the CAN bus is not idle: is there a transceiver, and is nothing shorted?");
    found.can_impossible = 800000;
    expect(TAKT_ERROR_CAN_RATE, "the CAN controller cannot make 800000 bit/s");
}

static void test_a_cycle_without_whole_slots_is_a_problem_for_steps(void)
{
    found.has_steps = false;
    expect(TAKT_ERROR_STEP_CYCLE, "step drives need a cycle of at most 2000 us, in steps of 5 us");
    found.needs_steps = false;
    test_a_board_with_everything_may_move();
}

static void test_after_a_crash_somebody_has_to_look(void)
{
    found.was_bitten = true;
    expect(TAKT_ERROR_WATCHDOG_RESET, "the watchdog had to restart the controller");
    found.has_crashed = true;
    found.crash = (struct crash_record){.cause = CRASH_BUS_FAULT, .address = 0x08001234};
    expect(TAKT_ERROR_CRASHED, "the controller had to stop and restart: a bus fault at 08001234");
}

static void test_a_broken_invariant_is_told_by_its_file_and_line(void)
{
    found.has_crashed = true;
    found.crash = (struct crash_record){.cause = CRASH_INVARIANT, .address = 105};
    crash_set_file(&found.crash, "firmware/plan/ring.c");
    expect(TAKT_ERROR_INVARIANT_BROKEN, "the controller had to stop and restart: invariant broken "
                                        "in firmware/plan/ring.c, line 105");
    crash_set_file(&found.crash, "firmware/controller/controller_background.c");
    expect(TAKT_ERROR_INVARIANT_BROKEN, "the controller had to stop and restart: invariant broken "
                                        "in troller/controller_background.c, line 105");
}

static void test_without_settings_nothing_moves(void)
{
    takt_diagnostic_set(&found.settings, TAKT_ERROR_SETTINGS_ABSENT, 0, 0, "", 0, 0);
    expect(TAKT_ERROR_SETTINGS_ABSENT,
           "no settings are stored: make them with takt machine --pack and load them");
}

static void test_all_problems_are_told_the_gravest_first(void)
{
    struct diagnostic problem;
    unsigned at = 0, count = 0;

    takt_diagnostic_set(&found.image, TAKT_ERROR_IMAGE_DAMAGED, 0, 0, "", 0, 7);
    takt_diagnostic_set(&found.settings, TAKT_ERROR_SETTINGS_CHECKSUM, 0, 0, "", 0, 0);
    found.clock = CLOCK_SLOW;
    found.can = CAN_ABSENT;
    found.has_steps = false;
    while (takt_findings_next(&found, &at, &problem)) {
        if (count++ == 0)
            TEST_ASSERT_EQUAL(TAKT_ERROR_IMAGE_DAMAGED, problem.code);
    }
    TEST_ASSERT_EQUAL(5, count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_board_with_everything_may_move);
    RUN_TEST(test_a_missing_crystal_is_a_problem_for_can);
    RUN_TEST(test_every_way_can_is_missing_is_told);
    RUN_TEST(test_a_cycle_without_whole_slots_is_a_problem_for_steps);
    RUN_TEST(test_after_a_crash_somebody_has_to_look);
    RUN_TEST(test_a_broken_invariant_is_told_by_its_file_and_line);
    RUN_TEST(test_without_settings_nothing_moves);
    RUN_TEST(test_all_problems_are_told_the_gravest_first);
    return UNITY_END();
}
