/*
 * firmware/program/words.h: which words may stand on a line together, and in which order they act.
 */
#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

/* The text's last line must be refused at this column and word, and no line before it. */
static void check_error(const char *text, enum takt_error code, uint32_t column, const char *word)
{
    reader_expect_refused(&reader, text, code);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(word, reader.diagnostic.word, text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(column, reader.diagnostic.column, text);
}

static void test_codes_of_one_group_exclude_each_other(void)
{
    check_error("G0 G1 X1", TAKT_ERROR_WORDS_CONFLICT, 4, "G1");
    check_error("G17 G18", TAKT_ERROR_WORDS_CONFLICT, 5, "G18");
    check_error("G20 G21", TAKT_ERROR_WORDS_CONFLICT, 5, "G21");
    check_error("G90 G91", TAKT_ERROR_WORDS_CONFLICT, 5, "G91");
    check_error("G90.1 G91.1", TAKT_ERROR_WORDS_CONFLICT, 7, "G91.1");
    check_error("G93 G94", TAKT_ERROR_WORDS_CONFLICT, 5, "G94");
    check_error("G43 G49", TAKT_ERROR_WORDS_CONFLICT, 5, "G49");
    check_error("G54 G59.3", TAKT_ERROR_WORDS_CONFLICT, 5, "G59.3");
    check_error("G61 G64", TAKT_ERROR_WORDS_CONFLICT, 5, "G64");
    check_error("G4 P1 G28", TAKT_ERROR_WORDS_CONFLICT, 7, "G28");
    check_error("M3 M5", TAKT_ERROR_WORDS_CONFLICT, 4, "M5");
    check_error("M7 M8", TAKT_ERROR_WORDS_CONFLICT, 4, "M8");
    check_error("M0 M2", TAKT_ERROR_WORDS_CONFLICT, 4, "M2");
    check_error("M48 M49", TAKT_ERROR_WORDS_CONFLICT, 5, "M49");
    check_error("G1 G1 X1", TAKT_ERROR_WORDS_CONFLICT, 4, "G1");
}

static void test_codes_of_different_groups_share_a_line(void)
{
    reader_open(&reader, "G17 G21 G40 G49 G54 G61 G80 G90 G91.1 G94 M5 M9 M48");
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_COOLANT);
    reader_expect_end(&reader);
}

static void test_g80_gives_way_to_a_motion_code(void)
{
    reader_open(&reader, "G80 G0 X1\nG0 G80 X2");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0);
}

static void test_a_letter_has_one_value(void)
{
    check_error("G0 X1 Y1 X2", TAKT_ERROR_WORD_REPEATED, 10, "X");
    check_error("F1 F2", TAKT_ERROR_WORD_REPEATED, 4, "F");
}

static void test_every_word_must_be_of_use(void)
{
    check_error("G1 F1 X1 I2", TAKT_ERROR_WORD_UNUSED, 10, "I2");
    check_error("G0 X1 P2", TAKT_ERROR_WORD_UNUSED, 7, "P2");
    check_error("G49 H1", TAKT_ERROR_WORD_UNUSED, 5, "H1");
    check_error("Q1", TAKT_ERROR_WORD_UNUSED, 1, "Q1");
    check_error("R1 J2", TAKT_ERROR_WORD_UNUSED, 1, "R1");
    check_error("F1 G17 G2 X1 I1 K1", TAKT_ERROR_WORD_UNUSED, 17, "K1");
    check_error("G80 X1", TAKT_ERROR_WORD_UNUSED, 5, "X1");
}

static void test_no_word_serves_two_codes(void)
{
    check_error("G92 X1 G0", TAKT_ERROR_WORD_SHARED, 5, "X1");
    check_error("G28 Z1 G1 F1", TAKT_ERROR_WORD_SHARED, 5, "Z1");
    check_error("G4 P1 G2 X1 I1 F1", TAKT_ERROR_WORD_SHARED, 4, "P1");
    check_error("G64 P1 G4", TAKT_ERROR_WORD_SHARED, 5, "P1");
}

static void test_axis_words_go_on_with_the_last_motion(void)
{
    reader_open(&reader, "F60 G1 X1\nG4 P1\nY1\nG92.2\nG28 X1\nZ1");
    (void)reader_expect(&reader, MOVE_FEED, 1.0, 0.0, 0.0);
    (void)reader_next(&reader, MOVE_DWELL);
    (void)reader_expect(&reader, MOVE_FEED, 1.0, 1.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 1.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 1.0, 0.0);
    (void)reader_expect(&reader, MOVE_FEED, 0.0, 1.0, 1.0);
    reader_expect_end(&reader);
}

static void test_axis_words_need_a_motion(void)
{
    check_error("X1", TAKT_ERROR_MOTION_MODE_MISSING, 1, "X1");
    check_error("G0 X1\nG80\nM3 Z1 A2", TAKT_ERROR_MOTION_MODE_MISSING, 4, "Z1");
}

static void test_a_motion_code_alone_is_a_motion_without_length(void)
{
    reader_open(&reader, "G0 X1\nG0\nG1 F5");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_FEED, 1.0, 0.0, 0.0);
}

static void test_a_line_acts_in_the_order_of_the_standard(void)
{
    reader_open(&reader, "M2 X1 G4 P1 M8 M3 M6 T5 S100 F60 G1 G91");
    (void)reader_next(&reader, MOVE_TOOL);
    TEST_ASSERT_TRUE(reader_next(&reader, MOVE_TOOL).tool_change);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, reader_next(&reader, MOVE_SPINDLE).speed_rpm);
    TEST_ASSERT_TRUE(reader_next(&reader, MOVE_COOLANT).flood);
    (void)reader_next(&reader, MOVE_DWELL);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, reader_expect(&reader, MOVE_FEED, 1.0, 0.0, 0.0).feed_mm_s);
    reader_expect_end(&reader);
}

static void test_a_line_may_make_as_many_moves_as_there_are(void)
{
    reader_open(&reader, "M3 S1\nM2 G28 X1 M8 M4 M6 T5 S100");
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_TOOL);
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_TOOL);
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_COOLANT);
    (void)reader_next(&reader, MOVE_RAPID);
    (void)reader_next(&reader, MOVE_RAPID);
    reader_expect_end(&reader);
}

static void test_line_numbers_mean_nothing(void)
{
    reader_open(&reader, "N10 G0 X1\nN10.5X2\n/N7 X3\nN99");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 3.0, 0.0, 0.0);
    reader_expect_end(&reader);
    check_error("G0 N2", TAKT_ERROR_WORD_UNKNOWN, 4, "N2");
}

static void test_lines_with_a_slash_are_left_out_when_asked(void)
{
    reader_prepare(&reader);
    reader.config.block_delete = true;
    reader_text(&reader, "G0 X1\n/X2\n / what is this ?\nY1");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 1.0, 0.0);
    reader_expect_end(&reader);
}

static void test_percent_opens_and_ends_a_program(void)
{
    reader_open(&reader, "\n (x)\n%\nG0 X1\n % \nX2");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    reader_expect_end(&reader);
    reader_open(&reader, "G0 X1\n%\nX2");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    reader_expect_end(&reader);
}

static void test_nothing_is_read_after_the_end(void)
{
    reader_open(&reader, "G0 X1 M30\nnonsense");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    reader_expect_end(&reader);
}

static void test_codes_may_be_calculated(void)
{
    reader_open(&reader, "G00X1\nG[1-1] X2\n#1=91\nG#1 X1 M05.0");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0);
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_expect(&reader, MOVE_RAPID, 3.0, 0.0, 0.0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_codes_of_one_group_exclude_each_other);
    RUN_TEST(test_codes_of_different_groups_share_a_line);
    RUN_TEST(test_g80_gives_way_to_a_motion_code);
    RUN_TEST(test_a_letter_has_one_value);
    RUN_TEST(test_every_word_must_be_of_use);
    RUN_TEST(test_no_word_serves_two_codes);
    RUN_TEST(test_axis_words_go_on_with_the_last_motion);
    RUN_TEST(test_axis_words_need_a_motion);
    RUN_TEST(test_a_motion_code_alone_is_a_motion_without_length);
    RUN_TEST(test_a_line_acts_in_the_order_of_the_standard);
    RUN_TEST(test_a_line_may_make_as_many_moves_as_there_are);
    RUN_TEST(test_line_numbers_mean_nothing);
    RUN_TEST(test_lines_with_a_slash_are_left_out_when_asked);
    RUN_TEST(test_percent_opens_and_ends_a_program);
    RUN_TEST(test_nothing_is_read_after_the_end);
    RUN_TEST(test_codes_may_be_calculated);
    return UNITY_END();
}
