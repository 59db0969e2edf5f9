/* G10 and other offsets, probing, involutes, feeds that follow the spindle, inputs and outputs. */
#include "program_reader.h"

static struct reader reader;

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_g10_l2_moves_the_system_in_use(void)
{
    reader_open(&reader, "G10 L2 P1 X5 Y6\nG0 X1\nG10 L2 P2 Z7\nG0 X2\nG55\nG0 X0 Y0 Z0");
    reader_expect_rapid(&reader, 6.0, 0.0, 0.0);
    reader_expect_rapid(&reader, 7.0, 0.0, 0.0);
    reader_expect_rapid(&reader, 0.0, 0.0, 7.0);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(6.0,
                             takt_parameters_get(&reader.parameters, PARAMETER_SYSTEM_OFFSET + 1));
}

static void test_g10_l20_gives_the_position_its_coordinates(void)
{
    reader_open(&reader,
                "G10 L2 P1 R40 X3 Y4\nT5 M6 G43\nG0 X10 Y20 Z5\nG10 L20 P1 X1 Y2\nG0 X1 Y2\n"
                "G10 L20 P1 Y9\nG0 X1 Y9");
    (void)reader_next(&reader, MOVE_TOOL);
    (void)reader_next(&reader, MOVE_TOOL);
    const struct point at = reader_next(&reader, MOVE_RAPID).end;

    reader_expect_rapid(&reader, at.at[AXIS_X], at.at[AXIS_Y], at.at[AXIS_Z]);
    reader_expect_rapid(&reader, at.at[AXIS_X], at.at[AXIS_Y], at.at[AXIS_Z]);
}

static void test_g10_l10_measures_a_tool(void)
{
    reader_open(&reader, "G10 L2 P1 X3 Y4 R25\nT5 M6\nG0 X10 Y20 Z50\nG10 L10 P5 X1 Y2 Z3\nG43\n"
                         "G0 X1 Y2 Z3");
    (void)reader_next(&reader, MOVE_TOOL);
    (void)reader_next(&reader, MOVE_TOOL);
    const struct point at = reader_next(&reader, MOVE_RAPID).end;

    reader_expect_rapid(&reader, at.at[AXIS_X], at.at[AXIS_Y], at.at[AXIS_Z]);
    reader_expect_end(&reader);
}

static void test_g10_l1_changes_a_tool_for_this_program_alone(void)
{
    reader_open(&reader, "G10 L1 P5 Z30 R4\nG43 H5\nG0 Z0\n");
    reader_expect_rapid(&reader, 0.0, 0.0, 30.0);
    reader_text(&reader, "G43 H5\nG0 Z0");
    reader_expect_rapid(&reader, 0.0, 0.0, 100.0);
}

static void test_the_values_of_the_tool_in_the_spindle_are_parameters(void)
{
    double expected[] = {5.0, 1.0, 0.25, 2.0, 0.0, 0.0, 0.0};

    reader_open(&reader,
                "G10 L1 P5 X1 Z2 R4 I10 J20 Q7\nT5 M6\n#1=#5400 #2=#5401 #3=#5402 #4=#5403\n"
                "#8=#5410 #9=#5411 #10=#5412 #11=#5413");
    (void)reader_next(&reader, MOVE_TOOL);
    (void)reader_next(&reader, MOVE_TOOL);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE_ARRAY(expected, reader.parameters.local, 7);
    TEST_ASSERT_EQUAL_DOUBLE(8.0, reader.parameters.local[7]);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, reader.parameters.local[8]);
    TEST_ASSERT_EQUAL_DOUBLE(20.0, reader.parameters.local[9]);
    TEST_ASSERT_EQUAL_DOUBLE(7.0, reader.parameters.local[10]);
}

/* All of them on one line, which then fails: nothing of it stays. */
static void test_all_parameters_of_a_line_are_taken_back(void)
{
    reader_open(&reader, "F60 G0 X4\nG55 M66 P1 G28.1 G92.1 G38.2 X2 M2");
    (void)reader_next(&reader, MOVE_RAPID);
    (void)reader_next(&reader, MOVE_INPUT);
    (void)reader_next(&reader, MOVE_PROBE);
    reader_expect_end(&reader);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, takt_parameters_get(&reader.parameters, PARAMETER_REFERENCE_1));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_parameters_get(&reader.parameters, PARAMETER_SYSTEM));
    reader_text(&reader, "F60\nG28.1 G92.1 G55 M66 P1 G38.2 X600");
    reader_expect_error(&reader, TAKT_ERROR_TRAVEL_EXCEEDED);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, takt_parameters_get(&reader.parameters, PARAMETER_REFERENCE_1));
}

static void test_more_tools_than_there_is_room_for_are_refused(void)
{
    static struct tool tools[PROGRAM_TOOL_CHANGES_MAX + 1];
    const struct tool_table table = {tools, PROGRAM_TOOL_CHANGES_MAX + 1};
    const char *text = "#1=1\no1 repeat [17]\nG10 L1 P#1 Z#1\n#1=[#1+1]\no1 endrepeat\n";

    for (unsigned i = 0; i <= PROGRAM_TOOL_CHANGES_MAX; i++) {
        tools[i].number = i + 1;
    }
    reader_prepare(&reader);
    reader.config.tools = &table;
    reader_text(&reader, text);
    reader_expect_error(&reader, TAKT_ERROR_TOOL_CHANGES_FULL);
}

static void test_m61_loads_a_tool_for_g43(void)
{
    reader_open(&reader, "M61 Q12\nG43\nG0 Z1");
    const struct move move = reader_next(&reader, MOVE_TOOL);

    TEST_ASSERT_TRUE(move.tool_loaded);
    TEST_ASSERT_EQUAL_UINT32(12, move.tool);
    reader_expect_rapid(&reader, 0.0, 0.0, 41.0);
}

static void test_a_probe_that_answers_ends_the_move_there(void)
{
    const struct program_answer answer = {
        .contact = true,
        .contact_at = {{4.0, 2.0, 1.5, 0.0, 0.0, 0.0}},
        .rest_at = {{4.5, 2.5, 1.75, 0.0, 0.0, 0.0}},
    };

    reader_open(&reader, "G92 X-1\nF60\nG38.2 X9\nG0 Y#5061 Z#5070");
    const struct move move = reader_expect(&reader, MOVE_PROBE, 10.0, 0.0, 0.0);

    TEST_ASSERT_FALSE(move.probe_away);
    TEST_ASSERT_FALSE(move.probe_optional);
    takt_program_answer(&reader.program, &answer);
    reader_expect_rapid(&reader, 4.5, 3.0, 1.0);
}

static void test_without_an_answer_a_probe_ends_where_it_was_sent(void)
{
    reader_open(&reader, "F60\nG38.5 X9\nG0 Y#5061 Z#5070");
    const struct move move = reader_expect(&reader, MOVE_PROBE, 9.0, 0.0, 0.0);

    TEST_ASSERT_TRUE(move.probe_away);
    TEST_ASSERT_TRUE(move.probe_optional);
    reader_expect_rapid(&reader, 9.0, 9.0, 0.0);
}

static void test_a_feed_per_revolution_is_told_with_what_it_comes_to(void)
{
    struct diagnostic warning;
    struct move move;

    reader_open(&reader, "M3 S600\nG95 F0.2\nG1 X1\nG93 X2 F60\nG94 F60 X3");
    (void)reader_next(&reader, MOVE_SPINDLE);
    move = reader_next(&reader, MOVE_FEED);
    TEST_ASSERT_EQUAL_DOUBLE(0.2, move.feed_rev_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, move.feed_mm_s);
    TEST_ASSERT_FALSE(takt_program_warning(&reader.program, &warning));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, reader_next(&reader, MOVE_FEED).feed_rev_mm);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, reader_next(&reader, MOVE_FEED).feed_rev_mm);
}

/* 314.159... m/min at a radius of 50 mm: 1000 rev/min; at 1 mm D, 2000, is less. */
static void test_a_surface_speed_follows_the_radius_up_to_d(void)
{
    struct move move;

    reader_open(&reader, "#1=[ACOS[-1]/180*3.14159265358979323846*100]\nG0 X50\nM3\nG96 D2000 S#1\n"
                         "G95 F0.1\nG1 X1\nX2");
    (void)reader_next(&reader, MOVE_RAPID);
    (void)reader_next(&reader, MOVE_SPINDLE);
    move = reader_next(&reader, MOVE_SPINDLE);
    TEST_ASSERT_EQUAL_DOUBLE(2000.0, move.speed_rpm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 314159.265358979 / 60.0, move.surface_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 100.0 / 60.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 200.0 / 60.0, reader_next(&reader, MOVE_FEED).feed_mm_s);
}

static void test_a_rigid_tap_comes_back_at_its_ratio(void)
{
    struct move move;

    reader_open(&reader, "M3 S60\nG0 Z5\nG33.1 Z-5 K2 I3\nG0 X1");
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_RAPID);
    move = reader_expect(&reader, MOVE_TAP, 0.0, 0.0, -5.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, move.feed_mm_s);
    move = reader_expect(&reader, MOVE_TAP_OUT, 0.0, 0.0, 5.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 6.0, move.feed_mm_s);
    TEST_ASSERT_EQUAL_DOUBLE(3.0, move.speed_ratio);
    reader_expect_rapid(&reader, 1.0, 0.0, 5.0);
}

static unsigned overrides_after(const char *text)
{
    reader_open(&reader, text);
    return reader_next(&reader, MOVE_RAPID).overrides;
}

static void test_overrides_are_switched_one_by_one(void)
{
    const unsigned start = OVERRIDE_FEED | OVERRIDE_SPINDLE | OVERRIDE_HOLD;

    TEST_ASSERT_EQUAL_UINT(start, overrides_after("G0 X1"));
    TEST_ASSERT_EQUAL_UINT(OVERRIDE_HOLD, overrides_after("M49\nG0 X1"));
    TEST_ASSERT_EQUAL_UINT(start, overrides_after("M49\nM48\nG0 X1"));
    TEST_ASSERT_EQUAL_UINT(start & ~OVERRIDE_FEED, overrides_after("M50 P0\nG0 X1"));
    TEST_ASSERT_EQUAL_UINT(start & ~OVERRIDE_SPINDLE, overrides_after("M51 P0\nG0 X1"));
    TEST_ASSERT_EQUAL_UINT(start | OVERRIDE_ADAPTIVE, overrides_after("M52 P1\nG0 X1"));
    TEST_ASSERT_EQUAL_UINT(start & ~OVERRIDE_HOLD, overrides_after("M53 P0\nG0 X1"));
    TEST_ASSERT_EQUAL_UINT(start, overrides_after("M53 P0\nM53\nG0 X1"));
}

static void test_g64_tells_how_far_moves_may_be_merged(void)
{
    reader_open(&reader, "G20 G64 P0.1 Q0.02\nG0 X1\nG64 P0.1\nG0 X2\nG61\nG0 X3");
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.508, reader_next(&reader, MOVE_RAPID).merge_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.54, reader_next(&reader, MOVE_RAPID).merge_mm);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, reader_next(&reader, MOVE_RAPID).merge_mm);
}

/* The involute of a circle of radius r about 0, unrolled by phi. */
static void takt_involute_point(double r, double phi, double way, double *x, double *y)
{
    *x = r * (takt_maths_cos(phi) + phi * takt_maths_sin(phi));
    *y = way * r * (takt_maths_sin(phi) - phi * takt_maths_cos(phi));
}

/*
 * From phi to phi, turning by way; off: how far the end lies off the involute, along the normal
 * there.
 */
static enum program_result read_involute(double from, double to, double way, double off)
{
    const double r = 4.0;
    const bool ccw = (to > from) == (way > 0.0);
    struct move move;
    double x[2];
    double y[2];

    takt_involute_point(r, from, way, &x[0], &y[0]);
    takt_involute_point(r, to, way, &x[1], &y[1]);
    x[1] += off * takt_maths_sin(to);
    y[1] -= off * way * takt_maths_cos(to);
    reader_open(&reader, "");
    takt_parameters_set(&reader.parameters, 1, x[0]);
    takt_parameters_set(&reader.parameters, 2, y[0]);
    takt_parameters_set(&reader.parameters, 3, x[1]);
    takt_parameters_set(&reader.parameters, 4, y[1]);
    reader_text(&reader, ccw ? "F60 G0 X#1 Y#2\nG3.2 X#3 Y#4 I[0-#1] J[0-#2] R4"
                             : "F60 G0 X#1 Y#2\nG2.2 X#3 Y#4 I[0-#1] J[0-#2] R4");
    (void)reader_next(&reader, MOVE_RAPID);
    return takt_program_next(&reader.program, &move, &reader.diagnostic);
}

static void test_any_piece_of_an_involute_is_read(void)
{
    static const double angles[] = {0.0, 0.3, 1.7, 3.9, 8.0, 21.0};
    const unsigned count = sizeof(angles) / sizeof(angles[0]);

    for (unsigned i = 0; i < count * count; i++) {
        if (i / count != i % count) {
            TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE,
                                  read_involute(angles[i / count], angles[i % count], 1.0, 0.0));
            TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE,
                                  read_involute(angles[i / count], angles[i % count], -1.0, 0.0));
        }
    }
}

static void test_an_end_off_the_involute_is_told_by_how_much(void)
{
    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, read_involute(1.0, 9.0, 1.0, 0.25));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_INVOLUTE_END, reader.diagnostic.code);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.25, reader.diagnostic.value);
    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, read_involute(9.0, 1.0, -1.0, -0.1));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_INVOLUTE_END, reader.diagnostic.code);
    TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE, read_involute(1.0, 9.0, 1.0, 0.02));
}

static void test_an_input_nobody_reads_is_0(void)
{
    reader_open(&reader, "#5399=7\nM66 P3 L4 Q1.5\nG0 X#5399");
    const struct move move = reader_next(&reader, MOVE_INPUT);

    TEST_ASSERT_EQUAL_UINT32(3, move.channel);
    TEST_ASSERT_EQUAL_INT(INPUT_LOW, move.input_wait);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, move.timeout_s);
    reader_expect_rapid(&reader, 0.0, 0.0, 0.0);
}

static void test_diameters_are_halved(void)
{
    reader_open(&reader, "G7 G0 X10\nG91 X2\nG8 G90 X10");
    reader_expect_rapid(&reader, 5.0, 0.0, 0.0);
    reader_expect_rapid(&reader, 6.0, 0.0, 0.0);
    reader_expect_rapid(&reader, 10.0, 0.0, 0.0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_g10_l2_moves_the_system_in_use);
    RUN_TEST(test_g10_l20_gives_the_position_its_coordinates);
    RUN_TEST(test_g10_l10_measures_a_tool);
    RUN_TEST(test_g10_l1_changes_a_tool_for_this_program_alone);
    RUN_TEST(test_the_values_of_the_tool_in_the_spindle_are_parameters);
    RUN_TEST(test_all_parameters_of_a_line_are_taken_back);
    RUN_TEST(test_more_tools_than_there_is_room_for_are_refused);
    RUN_TEST(test_m61_loads_a_tool_for_g43);
    RUN_TEST(test_a_probe_that_answers_ends_the_move_there);
    RUN_TEST(test_without_an_answer_a_probe_ends_where_it_was_sent);
    RUN_TEST(test_a_feed_per_revolution_is_told_with_what_it_comes_to);
    RUN_TEST(test_a_surface_speed_follows_the_radius_up_to_d);
    RUN_TEST(test_a_rigid_tap_comes_back_at_its_ratio);
    RUN_TEST(test_overrides_are_switched_one_by_one);
    RUN_TEST(test_g64_tells_how_far_moves_may_be_merged);
    RUN_TEST(test_any_piece_of_an_involute_is_read);
    RUN_TEST(test_an_end_off_the_involute_is_told_by_how_much);
    RUN_TEST(test_an_input_nobody_reads_is_0);
    RUN_TEST(test_diameters_are_halved);
    return UNITY_END();
}
