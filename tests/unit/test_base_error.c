#include "base/error.h"

#include "unity.h"

#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void check_text(const char *expected, enum takt_error code, const char *word, double value)
{
    struct diagnostic d;
    char text[DIAGNOSTIC_TEXT_MAX];
    takt_diagnostic_set(&d, code, 1, 1, word, strlen(word), value);
    size_t length = takt_diagnostic_text(&d, text);
    TEST_ASSERT_EQUAL_STRING(expected, text);
    TEST_ASSERT_EQUAL_UINT(strlen(expected), length);
}

static void test_the_word_and_the_value_stand_in_their_places(void)
{
    check_text("unknown word 'Q7'", TAKT_ERROR_WORD_UNKNOWN, "Q7", 0.0);
    check_text("the arc's end is 0.031 mm off its circle", TAKT_ERROR_ARC_ENDPOINT, "", 0.031);
    check_text("'X-12.5' must not be negative: -12.5", TAKT_ERROR_WORD_NEGATIVE, "X-12.5", -12.5);
    check_text("axis Z lags 2 mm behind its setpoint", TAKT_ERROR_DRIVE_FOLLOWING, "Z", 2.0);
    check_text("a comment is not closed", TAKT_ERROR_COMMENT_UNCLOSED, "", 0.0);
}

static void test_a_value_has_at_most_six_decimals_and_no_idle_zeros(void)
{
    check_text("'X' is out of range: 0.000001", TAKT_ERROR_WORD_OUT_OF_RANGE, "X", 1e-6);
    check_text("'X' is out of range: 0", TAKT_ERROR_WORD_OUT_OF_RANGE, "X", -1e-7);
    check_text("'X' is out of range: 100", TAKT_ERROR_WORD_OUT_OF_RANGE, "X", 100.0);
    check_text("'X' is out of range: 1.25", TAKT_ERROR_WORD_OUT_OF_RANGE, "X", 1.25);
    check_text("'X' is out of range: 1.500000e10", TAKT_ERROR_WORD_OUT_OF_RANGE, "X", 1.5e10);
    check_text("'X' is out of range: inf", TAKT_ERROR_WORD_OUT_OF_RANGE, "X", 1e308 * 10.0);
}

static void check_travel(const char *expected, const char *axis, double value, double limit)
{
    struct diagnostic d;
    char text[DIAGNOSTIC_TEXT_MAX];

    takt_diagnostic_set(&d, TAKT_ERROR_TRAVEL_EXCEEDED, 1, 1, axis, 1, value);
    takt_diagnostic_set_limit(&d, limit);
    (void)takt_diagnostic_text(&d, text);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void test_a_limit_stands_beside_its_value_in_the_unit_of_the_axis(void)
{
    check_travel("axis X would leave its travel: 520.5 mm, limit 500 mm", "X", 520.5, 500.0);
    check_travel("axis C would leave its travel: -361 degrees, limit -360 degrees", "C", -361.0,
                 -360.0);
}

static void test_percent_signs_of_the_word_are_left_alone(void)
{
    check_text("unknown word '%v%w%l%u%'", TAKT_ERROR_WORD_UNKNOWN, "%v%w%l%u%", 5.0);
}

static void test_set_keeps_code_place_word_and_value(void)
{
    struct diagnostic d;
    takt_diagnostic_set(&d, TAKT_ERROR_FEED_MISSING, 14, 7, "G1X5", 2, 3.5);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_FEED_MISSING, d.code);
    TEST_ASSERT_EQUAL_UINT32(14, d.line);
    TEST_ASSERT_EQUAL_UINT32(7, d.column);
    TEST_ASSERT_EQUAL_STRING("G1", d.word);
    TEST_ASSERT_TRUE(d.value == 3.5);
}

static void check_kept_word(const char *expected, const char *word, size_t length)
{
    struct diagnostic d;
    memset(&d, 'x', sizeof d);
    takt_diagnostic_set(&d, TAKT_ERROR_WORD_UNKNOWN, 1, 1, word, length, 0.0);
    TEST_ASSERT_EQUAL_STRING(expected, d.word);
}

static void test_a_long_word_is_cut_and_still_ends_in_zero(void)
{
    check_kept_word("1234567890123456789012345678901", "1234567890123456789012345678901", 31);
    check_kept_word("1234567890123456789012345678901", "12345678901234567890123456789012", 32);
    check_kept_word("", "", 0);
    check_kept_word("", NULL, 0);
}

static void test_a_word_is_not_cut_inside_a_character(void)
{
    /* 30 letters, then a character of two bytes that would end at 32 */
    check_kept_word("123456789012345678901234567890", "123456789012345678901234567890\xc3\xa4", 32);
    check_kept_word("12345678901234567890123456789\xc3\xa4",
                    "12345678901234567890123456789\xc3\xa4-", 32);
}

static void test_control_characters_cannot_reach_the_terminal(void)
{
    check_kept_word("?[31m?", "\x1b[31m\x7f", 6);
    check_kept_word("A?B", "A\0B", 3);
}

/* The longest word and value a diagnostic can hold. */
static void check_that_everything_fits(enum takt_error code)
{
    struct diagnostic d;
    char text[DIAGNOSTIC_TEXT_MAX];
    takt_diagnostic_set(&d, code, 1, 1, "1234567890123456789012345678901", 31, -123456789.123456);
    size_t length = takt_diagnostic_text(&d, text);
    TEST_ASSERT_TRUE_MESSAGE(length > 0 && length < DIAGNOSTIC_TEXT_MAX - 1, text);
    TEST_ASSERT_EQUAL_UINT(strlen(text), length);
    TEST_ASSERT_NULL_MESSAGE(strchr(text, '%'), text);
    TEST_ASSERT_TRUE_MESSAGE(text[length - 1] != '.', text);
}

static void test_every_text_knows_its_placeholders_and_fits(void)
{
    for (int index = 0; index < (int)TAKT_ERROR_TOTAL; index++)
        check_that_everything_fits((enum takt_error)(-1 - index));
}

static void test_codes_are_written_with_4_or_8_hexadecimal_digits_and_their_meaning(void)
{
    struct diagnostic d;
    char text[DIAGNOSTIC_TEXT_MAX];
    takt_diagnostic_set(&d, TAKT_ERROR_DRIVE_REFUSES, 0, 0, "X", 1, 0x06010002);
    d.meaning = "read only";
    (void)takt_diagnostic_text(&d, text);
    TEST_ASSERT_EQUAL_STRING("the drive of axis X refuses with abort code 06010002: read only",
                             text);
    takt_diagnostic_set(&d, TAKT_ERROR_DRIVE_FAULT, 0, 0, "X", 1, 0x611);
    (void)takt_diagnostic_text(&d, text);
    TEST_ASSERT_EQUAL_STRING("the drive of axis X reports 0611: ?", text);
}

static void test_codes_outside_the_list_are_named_by_their_number(void)
{
    check_text("no error", TAKT_OK, "", 0.0);
    check_text("error 4", (enum takt_error)4, "", 0.0);
    check_text("error -1000", (enum takt_error) - 1000, "", 0.0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_word_and_the_value_stand_in_their_places);
    RUN_TEST(test_a_value_has_at_most_six_decimals_and_no_idle_zeros);
    RUN_TEST(test_a_limit_stands_beside_its_value_in_the_unit_of_the_axis);
    RUN_TEST(test_percent_signs_of_the_word_are_left_alone);
    RUN_TEST(test_set_keeps_code_place_word_and_value);
    RUN_TEST(test_a_long_word_is_cut_and_still_ends_in_zero);
    RUN_TEST(test_a_word_is_not_cut_inside_a_character);
    RUN_TEST(test_control_characters_cannot_reach_the_terminal);
    RUN_TEST(test_every_text_knows_its_placeholders_and_fits);
    RUN_TEST(test_codes_are_written_with_4_or_8_hexadecimal_digits_and_their_meaning);
    RUN_TEST(test_codes_outside_the_list_are_named_by_their_number);
    return UNITY_END();
}
