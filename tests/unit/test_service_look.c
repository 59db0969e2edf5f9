/*
 * What a panel is shown of the program: coordinates, modes, the way left; and what it sets of tools
 * and offsets.
 */
#include "base/maths.h"
#include "service_bench.h"

void setUp(void)
{
    bench_set_up();
}

void tearDown(void)
{
}

static void run_line(const char *line)
{
    start_line(line);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
}

static void expect_work(int64_t x, int64_t y, int64_t z)
{
    TEST_ASSERT_INT64_WITHIN(1, x, shown(REGISTER_WORK_POSITION_X));
    TEST_ASSERT_INT64_WITHIN(1, y, shown(REGISTER_WORK_POSITION_Y));
    TEST_ASSERT_INT64_WITHIN(1, z, shown(REGISTER_WORK_POSITION_Z));
}

static void test_without_offsets_work_coordinates_are_those_of_the_machine(void)
{
    run_line("G0 X10 Y-4 Z3");
    expect_work(10000, -4000, 3000);
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_SYSTEM));
}

static void test_work_coordinates_are_those_the_line_names(void)
{
    tools[0].offset.at[AXIS_Z] = 5;
    run_line("G10 L2 P2 X20 Y10 Z1 R90");
    run_line("G55 G0 X7 Y3 Z2");
    TEST_ASSERT_EQUAL_INT64(2, shown(REGISTER_SYSTEM));
    expect_work(7000, 3000, 2000);
    TEST_ASSERT_EQUAL_INT64(17000, shown(REGISTER_POSITION_X)); /* 20 - 3 */
    TEST_ASSERT_EQUAL_INT64(17000, shown(REGISTER_POSITION_Y)); /* 10 + 7 */
    run_line("G92 X0");
    expect_work(0, 3000, 2000);
    run_line("G43 H3");
    expect_work(0, 3000, -3000);
}

static void test_an_offset_the_panel_sets_counts_at_once(void)
{
    run_line("G0 X10");
    must(REGISTER_WORK_OFFSET_X, 4000);
    expect_work(6000, 0, 0);
    run_line("G0 X1"); /* goes on with the modes of the line before */
    TEST_ASSERT_EQUAL_INT64(5000, shown(REGISTER_POSITION_X));
    expect_work(1000, 0, 0);
}

/* The reader is ahead, in another system, long before the axes are. */
static void test_work_coordinates_are_of_the_motion_that_is_executed(void)
{
    load("G21 G90 G61 F600\nG10 L2 P2 X100\nG1 X50\nG55\nG1 X-49\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    for (unsigned i = 0; i < 2000; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT64(2, shown(REGISTER_SYSTEM));
    TEST_ASSERT_INT64_WITHIN(1, shown(REGISTER_POSITION_X), shown(REGISTER_WORK_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(50000, shown(REGISTER_POSITION_X) + shown(REGISTER_DISTANCE_TO_GO_X));
    TEST_ASSERT_INT64_WITHIN(1, 600000, shown(REGISTER_AXIS_FEED_X));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_AXIS_FEED_Y));
    wait_for(PANEL_IDLE);
    expect_work(-49000, 0, 0);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_DISTANCE_TO_GO_X));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_AXIS_FEED_X));
}

static void test_modes_are_those_of_the_line_read_last(void)
{
    run_line("G21 G90 G17 G61 G94 G40 G80");
    TEST_ASSERT_EQUAL_INT64(800 << 16, shown(REGISTER_MODES));
    run_line("G91 G20 G18 G64 G99");
    TEST_ASSERT_EQUAL_INT64(800 << 16 | 1 | 1 << 2 | 1 << 3 | 2 << 4, shown(REGISTER_MODES));
    run_line("G90 G21 G17 G61 G98 G1 X1 F600");
    TEST_ASSERT_EQUAL_INT64(10 << 16 | 1 << 10, shown(REGISTER_MODES));
}

static void test_axes_that_are_homed_are_told(void)
{
    TEST_ASSERT_EQUAL_INT64(7, shown(REGISTER_HOMED));
}

static void test_axes_that_look_for_their_homes_do_not_know_them(void)
{
    bench_set_up_machine();
    machine.axis[AXIS_Y].home_order = 1;
    const struct service_config config = {.machine = &machine,
                                          .can = can_single(bus_attach(&bus, NULL)),
                                          .reader = &service_reader,
                                          .parameters = &parameters};
    takt_service_init(&service, &config);
    cycle();
    TEST_ASSERT_EQUAL_INT64(5, shown(REGISTER_HOMED));
}

static void test_wear_of_a_tool_is_set_shown_and_reset(void)
{
    double length_mm, time_s;

    must(REGISTER_TOOL_SELECT, 3);
    must(REGISTER_TOOL_WEAR_LENGTH, 123456);
    must(REGISTER_TOOL_WEAR_TIME, 78);
    TEST_ASSERT_EQUAL_INT64(123456, shown(REGISTER_TOOL_WEAR_LENGTH));
    takt_correction_get_wear(&service.controller.correction, 3, &length_mm, &time_s);
    TEST_ASSERT_TRUE(length_mm == 123456 && time_s == 78);
    must(REGISTER_TOOL_WEAR_LENGTH, 0);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_TOOL_WEAR_LENGTH));
    TEST_ASSERT_EQUAL_INT64(78, shown(REGISTER_TOOL_WEAR_TIME));
    must(REGISTER_TOOL_SELECT, 4);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_VALUE, order(REGISTER_TOOL_WEAR_LENGTH, 1));
}

static void test_a_line_sets_the_wear_of_a_tool(void)
{
    must(REGISTER_TOOL_SELECT, 3);
    run_line("G10 L12 P3 I1000 J20");
    TEST_ASSERT_EQUAL_INT64(1000, shown(REGISTER_TOOL_WEAR_LENGTH));
    TEST_ASSERT_EQUAL_INT64(20, shown(REGISTER_TOOL_WEAR_TIME));
    run_line("G10 L12 P3"); /* a new one */
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_TOOL_WEAR_LENGTH));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_TOOL_WEAR_TIME));
}

/* When it is its turn, not when it is read. */
static void test_a_program_sets_wear_where_it_stands(void)
{
    load("G21 G90 G61 F600\nG1 X5\nG10 L12 P3 I7\nG1 X10\nM2\n");
    must(REGISTER_TOOL_SELECT, 3);
    must(REGISTER_CYCLE_START, 1);
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && takt_service_get_state(&service) != PANEL_IDLE;
         i++) {
        cycle();
        TEST_ASSERT_EQUAL_INT64(
            shown(REGISTER_POSITION_X) > 5000 ? 7 : 0,
            shown(REGISTER_POSITION_X) == 5000 ? 0 : shown(REGISTER_TOOL_WEAR_LENGTH));
    }
    TEST_ASSERT_EQUAL_INT64(7, shown(REGISTER_TOOL_WEAR_LENGTH));
}

static void test_wear_that_makes_no_sense_is_refused(void)
{
    static const struct {
        const char *line;
        enum takt_error error;
    } wrong[] = {
        {"G10 L12 P4 I1", TAKT_ERROR_TOOL_ABSENT},
        {"G10 L12 P3 J1.5", TAKT_ERROR_WORD_NOT_WHOLE},
        {"G10 L12 P3 I-1", TAKT_ERROR_WORD_OUT_OF_RANGE},
        {"G10 L12 P3 I1 Z2", TAKT_ERROR_WORD_UNUSED},
        {"G10 L12 P3 I1 R2", TAKT_ERROR_WORD_UNUSED},
    };

    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        start_line(wrong[i].line);
        wait_for(PANEL_ALARM);
        TEST_ASSERT_EQUAL_INT_MESSAGE(wrong[i].error, service.alarm_text.code, wrong[i].line);
        must(REGISTER_RESET, 1);
        wait_for(PANEL_IDLE);
    }
}

static void test_what_a_line_makes_of_a_tool_lasts(void)
{
    run_line("G10 L1 P3 Z12.5 R2");
    must(REGISTER_TOOL_SELECT, 3);
    TEST_ASSERT_EQUAL_INT64(12500, shown(REGISTER_TOOL_OFFSET_Z));
    TEST_ASSERT_EQUAL_INT64(4000, shown(REGISTER_TOOL_DIAMETER));
    run_line("G43 H3 G0 Z0");
    TEST_ASSERT_EQUAL_INT64(12500, shown(REGISTER_POSITION_Z));
}

static void test_the_next_program_starts_at_the_line_that_is_set_and_only_that_one(void)
{
    load("G21 G90 G61 F6000\nG1 X5\nG1 X5 Y5\nG1 X0 Y5\nM2\n");
    must(REGISTER_START_LINE, 4);
    must(REGISTER_CYCLE_START, 1);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_START_LINE));
    bool passed_line_3 = false;
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && takt_service_get_state(&service) != PANEL_IDLE;
         i++) {
        cycle();
        passed_line_3 = passed_line_3 || shown(REGISTER_ACTIVE_LINE) == 3;
    }
    TEST_ASSERT_FALSE(passed_line_3);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(5000, shown(REGISTER_POSITION_Y));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_offsets_work_coordinates_are_those_of_the_machine);
    RUN_TEST(test_work_coordinates_are_those_the_line_names);
    RUN_TEST(test_an_offset_the_panel_sets_counts_at_once);
    RUN_TEST(test_work_coordinates_are_of_the_motion_that_is_executed);
    RUN_TEST(test_modes_are_those_of_the_line_read_last);
    RUN_TEST(test_axes_that_are_homed_are_told);
    RUN_TEST(test_axes_that_look_for_their_homes_do_not_know_them);
    RUN_TEST(test_wear_of_a_tool_is_set_shown_and_reset);
    RUN_TEST(test_a_line_sets_the_wear_of_a_tool);
    RUN_TEST(test_a_program_sets_wear_where_it_stands);
    RUN_TEST(test_wear_that_makes_no_sense_is_refused);
    RUN_TEST(test_what_a_line_makes_of_a_tool_lasts);
    RUN_TEST(test_the_next_program_starts_at_the_line_that_is_set_and_only_that_one);
    return UNITY_END();
}
