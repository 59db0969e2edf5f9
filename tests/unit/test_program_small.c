/*
 * The room program with the sizes it has in the images, hal/CMakeLists.txt: what they must have
 * room for, and what comes when it is not enough.
 */
#include "program_reader.h"

static struct reader reader;
static char text[16384];
static size_t length;

void setUp(void)
{
    length = 0;
}

void tearDown(void)
{
}

static void add_character(char c)
{
    TEST_ASSERT_TRUE(length < sizeof(text) - 1);
    text[length++] = c;
    text[length] = '\0';
}

/* Three digits. */
static void add_number(unsigned number)
{
    for (unsigned unit = 100; unit > 0; unit /= 10) {
        add_character((char)('0' + number / unit % 10));
    }
}

/* A pattern with this number wherever it has a '%'. */
static void add_numbered(const char *pattern, unsigned number)
{
    for (; *pattern != '\0'; pattern++) {
        if (*pattern == '%') {
            add_number(number);
        } else {
            add_character(*pattern);
        }
    }
}

/* The same this many times, with 0, 1 ... */
static void add(const char *pattern, unsigned times)
{
    for (unsigned i = 0; i < times; i++) {
        add_numbered(pattern, i);
    }
}

static void expect_refusal(enum takt_error code, unsigned line, unsigned column, const char *word,
                           double value)
{
    reader_expect_refused(&reader, text, code);
    TEST_ASSERT_EQUAL_UINT32(line, reader.diagnostic.line);
    TEST_ASSERT_EQUAL_UINT32(column, reader.diagnostic.column);
    TEST_ASSERT_EQUAL_STRING(word, reader.diagnostic.word);
    TEST_ASSERT_EQUAL_DOUBLE(value, reader.diagnostic.value);
}

/*
 * Each call has 12 arguments, of which the last is not 0, a name of its own, and an open IF; the
 * innermost saves modes.
 */
static void test_ten_calls_have_room_and_find_their_own_again(void)
{
    static const double minus_0 = -0.0;

    reader_open(&reader, "o<deep> sub\n"
                         "#<mine>=[#1*2]\n"
                         "o<more> if [#1 lt 10]\n"
                         "o<deep> call [#1+1] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [#1+100]\n"
                         "o<more> else\n"
                         "M70\nG91\nM72\n"
                         "o<more> endif\n"
                         "G0 X#1 Y#<mine> Z#12\n"
                         "o<deep> endsub\n"
                         "#12=-0\n"
                         "o<deep> call [1] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [100]\n"
                         "G0 X#1 Y#30\n");
    for (unsigned call = 10; call >= 1; call--) {
        reader_expect_rapid(&reader, call, 2.0 * call, 99.0 + call);
    }
    reader_expect_rapid(&reader, 0.0, 0.0, 100.0);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_MEMORY(&minus_0, &reader.parameters.local[11], sizeof(minus_0));
}

/*
 * 160 numbers: 30 of the main program's #1 ... and of five calls' leave 10, too few for the sixth.
 */
static void test_calls_that_keep_too_much_are_refused(void)
{
    add("#30=1\no1 sub\n", 1);
    add(" o1 call", 1);
    add(" [1]", 30);
    add("\no1 endsub\no1 call", 1);
    add(" [1]", 30);
    add("\n", 1);
    expect_refusal(TAKT_ERROR_PROGRAM_FULL, 3, 2, "O1 CALL", 0.0);
}

static void test_saved_modes_that_find_no_room_are_refused(void)
{
    add("#30=1\no1 sub\n", 1);
    add("o2 if [#1 lt 5]\no1 call [#1+1]", 1);
    add(" [1]", 29);
    add("\no2 else\nG0 X1 M70\no2 endif\no1 endsub\no1 call", 1);
    add(" [1]", 30);
    add("\n", 1);
    expect_refusal(TAKT_ERROR_PROGRAM_FULL, 6, 7, "M70", 0.0);
}

/* 768 characters: 24 names of 31, each with a zero behind it. */
static void test_names_of_parameters_run_out_of_characters(void)
{
    add("#<_abcdefghijklmnopqrstuvwxyz_%>=1\n", 24);
    add("G0 X1 #<more>=1\n", 1);
    expect_refusal(TAKT_ERROR_PARAMETERS_FULL, 25, 9, "MORE", 0.0);
}

static void test_names_of_o_words_run_out_of_characters(void)
{
    add("#<_abcdefghijklmnopqrstuvwxyz_%>=1\n", 24);
    add("o<more> if [1]\n", 1);
    expect_refusal(TAKT_ERROR_PROGRAM_FULL, 25, 1, "O<MORE> IF", 0.0);
    length = 0;
    add("#<_abcdefghijklmnopqrstuvwxyz_%>=1\n", 23);
    add("o<a_subroutine_of_28_letters_s> sub\no<passed_over_> if\no<a_subroutine_of_28_letters_s> "
        "endsub\n",
        1);
    add("o<more> sub\n", 1);
    expect_refusal(TAKT_ERROR_PROGRAM_FULL, 27, 1, "O<MORE> SUB", 0.0);
}

/* What is no longer open or set makes room, and what is stays what it is. */
static void test_names_that_are_not_in_use_any_more_take_no_room(void)
{
    add("o<sub_that_is_called_at_the_end> sub\nG0 X#1 Y#<_kept_from_the_beginning>\n", 1);
    add("o<sub_that_is_called_at_the_end> endsub\n#<_kept_from_the_beginning>=7\n", 1);
    add("o<outside> repeat [2]\n", 1);
    add("o<a_block_with_a_long_label_%> if [1]\n#<local>=3\n", 20);
    for (unsigned i = 20; i > 0; i--) {
        add_numbered("o<a_block_with_a_long_label_%> endif\n", i - 1);
    }
    add("o<closed_before_the_next_%> if [1]\no<closed_before_the_next_%> endif\n", 100);
    add("o<outside> endrepeat\n", 1);
    add("o<sub_that_is_called_at_the_end> call [#<local>]\n", 1);
    reader_open(&reader, text);
    reader_expect_rapid(&reader, 3.0, 7.0, 0.0);
    reader_expect_end(&reader);
}

static void test_a_tool_more_than_a_program_can_change_is_refused(void)
{
    static struct tool tools[PROGRAM_TOOL_CHANGES_MAX + 1];
    const struct tool_table table = {tools, PROGRAM_TOOL_CHANGES_MAX + 1};

    add("G10 L1 P[%+1] Z1\n", PROGRAM_TOOL_CHANGES_MAX);
    reader_prepare(&reader);
    for (unsigned i = 0; i <= PROGRAM_TOOL_CHANGES_MAX; i++) {
        tools[i].number = i + 1;
    }
    add("N1 G10 L1 P9 Z1\n", 1);
    reader.config.tools = &table;
    reader_text(&reader, text);
    reader_expect_error(&reader, TAKT_ERROR_TOOL_CHANGES_FULL);
    TEST_ASSERT_EQUAL_UINT32(9, reader.diagnostic.line);
    TEST_ASSERT_EQUAL_UINT32(4, reader.diagnostic.column);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, reader.diagnostic.value);
}

/* One of them is #5220. */
static void test_a_parameter_more_than_there_is_room_for_is_refused(void)
{
    add("#[100+%]=1\n", PARAMETERS_MAX - 1);
    add("#30=2 #5000=1\n", 1);
    expect_refusal(TAKT_ERROR_PARAMETERS_FULL, PARAMETERS_MAX, 7, "#5000", 0.0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ten_calls_have_room_and_find_their_own_again);
    RUN_TEST(test_calls_that_keep_too_much_are_refused);
    RUN_TEST(test_saved_modes_that_find_no_room_are_refused);
    RUN_TEST(test_names_of_parameters_run_out_of_characters);
    RUN_TEST(test_names_of_o_words_run_out_of_characters);
    RUN_TEST(test_names_that_are_not_in_use_any_more_take_no_room);
    RUN_TEST(test_a_tool_more_than_a_program_can_change_is_refused);
    RUN_TEST(test_a_parameter_more_than_there_is_room_for_is_refused);
    return UNITY_END();
}
