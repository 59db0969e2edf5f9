/* firmware/program/lexer.h: lines, columns, comments, and lines that cannot be read. */
#include "program/lexer.h"

#include "unity.h"

#include <string.h>

#define LONG_LINE_LENGTH 1000000

static struct program_lexer lexer;
static struct source_text context;
static struct diagnostic diagnostic;

void setUp(void)
{
}

void tearDown(void)
{
}

static void open_bytes(const char *bytes, size_t length)
{
    struct source source;

    takt_source_open_text(&source, &context, bytes, length);
    takt_lexer_open(&lexer, &source);
}

static void open_text(const char *text)
{
    open_bytes(text, strlen(text));
}

static void expect_line(uint32_t line, const char *text)
{
    TEST_ASSERT_EQUAL_INT(LEXER_LINE, takt_lexer_next_line(&lexer, &diagnostic));
    TEST_ASSERT_EQUAL_UINT32(line, lexer.line);
    TEST_ASSERT_EQUAL_STRING(text, lexer.text);
    TEST_ASSERT_EQUAL_UINT(strlen(text), lexer.length);
}

static void expect_error(enum takt_error code, uint32_t line, uint32_t column)
{
    TEST_ASSERT_EQUAL_INT(LEXER_ERROR, takt_lexer_next_line(&lexer, &diagnostic));
    TEST_ASSERT_EQUAL_INT(code, diagnostic.code);
    TEST_ASSERT_EQUAL_UINT32(line, diagnostic.line);
    TEST_ASSERT_EQUAL_UINT32(column, diagnostic.column);
}

static void expect_end(void)
{
    TEST_ASSERT_EQUAL_INT(LEXER_END, takt_lexer_next_line(&lexer, &diagnostic));
}

static void test_spaces_and_case_do_not_count(void)
{
    open_text("G 01\tX - 1 . 5Yz");
    expect_line(1, "g01x-1.5yz");
    expect_end();
}

static void test_columns_are_those_of_the_text(void)
{
    open_text("  G1 (comment) X2");
    expect_line(1, "g1x2");
    TEST_ASSERT_EQUAL_UINT(3, takt_lexer_column(&lexer, 0));
    TEST_ASSERT_EQUAL_UINT(4, takt_lexer_column(&lexer, 1));
    TEST_ASSERT_EQUAL_UINT(16, takt_lexer_column(&lexer, 2));
    TEST_ASSERT_EQUAL_UINT(17, takt_lexer_column(&lexer, 3));
    TEST_ASSERT_EQUAL_UINT(18, takt_lexer_column(&lexer, 4));
}

static void test_comments_are_left_out(void)
{
    open_text("g0(a;b)x1;rest ( of it\n;\n()\n( \xc3\xa4\xff )y2");
    expect_line(1, "g0x1");
    expect_line(2, "");
    expect_line(3, "");
    expect_line(4, "y2");
    expect_end();
}

static void test_lines_end_with_lf_or_crlf_or_the_text(void)
{
    open_text("a\r\nb\n\n\r\nc");
    expect_line(1, "a");
    expect_line(2, "b");
    expect_line(3, "");
    expect_line(4, "");
    expect_line(5, "c");
    expect_end();
    expect_end();
}

static void test_an_empty_text_has_no_line(void)
{
    open_text("");
    expect_end();
}

static void test_an_unclosed_comment_is_found_where_it_opens(void)
{
    open_text("x1 (open\ny2");
    expect_error(TAKT_ERROR_COMMENT_UNCLOSED, 1, 4);
    expect_line(2, "y2");
}

static void test_comments_nest(void)
{
    open_text("(a(b)c)x1(d(e)\ny2");
    expect_error(TAKT_ERROR_COMMENT_UNCLOSED, 1, 10);
    open_text("(a(b)c)x1(d(e))\ny2");
    expect_line(1, "x1");
    expect_line(2, "y2");
}

static void expect_comment(const char *comment)
{
    unsigned at = 0;

    for (; comment[at] != '\0'; at++) {
        TEST_ASSERT_EQUAL_INT(comment[at], takt_lexer_comment(&lexer, at));
    }
    TEST_ASSERT_EQUAL_INT('\0', takt_lexer_comment(&lexer, at));
}

static void test_the_last_comment_of_a_line_is_kept_as_it_stands_there(void)
{
    open_text("x1 ( first ) y2 (A (b) C)z3\nz4\n; rest (of it");
    expect_line(1, "x1y2z3");
    expect_comment("A (b) C");
    expect_line(2, "z4");
    expect_comment("");
    expect_line(3, "");
    expect_comment(" rest (of it");
}

/* A line of the largest length that is all text and comment: neither runs into the other. */
static void test_text_and_comment_fill_a_line(void)
{
    char text[PROGRAM_LINE_MAX + 1];

    memset(text, 'X', PROGRAM_LINE_MAX);
    text[PROGRAM_LINE_MAX] = '\0';
    text[100] = '(';
    text[PROGRAM_LINE_MAX - 1] = ')';
    open_text(text);
    TEST_ASSERT_EQUAL_INT(LEXER_LINE, takt_lexer_next_line(&lexer, &diagnostic));
    TEST_ASSERT_EQUAL_UINT(100, lexer.length);
    TEST_ASSERT_EQUAL_UINT(PROGRAM_LINE_MAX - 102, lexer.comment_length);
    TEST_ASSERT_EQUAL_INT('x', lexer.text[99]);
    TEST_ASSERT_EQUAL_INT('\0', lexer.text[100]);
    TEST_ASSERT_EQUAL_INT('X', takt_lexer_comment(&lexer, lexer.comment_length - 1U));
}

/* "x1 (" */
static void begin_comment(char text[])
{
    text[0] = 'x';
    text[1] = '1';
    text[2] = ' ';
    text[3] = '(';
}

static void test_a_comment_may_be_longer_than_a_line(void)
{
    char text[2 * PROGRAM_LINE_MAX];

    memset(text, 'c', sizeof(text));
    begin_comment(text);
    memcpy(text + sizeof(text) - 5, ")\ny2", 5);
    open_text(text);
    expect_line(1, "x1");
    expect_line(2, "y2");
}

/* Rather none than a wrong one: columns are kept in 16 bits. */
static void test_the_end_behind_a_comment_has_its_column_or_none(void)
{
    static char text[70000];

    memset(text, 'c', sizeof(text));
    begin_comment(text);
    text[299] = ')';
    open_bytes(text, 300);
    TEST_ASSERT_EQUAL_INT(LEXER_LINE, takt_lexer_next_line(&lexer, &diagnostic));
    TEST_ASSERT_EQUAL_UINT(301, takt_lexer_column(&lexer, 2));
    text[299] = 'c';
    text[sizeof(text) - 1] = ')';
    open_bytes(text, sizeof(text));
    TEST_ASSERT_EQUAL_INT(LEXER_LINE, takt_lexer_next_line(&lexer, &diagnostic));
    TEST_ASSERT_EQUAL_UINT(0, takt_lexer_column(&lexer, 2));
}

static void test_the_first_line_goes_on_with_none(void)
{
    open_text("\037x1\nx2\n\037x3");
    expect_error(TAKT_ERROR_CHARACTER_UNKNOWN, 1, 1);
    expect_line(2, "x2");
    expect_line(2, "x3");
}

static void test_a_line_of_the_largest_length_is_read(void)
{
    char text[PROGRAM_LINE_MAX + 3];

    memset(text, 'X', PROGRAM_LINE_MAX);
    memcpy(text + PROGRAM_LINE_MAX, "\r\n", 3);
    open_text(text);
    TEST_ASSERT_EQUAL_INT(LEXER_LINE, takt_lexer_next_line(&lexer, &diagnostic));
    TEST_ASSERT_EQUAL_UINT(PROGRAM_LINE_MAX, lexer.length);
    TEST_ASSERT_EQUAL_INT('x', lexer.text[PROGRAM_LINE_MAX - 1]);
    TEST_ASSERT_EQUAL_INT('\0', lexer.text[PROGRAM_LINE_MAX]);
}

static void test_one_character_more_is_too_long(void)
{
    char text[PROGRAM_LINE_MAX + 4];

    memset(text, ' ', sizeof(text));
    memcpy(text + PROGRAM_LINE_MAX, "X\nY", 4);
    open_text(text);
    expect_error(TAKT_ERROR_LINE_TOO_LONG, 1, PROGRAM_LINE_MAX + 1);
    TEST_ASSERT_EQUAL_DOUBLE(PROGRAM_LINE_MAX, diagnostic.value);
    expect_line(2, "y");
}

/* "x1", then length times 'X', then "y2", without ever holding them. */
struct generated {
    size_t at, length;
};

static char generated_byte(const struct generated *g)
{
    static const char before[] = "x1\n";
    static const char after[] = "\ny2";

    if (g->at < 3) {
        return before[g->at];
    }
    if (g->at < 3 + g->length) {
        return 'X';
    }
    return after[g->at - 3 - g->length];
}

static long generated_read(void *user, char *buffer, size_t size)
{
    struct generated *g = user;
    size_t count = 0;

    for (; count < size && g->at < g->length + 6; count++) {
        buffer[count] = generated_byte(g);
        g->at++;
    }
    return count > 0 ? (long)count : SOURCE_END;
}

static void test_a_line_of_a_megabyte_is_passed_over(void)
{
    struct generated text = {0, LONG_LINE_LENGTH};
    const struct source source = {generated_read, NULL, &text};

    takt_lexer_open(&lexer, &source);
    expect_line(1, "x1");
    expect_error(TAKT_ERROR_LINE_TOO_LONG, 2, PROGRAM_LINE_MAX + 1);
    expect_line(3, "y2");
    expect_end();
}

static void test_bytes_that_are_no_text_are_told_by_their_code(void)
{
    open_bytes("g0 \x00\x01", 5);
    expect_error(TAKT_ERROR_CHARACTER_UNKNOWN, 1, 4);
    TEST_ASSERT_EQUAL_STRING("0x00", diagnostic.word);
    open_bytes("\xfe\n1", 3);
    expect_error(TAKT_ERROR_CHARACTER_UNKNOWN, 1, 1);
    TEST_ASSERT_EQUAL_STRING("0xfe", diagnostic.word);
    expect_line(2, "1");
}

static void test_only_the_first_fault_of_a_line_is_told(void)
{
    open_text("\x01 \x02 (open");
    expect_error(TAKT_ERROR_CHARACTER_UNKNOWN, 1, 1);
    expect_end();
}

static long read_one_byte(void *user, char *buffer, size_t size)
{
    struct source_text *text = user;

    if (text->position == text->length || size == 0) {
        return SOURCE_END;
    }
    buffer[0] = text->text[text->position++];
    return 1;
}

static void test_it_does_not_matter_how_the_source_cuts_the_text(void)
{
    static const char text[] = "G0 X1\n(c) Y2\n\nZ3";
    const struct source source = {read_one_byte, NULL, &context};

    open_text(text);
    takt_lexer_open(&lexer, &source);
    expect_line(1, "g0x1");
    expect_line(2, "y2");
    expect_line(3, "");
    expect_line(4, "z3");
    expect_end();
}

/* Two bytes, then nothing any more. */
static long read_and_fail(void *user, char *buffer, size_t size)
{
    int *calls = user;

    (void)size;
    if ((*calls)++ > 0) {
        return SOURCE_ERROR;
    }
    buffer[0] = 'g';
    buffer[1] = '0';
    return 2;
}

static void test_a_source_that_fails_is_told(void)
{
    int calls = 0;
    const struct source source = {read_and_fail, NULL, &calls};

    takt_lexer_open(&lexer, &source);
    TEST_ASSERT_EQUAL_INT(LEXER_UNREADABLE, takt_lexer_next_line(&lexer, &diagnostic));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_SOURCE_UNREADABLE, diagnostic.code);
    TEST_ASSERT_EQUAL_UINT32(1, diagnostic.line);
}

static void test_a_text_source_can_be_set_back(void)
{
    struct source source;
    char byte;

    takt_source_open_text(&source, &context, "ab", 2);
    TEST_ASSERT_EQUAL_INT(1, source.read(source.context, &byte, 1));
    TEST_ASSERT_TRUE(source.seek(source.context, 0));
    TEST_ASSERT_EQUAL_INT(1, source.read(source.context, &byte, 1));
    TEST_ASSERT_EQUAL_INT('a', byte);
    TEST_ASSERT_TRUE(source.seek(source.context, 2));
    TEST_ASSERT_EQUAL_INT(SOURCE_END, source.read(source.context, &byte, 1));
    TEST_ASSERT_FALSE(source.seek(source.context, 3));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_spaces_and_case_do_not_count);
    RUN_TEST(test_columns_are_those_of_the_text);
    RUN_TEST(test_comments_are_left_out);
    RUN_TEST(test_lines_end_with_lf_or_crlf_or_the_text);
    RUN_TEST(test_an_empty_text_has_no_line);
    RUN_TEST(test_an_unclosed_comment_is_found_where_it_opens);
    RUN_TEST(test_comments_nest);
    RUN_TEST(test_the_last_comment_of_a_line_is_kept_as_it_stands_there);
    RUN_TEST(test_text_and_comment_fill_a_line);
    RUN_TEST(test_a_comment_may_be_longer_than_a_line);
    RUN_TEST(test_the_first_line_goes_on_with_none);
    RUN_TEST(test_the_end_behind_a_comment_has_its_column_or_none);
    RUN_TEST(test_a_line_of_the_largest_length_is_read);
    RUN_TEST(test_one_character_more_is_too_long);
    RUN_TEST(test_a_line_of_a_megabyte_is_passed_over);
    RUN_TEST(test_bytes_that_are_no_text_are_told_by_their_code);
    RUN_TEST(test_only_the_first_fault_of_a_line_is_told);
    RUN_TEST(test_it_does_not_matter_how_the_source_cuts_the_text);
    RUN_TEST(test_a_source_that_fails_is_told);
    RUN_TEST(test_a_text_source_can_be_set_back);
    return UNITY_END();
}
