/*
 * firmware/program/expression.h: what values mean, and what is wrong with those that mean nothing.
 */
#include "program_reader.h"

#include <stdio.h>

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

/* #1 = text must give expected, within a few units of the last place. */
static void check(const char *text, double expected)
{
    char line[PROGRAM_LINE_MAX + 1];

    (void)snprintf(line, sizeof(line), "#1=%s", text);
    reader_open(&reader, line);
    reader_expect_end(&reader);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14 * (1.0 + maths_abs(expected)), expected,
                              takt_parameters_get(&reader.parameters, 1));
}

/* #1 = text must be refused; the column counts from the first character of text. */
static void check_error(const char *text, enum takt_error code, uint32_t column, const char *word)
{
    char line[PROGRAM_LINE_MAX + 1];

    (void)snprintf(line, sizeof(line), "#1=%s", text);
    reader_expect_refused(&reader, line, code);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(word, reader.diagnostic.word, text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(column + 3, reader.diagnostic.column, text);
}

static void test_numbers(void)
{
    check("12", 12.0);
    check("12.", 12.0);
    check(".5", 0.5);
    check("-.5", -0.5);
    check("+3", 3.0);
    check("--3", 3.0);
    check("-+-3", 3.0);
    check("0.1", 0.1);
    check("1 2 . 5", 12.5);
}

static void test_products_come_before_sums(void)
{
    check("[1+2*3]", 7.0);
    check("[2*3+1]", 7.0);
    check("[1-6/3]", -1.0);
    check("[[1+2]*3]", 9.0);
    check("[1+7 MOD 4]", 4.0);
}

static void test_equal_operators_are_done_from_left_to_right(void)
{
    check("[10-4-3]", 3.0);
    check("[24/4/2]", 3.0);
    check("[2*3 MOD 4]", 2.0);
    check("[2**3**2]", 64.0);
}

static void test_powers_bind_tightest_but_for_the_sign(void)
{
    check("[2*3**2]", 18.0);
    check("[-2**2]", 4.0);
    check("[2**-1]", 0.5);
    check("[-[2**2]]", -4.0);
    check("[2**0.5]", 1.4142135623730951);
    check("[-8**3]", -512.0);
}

static void test_comparisons_come_after_sums_and_before_logic(void)
{
    check("[1+1 EQ 2]", 1.0);
    check("[1 LT 2 AND 3 GT 4]", 0.0);
    check("[1 LT 2 OR 3 GT 4]", 1.0);
    check("[1 LT 2 XOR 3 LT 4]", 0.0);
    check("[2 LE 2]", 1.0);
    check("[2 GE 3]", 0.0);
    check("[2 NE 2]", 0.0);
    check("[5 AND 0.5]", 1.0);
}

static void test_values_a_millionth_apart_are_equal(void)
{
    check("[1 EQ 1.0000009]", 1.0);
    check("[1 EQ 1.0000011]", 0.0);
    check("[1 NE 1.0000009]", 0.0);
    check("[1.0000009 LE 1]", 1.0);
    check("[1 GE 1.0000009]", 1.0);
    check("[1 LT 1.0000009]", 1.0);
}

static void test_a_remainder_is_never_negative(void)
{
    check("[7 MOD 3]", 1.0);
    check("[-7 MOD 3]", 2.0);
    check("[7 MOD -3]", 1.0);
    check("[-6 MOD 3]", 0.0);
    check("[5.5 MOD 2]", 1.5);
    check("[2 MOD 5]", 2.0);
}

/* 10^17 = 7 * 14285714285714285 + 5: a quotient too large for a product to be exact. */
static void test_a_remainder_is_exact_for_any_quotient(void)
{
    check("[100000000000000000 MOD 7]", 5.0);
    check("[10**22 MOD 3]", 1.0);
}

static void test_angles_are_degrees(void)
{
    check("SIN[30]", 0.5);
    check("COS[60]", 0.5);
    check("TAN[45]", 1.0);
    check("ASIN[0.5]", 30.0);
    check("ACOS[0.5]", 60.0);
    check("ATAN[1]/[1]", 45.0);
    check("ATAN[1]/[-1]", 135.0);
    check("ATAN[-1]/[0]", -90.0);
}

static void test_functions(void)
{
    check("ABS[-2.5]", 2.5);
    check("SQRT[2]", 1.4142135623730951);
    check("EXP[1]", 2.718281828459045);
    check("LN[10]", 2.302585092994046);
    check("FIX[2.8]", 2.0);
    check("FIX[-2.8]", -3.0);
    check("FUP[2.2]", 3.0);
    check("FUP[-2.8]", -2.0);
    check("ROUND[2.5]", 3.0);
    check("ROUND[-2.5]", -3.0);
    check("ROUND[2.4999]", 2.0);
    check("-SQRT[SQRT[16]]", -2.0);
    check("[ABS[-1]+ABS[2]]", 3.0);
}

static void test_parameters_of_parameters(void)
{
    reader_open(&reader, "#2=3 #3=4 #4=5\n#1=##2\n#5=###2\n#6=#[#2+1]\n#7=-#4\n##2=9");
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, takt_parameters_get(&reader.parameters, 1));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, takt_parameters_get(&reader.parameters, 5));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, takt_parameters_get(&reader.parameters, 6));
    TEST_ASSERT_EQUAL_DOUBLE(-5.0, takt_parameters_get(&reader.parameters, 7));
    TEST_ASSERT_EQUAL_DOUBLE(9.0, takt_parameters_get(&reader.parameters, 3));
}

static void test_exists_tells_which_names_have_been_set(void)
{
    check("EXISTS[#<none>]", 0.0);
    check("EXISTS[#5000]", 1.0);
    reader_open(&reader, "#<a>=0\n#1=EXISTS[#<A>]\n#2=EXISTS[#<ab>]");
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_parameters_get(&reader.parameters, 1));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_parameters_get(&reader.parameters, 2));
}

static void test_missing_pieces(void)
{
    check_error("", TAKT_ERROR_NUMBER_EXPECTED, 0, "=");
    check_error("[1+]", TAKT_ERROR_NUMBER_EXPECTED, 3, "+");
    check_error("[]", TAKT_ERROR_NUMBER_EXPECTED, 1, "[");
    check_error("[1+foo[2]]", TAKT_ERROR_NUMBER_EXPECTED, 3, "+");
    check_error(".", TAKT_ERROR_NUMBER_EXPECTED, 0, "=");
    check_error("#", TAKT_ERROR_NUMBER_EXPECTED, 1, "#");
    check_error("[1+2", TAKT_ERROR_BRACKET_UNCLOSED, 4, "2");
    check_error("[1 2 nor 3]", TAKT_ERROR_OPERATOR_EXPECTED, 4, "2");
    check_error("SQRT 4", TAKT_ERROR_BRACKET_EXPECTED, 1, "SQRT");
    check_error("ATAN[1]", TAKT_ERROR_SLASH_EXPECTED, 7, "]");
    check_error("ATAN[1]/2", TAKT_ERROR_BRACKET_EXPECTED, 8, "/");
    check_error("EXISTS 5", TAKT_ERROR_BRACKET_EXPECTED, 1, "EXISTS");
    check_error("EXISTS[5]", TAKT_ERROR_NUMBER_EXPECTED, 7, "[");
    check_error("EXISTS[#5", TAKT_ERROR_BRACKET_UNCLOSED, 9, "5");
}

static void test_what_cannot_be_calculated(void)
{
    check_error("[1/0]", TAKT_ERROR_DIVISION_BY_ZERO, 3, "/");
    check_error("[1 MOD 0]", TAKT_ERROR_DIVISION_BY_ZERO, 4, "MOD");
    check_error("[-8**0.5]", TAKT_ERROR_CALCULATION_UNDEFINED, 4, "**");
    check_error("SQRT[-4]", TAKT_ERROR_CALCULATION_UNDEFINED, 1, "SQRT");
    TEST_ASSERT_EQUAL_DOUBLE(-4.0, reader.diagnostic.value);
    check_error("LN[0]", TAKT_ERROR_CALCULATION_UNDEFINED, 1, "LN");
    check_error("ACOS[1.1]", TAKT_ERROR_CALCULATION_UNDEFINED, 1, "ACOS");
    check_error("ASIN[-1.1]", TAKT_ERROR_CALCULATION_UNDEFINED, 1, "ASIN");
    check_error("[10**200*10**200]", TAKT_ERROR_CALCULATION_NOT_FINITE, 9, "*");
    check_error("EXP[1000]", TAKT_ERROR_CALCULATION_NOT_FINITE, 1, "EXP[1000]");
}

static void test_parameters_that_cannot_be(void)
{
    check_error("#0", TAKT_ERROR_PARAMETER_NUMBER, 1, "#0");
    check_error("#-1", TAKT_ERROR_PARAMETER_NUMBER, 1, "#-1");
    check_error("#5602", TAKT_ERROR_PARAMETER_NUMBER, 1, "#5602");
    check_error("#1.5", TAKT_ERROR_PARAMETER_NUMBER, 1, "#1.5");
    check_error("#<none>", TAKT_ERROR_PARAMETER_UNDEFINED, 3, "NONE");
    check_error("#<>", TAKT_ERROR_PARAMETER_NAME, 2, "<");
    check_error("#<none", TAKT_ERROR_PARAMETER_NAME, 2, "<");
    check_error("#<a234567890123456789012345678901234567890123456789012345678901234>",
                TAKT_ERROR_PARAMETER_NAME, 2, "<");
    check("[0*EXISTS[#<a234567890123456789012345678901>]]", 0.0);
}

/* depth brackets around a 1. */
static void write_brackets(char *text, unsigned depth)
{
    memset(text, '[', depth);
    text[depth] = '1';
    memset(text + depth + 1, ']', depth);
    text[2 * depth + 1] = '\0';
}

static void test_nesting_is_limited(void)
{
    char text[2 * PROGRAM_NESTING_MAX + 4];

    write_brackets(text, PROGRAM_NESTING_MAX - 1);
    check(text, 1.0);
    write_brackets(text, PROGRAM_NESTING_MAX);
    check_error(text, TAKT_ERROR_NESTING_TOO_DEEP, PROGRAM_NESTING_MAX + 1, "1");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_numbers);
    RUN_TEST(test_products_come_before_sums);
    RUN_TEST(test_equal_operators_are_done_from_left_to_right);
    RUN_TEST(test_powers_bind_tightest_but_for_the_sign);
    RUN_TEST(test_comparisons_come_after_sums_and_before_logic);
    RUN_TEST(test_values_a_millionth_apart_are_equal);
    RUN_TEST(test_a_remainder_is_never_negative);
    RUN_TEST(test_a_remainder_is_exact_for_any_quotient);
    RUN_TEST(test_angles_are_degrees);
    RUN_TEST(test_functions);
    RUN_TEST(test_parameters_of_parameters);
    RUN_TEST(test_exists_tells_which_names_have_been_set);
    RUN_TEST(test_missing_pieces);
    RUN_TEST(test_what_cannot_be_calculated);
    RUN_TEST(test_parameters_that_cannot_be);
    RUN_TEST(test_nesting_is_limited);
    return UNITY_END();
}
