/* firmware/base/decimal.h against strtod and printf of the host, which are exact. */
#include "base/decimal.h"
#include "random_bits.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static unsigned random_below(uint64_t *state, unsigned limit)
{
    return (unsigned)(random_bits(state) % limit);
}

/*
 * Reading.
 */
static void check_read_as(const char *text, double expected, size_t expected_taken)
{
    double value = -1.0;
    size_t taken = takt_decimal_read(text, strlen(text), &value);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(expected_taken, taken, text);
    TEST_ASSERT_TRUE_MESSAGE(value == expected, text);
}

static void check_read_like_strtod(const char *text)
{
    check_read_as(text, strtod(text, NULL), strlen(text));
}

static void test_reads_digits_with_at_most_one_point(void)
{
    check_read_as("12", 12.0, 2);
    check_read_as("12.5", 12.5, 4);
    check_read_as(".5", 0.5, 2);
    check_read_as("12.", 12.0, 3);
    check_read_as("0", 0.0, 1);
    check_read_as("000.000", 0.0, 7);
    check_read_as("0012", 12.0, 4);
}

static void test_stops_at_the_first_character_that_is_not_part_of_the_number(void)
{
    check_read_as("12X3", 12.0, 2);
    check_read_as("1.2.3", 1.2, 3);
    check_read_as("12..", 12.0, 3);
    check_read_as("1e5", 1.0, 1);
    check_read_as("7 8", 7.0, 1);
    check_read_as("5/", 5.0, 1);
    check_read_as("5:", 5.0, 1);
    check_read_as("5\xb5", 5.0, 1);
}

static void test_reads_nothing_where_no_digit_stands(void)
{
    check_read_as("", -1.0, 0);
    check_read_as(".", -1.0, 0);
    check_read_as("..5", -1.0, 0);
    check_read_as("-1", -1.0, 0);
    check_read_as("+1", -1.0, 0);
    check_read_as("X", -1.0, 0);
}

static void test_reads_no_further_than_the_length(void)
{
    double value;
    TEST_ASSERT_EQUAL_UINT(2, takt_decimal_read("123", 2, &value));
    TEST_ASSERT_TRUE(value == 12.0);
    TEST_ASSERT_EQUAL_UINT(0, takt_decimal_read("123", 0, &value));
}

static void make_random_number(uint64_t *state, char *text, unsigned digits_max)
{
    unsigned digits = 1 + random_below(state, digits_max);
    unsigned point = random_below(state, digits + 1);
    unsigned zeros = random_below(state, 8) == 0 ? random_below(state, 30) : 0;
    char *c = text;
    if (point == 0) {
        *c++ = '.';
        memset(c, '0', zeros);
        c += zeros;
    }
    for (unsigned i = 0; i < digits; i++) {
        *c++ = (char)('0' + random_below(state, 10));
        if (i + 1 == point)
            *c++ = '.';
    }
    *c = '\0';
}

static void test_up_to_19_digits_are_rounded_correctly(void)
{
    uint64_t state = 1;
    char text[64];
    for (int i = 0; i < RANDOM_COUNT; i++) {
        make_random_number(&state, text, 19);
        check_read_like_strtod(text);
    }
}

/* Odd integers above 2^53 lie in the middle between two doubles. */
static void test_numbers_next_to_a_tie_are_rounded_correctly(void)
{
    uint64_t state = 2;
    char text[64];
    for (int i = 0; i < RANDOM_COUNT; i++) {
        uint64_t tie = (UINT64_C(1) << 53) + 2 * (random_bits(&state) >> 12) + 1;
        (void)snprintf(text, sizeof text, "%" PRIu64 "%s", tie, i % 2 == 0 ? ".01" : "");
        check_read_like_strtod(text);
        (void)snprintf(text, sizeof text, "%" PRIu64 ".99", tie - 1);
        check_read_like_strtod(text);
    }
    check_read_as("9007199254740993", 9007199254740992.0, 16);
    check_read_as("9007199254740995", 9007199254740996.0, 16);
    check_read_as("9007199254740993.001", 9007199254740994.0, 20);
    check_read_as("18014398509481983", 18014398509481984.0, 17);
}

/* digits / 10^places */
static void check_small_number(const char *digits, unsigned places)
{
    char zeros[400];
    char text[450];
    size_t count = places - strlen(digits);
    memset(zeros, '0', count);
    zeros[count] = '\0';
    (void)snprintf(text, sizeof text, "0.%s%s", zeros, digits);
    check_read_like_strtod(text);
}

/*
 * Found by continued fractions: less than 2^-119 of their size from the middle between two doubles.
 */
static void test_the_hardest_numbers_are_rounded_correctly(void)
{
    check_small_number("3507665085003296281", 73);
    check_small_number("7015330170006592562", 73);
    check_small_number("2219510890804279001", 65);
    check_small_number("6764958008109694533", 173);
    check_small_number("926145344610700019", 225);
    check_small_number("4630726723053500095", 226);
}

static void test_every_double_survives_17_digits(void)
{
    uint64_t state = 3;
    char text[64];
    for (int i = 0; i < RANDOM_COUNT; i++) {
        double value =
            (double)(random_bits(&state) >> 11) * pow(2.0, -20.0 - random_below(&state, 60));
        int places = 16 - (int)floor(log10(value));
        (void)snprintf(text, sizeof text, "%.*f", places > 0 ? places : 0, value);
        check_read_as(text, value, strlen(text));
    }
}

static void test_more_than_19_digits_are_read_within_one_ulp(void)
{
    uint64_t state = 4;
    char text[80];
    for (int i = 0; i < RANDOM_COUNT; i++) {
        make_random_number(&state, text, 35);
        double value, exact = strtod(text, NULL);
        TEST_ASSERT_EQUAL_UINT(strlen(text), takt_decimal_read(text, strlen(text), &value));
        TEST_ASSERT_TRUE(value == exact || value == nextafter(exact, 0.0));
    }
    check_read_as("10000000000000000000000000000", 1e28, 29);
    check_read_as("0.10000000000000000000000000000", 0.1, 31);
}

/* before, count times c, after */
static void check_long_number(const char *before, char c, size_t count, const char *after,
                              double expected)
{
    char middle[1600];
    char text[1700];
    TEST_ASSERT_TRUE(count < sizeof middle);
    memset(middle, c, count);
    middle[count] = '\0';
    (void)snprintf(text, sizeof text, "%s%s%s", before, middle, after);
    check_read_as(text, expected, strlen(text));
}

static void test_very_large_and_very_small_numbers_end_in_infinity_and_zero(void)
{
    check_long_number("1", '0', 308, "", 1e308);
    check_long_number("179769313486231570", '0', 291, "", 1.7976931348623157e308);
    check_long_number("17976931348623159", '0', 292, "", HUGE_VAL);
    check_long_number("9", '9', 1500, "", HUGE_VAL);
    check_long_number("0.", '0', 306, "1", 1e-307);
    check_long_number("0.", '0', 307, "22250738585072014", 2.2250738585072014e-308);
    check_long_number("0.", '0', 307, "2225073858507201", 0.0);
    check_long_number("0.", '0', 1500, "1", 0.0);
    check_long_number("", '0', 1500, "7", 7.0);
}

/*
 * Writing.
 */
static void check_written(const char *expected, double value, unsigned places)
{
    char text[DECIMAL_TEXT_MAX + 1];
    size_t length = takt_decimal_write(text, value, places);
    TEST_ASSERT_TRUE(length <= DECIMAL_TEXT_MAX);
    text[length] = '\0';
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void test_writes_a_fixed_number_of_places(void)
{
    check_written("0", 0.0, 0);
    check_written("0.000", 0.0, 3);
    check_written("12.5", 12.5, 1);
    check_written("-12.500000000", -12.5, 9);
    check_written("0.001", 0.001, 3);
    check_written("100.05", 100.05, 2);
    check_written("3.141592654", 3.14159265358979, 9);
    check_written("123456789.987654328", 123456789.987654328, 9);
}

static void test_zero_is_never_negative(void)
{
    check_written("0.000", -0.0, 3);
    check_written("0.000", -0.0004, 3);
    check_written("-0.001", -0.0005000001, 3);
    check_written("0", -0.4, 0);
    check_written("0.000000000", -0x1p-1074, 9);
}

static void test_halves_are_rounded_away_from_zero(void)
{
    check_written("1", 0.5, 0);
    check_written("-1", -0.5, 0);
    check_written("2", 1.5, 0);
    check_written("3", 2.5, 0);
    check_written("0.13", 0.125, 2);
    check_written("-0.38", -0.375, 2);
    check_written("0.000000001", 0x1p-30, 9);
    check_written("0.000976563", 0x1p-10, 9);
    check_written("0.0", 0.049999999999999996, 1);
}

static void test_a_carry_runs_through_to_the_front(void)
{
    check_written("1.000", 0.9996, 3);
    check_written("10.00", 9.995000001, 2);
    check_written("1000000000.000", 999999999.9999, 3);
    check_written("1000000000", 999999999.5, 0);
}

static void test_large_numbers_are_written_with_an_exponent(void)
{
    check_written("1.000e9", 1e9, 3);
    check_written("-1.000e9", -1e9, 3);
    check_written("1.235e12", 1234567890123.0, 3);
    check_written("1.000e13", 9.9999e12, 3);
    check_written("1.797693135e308", 1.7976931348623157e308, 9);
    check_written("-2e22", -1.5e22, 0);
    check_written("1e300", 1e300, 0);
}

static void test_writes_what_is_not_a_number_by_name(void)
{
    check_written("nan", NOT_A_NUMBER, 3);
    check_written("inf", HUGE_VAL, 3);
    check_written("-inf", -HUGE_VAL, 3);
}

/*
 * printf rounds exactly too, but ties to even: only there may it differ. value 10^places has the
 * fraction 1/2 when value is an odd multiple of 2^-(places + 1).
 */
static bool is_a_tie(double value, unsigned places)
{
    return fabs(fmod(ldexp(value, (int)places + 1), 2.0)) == 1.0;
}

static void test_random_numbers_are_written_like_printf_writes_them(void)
{
    uint64_t state = 5;
    char expected[64];
    for (int i = 0; i < RANDOM_COUNT; i++) {
        unsigned places = random_below(&state, 10);
        double size =
            (double)(random_bits(&state) >> 11) * pow(2.0, -24.0 - random_below(&state, 70));
        double value = random_below(&state, 2) == 0 ? size : -size;
        (void)snprintf(expected, sizeof expected, "%.*f", (int)places, value);
        if (fabs(value) < 1e9 && !is_a_tie(value, places) && strtod(expected, NULL) != 0.0)
            check_written(expected, value, places);
    }
}

/* The doubles next to a tie of every number of places: the nearest are only an ulp away from it. */
static void test_numbers_next_to_a_tie_are_written_like_printf_writes_them(void)
{
    uint64_t state = 6;
    char expected[64];
    for (int i = 0; i < RANDOM_COUNT; i++) {
        unsigned places = 1 + random_below(&state, 9);
        double limit = i % 2 == 0 ? 1e3 : 1e8;
        double value = ((double)random_below(&state, (unsigned)limit) + 0.5) / pow(10.0, places);
        (void)snprintf(expected, sizeof expected, "%.*f", (int)places, value);
        if (!is_a_tie(value, places))
            check_written(expected, value, places);
    }
}

static void test_what_is_written_reads_back(void)
{
    uint64_t state = 7;
    char text[DECIMAL_TEXT_MAX];
    for (int i = 0; i < RANDOM_COUNT; i++) {
        double micrometres = (double)random_below(&state, 2000000000);
        double value;
        size_t length = takt_decimal_write(text, micrometres / 1e3, 3);
        TEST_ASSERT_EQUAL_UINT(length, takt_decimal_read(text, length, &value));
        TEST_ASSERT_TRUE(value == micrometres / 1e3);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_reads_digits_with_at_most_one_point);
    RUN_TEST(test_stops_at_the_first_character_that_is_not_part_of_the_number);
    RUN_TEST(test_reads_nothing_where_no_digit_stands);
    RUN_TEST(test_reads_no_further_than_the_length);
    RUN_TEST(test_up_to_19_digits_are_rounded_correctly);
    RUN_TEST(test_numbers_next_to_a_tie_are_rounded_correctly);
    RUN_TEST(test_the_hardest_numbers_are_rounded_correctly);
    RUN_TEST(test_every_double_survives_17_digits);
    RUN_TEST(test_more_than_19_digits_are_read_within_one_ulp);
    RUN_TEST(test_very_large_and_very_small_numbers_end_in_infinity_and_zero);
    RUN_TEST(test_writes_a_fixed_number_of_places);
    RUN_TEST(test_zero_is_never_negative);
    RUN_TEST(test_halves_are_rounded_away_from_zero);
    RUN_TEST(test_a_carry_runs_through_to_the_front);
    RUN_TEST(test_large_numbers_are_written_with_an_exponent);
    RUN_TEST(test_writes_what_is_not_a_number_by_name);
    RUN_TEST(test_random_numbers_are_written_like_printf_writes_them);
    RUN_TEST(test_numbers_next_to_a_tie_are_written_like_printf_writes_them);
    RUN_TEST(test_what_is_written_reads_back);
    return UNITY_END();
}
