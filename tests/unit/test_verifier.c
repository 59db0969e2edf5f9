/*
 * The verifier against runs made by hand, most of them wrong in one way: it must see each.
 */
#include "unity.h"
#include "verifier/verifier.h"
#include "verifier/verifier_curve.h"

#include <math.h>
#include <string.h>

#define TAU_S 1e-3
#define PI    3.14159265358979323846

static struct machine machine;
static struct parameters parameters[2];
static struct source_text text[2];
static struct verifier verifier;
static struct cycle_record record;
static struct block executed;

void setUp(void)
{
    takt_machine_set_default(&machine);
    takt_parameters_clear(&parameters[0]);
    takt_parameters_clear(&parameters[1]);
    memset(&verifier, 0, sizeof verifier);
    memset(&record, 0, sizeof record);
    memset(&executed, 0, sizeof executed);
    executed.end = JUNCTION_STOP;
}

void tearDown(void)
{
    verifier_free(&verifier);
}

/* A judge of this program, before its first cycle. */
static void begin_as(const char *program, bool waits)
{
    struct program_config config = {.axes = takt_machine_axes(&machine),
                                    .parameters = &parameters[0],
                                    .waits = waits,
                                    .spindle_encoder = true};
    struct source source;

    for (int i = 0; i < AXIS_COUNT; i++) {
        config.travel_min[i] = -500;
        config.travel_max[i] = 500;
    }
    verifier_free(&verifier);
    takt_source_open_text(&source, &text[0], program, strlen(program));
    verifier_init(&verifier, &machine, &config, &source);
    config.parameters = &parameters[1];
    takt_source_open_text(&source, &text[1], program, strlen(program));
    verifier_follow(&verifier, &machine, &config, &source, false);
}

static void begin(const char *program)
{
    begin_as(program, false);
}

/*
 * A cycle of a block at x, y, as an ideal drive would do it: reporting each setpoint when it is
 * due.
 */
static void cycle(uint32_t block, double x, double y)
{
    static struct point due[DRIVES_LATENCY_CYCLES];

    if (verifier.figures.cycles == 0)
        memset(due, 0, sizeof due);
    record.block = block;
    record.cmd.at[AXIS_X] = x;
    record.cmd.at[AXIS_Y] = y;
    record.set = record.cmd;
    record.act = due[verifier.figures.cycles % DRIVES_LATENCY_CYCLES];
    due[verifier.figures.cycles % DRIVES_LATENCY_CYCLES] = record.set;
    verifier_add(&verifier, &record, &executed);
    record.landed = false;
}

static void landed_cycle(uint32_t block, double x, double y)
{
    record.landed = true;
    cycle(block, x, y);
}

static void test_velocity_acceleration_and_jerk_are_differences_from_standstill(void)
{
    begin("G0 X10\n");
    cycle(1, 0.001, 0); /* v 1, a 1000, j 1e6 */
    cycle(1, 0.003, 0); /* v 2, a 1000, j 0 */
    cycle(1, 0.003, 0); /* v 0, a -2000, j -3e6 */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2, verifier.figures.velocity_mm_s[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 2000, verifier.figures.acceleration_mm_s2[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 3e6, verifier.figures.jerk_mm_s3[AXIS_X]);
    TEST_ASSERT_EQUAL_DOUBLE(0, verifier.figures.jerk_mm_s3[AXIS_Y]);
}

static void test_the_history_goes_on_from_block_to_block(void)
{
    begin("G0 X1\nG0 Y1\n");
    cycle(1, 0.5, 0);
    landed_cycle(1, 1, 0); /* arrives at 500 mm/s */
    cycle(2, 1, 0);        /* and stands: a -5e5 */
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 5e5, verifier.figures.acceleration_mm_s2[AXIS_X]);
}

static void test_the_correction_of_a_rotary_axis_is_no_length(void)
{
    begin("G0 X1\n");
    record.set.at[AXIS_X] = 0.003;
    record.set.at[AXIS_Z] = 0.004;
    record.set.at[AXIS_C] = 0.1;
    verifier_add(&verifier, &record, &executed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.005, verifier.figures.correction_mm);
}

/* 20 mm deep at 1 mm: turned 0.05 above the bottom, and 0.5 above it. */
static void test_a_tap_may_turn_back_just_above_its_bottom(void)
{
    static const double depth[] = {19.95, 19.5};

    for (unsigned i = 0; i < 2; i++) {
        begin("M3 S100\nG33.1 X20 K1\n");
        cycle(1, 10, 0);
        cycle(1, depth[i], 0);
        cycle(2, depth[i] - 0.01, 0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, verifier.figures.path_error_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, i == 0 ? 0 : 0.5, verifier.figures.landing_error_mm);
    }
}

static void test_a_setpoint_beside_a_line_is_seen(void)
{
    begin("G0 X10 Y10\n");
    cycle(1, 1, 1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0, verifier.figures.path_error_mm);
    cycle(1, 2, 2 + 0.001);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.001 / sqrt(2), verifier.figures.path_error_mm);
}

static void test_a_setpoint_beyond_the_end_of_a_line_is_seen(void)
{
    begin("G0 X10\n");
    cycle(1, 10.25, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, verifier.figures.path_error_mm);
}

static void test_a_setpoint_beside_an_arc_is_seen(void)
{
    begin("F100\nG2 X20 I10\n");
    cycle(1, 10, 10);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, verifier.figures.path_error_mm);
    cycle(1, 10 + 10.5 * cos(PI / 4), 10.5 * sin(PI / 4));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5, verifier.figures.path_error_mm);
}

static void test_the_part_of_a_circle_that_is_not_on_the_arc_is_off_the_path(void)
{
    begin("F100\nG2 X20 I10\n");
    cycle(1, 10, -10);
    TEST_ASSERT_TRUE(verifier.figures.path_error_mm > 1);
}

static void test_the_chord_error_of_a_step_is_its_sagitta(void)
{
    double angle = 0.02;

    begin("F100\nG3 X0 Y0 I-10\n");
    cycle(1, 10 * cos(1) - 10, 10 * sin(1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10 * (1 - cos(0.5)), verifier.figures.chord_error_mm);
    begin("F100\nG3 X0 Y0 I-10\n");
    cycle(1, 10 * cos(angle) - 10, 10 * sin(angle));
    cycle(1, 10 * cos(2 * angle) - 10, 10 * sin(2 * angle));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10 * (1 - cos(angle / 2)), verifier.figures.chord_error_mm);
}

static void test_a_landed_end_is_compared_with_the_programmed_one(void)
{
    begin("G0 X10\nG0 Y5\n");
    landed_cycle(1, 10 - 1e-6, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-6, verifier.figures.landing_error_mm);
    landed_cycle(2, 10, 5);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1e-6, verifier.figures.landing_error_mm);
}

static void test_an_end_left_without_landing_is_seen(void)
{
    begin("G0 X10\nG0 Y5\n");
    cycle(1, 9, 0);
    cycle(2, 10, 1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, verifier.figures.landing_error_mm);
}

static void test_the_last_block_must_land(void)
{
    begin("G0 X10\n");
    cycle(1, 9.5, 0);
    verifier_finish(&verifier, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, verifier.figures.landing_error_mm);
}

/* Where a block is passed, the executed curve counts at the end of its block. */
static void test_a_passed_end_is_where_the_executed_path_leads(void)
{
    struct point start = {{0}}, end = {{10}};

    begin("G0 X10\nG0 X20\n");
    TEST_ASSERT_TRUE(takt_curve_set_line(&executed.curve, &start, &end));
    executed.end = JUNCTION_PASSED;
    executed.length_mm = 9.75;
    executed.scale = 1;
    cycle(1, 9, 0);
    executed.end = JUNCTION_STOP;
    landed_cycle(2, 20, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, verifier.figures.landing_error_mm);
}

static void test_blocks_in_which_no_cycle_ends_are_followed(void)
{
    begin("G0 X1\nG0 X2\nG0 X3\n");
    executed.end = JUNCTION_PASSED;
    landed_cycle(1, 1, 0);
    landed_cycle(3, 3, 0);
    verifier_finish(&verifier, true);
    TEST_ASSERT_EQUAL_UINT32(3, verifier.figures.blocks);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3, verifier.figures.path_length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, verifier.figures.path_error_mm);
}

static void test_a_run_of_more_blocks_than_the_program_has_is_seen(void)
{
    begin("G0 X1\n");
    landed_cycle(1, 1, 0);
    TEST_ASSERT_FALSE(verifier.strayed);
    cycle(2, 1, 0);
    TEST_ASSERT_TRUE(verifier.strayed);
}

/* Cycles of a smoothed path say that they execute a spline. */
static void begin_smoothed(const char *program)
{
    begin(program);
    executed.curve.kind = CURVE_SPLINE;
    executed.move.kind = MOVE_FEED;
}

static void test_numbers_that_go_back_are_seen_and_change_nothing_of_the_path(void)
{
    begin_smoothed("G64 P0.1\nF100\nG1 X1\nG1 X2\nG1 X3\n");
    cycle(1, 0.5, 0.05);
    cycle(3, 1.5, 0.05);
    TEST_ASSERT_FALSE(verifier.strayed);
    cycle(2, 2.5, 0.05);
    cycle(3, 3, 0);
    verifier_finish(&verifier, true);
    TEST_ASSERT_TRUE(verifier.strayed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3, verifier.figures.path_length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5, verifier.figures.smoothed_path_part);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5, verifier.figures.smoothed_corner_part);
}

static void test_wrong_numbers_do_not_hide_a_setpoint_beside_a_smoothed_path(void)
{
    begin_smoothed("G64 P0.1\nF100\nG1 X1\nG1 X2\nG1 X2 Y1\nG1 X0\n");
    cycle(1, 0.5, 0);
    cycle(4, 1, 1); /* on the last motion, but far from the second */
    verifier_finish(&verifier, false);
    TEST_ASSERT_TRUE(verifier.figures.smoothed_path_part > 9);
}

static void test_an_exact_motion_is_verified_as_such_whatever_the_cycle_says_it_executes(void)
{
    begin_smoothed("F100\nG1 X10\n");
    cycle(1, 5, 0.05);
    verifier_finish(&verifier, false);
    TEST_ASSERT_TRUE(verifier.figures.path_error_mm > 0.04);
}

static void test_a_feed_step_at_a_junction_is_seen_and_one_inside_a_block_is_none(void)
{
    begin("G0 X10\nG0 X20\n");
    cycle(1, 4, 0);
    cycle(1, 9.99, 0);
    landed_cycle(1, 10, 0);
    TEST_ASSERT_DOUBLE_WITHIN(
        1e-9, 4000, verifier.figures.junction_feed_step_mm_s); /* the first block begins */
    begin("G0 X10\nG0 X20\n");
    cycle(1, 0.01, 0);
    cycle(1, 9.99, 0);
    landed_cycle(1, 10, 0);
    cycle(2, 10.03, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 20, verifier.figures.junction_feed_step_mm_s);
}

static void test_the_following_error_compares_a_report_with_its_own_setpoint(void)
{
    begin("G0 X10\n");
    for (int k = 1; k <= 10; k++)
        cycle(1, 0.1 * k, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, verifier.figures.following_error_mm[AXIS_X]);
    record.act.at[AXIS_X] += 0.02; /* the drive runs ahead of the setpoint of three cycles ago */
    record.act.at[AXIS_X] += 0.1;
    verifier_add(&verifier, &record, &executed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.02, verifier.figures.following_error_mm[AXIS_X]);
}

static void test_the_digest_depends_on_every_bit_of_every_setpoint(void)
{
    uint64_t first;

    begin("G0 X10\n");
    cycle(1, 1, 0);
    first = verifier.figures.digest;
    begin("G0 X10\n");
    cycle(1, 1, 0);
    TEST_ASSERT_EQUAL_HEX64(first, verifier.figures.digest);
    begin("G0 X10\n");
    cycle(1, nextafter(1, 2), 0);
    TEST_ASSERT_TRUE(first != verifier.figures.digest);
}

static void test_the_distance_to_a_helix_finds_its_turn(void)
{
    struct point start = {{10, 0, 0}}, end = {{10, 0, 30}}, p;
    const double centre[2] = {0, 0};
    double fraction = 0;
    struct curve helix;

    TEST_ASSERT_TRUE(takt_curve_set_arc(&helix, &start, &end, PLANE_XY, centre, false, 3));
    for (int i = 0; i <= 300; i++) {
        takt_curve_point(&helix, helix.length_mm * i / 300, &p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, verifier_curve_distance(&helix, &p, &fraction));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, i / 300.0, fraction);
    }
    p.at[AXIS_Z] -= 0.5;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, verifier_curve_distance(&helix, &p, &fraction));
}

static void test_an_arc_of_changing_radius_is_on_its_own_path(void)
{
    struct point start = {{10, 0, 0}}, end = {{0, 10.5, 0}}, p;
    const double centre[2] = {0, 0};
    double fraction = 0;
    struct curve spiral;

    TEST_ASSERT_TRUE(takt_curve_set_arc(&spiral, &start, &end, PLANE_XY, centre, false, 1));
    for (int i = 0; i <= 100; i++) {
        takt_curve_point(&spiral, spiral.length_mm * i / 100, &p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, verifier_curve_distance(&spiral, &p, &fraction));
    }
}

static void expect_answered_run(double path_length_mm, double landing_error_mm)
{
    verifier_finish(&verifier, true);
    TEST_ASSERT_EQUAL_INT(0, verifier_get_missing(&verifier));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, path_length_mm, verifier.figures.path_length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, verifier.figures.path_error_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, landing_error_mm, verifier.figures.landing_error_mm);
}

static void answer_contact_at_rest(double x)
{
    verifier_answer(&verifier, &(struct program_answer){.contact = true, .rest_at = {{x}}});
}

static void test_a_probing_move_may_end_early_and_the_next_begins_there(void)
{
    begin_as("F60\nG38.2 X10\nG0 Y5\n", true);
    cycle(1, 2, 0);
    cycle(1, 4, 0);
    answer_contact_at_rest(4);
    cycle(2, 4, 2);
    landed_cycle(2, 4, 5);
    expect_answered_run(9, 0);
}

static void test_a_rest_that_is_not_the_last_setpoint_is_seen(void)
{
    begin_as("F60\nG38.2 X10\n", true);
    cycle(1, 4, 0);
    answer_contact_at_rest(4.5);
    verifier_finish(&verifier, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, verifier.figures.landing_error_mm);
}

static void test_a_probing_move_that_comes_to_its_end_counts_whole(void)
{
    begin_as("F60\nG38.3 X10\nM66 P0 L0\nG0 X12\n", true);
    landed_cycle(1, 10, 0);
    verifier_answer(&verifier, &(struct program_answer){.rest_at = {{10}}});
    verifier_answer(&verifier, &(struct program_answer){.value = 1});
    landed_cycle(2, 12, 0);
    expect_answered_run(12, 0);
}

static void test_the_verifier_goes_the_way_the_answer_leads(void)
{
    begin_as("G0 X0\nM66 P0 L0\nO1 if [#5399 EQ 1]\nG0 X1\nO1 else\nG0 Y1\nO1 endif\n", true);
    verifier_answer(&verifier, &(struct program_answer){.value = 1});
    landed_cycle(2, 1, 0);
    expect_answered_run(1, 0);
}

static void test_nothing_is_missing_before_an_answer(void)
{
    begin_as("G0 X1\nM66 P0 L0\nG0 X2\n", true);
    landed_cycle(1, 1, 0);
    TEST_ASSERT_EQUAL_INT(0, verifier_get_missing(&verifier));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tap_may_turn_back_just_above_its_bottom);
    RUN_TEST(test_velocity_acceleration_and_jerk_are_differences_from_standstill);
    RUN_TEST(test_the_history_goes_on_from_block_to_block);
    RUN_TEST(test_the_correction_of_a_rotary_axis_is_no_length);
    RUN_TEST(test_a_setpoint_beside_a_line_is_seen);
    RUN_TEST(test_a_setpoint_beyond_the_end_of_a_line_is_seen);
    RUN_TEST(test_a_setpoint_beside_an_arc_is_seen);
    RUN_TEST(test_the_part_of_a_circle_that_is_not_on_the_arc_is_off_the_path);
    RUN_TEST(test_the_chord_error_of_a_step_is_its_sagitta);
    RUN_TEST(test_a_landed_end_is_compared_with_the_programmed_one);
    RUN_TEST(test_an_end_left_without_landing_is_seen);
    RUN_TEST(test_the_last_block_must_land);
    RUN_TEST(test_a_passed_end_is_where_the_executed_path_leads);
    RUN_TEST(test_blocks_in_which_no_cycle_ends_are_followed);
    RUN_TEST(test_a_run_of_more_blocks_than_the_program_has_is_seen);
    RUN_TEST(test_numbers_that_go_back_are_seen_and_change_nothing_of_the_path);
    RUN_TEST(test_wrong_numbers_do_not_hide_a_setpoint_beside_a_smoothed_path);
    RUN_TEST(test_an_exact_motion_is_verified_as_such_whatever_the_cycle_says_it_executes);
    RUN_TEST(test_a_feed_step_at_a_junction_is_seen_and_one_inside_a_block_is_none);
    RUN_TEST(test_the_following_error_compares_a_report_with_its_own_setpoint);
    RUN_TEST(test_the_digest_depends_on_every_bit_of_every_setpoint);
    RUN_TEST(test_the_distance_to_a_helix_finds_its_turn);
    RUN_TEST(test_an_arc_of_changing_radius_is_on_its_own_path);
    RUN_TEST(test_a_probing_move_may_end_early_and_the_next_begins_there);
    RUN_TEST(test_a_rest_that_is_not_the_last_setpoint_is_seen);
    RUN_TEST(test_a_probing_move_that_comes_to_its_end_counts_whole);
    RUN_TEST(test_the_verifier_goes_the_way_the_answer_leads);
    RUN_TEST(test_nothing_is_missing_before_an_answer);
    return UNITY_END();
}
