/* Compensated programs, move by move. Figures by hand; the property test verifies contours. */
#include "cutter_compensation/cutter_compensation.h"

#include "program_reader.h"

#include <math.h>
#include <stdio.h>

static struct reader reader;
static struct cutter_compensation offset;

static void open_text(const char *text)
{
    reader_open(&reader, text);
    takt_cutter_compensation_open(&offset, &reader.config);
}

static enum program_result next(struct move *m)
{
    memset(m, 0, sizeof(*m));
    return takt_cutter_compensation_next(&offset, &reader.program, m, &reader.diagnostic);
}

static struct move expect(enum move_kind kind, double x, double y, double z)
{
    struct move m;
    const enum program_result result = next(&m);

    reader_check(&reader, result, kind, &m);
    reader_check_end(&m, x, y, z);
    TEST_ASSERT_EQUAL_INT(CUTTER_OFF, m.cutter_side);
    return m;
}

static void expect_kind(enum move_kind kind)
{
    struct move m;

    TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE, next(&m));
    TEST_ASSERT_EQUAL_INT(kind, m.kind);
}

static void expect_error(enum takt_error code, uint32_t line, double value)
{
    struct move m;

    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, next(&m));
    TEST_ASSERT_EQUAL_INT(code, reader.diagnostic.code);
    TEST_ASSERT_EQUAL_UINT32(line, reader.diagnostic.line);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, value, reader.diagnostic.value);
}

static void expect_end(void)
{
    struct move m;

    expect_kind(MOVE_END);
    TEST_ASSERT_EQUAL_INT(PROGRAM_END, next(&m));
    TEST_ASSERT_EQUAL_INT(PROGRAM_END, next(&m));
}

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_moves_without_compensation_pass_unchanged(void)
{
    open_text("G0 X10\nG4 P1\nG1 Y5 F60\nG3 X20 Y15 J10\n");
    (void)expect(MOVE_RAPID, 10.0, 0.0, 0.0);
    expect_kind(MOVE_DWELL);
    (void)expect(MOVE_FEED, 10.0, 5.0, 0.0);
    const struct move m = expect(MOVE_ARC_CCW, 20.0, 15.0, 0.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 15.0, m.centre_mm[1]);
    expect_end();
}

static void test_the_entry_ends_beside_its_end(void)
{
    open_text("G41.1 D6\nG1 X30 Y40 F60\n");
    (void)expect(MOVE_FEED, 30.0 - 3.0 * 0.8, 40.0 + 3.0 * 0.6, 0.0);
    expect_end();
}

static void test_an_outer_corner_is_an_arc_about_it(void)
{
    open_text("G41.1 D6\nG1 X20 F60\nF120 Y-20\n");
    (void)expect(MOVE_FEED, 20.0, 3.0, 0.0);
    const struct move m = expect(MOVE_ARC_CW, 23.0, 0.0, 0.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20.0, m.centre_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, m.centre_mm[1]);
    TEST_ASSERT_EQUAL_UINT32(1, m.turns);
    TEST_ASSERT_EQUAL_UINT32(3, m.line);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, m.feed_mm_s);
    (void)expect(MOVE_FEED, 23.0, -20.0, 0.0);
    expect_end();
}

static void test_an_inner_corner_is_where_the_ways_cross(void)
{
    open_text("G41.1 D6\nG1 X20 F60\nY20\n");
    (void)expect(MOVE_FEED, 17.0, 3.0, 0.0);
    (void)expect(MOVE_FEED, 17.0, 20.0, 0.0);
    expect_end();
}

/* The line y = 3 meets the circle of radius 20 - 3 about (40, 0) at x = 40 + sqrt(17^2 - 3^2). */
static void test_an_inner_corner_between_line_and_arc(void)
{
    open_text("G41.1 D6\nG1 X20 F60\nX60\nG3 X40 Y20 I-20\n");
    (void)expect(MOVE_FEED, 20.0, 3.0, 0.0);
    (void)expect(MOVE_FEED, 40.0 + sqrt(280.0), 3.0, 0.0);
    (void)expect(MOVE_ARC_CCW, 40.0, 17.0, 0.0);
    expect_end();
}

static void test_a_tool_inside_an_arc_runs_on_a_smaller_one(void)
{
    open_text("G41.1 D6\nG1 X20 F60\nG3 X30 Y10 J10\nG3 X20 Y20 I-10\nG40 G1 X0\n");
    (void)expect(MOVE_FEED, 20.0, 3.0, 0.0);
    struct move m = expect(MOVE_ARC_CCW, 27.0, 10.0, 0.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20.0, m.centre_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10.0, m.centre_mm[1]);
    (void)expect(MOVE_ARC_CCW, 20.0, 17.0, 0.0);
    (void)expect(MOVE_FEED, 0.0, 20.0, 0.0);
    expect_end();
}

static void test_a_helix_keeps_its_turns_and_its_depth(void)
{
    open_text("G41.1 D6\nG1 X20 F60\nG3 X20 Y0 Z-8 J10 P3\nG40 G1 X0\n");
    (void)expect(MOVE_FEED, 20.0, 3.0, 0.0);
    const struct move m = expect(MOVE_ARC_CCW, 20.0, 3.0, -8.0);

    TEST_ASSERT_EQUAL_UINT32(3, m.turns);
    (void)expect(MOVE_FEED, 0.0, 0.0, -8.0);
    expect_end();
}

static void test_moves_across_the_plane_happen_at_the_corner_of_the_tool(void)
{
    open_text("G41.1 D6\nG1 X20 F60\nZ-2\nY20\nZ-4\nX40\n");
    (void)expect(MOVE_FEED, 17.0, 3.0, 0.0);
    (void)expect(MOVE_FEED, 17.0, 3.0, -2.0);
    (void)expect(MOVE_FEED, 17.0, 20.0, -2.0);
    (void)expect(MOVE_FEED, 17.0, 20.0, -4.0);
    (void)expect(MOVE_ARC_CW, 20.0, 23.0, -4.0);
    (void)expect(MOVE_FEED, 40.0, 23.0, -4.0);
    expect_end();
}

static void test_commands_keep_their_place(void)
{
    open_text("G41.1 D6\nG1 X20 F60\nM8\nG4 P1\nY20\nM9\n");
    (void)expect(MOVE_FEED, 17.0, 3.0, 0.0);
    expect_kind(MOVE_COOLANT);
    expect_kind(MOVE_DWELL);
    (void)expect(MOVE_FEED, 17.0, 20.0, 0.0);
    expect_kind(MOVE_COOLANT);
    expect_end();
}

static void expect_own(const struct move *m, double tolerance_mm, double merge_mm,
                       unsigned overrides, unsigned correction_off)
{
    TEST_ASSERT_EQUAL_DOUBLE(tolerance_mm, m->tolerance_mm);
    TEST_ASSERT_EQUAL_DOUBLE(merge_mm, m->merge_mm);
    TEST_ASSERT_EQUAL_UINT(overrides, m->overrides);
    TEST_ASSERT_EQUAL_UINT(correction_off, m->correction_off);
    TEST_ASSERT_EQUAL_UINT(CUTTER_LEFT, m->contour_side);
}

/* M72 brings back what else no word may change inside of a contour. */
static void test_moves_of_a_contour_keep_what_is_their_own(void)
{
    struct move m;

    reader_prepare(&reader);
    reader.config.correction_layers = 3;
    reader_text(&reader, "G64 P0.05 M49\nM70\nG64 P0.1 Q0.02 M48\nG41.1 D2\nG1 X10 F600\nX20\n"
                         "G4 P1.5\nT5\nM72\nG1 X30 F1200\nM121\nZ5 F60\nX40 F1200\nG40 X50\n");
    takt_cutter_compensation_open(&offset, &reader.config);
    for (unsigned x = 10; x <= 20; x += 10) {
        m = expect(MOVE_FEED, x, 1.0, 0.0);
        expect_own(&m, 0.1, 0.02, OVERRIDE_FEED | OVERRIDE_SPINDLE | OVERRIDE_HOLD, 0);
        TEST_ASSERT_EQUAL_DOUBLE(10.0, m.feed_mm_s);
        TEST_ASSERT_EQUAL_INT(x == 10, m.cutter_entry);
    }
    TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE, next(&m));
    TEST_ASSERT_EQUAL_INT(MOVE_DWELL, m.kind);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, m.dwell_s);
    TEST_ASSERT_EQUAL_UINT32(7, m.line);
    TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE, next(&m));
    TEST_ASSERT_EQUAL_INT(MOVE_TOOL, m.kind);
    TEST_ASSERT_EQUAL_UINT32(5, m.tool);
    TEST_ASSERT_EQUAL_UINT32(8, m.line);
    m = expect(MOVE_FEED, 30.0, 1.0, 0.0);
    expect_own(&m, 0.05, 0.05, OVERRIDE_HOLD, 0);
    m = expect(MOVE_FEED, 30.0, 1.0, 5.0);
    expect_own(&m, 0.05, 0.05, OVERRIDE_HOLD, 7);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, m.feed_mm_s);
    TEST_ASSERT_EQUAL_UINT32(12, m.line);
    m = expect(MOVE_FEED, 40.0, 1.0, 5.0);
    expect_own(&m, 0.05, 0.05, OVERRIDE_HOLD, 7);
    (void)expect(MOVE_FEED, 50.0, 0.0, 5.0);
    expect_end();
}

/* A step of 1 under a tool of radius 5: the way at height 5 meets the circle about its edge. */
static void test_a_step_lower_than_the_tool_is_passed_over_with_a_warning(void)
{
    struct diagnostic warning;

    open_text("G41.1 D10\nG1 X20 F60\nX60\nY1\nX100\n");
    (void)expect(MOVE_FEED, 20.0, 5.0, 0.0);
    (void)expect(MOVE_FEED, 57.0, 5.0, 0.0);
    (void)expect(MOVE_ARC_CW, 60.0, 6.0, 0.0);
    (void)expect(MOVE_FEED, 100.0, 6.0, 0.0);
    expect_end();
    TEST_ASSERT_TRUE(takt_cutter_compensation_warning(&offset, &warning));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_OFFSET_LEFT_OUT, warning.code);
    TEST_ASSERT_EQUAL_UINT32(4, warning.line);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, warning.value);
    TEST_ASSERT_FALSE(takt_cutter_compensation_warning(&offset, &warning));
}

static void test_a_short_bottom_is_left_out(void)
{
    open_text("G41.1 D10\nG1 X20 F60\nX40 Y-20\nX41\nX61 Y0\nX90\n");
    const double c = sqrt(0.5);

    (void)expect(MOVE_FEED, 20.0, 5.0, 0.0);
    (void)expect(MOVE_ARC_CW, 20.0 + 5.0 * c, 5.0 * c, 0.0);
    (void)expect(MOVE_FEED, 40.5, -20.5 + 5.0 / c, 0.0);
    (void)expect(MOVE_FEED, 61.0 - 5.0 * c, 5.0 * c, 0.0);
    (void)expect(MOVE_ARC_CW, 61.0, 5.0, 0.0);
    (void)expect(MOVE_FEED, 90.0, 5.0, 0.0);
    expect_end();
}

/* What is left out must not have moved another axis. */
static void test_a_step_that_goes_deeper_is_refused(void)
{
    open_text("G41.1 D10\nG1 X20 F60\nX60\nY1 Z-3\nX100\nG40 X120\n");
    expect_error(TAKT_ERROR_OFFSET_GOUGE, 4, 1.0);
}

static void test_a_corner_without_room_behind_it_is_refused_with_its_depth(void)
{
    open_text("G41.1 D10\nG1 X20 F60\nX40\nY2\nG40 X0\nG0 X10\n");
    expect_error(TAKT_ERROR_OFFSET_GOUGE, 4, 2.0);
    (void)expect(MOVE_FEED, 0.0, 2.0, 0.0);
    (void)expect(MOVE_RAPID, 10.0, 2.0, 0.0);
    expect_end();
}

/* A hollow of many more short ways than the look-ahead has, each turning a little. */
static void test_a_hollow_of_more_ways_than_the_look_ahead_is_refused(void)
{
    static char text[8192];
    size_t at = (size_t)snprintf(text, sizeof text, "G41.1 D10\nG1 X20 F60\nX40\n");
    struct move m;
    enum program_result result;

    for (int i = -100; i <= 100; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "X%.5f Y%.5f\n",
                               42.0 + 2.0 * sin(i * 0.0157), -2.0 * cos(i * 0.0157));
    }
    (void)snprintf(text + at, sizeof text - at, "X44 Y0\nX80\n");
    open_text(text);
    do {
        result = next(&m);
    } while (result == PROGRAM_MOVE);
    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, result);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_OFFSET_GOUGE, reader.diagnostic.code);
    TEST_ASSERT_TRUE(reader.diagnostic.value > 0.0 && reader.diagnostic.value <= 5.0);
}

static void test_an_entry_not_longer_than_the_radius_is_refused(void)
{
    open_text("G41.1 D10\nG1 X4 F60\n");
    expect_error(TAKT_ERROR_OFFSET_ENTRY_SHORT, 2, 1.0);
    open_text("G41.1 D10\nG1 X5 F60\n");
    expect_error(TAKT_ERROR_OFFSET_ENTRY_SHORT, 2, 0.0);
}

static void test_an_arc_smaller_than_the_tool_is_refused_with_the_difference(void)
{
    open_text("G41.1 D10\nG1 X20 F60\nX40\nG3 X44 Y4 J4\n");
    expect_error(TAKT_ERROR_OFFSET_ARC_SMALL, 4, 1.0);
}

static void test_travel_is_that_of_the_tool(void)
{
    open_text("G42.1 D10\nG1 X496 F60\nY40\n");
    (void)expect(MOVE_FEED, 496.0, -5.0, 0.0);
    expect_error(TAKT_ERROR_TRAVEL_EXCEEDED, 3, 501.0);
    TEST_ASSERT_EQUAL_STRING("X", reader.diagnostic.word);
    open_text("G41.1 D10\nG1 X520 F60\n");
    expect_error(TAKT_ERROR_TRAVEL_EXCEEDED, 2, 520.0);
}

/* An arc that is the first move of all: right of its centre, where it does not go, travel ends. */
static void test_travel_of_the_first_move_is_looked_at_from_where_the_machine_stands(void)
{
    reader_prepare(&reader);
    reader.config.start.at[AXIS_X] = 498.0;
    reader.config.start.at[AXIS_Y] = 54.0;
    reader_text(&reader, "G41.1 D10\nG3 X462 I-18 J-24 F60\n");
    takt_cutter_compensation_open(&offset, &reader.config);
    (void)expect(MOVE_ARC_CCW, 465.0, 50.0, 0.0);
    expect_end();
}

/* One error a contour: what is left of it is not looked at. */
static void test_reading_goes_on_behind_a_faulty_contour(void)
{
    open_text("G41.1 D10\nG1 X2 F60\nX4\nY4\nG40\nG1 X0\nG42.1 D10\nX20\nG40 X40\n");
    expect_error(TAKT_ERROR_OFFSET_ENTRY_SHORT, 2, 3.0);
    (void)expect(MOVE_FEED, 0.0, 4.0, 0.0);
    (void)expect(MOVE_FEED, 20.0, -1.0, 0.0);
    (void)expect(MOVE_FEED, 40.0, 4.0, 0.0);
    expect_end();
}

static void test_an_error_of_the_program_comes_after_the_moves_before_it(void)
{
    open_text("G41.1 D10\nG1 X20 F60\nX40\nQ\nX60\nG40 X80\n");
    (void)expect(MOVE_FEED, 20.0, 5.0, 0.0);
    (void)expect(MOVE_FEED, 40.0, 5.0, 0.0);
    expect_error(TAKT_ERROR_NUMBER_EXPECTED, 4, 0.0);
    (void)expect(MOVE_FEED, 80.0, 0.0, 0.0);
    expect_end();
}

static void test_a_second_contour_may_follow_without_a_move_between(void)
{
    open_text("G41.1 D10\nG1 X20 F60\nG40\nG41.1 D10\nX40\nG40 X50\n");
    (void)expect(MOVE_FEED, 20.0, 5.0, 0.0);
    (void)expect(MOVE_FEED, 40.0, 5.0, 0.0);
    (void)expect(MOVE_FEED, 50.0, 0.0, 0.0);
    expect_end();
}

/* Beside (40, 0), at (40, 5), the tool stays: the next entry goes from there along X. */
static void test_a_contour_behind_a_tool_change_begins_where_the_tool_stands(void)
{
    open_text("G41.1 D10\nG1 X40 F60\nG40\nT5 M6\nG41.1 D10\nX60\nG40 X80\n");
    (void)expect(MOVE_FEED, 40.0, 5.0, 0.0);
    expect_kind(MOVE_TOOL);
    expect_kind(MOVE_TOOL);
    (void)expect(MOVE_FEED, 60.0, 10.0, 0.0);
    (void)expect(MOVE_FEED, 80.0, 5.0, 0.0);
    expect_end();
}

static void test_sharp_corners_stand_off_by_no_more_than_a_right_angle_gives(void)
{
    reader_prepare(&reader);
    reader.config.sharp_corners = true;
    reader_text(&reader, "G41.1 D6\nG1 X20 F60\nY-20\nY0\nG40 X0\n");
    takt_cutter_compensation_open(&offset, &reader.config);
    (void)expect(MOVE_FEED, 20.0, 3.0, 0.0);
    (void)expect(MOVE_FEED, 23.0, 3.0, 0.0);
    (void)expect(MOVE_FEED, 23.0, 0.0, 0.0);
    (void)expect(MOVE_FEED, 23.0, -20.0, 0.0);
    (void)expect(MOVE_FEED, 23.0, -23.0, 0.0);
    (void)expect(MOVE_FEED, 17.0, -23.0, 0.0);
    (void)expect(MOVE_FEED, 17.0, -20.0, 0.0);
    (void)expect(MOVE_FEED, 17.0, 0.0, 0.0);
    (void)expect(MOVE_FEED, 0.0, 0.0, 0.0);
    expect_end();
}

static void test_a_rapid_goes_around_an_outer_corner_in_lines(void)
{
    open_text("G41.1 D6\nG0 X20\nY-20\nG40 X0\n");
    (void)expect(MOVE_RAPID, 20.0, 3.0, 0.0);
    (void)expect(MOVE_RAPID, 23.0, 3.0, 0.0);
    (void)expect(MOVE_RAPID, 23.0, 0.0, 0.0);
    (void)expect(MOVE_RAPID, 23.0, -20.0, 0.0);
    (void)expect(MOVE_RAPID, 0.0, -20.0, 0.0);
    expect_end();
}

/* A corner of 1e-5 rad: the ways cross 2.5e-5 mm beyond their ends, without an arc between. */
static void test_a_corner_by_rounding_is_no_corner(void)
{
    open_text("G41.1 D10\nG1 X20 F60\nX40\nX140 Y-0.001\n");
    (void)expect(MOVE_FEED, 20.0, 5.0, 0.0);
    (void)expect(MOVE_FEED, 40.000025, 5.0, 0.0);
    (void)expect(MOVE_FEED, 140.00005, 4.999, 0.0);
    expect_end();
}

/*
 * The tool goes outside around the circle of radius 1 about (0, 0), on one of radius 3; the line
 * behind it climbs by 0.001 from (0, 1). With a = atan 0.001, its way has the distance D = cos
 * a + 2 from (0, 0), at its foot D (sin a, cos a), and crosses the circle at sqrt(9 - D^2) before
 * and behind that. What lies between is inside the circle.
 */
/* Radius 2, orientation 3: the point led lies 2 mm beside the nose's centre, and 2 mm back. */
static void test_a_lathe_tool_is_led_beside_its_nose(void)
{
    open_text("G18 G0 X30\nG42.1 D4 L3\nG1 X20 F60\nZ-20\nG2 X30 Z-30 I10\nG1 Y5\nG40 X40\n");
    (void)expect(MOVE_RAPID, 30.0, 0.0, 0.0);
    (void)expect(MOVE_FEED, 20.0 + 2.0 + 2.0, 0.0, -2.0 - 2.0);
    (void)expect(MOVE_FEED, 24.0, 0.0, -20.0 - 2.0);
    const struct move m = expect(MOVE_ARC_CW, 32.0, 0.0, -30.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -22.0, m.centre_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 32.0, m.centre_mm[1]);
    (void)expect(MOVE_FEED, 32.0, 5.0, -30.0);
    (void)expect(MOVE_FEED, 40.0, 5.0, -30.0);
    expect_end();
}

static void test_a_blunt_inner_corner_behind_an_arc_is_the_crossing_ahead(void)
{
    const double sine = 0.001 / sqrt(1.0 + 1e-6);
    const double cosine = 1.0 / sqrt(1.0 + 1e-6);
    const double foot = cosine + 2.0;
    const double ahead = sqrt(9.0 - foot * foot);

    open_text("G0 X1 Y-20\nG42.1 D4\nG1 Y0 F60\nG3 X0 Y1 I-1\nG1 X-10 Y1.01\n");
    (void)expect(MOVE_RAPID, 1.0, -20.0, 0.0);
    (void)expect(MOVE_FEED, 3.0, 0.0, 0.0);
    (void)expect(MOVE_ARC_CCW, foot * sine - ahead * cosine, foot * cosine + ahead * sine, 0.0);
    (void)expect(MOVE_FEED, -10.0 + 2.0 * sine, 1.01 + 2.0 * cosine, 0.0);
    expect_end();
}

static void test_too_many_commands_inside_a_contour_are_refused(void)
{
    static char text[4096];
    size_t at = (size_t)snprintf(text, sizeof text, "G41.1 D10\nG1 X20 F60\nX40\n");
    struct move m;
    enum program_result result;

    for (int i = 0; i < COMPENSATION_ITEMS_MAX; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "M8\n");
    }
    (void)snprintf(text + at, sizeof text - at, "X60\n");
    open_text(text);
    do {
        result = next(&m);
    } while (result == PROGRAM_MOVE);
    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, result);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_OFFSET_CROWDED, reader.diagnostic.code);
}

static void test_the_memory_is_what_the_limits_say(void)
{
    const size_t items = COMPENSATION_ITEMS_MAX + 3;

    TEST_ASSERT_TRUE(sizeof(struct cutter_compensation) <= items * 800);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_moves_without_compensation_pass_unchanged);
    RUN_TEST(test_the_entry_ends_beside_its_end);
    RUN_TEST(test_an_outer_corner_is_an_arc_about_it);
    RUN_TEST(test_an_inner_corner_is_where_the_ways_cross);
    RUN_TEST(test_an_inner_corner_between_line_and_arc);
    RUN_TEST(test_a_tool_inside_an_arc_runs_on_a_smaller_one);
    RUN_TEST(test_a_helix_keeps_its_turns_and_its_depth);
    RUN_TEST(test_moves_across_the_plane_happen_at_the_corner_of_the_tool);
    RUN_TEST(test_commands_keep_their_place);
    RUN_TEST(test_moves_of_a_contour_keep_what_is_their_own);
    RUN_TEST(test_a_step_lower_than_the_tool_is_passed_over_with_a_warning);
    RUN_TEST(test_a_short_bottom_is_left_out);
    RUN_TEST(test_a_step_that_goes_deeper_is_refused);
    RUN_TEST(test_a_corner_without_room_behind_it_is_refused_with_its_depth);
    RUN_TEST(test_a_hollow_of_more_ways_than_the_look_ahead_is_refused);
    RUN_TEST(test_an_entry_not_longer_than_the_radius_is_refused);
    RUN_TEST(test_an_arc_smaller_than_the_tool_is_refused_with_the_difference);
    RUN_TEST(test_travel_is_that_of_the_tool);
    RUN_TEST(test_travel_of_the_first_move_is_looked_at_from_where_the_machine_stands);
    RUN_TEST(test_reading_goes_on_behind_a_faulty_contour);
    RUN_TEST(test_an_error_of_the_program_comes_after_the_moves_before_it);
    RUN_TEST(test_a_second_contour_may_follow_without_a_move_between);
    RUN_TEST(test_a_contour_behind_a_tool_change_begins_where_the_tool_stands);
    RUN_TEST(test_sharp_corners_stand_off_by_no_more_than_a_right_angle_gives);
    RUN_TEST(test_a_rapid_goes_around_an_outer_corner_in_lines);
    RUN_TEST(test_a_corner_by_rounding_is_no_corner);
    RUN_TEST(test_a_lathe_tool_is_led_beside_its_nose);
    RUN_TEST(test_a_blunt_inner_corner_behind_an_arc_is_the_crossing_ahead);
    RUN_TEST(test_too_many_commands_inside_a_contour_are_refused);
    RUN_TEST(test_the_memory_is_what_the_limits_say);
    return UNITY_END();
}
