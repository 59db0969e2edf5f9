/* firmware/program/parameters.h and how programs set and read parameters. */
#include "program_reader.h"

#include <stdio.h>

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

static double parameter(unsigned number)
{
    return takt_parameters_get(&reader.parameters, number);
}

static void test_a_parameter_never_set_is_zero(void)
{
    struct parameters p;

    takt_parameters_clear(&p);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_parameters_get(&p, 1));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_parameters_get(&p, 31));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_parameters_get(&p, PARAMETER_NUMBER_MAX));
}

/* Numbers in an order that jumps about: 7919 is prime to 5601. */
static void test_many_parameters_keep_their_values_in_any_order(void)
{
    struct parameters p;

    takt_parameters_clear(&p);
    for (unsigned i = 0; i < PARAMETERS_MAX; i++) {
        const unsigned number = 1 + i * 7919U % PARAMETER_NUMBER_MAX;

        TEST_ASSERT_TRUE(takt_parameters_set(&p, number, number + 0.5));
    }
    for (unsigned i = 0; i < PARAMETERS_MAX; i++) {
        const unsigned number = 1 + i * 7919U % PARAMETER_NUMBER_MAX;

        TEST_ASSERT_EQUAL_DOUBLE(number + 0.5, takt_parameters_get(&p, number));
    }
}

static void test_a_full_store_refuses_only_what_needs_room(void)
{
    struct parameters p;

    takt_parameters_clear(&p);
    for (unsigned i = 0; i < PARAMETERS_MAX; i++) {
        TEST_ASSERT_TRUE(takt_parameters_set(&p, 100 + i, 1.0));
    }
    TEST_ASSERT_FALSE(takt_parameters_set(&p, 5000, 1.0));
    TEST_ASSERT_TRUE(takt_parameters_set(&p, 5000, 0.0));
    TEST_ASSERT_TRUE(takt_parameters_set(&p, 100, 2.0));
    TEST_ASSERT_TRUE(takt_parameters_set(&p, 30, 3.0));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, takt_parameters_get(&p, 100));
    TEST_ASSERT_EQUAL_DOUBLE(3.0, takt_parameters_get(&p, 30));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_parameters_get(&p, 5000));
}

static void test_parameters_set_back_to_zero_make_room_for_others(void)
{
    struct parameters p;

    takt_parameters_clear(&p);
    for (unsigned i = 0; i < PARAMETERS_MAX; i++) {
        TEST_ASSERT_TRUE(takt_parameters_set(&p, 100 + i, 100.0 + i));
    }
    TEST_ASSERT_TRUE(takt_parameters_set(&p, 100, 0.0));
    TEST_ASSERT_TRUE(takt_parameters_set(&p, 777, 0.0));
    TEST_ASSERT_TRUE(takt_parameters_set(&p, 5000, 1.0));
    TEST_ASSERT_TRUE(takt_parameters_set(&p, 31, 2.0));
    TEST_ASSERT_FALSE(takt_parameters_set(&p, 777, 3.0));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_parameters_get(&p, 5000));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, takt_parameters_get(&p, 31));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_parameters_get(&p, 100));
    for (unsigned i = 1; i < PARAMETERS_MAX; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(i == 677 ? 0.0 : 100.0 + i, takt_parameters_get(&p, 100 + i));
    }
}

/*
 * A line that fails gives back what it took: also where the place of a zero has been taken since.
 */
static void test_a_faulty_line_in_a_full_store_assigns_nothing(void)
{
    const unsigned last = 98 + PARAMETERS_MAX;

    reader_prepare(&reader);
    for (unsigned number = 100; number <= last; number++) {
        TEST_ASSERT_TRUE(takt_parameters_set(&reader.parameters, number, 1.0));
    }
    reader_text(&reader, "#100=0 #5000=2 #5001=3\n"); /* #5220 has the last place */
    reader_expect_error(&reader, TAKT_ERROR_PARAMETERS_FULL);
    TEST_ASSERT_EQUAL_STRING("#5001", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, parameter(100));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(5000));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, parameter(last));
}

static void test_listing_goes_by_number_and_leaves_zeros_out(void)
{
    static const unsigned expected[] = {3, 30, 31, 5221};
    struct parameters p;
    unsigned number = 0;
    double value;

    takt_parameters_clear(&p);
    (void)takt_parameters_set(&p, 5221, 4.0);
    (void)takt_parameters_set(&p, 30, 2.0);
    (void)takt_parameters_set(&p, 100, 1.0);
    (void)takt_parameters_set(&p, 100, 0.0);
    (void)takt_parameters_set(&p, 31, 3.0);
    (void)takt_parameters_set(&p, 3, 1.0);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(takt_parameters_next(&p, &number, &value));
        TEST_ASSERT_EQUAL_UINT(expected[i], number);
        TEST_ASSERT_EQUAL_DOUBLE(i + 1.0, value);
    }
    TEST_ASSERT_FALSE(takt_parameters_next(&p, &number, &value));
}

static void test_assignments_take_effect_after_their_line(void)
{
    reader_open(&reader, "#1=10 #2=20\n#1=#2 #2=#1 G0 X#1\nX#1 Y#2");
    (void)reader_expect(&reader, MOVE_RAPID, 10.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 20.0, 10.0, 0.0);
}

static void test_the_last_assignment_of_a_line_wins(void)
{
    reader_open(&reader, "#1=1 #1=2 #<a>=3 #<a>=4\n#2=#<a>");
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(2.0, parameter(1));
    TEST_ASSERT_EQUAL_DOUBLE(4.0, parameter(2));
}

static void test_a_faulty_line_assigns_nothing(void)
{
    reader_open(&reader, "#1=1 #<a>=5\n#1=2 #1=3 #<a>=6 #<b>=7 #40=8 G0 X9999\n"
                         "#2=#<a> #3=EXISTS[#<b>]");
    reader_expect_error(&reader, TAKT_ERROR_TRAVEL_EXCEEDED);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, parameter(1));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, parameter(2));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(3));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(40));
}

static void test_programs_read_where_they_are(void)
{
    reader_open(&reader, "G20 #5221=25.4 G55\nG54 G0 X2 Y1 A90\n"
                         "#1=#5420 #2=#5421 #3=#5423 #4=#5220");
    (void)reader_next(&reader, MOVE_RAPID);
    reader_expect_end(&reader);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, parameter(1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, parameter(2));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 90.0, parameter(3));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, parameter(4));
}

static void test_programs_read_which_tool_they_have(void)
{
    reader_open(&reader, "#1=#5400\nT5 M6\n#2=#5400 #3=#5403 #4=#5401 #5=#5410\nT99 M6\n#6=#5403");
    for (int i = 0; i < 4; i++) {
        (void)reader_next(&reader, MOVE_TOOL);
    }
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(1));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, parameter(2));
    TEST_ASSERT_EQUAL_DOUBLE(100.0, parameter(3));
    TEST_ASSERT_EQUAL_DOUBLE(0.5, parameter(4));
    TEST_ASSERT_EQUAL_DOUBLE(6.0, parameter(5));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(6));
}

static void test_computed_parameters_cannot_be_set(void)
{
    static const unsigned numbers[] = {5400, 5403, 5410, 5420, 5425};
    char line[32];

    for (size_t i = 0; i < sizeof(numbers) / sizeof(numbers[0]); i++) {
        (void)snprintf(line, sizeof(line), "#%u=1", numbers[i]);
        reader_open(&reader, line);
        reader_expect_error(&reader, TAKT_ERROR_PARAMETER_READ_ONLY);
    }
}

static void test_an_assignment_needs_its_sign(void)
{
    reader_open(&reader, "G0 #1 5");
    reader_expect_error(&reader, TAKT_ERROR_EQUALS_EXPECTED);
    TEST_ASSERT_EQUAL_STRING("#15", reader.diagnostic.word);
}

/* "#1=1 " count times. */
static void write_assignments(char *line, unsigned count)
{
    line[0] = '\0';
    for (unsigned i = 0; i < count; i++) {
        (void)snprintf(line + 5 * (size_t)i, 6, "#1=1 ");
    }
}

static void test_a_line_has_so_many_assignments_and_no_more(void)
{
    char line[PROGRAM_LINE_MAX + 1];

    write_assignments(line, PROGRAM_ASSIGNMENTS_MAX);
    reader_open(&reader, line);
    reader_expect_end(&reader);
    write_assignments(line, PROGRAM_ASSIGNMENTS_MAX + 1);
    reader_open(&reader, line);
    reader_expect_error(&reader, TAKT_ERROR_ASSIGNMENTS_TOO_MANY);
    TEST_ASSERT_EQUAL_UINT32(5 * PROGRAM_ASSIGNMENTS_MAX + 1, reader.diagnostic.column);
}

static void test_names_run_out_as_numbers_do(void)
{
    static char text[PROGRAM_NAMES_MAX * 16 + 64];
    size_t length = 0;

    for (unsigned i = 0; i < PROGRAM_NAMES_MAX; i++) {
        length += (size_t)snprintf(text + length, sizeof(text) - length, "#<n%u>=%u\n", i, i);
    }
    (void)snprintf(text + length, sizeof(text) - length, "#<n0>=5 #<more>=1\n#1=#<n0> #2=#<n95>");
    reader_open(&reader, text);
    reader_expect_error(&reader, TAKT_ERROR_PARAMETERS_FULL);
    TEST_ASSERT_EQUAL_STRING("MORE", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_UINT32(PROGRAM_NAMES_MAX + 1, reader.diagnostic.line);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, parameter(1));
    TEST_ASSERT_EQUAL_DOUBLE(95.0, parameter(2));
}

static void test_numbers_run_out(void)
{
    reader_prepare(&reader);
    for (unsigned i = 0; i < PARAMETERS_MAX; i++) {
        (void)takt_parameters_set(&reader.parameters, 100 + i, 1.0);
    }
    reader_text(&reader, "#100=2 #3000=1\nG92 X5\n#101=2");
    reader_expect_error(&reader, TAKT_ERROR_PARAMETERS_FULL);
    TEST_ASSERT_EQUAL_STRING("#3000", reader.diagnostic.word);
    reader_expect_error(&reader, TAKT_ERROR_PARAMETERS_FULL);
    TEST_ASSERT_EQUAL_STRING("G92", reader.diagnostic.word);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, parameter(100));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, parameter(101));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_parameter_never_set_is_zero);
    RUN_TEST(test_many_parameters_keep_their_values_in_any_order);
    RUN_TEST(test_a_full_store_refuses_only_what_needs_room);
    RUN_TEST(test_parameters_set_back_to_zero_make_room_for_others);
    RUN_TEST(test_a_faulty_line_in_a_full_store_assigns_nothing);
    RUN_TEST(test_listing_goes_by_number_and_leaves_zeros_out);
    RUN_TEST(test_assignments_take_effect_after_their_line);
    RUN_TEST(test_the_last_assignment_of_a_line_wins);
    RUN_TEST(test_a_faulty_line_assigns_nothing);
    RUN_TEST(test_programs_read_where_they_are);
    RUN_TEST(test_programs_read_which_tool_they_have);
    RUN_TEST(test_computed_parameters_cannot_be_set);
    RUN_TEST(test_an_assignment_needs_its_sign);
    RUN_TEST(test_a_line_has_so_many_assignments_and_no_more);
    RUN_TEST(test_names_run_out_as_numbers_do);
    RUN_TEST(test_numbers_run_out);
    return UNITY_END();
}
