#include "editor/lsp_text.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static const char *clean(const char *text)
{
    static char copy[64];

    (void)snprintf(copy, sizeof copy, "%s", text);
    lsp_text_clean(copy);
    return copy;
}

static void test_text_that_is_right_stays(void)
{
    static const char *const texts[] = {"",
                                        "G1 X1",
                                        "\xc3\xa9",
                                        "\xe2\x82\xac",
                                        "\xed\x9f\xbf",
                                        "\xf0\x9f\x94\xa7",
                                        "\xf4\x8f\xbf\xbf",
                                        "\xc2\x80\xdf\xbf\xe0\xa0\x80\xef\xbf\xbf"};

    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        TEST_ASSERT_EQUAL_STRING(texts[i], clean(texts[i]));
}

static void test_bytes_that_are_no_character_become_question_marks(void)
{
    TEST_ASSERT_EQUAL_STRING("?", clean("\xc3"));
    TEST_ASSERT_EQUAL_STRING("?x", clean("\xa9x"));
    TEST_ASSERT_EQUAL_STRING("'?'", clean("'\xc3'"));
    TEST_ASSERT_EQUAL_STRING("??", clean("\xe2\x82"));
    TEST_ASSERT_EQUAL_STRING("??", clean("\xc0\x80"));
    TEST_ASSERT_EQUAL_STRING("???", clean("\xe0\x9f\xbf"));
    TEST_ASSERT_EQUAL_STRING("???", clean("\xed\xa0\x80"));
    TEST_ASSERT_EQUAL_STRING("????", clean("\xf4\x90\x80\x80"));
    TEST_ASSERT_EQUAL_STRING("?????", clean("\xf8\x88\x80\x80\x80"));
}

static void test_units_and_bytes_are_each_others_inverse(void)
{
    static const char line[] = "a\xc3\xa9\xf0\x9f\x94\xa7z";
    static const size_t bytes[] = {0, 1, 3, 7, 8};
    static const size_t units[] = {0, 1, 2, 4, 5};

    for (size_t i = 0; i < sizeof bytes / sizeof bytes[0]; i++) {
        TEST_ASSERT_EQUAL_UINT(units[i], lsp_text_units(line, sizeof line - 1, bytes[i]));
        TEST_ASSERT_EQUAL_UINT(bytes[i], lsp_text_byte(line, sizeof line - 1, units[i]));
    }
}

static void test_paths_and_uris_are_each_others_inverse(void)
{
    static const char path[] = "/a b/\xc3\xa9%20#?.ngc";
    char *uri = lsp_text_uri(path);
    char *back = lsp_text_path(uri);
    char *other = lsp_text_path("untitled:a%20b");

    TEST_ASSERT_EQUAL_STRING("file:///a%20b/%C3%A9%2520%23%3F.ngc", uri);
    TEST_ASSERT_EQUAL_STRING(path, back);
    TEST_ASSERT_EQUAL_STRING("untitled:a%20b", other);
    free(uri);
    free(back);
    free(other);
}

static void test_lines_end_with_either_end(void)
{
    static const char text[] = "one\r\n\ntwo";
    size_t length;

    TEST_ASSERT_EQUAL_PTR(text, lsp_text_line(text, sizeof text - 1, 0, &length));
    TEST_ASSERT_EQUAL_UINT(3, length);
    (void)lsp_text_line(text, sizeof text - 1, 1, &length);
    TEST_ASSERT_EQUAL_UINT(0, length);
    TEST_ASSERT_EQUAL_PTR(text + 6, lsp_text_line(text, sizeof text - 1, 2, &length));
    TEST_ASSERT_EQUAL_UINT(3, length);
    (void)lsp_text_line(text, sizeof text - 1, 9, &length);
    TEST_ASSERT_EQUAL_UINT(0, length);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_text_that_is_right_stays);
    RUN_TEST(test_bytes_that_are_no_character_become_question_marks);
    RUN_TEST(test_units_and_bytes_are_each_others_inverse);
    RUN_TEST(test_paths_and_uris_are_each_others_inverse);
    RUN_TEST(test_lines_end_with_either_end);
    return UNITY_END();
}
