/* firmware/program/program.h: errors name line, column and word, and leave everything as it was. */
#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

struct faulty {
    const char *text;
    enum takt_error code;
    uint32_t line, column;
    const char *word;
};

/*
 * One line of every kind of fault; those of expressions, arcs and events have tests of their own.
 */
static const struct faulty table[] = {
    {"G0 X1\nG77 D1", TAKT_ERROR_WORD_UNKNOWN, 2, 1, "G77"},
    {"X1 G89.5 K1", TAKT_ERROR_WORD_UNKNOWN, 1, 4, "G89.5"},
    {"G0 X1 N5", TAKT_ERROR_WORD_UNKNOWN, 1, 7, "N5"},
    {"F1 G5.1 X1", TAKT_ERROR_WORD_MISSING, 1, 4, "I"},
    {"G81 Z1", TAKT_ERROR_WORD_MISSING, 1, 1, "R"},
    {"M8 G10 L2", TAKT_ERROR_WORD_MISSING, 1, 4, "P"},
    {"G1.05", TAKT_ERROR_WORD_UNKNOWN, 1, 1, "G1.05"},
    {"G-1", TAKT_ERROR_WORD_UNKNOWN, 1, 1, "G-1"},
    {"G6553.5", TAKT_ERROR_WORD_UNKNOWN, 1, 1, "G6553.5"},
    {"G99999999999", TAKT_ERROR_WORD_UNKNOWN, 1, 1, "G99999999999"},
    {"M3 M100", TAKT_ERROR_WORD_UNKNOWN, 1, 4, "M100"},
    {"M0.5", TAKT_ERROR_WORD_UNKNOWN, 1, 1, "M0.5"},
    {"(a) D 1.5", TAKT_ERROR_WORD_UNUSED, 1, 5, "D1.5"},
    {"E1", TAKT_ERROR_WORD_UNUSED, 1, 1, "E1"},
    {"L2", TAKT_ERROR_WORD_UNUSED, 1, 1, "L2"},
    {"G0 X1 * Y2", TAKT_ERROR_CHARACTER_UNKNOWN, 1, 7, "*"},
    {"?", TAKT_ERROR_CHARACTER_UNKNOWN, 1, 1, "?"},
    {"F1\nG6.2 X0 Y0 K2 P3\nX1 Y0 K1.5", TAKT_ERROR_SPLINE_KNOT, 3, 7, "K1.5"},
    {"F1\nG6.2 X0 Y0 K0 P3\nX1 Y0 K0\nX2 Y1 K0\nG6.2 K2\nG6.2 K1", TAKT_ERROR_SPLINE_KNOT, 6, 6,
     "K1"},
    {"G0 X1 (a) 2 +3", TAKT_ERROR_CHARACTER_UNKNOWN, 1, 13, "+"},
    {"G0 X1.2.3", TAKT_ERROR_CHARACTER_UNKNOWN, 1, 8, "."},
    {"%%", TAKT_ERROR_CHARACTER_UNKNOWN, 1, 1, "%"},
    {"G0 X1 / Y2", TAKT_ERROR_CHARACTER_UNKNOWN, 1, 7, "/"},
    {"G0 X\tY1", TAKT_ERROR_NUMBER_EXPECTED, 1, 4, "X"},
    {"G0 X-", TAKT_ERROR_NUMBER_EXPECTED, 1, 5, "-"},
    {"N G0", TAKT_ERROR_NUMBER_EXPECTED, 1, 1, "N"},
    {"G0 (x", TAKT_ERROR_COMMENT_UNCLOSED, 1, 4, "("},
    {"G0 (x(y)", TAKT_ERROR_COMMENT_UNCLOSED, 1, 4, "("},
    {"G0 XSQRTT[4]", TAKT_ERROR_FUNCTION_UNKNOWN, 1, 5, "SQRTT"},
    {"G0 XSINY1", TAKT_ERROR_FUNCTION_UNKNOWN, 1, 5, "SINY"},
    {"(abort, no tool)", TAKT_ERROR_ABORTED, 1, 0, " no tool"},
    {"G0 X1 ( Abort,)", TAKT_ERROR_ABORTED, 1, 0, ""},
    {"; ABORT,x", TAKT_ERROR_ABORTED, 1, 0, "x"},
};

static void check(const struct faulty *f)
{
    reader_expect_refused(&reader, f->text, f->code);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f->line, reader.diagnostic.line, f->text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f->column, reader.diagnostic.column, f->text);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(f->word, reader.diagnostic.word, f->text);
}

static void test_errors_name_line_column_and_word(void)
{
    for (size_t i = 0; i < sizeof(table) / sizeof(table[0]); i++) {
        check(&table[i]);
    }
}

static void test_reading_goes_on_with_the_next_line(void)
{
    reader_open(&reader, "G0 X1\nX2 Q\nX3\nX4 (\n\nX5");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    reader_expect_error(&reader, TAKT_ERROR_NUMBER_EXPECTED);
    (void)reader_expect(&reader, MOVE_RAPID, 3.0, 0.0, 0.0);
    reader_expect_error(&reader, TAKT_ERROR_COMMENT_UNCLOSED);
    TEST_ASSERT_EQUAL_UINT32(6, reader_expect(&reader, MOVE_RAPID, 5.0, 0.0, 0.0).line);
    reader_expect_end(&reader);
}

/*
 * The faulty line selects every other mode before it fails, and moves to one of two points before
 * the second.
 */
static void test_a_faulty_line_changes_no_mode_and_moves_nothing(void)
{
    struct move move;

    reader_open(&reader, "G1 X1 F60\n"
                         "M4 S9 T5 F600 G20 G18 G91 G90.1 G55 G43 H5 G64 P1 G93 M8 X1 G0 Z99\n"
                         "#5161=900\n"
                         "G28 Y5\n"
                         "X2\nG2 X4 I1");
    (void)reader_expect(&reader, MOVE_FEED, 1.0, 0.0, 0.0);
    reader_expect_error(&reader, TAKT_ERROR_TRAVEL_EXCEEDED);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 5.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    move = reader_expect(&reader, MOVE_FEED, 2.0, 0.0, 0.0);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, move.feed_mm_s);
    TEST_ASSERT_EQUAL_INT(PATH_EXACT, move.path);
    move = reader_expect(&reader, MOVE_ARC_CW, 4.0, 0.0, 0.0);
    TEST_ASSERT_EQUAL_INT(PLANE_XY, move.plane);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.0, move.centre_mm[0]);
    reader_expect_end(&reader);
}

static void test_a_line_that_fails_half_way_is_undone_whole(void)
{
    reader_open(&reader, "#5161=900 G0 X1\nG28 X5\nY1");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    reader_expect_error(&reader, TAKT_ERROR_TRAVEL_EXCEEDED);
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 1.0, 0.0);
    reader_expect_end(&reader);
}

static void test_a_faulty_line_changes_no_parameter(void)
{
    static const char *const texts[] = {"G55 G0 X9999", "G92.1 G0 X9999", "G92.2 G0 X9999",
                                        "G92.3 G0 X9999", "G59.3 G92 X1 H1"};

    for (size_t i = 0; i < sizeof(texts) / sizeof(texts[0]); i++) {
        struct parameters before;

        reader_prepare(&reader);
        (void)takt_parameters_set(&reader.parameters, PARAMETER_AXIS_OFFSET, 5.0);
        (void)takt_parameters_set(&reader.parameters, PARAMETER_AXIS_APPLIED,
                                  i % 2 == 0 ? 1.0 : 0.0);
        (void)takt_parameters_set(&reader.parameters, PARAMETER_SYSTEM, 1.0);
        before = reader.parameters;
        reader_text(&reader, texts[i]);
        struct move move;

        TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR,
                              takt_program_next(&reader.program, &move, &reader.diagnostic));
        for (unsigned n = 1; n <= PARAMETER_NUMBER_MAX; n++) {
            TEST_ASSERT_TRUE_MESSAGE(takt_parameters_get(&before, n) ==
                                         takt_parameters_get(&reader.parameters, n),
                                     texts[i]);
        }
    }
}

static long fail_to_read(void *context, char *buffer, size_t size)
{
    (void)context;
    memset(buffer, 0, size);
    return SOURCE_ERROR;
}

static void test_a_source_that_fails_ends_the_program(void)
{
    const struct source source = {fail_to_read, NULL, NULL};
    struct move move;

    reader_prepare(&reader);
    takt_program_open(&reader.program, &reader.config, &source);
    reader_expect_error(&reader, TAKT_ERROR_SOURCE_UNREADABLE);
    TEST_ASSERT_EQUAL_INT(PROGRAM_END,
                          takt_program_next(&reader.program, &move, &reader.diagnostic));
}

static void test_a_program_can_be_opened_again(void)
{
    reader_open(&reader, "#<a>=1 G91 G20 G1 F1 X1\nX1 N1");
    (void)reader_next(&reader, MOVE_FEED);
    reader_expect_error(&reader, TAKT_ERROR_WORD_UNKNOWN);
    reader_text(&reader, "G0 X1\nX2\n#1=EXISTS[#<a>]");
    TEST_ASSERT_EQUAL_UINT32(1, reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0).line);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_parameters_get(&reader.parameters, 1));
}

static void test_the_interpreter_fits_into_its_memory(void)
{
    TEST_ASSERT_TRUE(sizeof(struct program) + sizeof(struct parameters) <= PROGRAM_MEMORY_MAX);
}

/* The errors of a text, by their lines. */
static void expect_errors(const char *text, const uint32_t *lines, unsigned count)
{
    struct move move;
    enum program_result result;
    unsigned errors = 0;

    reader_open(&reader, text);
    while ((result = takt_program_next(&reader.program, &move, &reader.diagnostic)) !=
           PROGRAM_END) {
        if (result == PROGRAM_ERROR) {
            const uint32_t line = errors < count ? lines[errors] : 0;

            errors++;
            TEST_ASSERT_EQUAL_UINT32_MESSAGE(line, reader.diagnostic.line, text);
        }
    }
    TEST_ASSERT_EQUAL_UINT_MESSAGE(count, errors, text);
}

static void test_what_only_comes_of_a_refused_line_is_no_error(void)
{
    static const uint32_t arc[] = {2, 5};
    static const uint32_t feed[] = {1};
    static const uint32_t other[] = {1, 2};
    static const uint32_t late[] = {2, 5};

    /* the motion, then where it begins; another error of a line is told */
    expect_errors("G1 X1 F60\nG2 X10 Y0 I5 J3\nX7 Y3 I-24.273 J2\nG3 X9 Y0 I1\nG1 X8 Y8 K1", arc,
                  2);
    expect_errors("G1 X1 F60 Q1\nX2\nG1 X3", feed, 1);
    expect_errors("G0 X1 Q1\nE1", other, 2);
    /* the place and the motion are known again */
    expect_errors("G1 X1 F60\nG2 X9 Y1 I3\nG1 X1 Y1\nX2\nG2 X9 Y1 I3", late, 2);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_errors_name_line_column_and_word);
    RUN_TEST(test_reading_goes_on_with_the_next_line);
    RUN_TEST(test_a_faulty_line_changes_no_mode_and_moves_nothing);
    RUN_TEST(test_what_only_comes_of_a_refused_line_is_no_error);
    RUN_TEST(test_a_line_that_fails_half_way_is_undone_whole);
    RUN_TEST(test_a_faulty_line_changes_no_parameter);
    RUN_TEST(test_a_source_that_fails_ends_the_program);
    RUN_TEST(test_a_program_can_be_opened_again);
    RUN_TEST(test_the_interpreter_fits_into_its_memory);
    return UNITY_END();
}
