/* firmware/program/coordinates.h: from words to machine positions. */
#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_rotary_words_are_degrees(void)
{
    reader_open(&reader, "G0 A90\nG91 A-45\nG20 G90 X1 A30\n#5=#5423");
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, MATHS_HALF_PI,
                              reader_next(&reader, MOVE_RAPID).end.at[AXIS_A]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, MATHS_PI / 4, reader_next(&reader, MOVE_RAPID).end.at[AXIS_A]);
    const struct move move = reader_expect(&reader, MOVE_RAPID, 25.4, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, MATHS_PI / 6, move.end.at[AXIS_A]);
    reader_expect_end(&reader);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 30.0, takt_parameters_get(&reader.parameters, 5));
}

static void test_offsets_add_up(void)
{
    reader_open(&reader, "#5241=1 #5242=2 #5244=90\nG55 G43 H5\nG0 X10 Y10 Z10 A0\n"
                         "G92 X0\nX5\nG49 X5 Z1");
    const struct move move = reader_expect(&reader, MOVE_RAPID, 11.5, 12.25, 110.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, MATHS_HALF_PI, move.end.at[AXIS_A]);
    (void)reader_expect(&reader, MOVE_RAPID, 16.5, 12.25, 110.0);
    (void)reader_expect(&reader, MOVE_RAPID, 16.0, 12.25, 1.0);
}

/*
 * The interpreter keeps machine positions, so an axis that is not named keeps its bits through any
 * offset.
 */
static void test_an_axis_without_a_word_stays_exactly_where_it_is(void)
{
    reader_open(&reader, "#5241=0.1 #5242=0.7\nG0 X0.3 Y0.2\nG55 Y1.1\nG92 X0.17\nY1.3\nG54 Y1.7");
    const double x = reader_next(&reader, MOVE_RAPID).end.at[AXIS_X];

    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(reader_next(&reader, MOVE_RAPID).end.at[AXIS_X] == x);
    }
}

static void test_selecting_a_system_moves_nothing_and_is_remembered(void)
{
    reader_open(&reader, "#5381=8\nG59.3");
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(9.0, takt_parameters_get(&reader.parameters, PARAMETER_SYSTEM));
    reader_text(&reader, "G0 X1 M2");
    (void)reader_expect(&reader, MOVE_RAPID, 9.0, 0.0, 0.0);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_parameters_get(&reader.parameters, PARAMETER_SYSTEM));
}

/* cos 30 degrees = sqrt(3) / 2, sin 30 degrees = 1 / 2 */
static void test_a_rotated_system_turns_x_and_y(void)
{
    reader_open(&reader,
                "#5250=30 #5241=1\nG55\nG0 X10 Y0 Z2\nG91 Y4\nG53 G90 X0 Y0\nX#5420 Y#5421");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0 + 5.0 * maths_sqrt(3.0), 5.0, 2.0);
    (void)reader_expect(&reader, MOVE_RAPID, 5.0 * maths_sqrt(3.0) - 1.0,
                        5.0 + 2.0 * maths_sqrt(3.0), 2.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 2.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 2.0);
    reader_expect_end(&reader);
}

static void test_an_axis_that_is_not_named_keeps_its_position_in_a_rotated_system(void)
{
    reader_open(&reader, "G0 X0.1 Y0.7\nG10 L2 P1 R33\nG0 Z1");
    const struct point before = reader_next(&reader, MOVE_RAPID).end;
    const struct point after = reader_next(&reader, MOVE_RAPID).end;

    TEST_ASSERT_TRUE(before.at[AXIS_X] == after.at[AXIS_X]);
    TEST_ASSERT_TRUE(before.at[AXIS_Y] == after.at[AXIS_Y]);
}

static void test_an_arc_across_a_rotated_plane_is_refused(void)
{
    reader_open(&reader, "G10 L2 P1 R30\nG18 F100\nG2 X10 I5");
    reader_expect_error(&reader, TAKT_ERROR_ARC_TILTED);
    TEST_ASSERT_EQUAL_STRING("G2", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_DOUBLE(30.0, reader.diagnostic.value);
}

static void test_axis_offsets_outlive_the_program(void)
{
    reader_open(&reader, "G0 X10 A90\nG92 X0 A0");
    (void)reader_next(&reader, MOVE_RAPID);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_parameters_get(&reader.parameters, PARAMETER_AXIS_APPLIED));
    TEST_ASSERT_EQUAL_DOUBLE(10.0, takt_parameters_get(&reader.parameters, PARAMETER_AXIS_OFFSET));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 90.0,
                              takt_parameters_get(&reader.parameters, PARAMETER_AXIS_OFFSET + 3));
    reader_text(&reader, "G0 X1 A-90");
    const struct move move = reader_expect(&reader, MOVE_RAPID, 11.0, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, move.end.at[AXIS_A]);
}

static void test_suspended_axis_offsets_can_be_restored_cancelled_ones_not(void)
{
    reader_open(&reader, "G92 X-5\nG92.2 G0 X0\nG92.3 X0\nG92.1 X0\nG92.3 X0");
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 5.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 0.0);
    reader_expect_end(&reader);
}

static void test_axis_offsets_need_an_axis(void)
{
    reader_open(&reader, "G21 G92");
    reader_expect_error(&reader, TAKT_ERROR_AXIS_WORD_MISSING);
    TEST_ASSERT_EQUAL_UINT32(5, reader.diagnostic.column);
}

static void test_machine_coordinates_pass_all_offsets_by(void)
{
    reader_open(&reader, "#5241=7\nG55 G43 H5 G92 X1\nG53 G0 X3\nX0\nG20 G53 X1");
    (void)reader_expect(&reader, MOVE_RAPID, 3.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, -1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 25.4, 0.0, 0.0);
}

static void test_machine_coordinates_are_for_straight_absolute_moves(void)
{
    static const char *const texts[] = {"G91 G53 G0 X1", "F1 G53 G2 X2 I1", "G53 M5", "G53 G80"};

    for (size_t i = 0; i < sizeof(texts) / sizeof(texts[0]); i++) {
        reader_open(&reader, texts[i]);
        struct move move;
        enum program_result result;

        do {
            result = takt_program_next(&reader.program, &move, &reader.diagnostic);
        } while (result == PROGRAM_MOVE && move.kind == MOVE_SPINDLE);
        TEST_ASSERT_EQUAL_INT_MESSAGE(PROGRAM_ERROR, result, texts[i]);
        TEST_ASSERT_EQUAL_INT(TAKT_ERROR_MACHINE_COORDINATES, reader.diagnostic.code);
        TEST_ASSERT_EQUAL_STRING("G53", reader.diagnostic.word);
    }
}

static void test_tool_length_is_that_of_h_or_of_the_tool_in_the_spindle(void)
{
    reader_open(&reader, "T12 M6\nG43 G0 Z0\nG43 H5 Z0\nG43 H0 Z0\nG49 Z2");
    (void)reader_next(&reader, MOVE_TOOL);
    (void)reader_next(&reader, MOVE_TOOL);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 40.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 100.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 40.0);
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 2.0);
    TEST_ASSERT_FALSE(takt_program_warning(&reader.program, &reader.diagnostic));
}

static void test_an_unknown_tool_has_no_length_and_a_warning(void)
{
    reader_open(&reader, "G43 H12\nG0 Z1\nG43 H7 Z1");
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 41.0);
    TEST_ASSERT_FALSE(takt_program_warning(&reader.program, &reader.diagnostic));
    (void)reader_expect(&reader, MOVE_RAPID, 0.0, 0.0, 1.0);
    TEST_ASSERT_TRUE(takt_program_warning(&reader.program, &reader.diagnostic));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TOOL_UNKNOWN, reader.diagnostic.code);
    TEST_ASSERT_EQUAL_UINT32(3, reader.diagnostic.line);
    TEST_ASSERT_EQUAL_UINT32(5, reader.diagnostic.column);
    TEST_ASSERT_EQUAL_STRING("H7", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_DOUBLE(7.0, reader.diagnostic.value);
    TEST_ASSERT_FALSE(takt_program_warning(&reader.program, &reader.diagnostic));
}

static void test_reference_positions_are_machine_positions(void)
{
    reader_open(&reader, "#5161=10 #5163=30 #5164=90 #5181=-1 #5241=3\n"
                         "G55 G43 H5 G0 X0 Z0\nG28\nG30 X5\nG91 G28 Z-1");
    (void)reader_expect(&reader, MOVE_RAPID, 3.5, 0.0, 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, MATHS_HALF_PI,
                              reader_expect(&reader, MOVE_RAPID, 10.0, 0.0, 30.0).end.at[AXIS_A]);
    (void)reader_expect(&reader, MOVE_RAPID, 8.5, 0.0, 30.0);
    (void)reader_expect(&reader, MOVE_RAPID, -1.0, 0.0, 30.0);
    (void)reader_expect(&reader, MOVE_RAPID, -1.0, 0.0, 29.0);
    (void)reader_expect(&reader, MOVE_RAPID, -1.0, 0.0, 30.0);
    reader_expect_end(&reader);
}

static void test_axes_the_machine_does_not_have_are_refused_by_name(void)
{
    static const char letters[] = "BCUVW";
    char text[] = "G0 X1 ?2";

    for (const char *letter = letters; *letter != '\0'; letter++) {
        text[6] = *letter;
        reader_open(&reader, text);
        reader_expect_error(&reader, TAKT_ERROR_AXIS_MISSING);
        TEST_ASSERT_EQUAL_INT(*letter, reader.diagnostic.word[0]);
        TEST_ASSERT_EQUAL_UINT32(7, reader.diagnostic.column);
    }
}

/*
 * 0.1 + 0.2 - 0.3 is not 0: a difference that has no length must not turn degrees per minute into
 * mm.
 */
static void test_the_rounding_of_linear_axes_does_not_change_the_unit_of_feed(void)
{
    struct move move;

    reader_open(&reader, "G0 X0.3\nG1 X[0.1+0.2] A90 F180\n");
    (void)reader_next(&reader, MOVE_RAPID);
    move = reader_next(&reader, MOVE_FEED);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, MATHS_PI / 60.0, move.feed_mm_s);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rotary_words_are_degrees);
    RUN_TEST(test_the_rounding_of_linear_axes_does_not_change_the_unit_of_feed);
    RUN_TEST(test_offsets_add_up);
    RUN_TEST(test_an_axis_without_a_word_stays_exactly_where_it_is);
    RUN_TEST(test_selecting_a_system_moves_nothing_and_is_remembered);
    RUN_TEST(test_a_rotated_system_turns_x_and_y);
    RUN_TEST(test_an_axis_that_is_not_named_keeps_its_position_in_a_rotated_system);
    RUN_TEST(test_an_arc_across_a_rotated_plane_is_refused);
    RUN_TEST(test_axis_offsets_outlive_the_program);
    RUN_TEST(test_suspended_axis_offsets_can_be_restored_cancelled_ones_not);
    RUN_TEST(test_axis_offsets_need_an_axis);
    RUN_TEST(test_machine_coordinates_pass_all_offsets_by);
    RUN_TEST(test_machine_coordinates_are_for_straight_absolute_moves);
    RUN_TEST(test_tool_length_is_that_of_h_or_of_the_tool_in_the_spindle);
    RUN_TEST(test_an_unknown_tool_has_no_length_and_a_warning);
    RUN_TEST(test_reference_positions_are_machine_positions);
    RUN_TEST(test_axes_the_machine_does_not_have_are_refused_by_name);
    return UNITY_END();
}
