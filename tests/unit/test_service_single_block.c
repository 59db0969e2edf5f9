/*
 * firmware/service/service.h: single block, switched on and off while a program runs. It holds at
 * the next block end at which the axes can come to rest within their limits, exactly there, and
 * nowhere else.
 */
#include "service_verifier.h"

#include <stdio.h>

#define CORNERS  120U
#define PLACE_MM 1e-9

static uint64_t chance;

void setUp(void)
{
    bench_set_up();
    begin_judging();
    chance = 1;
}

void tearDown(void)
{
}

static unsigned draw(unsigned below)
{
    chance = chance * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(chance >> 33) % below;
}

/*
 * 300 mm along X at 50 mm/s in blocks of this many tenths of a mm, on their way for half a second.
 */
static void cut(unsigned tenths)
{
    static char text[60000];
    int length = sprintf(text, "G21 F3000\n");

    for (unsigned k = tenths; k <= 3000; k += tenths)
        length += sprintf(text + length, "G1 X%u.%u\n", k / 10, k % 10);
    load(text);
    must(REGISTER_CYCLE_START, 1);
    verified_cycles(500);
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] > 10);
}

/* Held at an end of these blocks, at rest; returns which. */
static double expect_held(unsigned tenths)
{
    verified_wait_for(PANEL_HELD);
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_SINGLE_BLOCK, shown(REGISTER_HOLD_REASON));
    const double held = service.at.at[AXIS_X];
    const double blocks = takt_maths_round(held * 10.0 / tenths);

    verified_cycles(100);
    TEST_ASSERT_EQUAL_DOUBLE(held, service.at.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(PLACE_MM, 0.1 * tenths * blocks, held);
    return blocks;
}

static void test_switched_on_it_holds_at_the_next_block_end_that_can_be_reached(void)
{
    cut(50);
    const double from = service.at.at[AXIS_X];

    must(REGISTER_SINGLE_BLOCK, 1);
    const double blocks = expect_held(50);

    TEST_ASSERT_TRUE(5.0 * blocks < from + 20.0);
    must(REGISTER_CYCLE_START, 1);
    TEST_ASSERT_EQUAL_DOUBLE(blocks + 1, expect_held(50));
    must(REGISTER_CYCLE_START, 1);
    TEST_ASSERT_EQUAL_DOUBLE(blocks + 2, expect_held(50));
    expect_limits_kept();
}

static void test_blocks_too_short_to_brake_in_are_passed(void)
{
    cut(1);
    const double from = service.at.at[AXIS_X];

    must(REGISTER_SINGLE_BLOCK, 1);
    const double blocks = expect_held(1);

    TEST_ASSERT_TRUE(0.1 * blocks < from + 15.0);
    must(REGISTER_CYCLE_START, 1);
    TEST_ASSERT_EQUAL_DOUBLE(blocks + 1, expect_held(1));
    expect_limits_kept();
}

static void test_switched_off_it_holds_no_more(void)
{
    cut(50);
    must(REGISTER_SINGLE_BLOCK, 1);
    const double blocks = expect_held(50);

    must(REGISTER_SINGLE_BLOCK, 0);
    must(REGISTER_CYCLE_START, 1);
    verified_cycles(400);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] > 5.0 * blocks + 10.0);
    TEST_ASSERT_TRUE(most_velocity > 49);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(300000, shown(REGISTER_POSITION_X));
    expect_limits_kept();
}

static void test_a_switch_that_was_on_for_a_moment_changes_nothing(void)
{
    cut(50);
    must(REGISTER_SINGLE_BLOCK, 1);
    verified_cycle();
    must(REGISTER_SINGLE_BLOCK, 0);
    verified_cycles(1000);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(300000, shown(REGISTER_POSITION_X));
}

/* Corners of a random program: short lines and long ones, in any direction. */
static double corner[CORNERS][2];

static void write_random_program(char *text)
{
    double x = 0, y = 0;
    int length = sprintf(text, "G21 G17 F4000 G64\n");

    for (unsigned k = 0; k < CORNERS; k++) {
        const double reach = draw(3) == 0 ? 0.4 : 20.0;

        x = maths_clamp(x + reach * (0.001 * draw(2001) - 1.0), 0.0, 90.0);
        y = maths_clamp(y + reach * (0.001 * draw(2001) - 1.0), 0.0, 90.0);
        x = 0.001 * takt_maths_round(1000 * x);
        y = 0.001 * takt_maths_round(1000 * y);
        corner[k][0] = x;
        corner[k][1] = y;
        length += sprintf(text + length, "G1 X%.3f Y%.3f\n", x, y);
    }
    (void)sprintf(text + length, "M2\n");
}

static bool is_at_corner(void)
{
    for (unsigned k = 0; k < CORNERS; k++)
        if (maths_abs(service.at.at[AXIS_X] - corner[k][0]) < PLACE_MM &&
            maths_abs(service.at.at[AXIS_Y] - corner[k][1]) < PLACE_MM)
            return true;
    return false;
}

/* What an operator with restless hands does; true while there is something to do. */
static bool play(bool *on)
{
    const enum panel_state state = takt_service_get_state(&service);

    if (state == PANEL_HELD) {
        if (shown(REGISTER_HOLD_REASON) == PANEL_HOLD_SINGLE_BLOCK) {
            verified_cycles(60);
            TEST_ASSERT_TRUE_MESSAGE(is_at_corner(), "a single block is held at its end");
        }
        must(REGISTER_CYCLE_START, 1);
    } else if (state != PANEL_RUNNING) {
        return false;
    } else if (draw(6) == 0) {
        must(REGISTER_FEED_HOLD, 1);
    } else if (draw(3) == 0) {
        must(REGISTER_FEED_OVERRIDE, 200 + draw(1001));
    }
    if (draw(2) == 0)
        must(REGISTER_SINGLE_BLOCK, *on = !*on);
    return true;
}

static void run_random_program(uint64_t seed)
{
    static char text[CORNERS * 40];
    bool on = false;

    chance = seed;
    write_random_program(text);
    load(text);
    must(REGISTER_CYCLE_START, 1);
    do
        verified_cycles(1 + draw(300));
    while (play(&on));
    TEST_ASSERT_EQUAL_INT(PANEL_IDLE, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_DOUBLE_WITHIN(PLACE_MM, corner[CORNERS - 1][0], service.at.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(PLACE_MM, corner[CORNERS - 1][1], service.at.at[AXIS_Y]);
    expect_limits_kept();
}

static void test_whatever_the_operator_switches_limits_hold_and_holds_are_at_block_ends(void)
{
    static const enum ramp_profile profiles[] = {RAMP_PROFILE_JERK, RAMP_PROFILE_SMOOTH};

    for (unsigned seed = 1; seed <= 12; seed++) {
        bench_set_up_machine();
        machine.profile = profiles[seed % 2];
        machine.landing = seed % 3 == 0 ? LANDING_BLOCK : machine.landing;
        machine.override_proportional = seed % 4 == 0;
        bench_start();
        begin_judging();
        run_random_program(seed);
    }
}

/* Too short to brake in, sharp corners: while the first is run, at every cycle once. */
static void test_switched_on_in_any_cycle_of_short_blocks_it_keeps_the_limits(void)
{
    for (unsigned cycles = 1; cycles <= 50; cycles++) {
        bench_set_up();
        begin_judging();
        load(
            "G21 G61 F6000\nG1 X-0.005 Y0.05 F1919.807\nG1 X-0.004 Y0.049\nG1 X0.035 Y0.017\nM2\n");
        must(REGISTER_CYCLE_START, 1);
        verified_cycles(cycles);
        must(REGISTER_SINGLE_BLOCK, 1);
        for (unsigned i = 0; i < 3 && takt_service_get_state(&service) != PANEL_IDLE; i++) {
            verified_cycles(150);
            if (takt_service_get_state(&service) == PANEL_HELD)
                must(REGISTER_CYCLE_START, 1);
        }
        verified_wait_for(PANEL_IDLE);
        TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
        TEST_ASSERT_DOUBLE_WITHIN(PLACE_MM, 0.035, service.at.at[AXIS_X]);
        TEST_ASSERT_TRUE(most_acceleration <= 1000.0 * 1.0001);
        TEST_ASSERT_TRUE(most_jerk <= 50000.0 * 1.001);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_switched_on_it_holds_at_the_next_block_end_that_can_be_reached);
    RUN_TEST(test_blocks_too_short_to_brake_in_are_passed);
    RUN_TEST(test_switched_off_it_holds_no_more);
    RUN_TEST(test_a_switch_that_was_on_for_a_moment_changes_nothing);
    RUN_TEST(test_switched_on_in_any_cycle_of_short_blocks_it_keeps_the_limits);
    RUN_TEST(test_whatever_the_operator_switches_limits_hold_and_holds_are_at_block_ends);
    return UNITY_END();
}
