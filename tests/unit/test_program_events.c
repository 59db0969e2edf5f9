/* firmware/program/events.h and modes.h: spindle, coolant, tool, waiting, feeds and path modes. */
#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

static void expect_spindle(enum spindle_direction direction, double speed_rpm)
{
    const struct move move = reader_next(&reader, MOVE_SPINDLE);

    TEST_ASSERT_EQUAL_INT(direction, move.direction);
    TEST_ASSERT_EQUAL_DOUBLE(speed_rpm, move.speed_rpm);
}

static void expect_coolant(bool mist, bool flood)
{
    const struct move move = reader_next(&reader, MOVE_COOLANT);

    TEST_ASSERT_EQUAL_INT(mist, move.mist);
    TEST_ASSERT_EQUAL_INT(flood, move.flood);
}

static void expect_tool(uint32_t tool, bool change)
{
    const struct move move = reader_next(&reader, MOVE_TOOL);

    TEST_ASSERT_EQUAL_UINT32(tool, move.tool);
    TEST_ASSERT_EQUAL_INT(change, move.tool_change);
}

static void test_orienting_without_angle_and_way_stops_the_spindle(void)
{
    reader_open(&reader, "S100 M3\nM19\nM3\nM19 P1\nM3\nM19 R0");
    expect_spindle(SPINDLE_CW, 100.0);
    expect_spindle(SPINDLE_OFF, 0.0);
    expect_spindle(SPINDLE_CW, 100.0);
    (void)reader_next(&reader, MOVE_ORIENT);
    expect_spindle(SPINDLE_CW, 100.0);
    (void)reader_next(&reader, MOVE_ORIENT);
    reader_expect_end(&reader);
}

static void check_error(const char *text, enum takt_error code, const char *word)
{
    reader_expect_refused(&reader, text, code);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(word, reader.diagnostic.word, text);
}

static void test_the_spindle_hears_of_speed_once(void)
{
    reader_open(&reader, "S100\nM3\nS200\nM4 S300\nM5\nS400\nM4");
    expect_spindle(SPINDLE_CW, 100.0);
    expect_spindle(SPINDLE_CW, 200.0);
    expect_spindle(SPINDLE_CCW, 300.0);
    expect_spindle(SPINDLE_OFF, 0.0);
    expect_spindle(SPINDLE_CCW, 400.0);
    reader_expect_end(&reader);
}

static void test_the_spindle_s_maximum_is_used_with_a_warning(void)
{
    reader_open(&reader, "M3 S30000");
    expect_spindle(SPINDLE_CW, 24000.0);
    TEST_ASSERT_TRUE(takt_program_warning(&reader.program, &reader.diagnostic));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_SPINDLE_LIMITED, reader.diagnostic.code);
    TEST_ASSERT_EQUAL_STRING("S30000", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_DOUBLE(24000.0, reader.diagnostic.value);
}

static void test_no_more_warnings_are_kept_than_there_is_room_for(void)
{
    unsigned count = 0;

    reader_open(&reader, "S90000\nS90000\nS90000\nS90000\nS90000\nS90000\nS90000");
    reader_expect_end(&reader);
    while (takt_program_warning(&reader.program, &reader.diagnostic)) {
        count++;
        TEST_ASSERT_EQUAL_UINT32(count, reader.diagnostic.line);
    }
    TEST_ASSERT_EQUAL_UINT(PROGRAM_WARNINGS_MAX, count);
}

static void test_coolants_add_up_until_m9(void)
{
    reader_open(&reader, "M7\nM8\nM9\nM8");
    expect_coolant(true, false);
    expect_coolant(true, true);
    expect_coolant(false, false);
    expect_coolant(false, true);
}

static void test_a_tool_is_prepared_and_changed_with_the_spindle_off(void)
{
    reader_open(&reader, "T5\nM6\nM3 S1\nT0 M6\nM6");
    expect_tool(5, false);
    expect_tool(5, true);
    expect_spindle(SPINDLE_CW, 1.0);
    expect_tool(0, false);
    expect_spindle(SPINDLE_OFF, 0.0);
    expect_tool(0, true);
    expect_tool(0, true);
    reader_expect_end(&reader);
}

static void test_a_change_needs_a_tool(void)
{
    check_error("M6", TAKT_ERROR_TOOL_MISSING, "M6");
    check_error("T1.5", TAKT_ERROR_WORD_NOT_WHOLE, "T1.5");
    check_error("T-1", TAKT_ERROR_WORD_OUT_OF_RANGE, "T-1");
    check_error("T1000000", TAKT_ERROR_WORD_OUT_OF_RANGE, "T1000000");
}

static void test_dwells_and_stops(void)
{
    reader_open(&reader, "G4 P0.25\nM0\nM1\nG20 G4 P2");
    TEST_ASSERT_EQUAL_DOUBLE(0.25, reader_next(&reader, MOVE_DWELL).dwell_s);
    TEST_ASSERT_FALSE(reader_next(&reader, MOVE_STOP).optional);
    TEST_ASSERT_TRUE(reader_next(&reader, MOVE_STOP).optional);
    TEST_ASSERT_EQUAL_DOUBLE(2.0, reader_next(&reader, MOVE_DWELL).dwell_s);
    check_error("G4", TAKT_ERROR_DWELL_MISSING, "G4");
}

static void test_some_values_cannot_be_negative(void)
{
    check_error("G4 P-1", TAKT_ERROR_WORD_NEGATIVE, "P-1");
    check_error("F-1", TAKT_ERROR_WORD_NEGATIVE, "F-1");
    check_error("S-1", TAKT_ERROR_WORD_NEGATIVE, "S-1");
    check_error("G64 P-0.1", TAKT_ERROR_WORD_NEGATIVE, "P-0.1");
}

static void test_feed_is_millimetres_or_inches_a_minute(void)
{
    reader_open(&reader, "F600 G1 X1\nG20 X1\nF10 X2\nG21 X60");
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 254.0 / 60.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 254.0 / 60.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
}

static void test_feed_of_a_rotary_axis_alone_is_degrees_a_minute(void)
{
    reader_open(&reader, "G20 F360 G1 A90\nA0 X1\nG93 A45 F2\nG21 X0 A0 F3");
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 6.0 * RAD_PER_DEGREE,
                              reader_next(&reader, MOVE_FEED).feed_mm_s);
    (void)reader_expect(&reader, MOVE_FEED, 25.4, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.5 * RAD_PER_DEGREE,
                              reader_next(&reader, MOVE_FEED).feed_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 25.4 / 20.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
}

static void test_inverse_time_is_one_over_the_minutes_of_a_move(void)
{
    reader_open(&reader, "G93 G1 X30 Y40 F2\nG2 X40 I5 F3 P2\nG1 F1\nG0 X0");
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 50.0 / 30.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.0 * 5.0 * MATHS_PI / 20.0,
                              reader_next(&reader, MOVE_ARC_CW).feed_mm_s);
    TEST_ASSERT_TRUE(reader_next(&reader, MOVE_FEED).feed_mm_s > 0.0);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, reader_next(&reader, MOVE_RAPID).feed_mm_s);
}

static void test_cutting_without_a_feed_is_refused(void)
{
    check_error("G1 X1", TAKT_ERROR_FEED_MISSING, "G1");
    check_error("F0 G2 I1", TAKT_ERROR_FEED_MISSING, "G2");
    check_error("G93 G3 I1", TAKT_ERROR_FEED_MISSING, "G3");
    check_error("G93 F10\nG94 G1 X1", TAKT_ERROR_FEED_MISSING, "G1");
    TEST_ASSERT_EQUAL_UINT32(2, reader.diagnostic.line);
}

static void expect_path(enum move_path path, double tolerance_mm)
{
    const struct move move = reader_next(&reader, MOVE_RAPID);

    TEST_ASSERT_EQUAL_INT(path, move.path);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, tolerance_mm, move.tolerance_mm);
}

static const char path_text[] = "G0 X1\nG64 X2\nG64 P0.1 X3\nG20 G64 P0.1 Q1 X0\nG61.1 X1\nG61 X2";

static void test_path_modes(void)
{
    reader_prepare(&reader);
    reader.config.path_tolerance_mm = 0.02;
    reader_text(&reader, path_text);
    expect_path(PATH_EXACT, 0.0);
    expect_path(PATH_BLEND, 0.02);
    expect_path(PATH_BLEND, 0.1);
    expect_path(PATH_BLEND, 2.54);
    expect_path(PATH_EXACT_STOP, 0.0);
    expect_path(PATH_EXACT, 0.0);
}

static void test_the_exact_path_can_be_forced(void)
{
    reader_prepare(&reader);
    reader.config.exact_path = true;
    reader_text(&reader, path_text);
    for (int i = 0; i < 4; i++) {
        expect_path(PATH_EXACT, 0.0);
    }
    expect_path(PATH_EXACT_STOP, 0.0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_orienting_without_angle_and_way_stops_the_spindle);
    RUN_TEST(test_the_spindle_hears_of_speed_once);
    RUN_TEST(test_the_spindle_s_maximum_is_used_with_a_warning);
    RUN_TEST(test_no_more_warnings_are_kept_than_there_is_room_for);
    RUN_TEST(test_coolants_add_up_until_m9);
    RUN_TEST(test_a_tool_is_prepared_and_changed_with_the_spindle_off);
    RUN_TEST(test_a_change_needs_a_tool);
    RUN_TEST(test_dwells_and_stops);
    RUN_TEST(test_some_values_cannot_be_negative);
    RUN_TEST(test_feed_is_millimetres_or_inches_a_minute);
    RUN_TEST(test_feed_of_a_rotary_axis_alone_is_degrees_a_minute);
    RUN_TEST(test_inverse_time_is_one_over_the_minutes_of_a_move);
    RUN_TEST(test_cutting_without_a_feed_is_refused);
    RUN_TEST(test_path_modes);
    RUN_TEST(test_the_exact_path_can_be_forced);
    return UNITY_END();
}
