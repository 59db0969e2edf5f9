#include "cli/suggest.h"
#include "unity.h"

static const char *const words[] = {"max_velocity_mm_s", "max_acceleration_mm_s2", "max_jerk_mm_s3",
                                    "type"};

void setUp(void)
{
}

void tearDown(void)
{
}

static const char *nearest(const char *word)
{
    return suggest_word(word, words, sizeof words / sizeof words[0]);
}

static void test_the_distance_counts_insertions_deletions_replacements_and_swaps(void)
{
    TEST_ASSERT_EQUAL_UINT(0, suggest_distance("trace", "trace"));
    TEST_ASSERT_EQUAL_UINT(0, suggest_distance("Trace", "tRACE"));
    TEST_ASSERT_EQUAL_UINT(1, suggest_distance("trace", "traces"));
    TEST_ASSERT_EQUAL_UINT(1, suggest_distance("trace", "race"));
    TEST_ASSERT_EQUAL_UINT(1, suggest_distance("trace", "trade"));
    TEST_ASSERT_EQUAL_UINT(1, suggest_distance("trace", "tarce"));
    TEST_ASSERT_EQUAL_UINT(3, suggest_distance("kitten", "sitting"));
    TEST_ASSERT_EQUAL_UINT(4, suggest_distance("", "four"));
    TEST_ASSERT_EQUAL_UINT(4, suggest_distance("four", ""));
}

static void test_a_misspelt_word_has_its_neighbour(void)
{
    TEST_ASSERT_EQUAL_STRING("max_velocity_mm_s", nearest("max_velcity_mm_s"));
    TEST_ASSERT_EQUAL_STRING("type", nearest("tpye"));
}

static void test_a_forgotten_end_does_not_hide_the_word(void)
{
    TEST_ASSERT_EQUAL_STRING("max_jerk_mm_s3", nearest("max_jerk"));
    TEST_ASSERT_EQUAL_STRING("max_jerk_mm_s3", nearest("max_jrk"));
}

static void test_a_word_that_is_like_none_has_no_neighbour(void)
{
    TEST_ASSERT_NULL(nearest("colour"));
    TEST_ASSERT_NULL(nearest(""));
}

static void test_a_word_of_any_length_is_safe(void)
{
    char longest[4 * SUGGEST_WORD_MAX];

    for (unsigned i = 0; i < sizeof longest - 1; i++)
        longest[i] = 'x';
    longest[sizeof longest - 1] = '\0';
    TEST_ASSERT_NULL(nearest(longest));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_distance_counts_insertions_deletions_replacements_and_swaps);
    RUN_TEST(test_a_misspelt_word_has_its_neighbour);
    RUN_TEST(test_a_forgotten_end_does_not_hide_the_word);
    RUN_TEST(test_a_word_that_is_like_none_has_no_neighbour);
    RUN_TEST(test_a_word_of_any_length_is_safe);
    return UNITY_END();
}
