#define _XOPEN_SOURCE 700 /* mkdtemp */

/* The text of a program: from a file piece by piece, the same bytes as from memory. */
#include "cli/program_text.h"

#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Lines enough for several pieces. */
#define LINES 9000

static char folder[32];
static char path[64];
static char content[LINES * 16];
static size_t content_length;
static struct program_text text;
static struct program_text_reader reader;
static struct source source;

static void put(const char *bytes, size_t length, const char *mode)
{
    FILE *file = fopen(path, mode);

    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_UINT(length, fwrite(bytes, 1, length, file));
    TEST_ASSERT_EQUAL_INT(0, fclose(file));
}

void setUp(void)
{
    (void)snprintf(folder, sizeof folder, "/tmp/takt-text-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    (void)snprintf(path, sizeof path, "%s/part.ngc", folder);
    content_length = 0;
    for (unsigned i = 1; i <= LINES; i++)
        content_length += (size_t)snprintf(content + content_length,
                                           sizeof content - content_length, "N%u X1\r\n", i);
    put(content, content_length, "wb");
    TEST_ASSERT_TRUE(program_text_open(&text, path));
    program_text_read(&text, &reader, &source);
}

void tearDown(void)
{
    program_text_close(&text);
    (void)unlink(path);
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
}

/* Everything from here on, asked for in pieces of an odd size, is the content from there on. */
static void expect_rest(size_t from)
{
    char buffer[511];
    long got;

    while ((got = source.read(source.context, buffer, sizeof buffer)) > 0) {
        TEST_ASSERT_TRUE(from + (size_t)got <= content_length);
        TEST_ASSERT_EQUAL_MEMORY(content + from, buffer, (size_t)got);
        from += (size_t)got;
    }
    TEST_ASSERT_EQUAL_INT(SOURCE_END, got);
    TEST_ASSERT_EQUAL_UINT(content_length, from);
}

static void test_a_file_is_read_whole_and_in_order(void)
{
    TEST_ASSERT_TRUE(text.is_file);
    TEST_ASSERT_TRUE(content_length > (size_t)3 * PROGRAM_TEXT_PIECE);
    expect_rest(0);
}

static void test_reading_goes_on_at_any_place(void)
{
    static const size_t places[] = {70000, 0, 16384, 16383, 40000, 39999, 12};

    for (unsigned i = 0; i < sizeof places / sizeof places[0]; i++) {
        char byte;

        TEST_ASSERT_TRUE(source.seek(source.context, places[i]));
        TEST_ASSERT_EQUAL_INT(1, source.read(source.context, &byte, 1));
        TEST_ASSERT_EQUAL_INT(content[places[i]], byte);
    }
    expect_rest(13);
}

static void test_no_place_is_behind_the_end(void)
{
    TEST_ASSERT_TRUE(source.seek(source.context, content_length));
    expect_rest(content_length);
    TEST_ASSERT_FALSE(source.seek(source.context, content_length + 1));
}

static void test_two_readings_do_not_disturb_each_other(void)
{
    static struct program_text_reader other;
    struct source second;
    char buffer[512];

    program_text_read(&text, &other, &second);
    TEST_ASSERT_TRUE(second.seek(second.context, 60000));
    TEST_ASSERT_TRUE(second.read(second.context, buffer, sizeof buffer) > 0);
    expect_rest(0);
}

static void test_a_file_that_changes_cannot_be_read_on(void)
{
    char buffer[512];

    TEST_ASSERT_TRUE(source.read(source.context, buffer, sizeof buffer) > 0);
    put("M2\n", 3, "ab");
    TEST_ASSERT_TRUE(source.seek(source.context, 50000));
    TEST_ASSERT_EQUAL_INT(SOURCE_ERROR, source.read(source.context, buffer, sizeof buffer));
}

static void expect_line(const char *expected, uint32_t line, size_t first, size_t size)
{
    char bytes[64];
    const size_t length = program_text_line(&text, line, first, bytes, size);

    TEST_ASSERT_EQUAL_UINT(strlen(expected), length);
    if (length > 0)
        TEST_ASSERT_EQUAL_MEMORY(expected, bytes, length);
}

static void test_a_line_is_found_by_its_number(void)
{
    expect_line("N1 X1", 1, 0, 64);
    expect_line("N4999 X1", 4999, 0, 64);
    expect_line("X1", 9000, 6, 64);
    expect_line("N90", 9000, 0, 3);
    expect_line("", 9001, 0, 64);
    expect_line("", 12345, 0, 64);
}

/* The null device stands for a stream: it has no length. */
static void test_what_is_no_lasting_file_is_kept_whole(void)
{
    struct program_text other;

    TEST_ASSERT_TRUE(program_text_open(&other, "/dev/null"));
    TEST_ASSERT_FALSE(other.is_file);
    content_length = 0;
    program_text_read(&other, &reader, &source);
    expect_rest(0);
    program_text_close(&other);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_file_is_read_whole_and_in_order);
    RUN_TEST(test_reading_goes_on_at_any_place);
    RUN_TEST(test_no_place_is_behind_the_end);
    RUN_TEST(test_two_readings_do_not_disturb_each_other);
    RUN_TEST(test_a_file_that_changes_cannot_be_read_on);
    RUN_TEST(test_a_line_is_found_by_its_number);
    RUN_TEST(test_what_is_no_lasting_file_is_kept_whole);
    return UNITY_END();
}
