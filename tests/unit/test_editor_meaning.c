#include "editor/meaning.h"
#include "program/codes.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

/* Highest number of a code, times ten. */
#define NUMBER_MAX 9999

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_every_code_has_a_meaning_and_nothing_else_has(void)
{
    char text[16];

    for (unsigned i = 0; i < 2; i++) {
        const char letter = "gm"[i];

        for (unsigned number = 0; number <= NUMBER_MAX; number++) {
            (void)snprintf(text, sizeof text, "%c%u", letter, number);
            TEST_ASSERT_EQUAL_MESSAGE(takt_code_find(letter, number) != NULL,
                                      meaning_of_code(letter, number) != NULL, text);
        }
    }
}

static void test_a_keyword_is_not_taken_for_the_beginning_of_another(void)
{
    static const char *const words[] = {"sub",    "endsub", "return",    "call",  "if",
                                        "elseif", "else",   "endif",     "while", "endwhile",
                                        "do",     "repeat", "endrepeat", "break", "continue"};
    size_t length;

    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(meaning_of_flow(words[i], &length), words[i]);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(strlen(words[i]), length, words[i]);
    }
    TEST_ASSERT_NULL(meaning_of_flow("goto", &length));
}

static void test_letters_that_may_stand_in_a_program_have_a_meaning(void)
{
    for (const char *letter = "abcdefhijklnopqrstxyz"; *letter != '\0'; letter++) {
        TEST_ASSERT_NOT_NULL(meaning_of_letter(*letter));
    }
    TEST_ASSERT_NULL(meaning_of_letter('g'));
    TEST_ASSERT_NULL(meaning_of_letter('u'));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_code_has_a_meaning_and_nothing_else_has);
    RUN_TEST(test_a_keyword_is_not_taken_for_the_beginning_of_another);
    RUN_TEST(test_letters_that_may_stand_in_a_program_have_a_meaning);
    return UNITY_END();
}
