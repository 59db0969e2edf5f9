/*
 * A program that waits for what the world answers: probing moves (G38) and inputs (M66).
 */
#include "cutter_compensation/cutter_compensation.h"

#include "program_reader.h"

static struct reader reader;
static struct cutter_compensation offset;

void setUp(void)
{
}

void tearDown(void)
{
}

static void open_waiting(const char *text)
{
    reader_prepare(&reader);
    reader.config.waits = true;
    reader_text(&reader, text);
    takt_cutter_compensation_open(&offset, &reader.config);
}

static enum program_result next(struct move *m)
{
    return takt_cutter_compensation_next(&offset, &reader.program, m, &reader.diagnostic);
}

static void expect_wait(void)
{
    struct move m;

    TEST_ASSERT_EQUAL_INT(PROGRAM_WAIT, next(&m));
    TEST_ASSERT_EQUAL_INT(PROGRAM_WAIT, next(&m));
}

static struct move expect(enum move_kind kind)
{
    struct move m = {0};
    const enum program_result result = next(&m);

    reader_check(&reader, result, kind, &m);
    return m;
}

static void expect_to(enum move_kind kind, double x, double y, double z)
{
    const struct move m = expect(kind);

    reader_check_end(&m, x, y, z);
}

static void expect_end(void)
{
    struct move m;

    (void)expect(MOVE_END);
    TEST_ASSERT_EQUAL_INT(PROGRAM_END, next(&m));
}

static void answer_contact(double contact_z, double rest_z)
{
    const struct program_answer a = {
        .contact = true,
        .contact_at = {{1.0, 2.0, contact_z}},
        .rest_at = {{1.0, 2.0, rest_z}},
    };

    takt_cutter_compensation_answer(&offset, &reader.program, &a);
}

static void answer_value(double value)
{
    takt_cutter_compensation_answer(&offset, &reader.program,
                                    &(struct program_answer){.value = value});
}

static double parameter(unsigned number)
{
    return takt_parameters_get(&reader.parameters, number);
}

static void test_nothing_is_read_behind_a_probing_move_until_it_is_answered(void)
{
    open_waiting("G0 X1 Y2\nF60 G38.2 Z-10\n#1=#5063\nG0 Z#1\n");
    expect_to(MOVE_RAPID, 1.0, 2.0, 0.0);
    expect_to(MOVE_PROBE, 1.0, 2.0, -10.0);
    expect_wait();
    answer_contact(-4.25, -4.5);
    expect_to(MOVE_RAPID, 1.0, 2.0, -4.25);
    expect_end();
}

/* G92 and the tool's length take part in what the program sees; inches are its unit. */
static void test_the_contact_is_told_in_the_program_s_coordinates_and_units(void)
{
    open_waiting("G0 X1 Y2\nG43.1 Z5\nG92 X0\nG20 F10 G38.2 Z-1\nG21\n");
    expect_to(MOVE_RAPID, 1.0, 2.0, 0.0);
    (void)expect(MOVE_PROBE);
    answer_contact(-7.7, -8.0);
    expect_end();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, parameter(5061));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0 / 25.4, parameter(5062));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -12.7 / 25.4, parameter(5063));
    TEST_ASSERT_TRUE(parameter(5070) == 1.0);
}

static void test_a_relative_move_goes_on_from_where_the_axes_came_to_rest(void)
{
    open_waiting("F60 G38.3 Z-10\nG91 G0 Z3\n");
    (void)expect(MOVE_PROBE);
    answer_contact(-4.25, -4.5);
    expect_to(MOVE_RAPID, 1.0, 2.0, -1.5);
    expect_end();
}

static void test_without_contact_the_parameters_tell_the_end(void)
{
    const struct point end = {{0.0, 0.0, -10.0}};

    open_waiting("F60 G38.3 Z-10\n");
    (void)expect(MOVE_PROBE);
    takt_cutter_compensation_answer(&offset, &reader.program,
                                    &(struct program_answer){.contact_at = end, .rest_at = end});
    expect_end();
    TEST_ASSERT_TRUE(parameter(5063) == -10.0);
    TEST_ASSERT_TRUE(parameter(5070) == 0.0);
}

static void test_a_branch_follows_the_contact(void)
{
    open_waiting("F60 G38.3 Z-10\nO1 if [#5070 EQ 1]\nG0 X7\nO1 else\nG0 X8\nO1 endif\n");
    (void)expect(MOVE_PROBE);
    expect_wait();
    answer_contact(-4.0, -4.0);
    expect_to(MOVE_RAPID, 7.0, 2.0, -4.0);
    expect_end();
}

static void test_nothing_is_read_behind_an_input_until_it_is_answered(void)
{
    open_waiting("M66 E1 L0\nG0 X#5399\nM66 P3 L3 Q2\nG0 Y#5399\n");
    (void)expect(MOVE_INPUT);
    expect_wait();
    answer_value(2.5);
    expect_to(MOVE_RAPID, 2.5, 0.0, 0.0);
    (void)expect(MOVE_INPUT);
    expect_wait();
    answer_value(PROGRAM_INPUT_TIMED_OUT);
    expect_to(MOVE_RAPID, 2.5, -1.0, 0.0);
    expect_end();
}

static void test_the_rest_of_an_input_s_line_waits_too(void)
{
    open_waiting("M66 P0 L0 G0 X5\nG0 Y#5399\n");
    (void)expect(MOVE_INPUT);
    expect_wait();
    answer_value(1.0);
    expect_to(MOVE_RAPID, 5.0, 0.0, 0.0);
    expect_to(MOVE_RAPID, 5.0, 1.0, 0.0);
    expect_end();
}

/*
 * The tool's centre is at (20, 3) when G40 comes; nothing of the contour may be kept back by the
 * input.
 */
static void test_a_contour_is_done_before_the_program_waits(void)
{
    open_waiting("G41.1 D6\nG1 X20 F60\nX40\nG40\nM66 P1\nG1 X60 Y#5399\n");
    expect_to(MOVE_FEED, 20.0, 3.0, 0.0);
    expect_to(MOVE_FEED, 40.0, 3.0, 0.0);
    (void)expect(MOVE_INPUT);
    expect_wait();
    answer_value(1.0);
    expect_to(MOVE_FEED, 60.0, 1.0, 0.0);
    expect_end();
}

/* The entry of a contour is as long as the way from where the probing move came to rest. */
static void test_a_contour_begins_where_a_probing_move_came_to_rest(void)
{
    struct move m;

    open_waiting("F60 G38.3 X30\nG41.1 D6\nG1 X4\n");
    (void)expect(MOVE_PROBE);
    answer_contact(0.0, 0.0);
    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, next(&m));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_OFFSET_ENTRY_SHORT, reader.diagnostic.code);
}

static void test_an_answer_nobody_asked_for_changes_nothing(void)
{
    open_waiting("G0 X1\nG0 X[#5399+2] Y#5070\n");
    (void)expect(MOVE_RAPID);
    answer_value(5.0);
    answer_contact(-1.0, -1.0);
    expect_to(MOVE_RAPID, 2.0, 0.0, 0.0);
    expect_end();
}

static void test_without_waiting_the_program_goes_on_as_if_nothing_had_answered(void)
{
    reader_open(&reader, "F60 G38.2 Z-10\nM66 E1 L0\nG0 X#5399 Y#5070 Z#5063\n");
    (void)reader_next(&reader, MOVE_PROBE);
    (void)reader_next(&reader, MOVE_INPUT);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, -10.0);
    reader_expect_end(&reader);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_is_read_behind_a_probing_move_until_it_is_answered);
    RUN_TEST(test_the_contact_is_told_in_the_program_s_coordinates_and_units);
    RUN_TEST(test_a_relative_move_goes_on_from_where_the_axes_came_to_rest);
    RUN_TEST(test_without_contact_the_parameters_tell_the_end);
    RUN_TEST(test_a_branch_follows_the_contact);
    RUN_TEST(test_nothing_is_read_behind_an_input_until_it_is_answered);
    RUN_TEST(test_the_rest_of_an_input_s_line_waits_too);
    RUN_TEST(test_a_contour_is_done_before_the_program_waits);
    RUN_TEST(test_a_contour_begins_where_a_probing_move_came_to_rest);
    RUN_TEST(test_an_answer_nobody_asked_for_changes_nothing);
    RUN_TEST(test_without_waiting_the_program_goes_on_as_if_nothing_had_answered);
    return UNITY_END();
}
