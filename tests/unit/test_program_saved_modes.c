/*
 * M70 to M73, and the named parameters that say how things stand.
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

/* Everything M70 saves, set to something else than at the start. */
#define OTHER_MODES "F600 S100 M3 M8 G20 G18 G91 G55 G64 P0.01 G90.1 G43.1 Z1\n"

static void test_m72_brings_all_saved_modes_back(void)
{
    struct move move;

    reader_open(&reader, "F60 S500 M4 M7\nM70\n" OTHER_MODES
                         "M72\nG1 X1\nG0 X#<_plane> Y#<_coord_system>\n");
    reader.config.travel_max[AXIS_X] = 1000.0;
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_COOLANT);
    (void)reader_next(&reader, MOVE_SPINDLE);
    (void)reader_next(&reader, MOVE_COOLANT);
    move = reader_next(&reader, MOVE_SPINDLE);
    TEST_ASSERT_EQUAL_INT(SPINDLE_CCW, move.direction);
    TEST_ASSERT_EQUAL_DOUBLE(500.0, move.speed_rpm);
    move = reader_next(&reader, MOVE_COOLANT);
    TEST_ASSERT_TRUE(move.mist && !move.flood);
    move = reader_expect(&reader, MOVE_FEED, 1.0, 0.0, 0.0);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, move.feed_mm_s);
    TEST_ASSERT_EQUAL_INT(PATH_EXACT, move.path);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_parameters_get(&reader.parameters, PARAMETER_SYSTEM));
}

static void test_m72_leaves_position_offsets_and_motion_alone(void)
{
    reader_open(&reader, "F60 G1 X1\nM70\nG0 X2\nG92 X0\nM72\nX3\n");
    (void)reader_next(&reader, MOVE_FEED);
    (void)reader_next(&reader, MOVE_RAPID);
    (void)reader_expect(&reader, MOVE_RAPID, 5.0, 0.0, 0.0);
}

static void test_m72_does_not_change_what_a_compensated_contour_stands_on(void)
{
    reader_expect_refused(&reader, "G18\nM70\nG17\nG41.1 D6\nM72\n", TAKT_ERROR_CUTTER_ON);
    TEST_ASSERT_EQUAL_STRING("M72", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_UINT32(5, reader.diagnostic.line);
    reader_expect_refused(&reader, "G55\nM70\nG54\nG41.1 D6\nM72\n", TAKT_ERROR_CUTTER_ON);
    reader_expect_refused(&reader, "G43.1 Z1\nM70\nG49\nG41.1 D6\nM72\n", TAKT_ERROR_CUTTER_ON);
    reader_open(&reader, "G91\nM70\nG90\nG41.1 D6\nM72\nM2\n");
    reader_expect_end(&reader);
}

static void test_m72_needs_m70_of_the_same_call(void)
{
    reader_open(&reader, "M72\n");
    reader_expect_error(&reader, TAKT_ERROR_MODES_NOT_SAVED);
    reader_open(&reader, "M70\nM71\nM72\n");
    reader_expect_error(&reader, TAKT_ERROR_MODES_NOT_SAVED);
    reader_open(&reader, "M70\no1 call\nM2\no1 sub\nM72\no1 endsub\n");
    reader_expect_error(&reader, TAKT_ERROR_MODES_NOT_SAVED);
}

static void test_m73_brings_modes_back_when_the_call_ends(void)
{
    reader_open(&reader, "o1 sub\nM73\nG91 G20\no1 return\no1 endsub\no2 sub\nG91\no2 endsub\n"
                         "o3 sub\nM73\nG20\nM71\no3 endsub\n"
                         "G0 X5\no1 call\nX4\no2 call\nX1\nG90\no3 call\nX1\n");
    (void)reader_expect(&reader, MOVE_RAPID, 5.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 4.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 5.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 25.4, 0.0, 0.0);
    reader_expect_end(&reader);
}

static void test_m73_works_in_numbered_programs_and_does_nothing_in_the_main_one(void)
{
    reader_open(&reader, "M73\nG0 X1\nM98 P1\nX2\nM2\no1\nM73\nG91\nX1\nM99\n");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0);
    reader_expect_end(&reader);
}

static void test_a_line_with_an_error_has_restored_nothing(void)
{
    reader_open(&reader, "M70\nG91 G55\nM72 G1 X1\nG0 X[#<_incremental>+#5220]\n");
    reader_expect_error(&reader, TAKT_ERROR_FEED_MISSING);
    (void)reader_expect(&reader, MOVE_RAPID, 3.0, 0.0, 0.0);
}

/* After text, the parameter has this value. */
static void expect_value(const char *text, const char *name, double value)
{
    static char program[256];

    (void)snprintf(program, sizeof(program), "%s\n#100=#<%s>\nM2\n", text, name);
    reader_open(&reader, program);
    for (;;) {
        struct move move;
        const enum program_result result =
            takt_program_next(&reader.program, &move, &reader.diagnostic);

        TEST_ASSERT_MESSAGE(result != PROGRAM_ERROR, program);
        if (result == PROGRAM_END) {
            break;
        }
    }
    TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(value, takt_parameters_get(&reader.parameters, 100), program);
}

struct expectation {
    const char *text, *name;
    double value;
};

static const struct expectation expectations[] = {
    {"", "_motion_mode", 800.0},
    {"G0 X1", "_motion_mode", 0.0},
    {"F1\nG3 X2 I1", "_motion_mode", 30.0},
    {"", "_plane", 170.0},
    {"G18", "_plane", 180.0},
    {"G19", "_plane", 190.0},
    {"", "_ccomp", 400.0},
    {"G41 D5", "_ccomp", 410.0},
    {"G42.1 D5", "_ccomp", 420.0},
    {"", "_metric", 1.0},
    {"G20", "_metric", 0.0},
    {"G20", "_imperial", 1.0},
    {"", "_imperial", 0.0},
    {"", "_absolute", 1.0},
    {"G91", "_absolute", 0.0},
    {"G91", "_incremental", 1.0},
    {"G93", "_inverse_time", 1.0},
    {"G93", "_units_per_minute", 0.0},
    {"", "_units_per_minute", 1.0},
    {"G95", "_units_per_rev", 1.0},
    {"", "_coord_system", 540.0},
    {"G59", "_coord_system", 590.0},
    {"G59.3", "_coord_system", 593.0},
    {"", "_tool_offset", 0.0},
    {"G43 H5", "_tool_offset", 1.0},
    {"", "_retract_old_z", 0.0},
    {"G98", "_retract_old_z", 1.0},
    {"G99", "_retract_r_plane", 1.0},
    {"G99", "_retract_old_z", 0.0},
    {"", "_spindle_rpm_mode", 1.0},
    {"G96 S100", "_spindle_css_mode", 1.0},
    {"", "_ijk_absolute_mode", 0.0},
    {"G90.1", "_ijk_absolute_mode", 1.0},
    {"", "_lathe_diameter_mode", 0.0},
    {"", "_lathe_radius_mode", 1.0},
    {"", "_spindle_on", 0.0},
    {"M4", "_spindle_on", 1.0},
    {"M4", "_spindle_cw", 0.0},
    {"M3", "_spindle_cw", 1.0},
    {"M7", "_mist", 1.0},
    {"M8", "_flood", 1.0},
    {"M8\nM9", "_flood", 0.0},
    {"", "_feed_override", 1.0},
    {"M49", "_feed_override", 0.0},
    {"M49", "_speed_override", 0.0},
    {"", "_adaptive_feed", 0.0},
    {"", "_feed_hold", 1.0},
    {"F300", "_feed", 300.0},
    {"G20\nF10\nG21", "_feed", 254.0},
    {"S1200", "_rpm", 1200.0},
    {"", "_current_tool", 0.0},
    {"T5 M6", "_current_tool", 5.0},
    {"T5", "_current_tool", 0.0},
    {"T5", "_selected_tool", 5.0},
    {"", "_selected_tool", -1.0},
    {"G0 X3\nG92 X1", "_x", 1.0},
    {"G0 X3\nG92 X1", "_abs_x", 3.0},
    {"G20 G0 Y2", "_abs_y", 2.0},
    {"G0 Y2", "_y", 2.0},
    {"G0 Z-4", "_z", -4.0},
    {"G0 A90", "_a", 90.0},
    {"G0 A90", "_abs_a", 90.0},
    {"", "_b", 0.0},
    {"", "_c", 0.0},
    {"", "_u", 0.0},
    {"", "_value", 0.0},
    {"", "_value_returned", 0.0},
    {"", "_call_level", 0.0},
    {"", "_remap_level", 0.0},
    {"", "_task", 1.0},
    {"\n", "_line", 3.0},
    {"", "_vmajor", 2.9},
    {"", "_vminor", 0.0},
};

static void test_predefined_parameters_say_how_things_stand(void)
{
    for (unsigned i = 0; i < sizeof(expectations) / sizeof(expectations[0]); i++) {
        expect_value(expectations[i].text, expectations[i].name, expectations[i].value);
    }
}

static void test_predefined_parameters_exist_and_cannot_be_set(void)
{
    reader_open(&reader,
                "G0 X[EXISTS[#<_feed>]] Y[EXISTS[#<_feeds>]] Z[EXISTS[#<_fee>]]\n#<_feed>=1\n");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0);
    reader_expect_error(&reader, TAKT_ERROR_PARAMETER_READ_ONLY);
    TEST_ASSERT_EQUAL_STRING("_FEED", reader.diagnostic.word);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_m72_brings_all_saved_modes_back);
    RUN_TEST(test_m72_leaves_position_offsets_and_motion_alone);
    RUN_TEST(test_m72_does_not_change_what_a_compensated_contour_stands_on);
    RUN_TEST(test_m72_needs_m70_of_the_same_call);
    RUN_TEST(test_m73_brings_modes_back_when_the_call_ends);
    RUN_TEST(test_m73_works_in_numbered_programs_and_does_nothing_in_the_main_one);
    RUN_TEST(test_a_line_with_an_error_has_restored_nothing);
    RUN_TEST(test_predefined_parameters_say_how_things_stand);
    RUN_TEST(test_predefined_parameters_exist_and_cannot_be_set);
    return UNITY_END();
}
