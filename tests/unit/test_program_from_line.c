/*
 * Starting in the middle of a program.
 */
#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

static void open_at(uint32_t line, const char *text)
{
    reader_prepare(&reader);
    reader.config.from_line = line;
    reader_text(&reader, text);
}

static void test_the_machine_goes_up_across_and_down_at_the_feed(void)
{
    open_at(4, "F600 G1 X1 Z7\nX10 Y20\nZ-2\nX30\n");
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 7.0);
    (void)reader_expect(&reader, MOVE_RAPID, 10.0, 20.0, 7.0);
    const struct move down = reader_expect(&reader, MOVE_FEED, 10.0, 20.0, -2.0);

    TEST_ASSERT_EQUAL_DOUBLE(10.0, down.feed_mm_s);
    TEST_ASSERT_EQUAL_UINT(4, down.line);
    (void)reader_expect(&reader, MOVE_FEED, 30.0, 20.0, -2.0);
    reader_expect_end(&reader);
}

static void test_arcs_count_with_their_highest_point(void)
{
    open_at(2, "G18 F600 G3 X-10 I-5\nG1 X0\n");
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 5.0);
    (void)reader_expect(&reader, MOVE_RAPID, -10.0, 0.0, 5.0);
    (void)reader_expect(&reader, MOVE_FEED, -10.0, 0.0, 0.0);
}

static void test_without_a_feed_it_goes_down_slowly(void)
{
    open_at(3, "G0 Z5\nX1 Z-3\nX2\n");
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 5.0);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 5.0);
    TEST_ASSERT_EQUAL_DOUBLE(PROGRAM_APPROACH_FEED_MM_MIN / 60.0,
                             reader_expect(&reader, MOVE_FEED, 1.0, 0.0, -3.0).feed_mm_s);
}

static void test_tool_spindle_and_coolant_are_brought_back(void)
{
    struct move move;

    open_at(3, "T5 M6 S900 M3 M8\nT12 G0 X1 Z-1 A90\nG20 G91 X1\n");
    move = reader_next(&reader, MOVE_TOOL);
    TEST_ASSERT_TRUE(!move.tool_change && move.tool == 5);
    move = reader_next(&reader, MOVE_TOOL);
    TEST_ASSERT_TRUE(move.tool_change && move.tool == 5);
    move = reader_next(&reader, MOVE_TOOL);
    TEST_ASSERT_TRUE(!move.tool_change && move.tool == 12);
    move = reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 90.0 * RAD_PER_DEGREE, move.end.at[AXIS_A]);
    move = reader_next(&reader, MOVE_SPINDLE);
    TEST_ASSERT_TRUE(move.direction == SPINDLE_CW && move.speed_rpm == 900.0);
    move = reader_next(&reader, MOVE_COOLANT);
    TEST_ASSERT_TRUE(move.flood && !move.mist);
    (void)reader_expect(&reader, MOVE_FEED, 1.0, 0.0, -1.0);
    (void)reader_expect(&reader, MOVE_RAPID, 26.4, 0.0, -1.0);
    reader_expect_end(&reader);
}

static void expect_setup(unsigned which, double value, bool ends)
{
    const struct move move = reader_next(&reader, MOVE_SETUP);

    TEST_ASSERT_EQUAL_UINT(which, move.channel);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, value, move.setup);
    TEST_ASSERT_EQUAL_INT(ends, move.setup_ends);
    TEST_ASSERT_EQUAL_UINT(4, move.line);
}

/*
 * What was told last of each number, all of it together, with the tool up and before it goes
 * across.
 */
static void test_the_part_is_set_up_as_the_lines_before_have_it(void)
{
    open_at(4, "G10 L13 X0.5 K2\nG0 X1 Z3\nG10 L13 X0.7 R-1\nX2 Z2\n");
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 3.0);
    expect_setup(0, 0.7, false);
    expect_setup(5, 2.0 * RAD_PER_DEGREE, false);
    expect_setup(6, -1.0 * RAD_PER_DEGREE, true);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 3.0);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 2.0);
    reader_expect_end(&reader);
}

/* More moves than there is room for at once. */
static void test_all_that_there_is_to_bring_back_is_brought_back(void)
{
    open_at(4, "T5 M6 S900 M3 M8 F600\nT12 G10 L13 X1 Y2 Z3 I4 J5 K6 R7\nG0 X1 Z3\nG1 X2 Z-1\n");
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 3.0);
    for (unsigned i = 0; i < 3; i++)
        (void)reader_next(&reader, MOVE_TOOL);
    for (unsigned i = 0; i < MOVE_SETUP_VALUES; i++)
        expect_setup(i, (i + 1) * (i < 3 ? 1.0 : RAD_PER_DEGREE), i + 1 == MOVE_SETUP_VALUES);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 3.0);
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_COOLANT);
    (void)reader_expect(&reader, MOVE_FEED, 2.0, 0.0, -1.0);
    reader_expect_end(&reader);
}

static void test_it_starts_where_the_line_is_executed_for_the_first_time(void)
{
    open_at(2, "o1 sub\nG0 X[#1+1]\no1 endsub\nG0 X1\no1 call [1]\no1 call [2]\n");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 3.0, 0.0, 0.0);
    reader_expect_end(&reader);
}

static void test_from_the_first_line_all_is_as_usual(void)
{
    open_at(1, "G0 X1\n");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    reader_expect_end(&reader);
}

static void expect_never(uint32_t line, const char *text)
{
    struct move move;

    open_at(line, text);
    reader_expect_error(&reader, TAKT_ERROR_FROM_LINE_MISSED);
    TEST_ASSERT_EQUAL_DOUBLE(line, reader.diagnostic.value);
    TEST_ASSERT_EQUAL_INT(PROGRAM_END,
                          takt_program_next(&reader.program, &move, &reader.diagnostic));
}

static void test_a_line_that_is_never_executed_is_an_error(void)
{
    expect_never(9, "G0 X1\nG0 X2\n");
    expect_never(3, "G0 X1\nM2\nG0 X2\n");
    expect_never(2, "o1 if [0]\nG0 X1\no1 endif\n");
    expect_never(9, "o1 while [1]\nG0 X1\no1 endwhile\n");
}

static void test_nobody_starts_inside_a_compensated_contour(void)
{
    open_at(4, "F100 G41 D5\nG1 X50\nX100\nX150\nG40 X200\n");
    reader_expect_error(&reader, TAKT_ERROR_FROM_LINE_CUTTER);
    TEST_ASSERT_EQUAL_INT(
        PROGRAM_END, takt_program_next(&reader.program, &(struct move){0}, &reader.diagnostic));
}

static void test_nobody_starts_behind_what_a_probe_would_have_found(void)
{
    open_at(3, "F100 G38.3 Z-5\nG0 Z5\nX#5061\n");
    reader_expect_error(&reader, TAKT_ERROR_FROM_LINE_PROBE);
    TEST_ASSERT_EQUAL_UINT(1, reader.diagnostic.line);
    TEST_ASSERT_EQUAL_INT(
        PROGRAM_END, takt_program_next(&reader.program, &(struct move){0}, &reader.diagnostic));
}

static void test_nobody_starts_at_a_place_out_of_the_travel(void)
{
    /* The tool itself, 5 mm aside, stays inside while it follows the contour. */
    open_at(4, "F100 G42.1 D10 G1 X20 Y503\nX40\nG40\nX60\n");
    reader_expect_error(&reader, TAKT_ERROR_TRAVEL_EXCEEDED);
    TEST_ASSERT_EQUAL_UINT(4, reader.diagnostic.line);
    TEST_ASSERT_EQUAL_UINT(0, reader.diagnostic.column); /* no word of the line leads there */
    TEST_ASSERT_EQUAL_STRING("Y", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_INT(
        PROGRAM_END, takt_program_next(&reader.program, &(struct move){0}, &reader.diagnostic));
}

static void test_errors_before_the_line_are_told(void)
{
    open_at(3, "G0 X1\nG77\nG0 X2\n");
    reader_expect_error(&reader, TAKT_ERROR_WORD_UNKNOWN);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_machine_goes_up_across_and_down_at_the_feed);
    RUN_TEST(test_arcs_count_with_their_highest_point);
    RUN_TEST(test_without_a_feed_it_goes_down_slowly);
    RUN_TEST(test_tool_spindle_and_coolant_are_brought_back);
    RUN_TEST(test_the_part_is_set_up_as_the_lines_before_have_it);
    RUN_TEST(test_all_that_there_is_to_bring_back_is_brought_back);
    RUN_TEST(test_it_starts_where_the_line_is_executed_for_the_first_time);
    RUN_TEST(test_from_the_first_line_all_is_as_usual);
    RUN_TEST(test_a_line_that_is_never_executed_is_an_error);
    RUN_TEST(test_nobody_starts_inside_a_compensated_contour);
    RUN_TEST(test_nobody_starts_behind_what_a_probe_would_have_found);
    RUN_TEST(test_nobody_starts_at_a_place_out_of_the_travel);
    RUN_TEST(test_errors_before_the_line_are_told);
    return UNITY_END();
}
