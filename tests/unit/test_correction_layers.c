/* The layers: what each corrects, their sum, switching, fading, and loading while in motion. */
#include "correction_bench.h"

static struct table table;
static struct diagnostic wrong;

static void make_axis_table(enum axis input, enum axis corrected, double up_um, double down_um)
{
    memset(&table, 0, sizeof table);
    table.inputs = 1;
    table.input[0] = (uint8_t)input;
    table.knots[0] = 3;
    table.outputs = 2;
    table.output[0] = (struct table_output){(uint8_t)corrected, TABLE_UP};
    table.output[1] = (struct table_output){(uint8_t)corrected, TABLE_DOWN};
    for (size_t i = 0; i < 3; i++) {
        table.knot_mm[0][i] = 100.0 * (double)i;
        table.value_mm[2 * i] = (float)(1e-3 * up_um);
        table.value_mm[2 * i + 1] = (float)(1e-3 * down_um);
    }
}

static void make_volume(struct correction_tables *to, double um)
{
    memset(&table, 0, sizeof table);
    table.inputs = 3;
    table.outputs = 1;
    for (uint8_t i = 0; i < 3; i++) {
        table.input[i] = i;
        table.knots[i] = 2;
        table.knot_mm[i][1] = 100.0;
    }
    for (unsigned i = 0; i < 8; i++)
        table.value_mm[i] = (float)(1e-3 * um);
    TEST_ASSERT_TRUE(takt_grid_set(&to->volume, &table, &wrong));
}

static void test_without_anything_to_correct_the_setpoint_is_the_command_to_the_last_bit(void)
{
    const struct point at = {{0.1, -0.0, 1.0 / 3}};
    struct point set;

    begin(NULL);
    takt_correction_cycle(&c, &at, &move, &set);
    TEST_ASSERT_EQUAL_MEMORY(&at, &set, sizeof set);
}

static void test_a_diagonal_matrix_takes_back_a_pitch_error(void)
{
    settings.machine[AXIS_X][0] = -25e-6;
    begin(NULL);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, -0.01, settle(400, 5, 0, 0).at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, settle(0, 5, 0, 0).at[AXIS_X]);
}

static void test_the_matrix_is_composed_of_machine_workpiece_and_overhang(void)
{
    struct point k;

    settings.turn_axis = AXIS_C;
    settings.machine[AXIS_Y][3] = 1e-5;
    settings.machine[3][AXIS_X] = 1e-7;
    settings.workpiece[AXIS_X][1] = 2e-5;
    settings.overhang[AXIS_Z][2] = 3e-5;
    move.work_mm[1] = 50;
    move.overhang_mm[2] = -100;
    begin(NULL);
    k = settle(100, 150, 0, 2.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2e-5 * (150 - 50), k.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-10, 2e-5, k.at[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -3e-3, k.at[AXIS_Z]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 1e-5, k.at[AXIS_C]);
}

static void test_thermal_growth_of_fifteen_kelvin_is_taken_back(void)
{
    settings.thermal_per_k[AXIS_Y] = 11e-6;
    settings.thermal_reference_mm[AXIS_Y] = 50;
    begin(NULL);
    takt_correction_set_rise(&c, AXIS_Y, 15.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, -11e-6 * 15 * 250, settle(0, 300, 0, 0).at[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 11e-6 * 15 * 50, settle(0, 0, 0, 0).at[AXIS_Y]);
}

/* 30 K at the farthest place; switched, it fades at that size times the highest rate of a fade. */
static void test_the_need_of_thermal_growth_is_that_of_thirty_kelvin(void)
{
    const struct motion_bound most = {.farthest_mm = {500, 400, 300}};
    struct need need;

    settings.thermal_per_k[AXIS_Y] = -11e-6;
    begin(NULL);
    takt_correction_get_need(&c, &most, &need);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, need.size_mm[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 11e-6 * 30 * 400, need.size_mm[AXIS_Y]);
    TEST_ASSERT_TRUE(need.velocity_mm_s[AXIS_Y] >
                     need.size_mm[AXIS_Y] * takt_fade_velocity_per_s(&c.layer_pace));
}

static void test_backlash_follows_the_direction_of_the_last_motion(void)
{
    make_axis_table(AXIS_X, AXIS_X, 10, -10);
    TEST_ASSERT_TRUE(takt_axis_tables_add(&tables.axes, &table, &wrong));
    begin(&tables);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.01, settle(50, 0, 0, 0).at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -0.01, settle(49.99, 0, 0, 0).at[AXIS_X]);
    /* nothing that is only rounding turns it */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -0.01, settle(49.99 + 1e-9, 0, 0, 0).at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.01, settle(50, 0, 0, 0).at[AXIS_X]);
}

static void test_a_reversal_fades_within_the_need(void)
{
    struct motion_bound most = {
        {100, 100, 100}, {1000, 1000, 1000}, {50000, 50000, 50000}, {500, 500, 500}};
    double x[4] = {0}, a = 0, j = 0;
    struct need need;
    struct point set;

    make_axis_table(AXIS_X, AXIS_X, 10, -10);
    TEST_ASSERT_TRUE(takt_axis_tables_add(&tables.axes, &table, &wrong));
    begin(&tables);
    takt_correction_get_need(&c, &most, &need);
    (void)settle(50, 0, 0, 0);
    for (int i = 0; i < 2000; i++) {
        const struct point at = {{i < 1000 ? 50 - 1e-5 * i : 49.99 + 1e-5 * (i - 1000)}};

        takt_correction_cycle(&c, &at, &move, &set);
        x[3] = x[2], x[2] = x[1], x[1] = x[0], x[0] = set.at[AXIS_X] - at.at[AXIS_X];
        if (i < 4)
            continue;
        a = fmax(a, fabs(x[0] - 2 * x[1] + x[2]) / (CYCLE_S * CYCLE_S));
        j = fmax(j, fabs(x[0] - 3 * x[1] + 3 * x[2] - x[3]) / (CYCLE_S * CYCLE_S * CYCLE_S));
    }
    TEST_ASSERT_TRUE(a <= need.acceleration_mm_s2[AXIS_X]);
    TEST_ASSERT_TRUE(j <= need.jerk_mm_s3[AXIS_X]);
    TEST_ASSERT_TRUE(need.jerk_mm_s3[AXIS_X] < 0.05 * 50000);
}

static void test_a_worn_tool_is_followed_along_and_across(void)
{
    struct point set;

    settings.wear_along_per_mm = 1e-6;
    settings.wear_across_per_mm = 2e-6;
    begin(NULL);
    move.tool = 7;
    move.contour_side = CUTTER_LEFT;
    for (int i = 0; i <= 20000; i++)
        takt_correction_cycle(&c, &(struct point){{0.05 * i}}, &move, &set);
    move.kind = MOVE_DWELL;
    for (int i = 0; i < 5000; i++)
        takt_correction_cycle(&c, &(struct point){{1000}}, &move, &set);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -1e-3, set.at[AXIS_Z]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -2e-3, set.at[AXIS_Y]); /* right of the way in X */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1000, set.at[AXIS_X]);
    double length_mm, time_s;

    takt_correction_get_wear(&c, 7, &length_mm, &time_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1000, length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 20, time_s);
}

static void test_wear_is_kept_per_tool(void)
{
    double length_mm, time_s;

    settings.wear_along_per_mm = 1e-6;
    begin(NULL);
    takt_correction_set_wear(&c, 3, 5000, 60);
    takt_correction_set_wear(&c, 4, 1000, 10);
    move.tool = 3;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -5e-3, settle(0, 0, 0, 0).at[AXIS_Z]);
    move.tool = 4;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -1e-3, settle(0, 0, 0, 0).at[AXIS_Z]);
    takt_correction_get_wear(&c, 3, &length_mm, &time_s);
    TEST_ASSERT_EQUAL_DOUBLE(5000, length_mm);
}

static void test_layers_add_up(void)
{
    settings.machine[AXIS_X][0] = -25e-6;
    settings.setup_offset_mm[AXIS_X] = 0.2;
    settings.thermal_per_k[AXIS_X] = 10e-6;
    make_volume(&tables, 7);
    table.output[0].axis = AXIS_X;
    begin(&tables);
    takt_correction_set_rise(&c, AXIS_X, 10);
    TEST_ASSERT_EQUAL_HEX(1U << CORRECTION_MATRIX | 1U << CORRECTION_SETUP |
                              1U << CORRECTION_VOLUME | 1U << CORRECTION_THERMAL,
                          takt_correction_get_present(&c));
    TEST_ASSERT_DOUBLE_WITHIN(2e-8, -0.0025 + 0.2 + 0.007 - 0.01, settle(100, 0, 0, 0).at[AXIS_X]);
}

static void test_machine_file_operator_and_program_switch_layers(void)
{
    settings.machine[AXIS_X][0] = 1e-4;
    settings.setup_offset_mm[AXIS_X] = 0.5;
    settings.off = 1U << CORRECTION_SETUP;
    begin(NULL);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.01, settle(100, 0, 0, 0).at[AXIS_X]);
    takt_correction_switch(&c, CORRECTION_SETUP, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.51, settle(100, 0, 0, 0).at[AXIS_X]);
    move.correction_off = 1U << CORRECTION_MATRIX;
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.5, settle(100, 0, 0, 0).at[AXIS_X]);
    move.kind = MOVE_DWELL; /* says nothing of layers */
    move.correction_off = 0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.5, settle(100, 0, 0, 0).at[AXIS_X]);
    takt_correction_switch(&c, CORRECTION_SETUP, false);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, settle(100, 0, 0, 0).at[AXIS_X]);
    TEST_ASSERT_EQUAL_HEX(0, takt_correction_get_running(&c));
}

static void test_tables_are_exchanged_without_a_jump(void)
{
    double before = 0, largest = 0;
    struct point set;

    make_volume(&tables, 30);
    make_volume(&other_tables, -30);
    begin(&tables);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.03, settle(50, 50, 50, 0).at[AXIS_X]);
    TEST_ASSERT_TRUE(takt_correction_load(&c, &other_tables, &wrong));
    for (int i = 0; i < 20000; i++) {
        const struct point at = {{50, 50, 50}};

        takt_correction_cycle(&c, &at, &move, &set);
        if (i > 0)
            largest = fmax(largest, fabs(set.at[AXIS_X] - before));
        before = set.at[AXIS_X];
        TEST_ASSERT_TRUE(i > 0 || takt_correction_is_loading(&c));
    }
    TEST_ASSERT_FALSE(takt_correction_is_loading(&c));
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 49.97, before);
    TEST_ASSERT_TRUE(largest < 1e-4); /* 0.1 mm/s */
}

static void test_a_table_that_needs_more_than_is_reserved_is_refused_and_the_old_one_kept(void)
{
    const struct motion_bound most = {
        {100, 100, 100}, {1000, 1000, 1000}, {50000, 50000, 50000}, {500, 500, 500}};
    struct need need;

    make_volume(&tables, 5);
    make_volume(&other_tables, 500);
    begin(&tables);
    takt_correction_reserve(&c, &most, &need);
    TEST_ASSERT_FALSE(takt_correction_load(&c, &other_tables, &wrong));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_RESERVE, wrong.code);
    TEST_ASSERT_FALSE(takt_correction_is_loading(&c));
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.005, settle(50, 50, 50, 0).at[AXIS_X]);
    settings.reserve_ratio = 0.05;
    begin(&tables);
    takt_correction_reserve(&c, &most, &need);
    TEST_ASSERT_EQUAL_DOUBLE(5.0, need.velocity_mm_s[AXIS_X]);
    TEST_ASSERT_TRUE(takt_correction_load(&c, &other_tables, &wrong));
}

static void test_leaving_a_table_is_told_once_until_it_is_asked(void)
{
    make_volume(&tables, 5);
    begin(&tables);
    (void)settle(50, 50, 50, 0);
    TEST_ASSERT_EQUAL_HEX(0, takt_correction_take_outside(&c));
    (void)settle(50, 101, -0.5, 0);
    TEST_ASSERT_EQUAL_HEX(1U << AXIS_Y | 1U << AXIS_Z, takt_correction_take_outside(&c));
}

static void test_the_settled_correction_is_what_the_cycle_comes_to(void)
{
    const struct point at = {{70, 30, 20}};
    struct point k, settled;

    settings.machine[AXIS_X][1] = 3e-5;
    settings.setup_rotation_rad[AXIS_Z] = 1e-4;
    make_volume(&tables, 12);
    make_axis_table(AXIS_Y, AXIS_Z, 4, 2);
    TEST_ASSERT_TRUE(takt_axis_tables_add(&tables.axes, &table, &wrong));
    begin(&tables);
    takt_correction_evaluate(&c, &at, &move, &k);
    settled = settle(70, 30, 20, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, settled.at[AXIS_X], k.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, settled.at[AXIS_Y], k.at[AXIS_Y]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.003, k.at[AXIS_Z]); /* the mean of both directions */
}

static void test_a_pair_of_axes_given_twice_and_too_many_points_are_refused(void)
{
    make_axis_table(AXIS_X, AXIS_X, 1, 1);
    TEST_ASSERT_TRUE(takt_axis_tables_add(&tables.axes, &table, &wrong));
    TEST_ASSERT_FALSE(takt_axis_tables_add(&tables.axes, &table, &wrong));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_PAIR_TWICE, wrong.code);
    tables.axes.points = AXIS_TABLES_POINTS_MAX - 2;
    make_axis_table(AXIS_Y, AXIS_X, 1, 1);
    TEST_ASSERT_FALSE(takt_axis_tables_add(&tables.axes, &table, &wrong));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_PAIRS_MANY, wrong.code);
}

static void test_a_volume_fades_in_when_its_first_patch_is_there_at_rest_and_in_motion(void)
{
    unsigned faded = 0;

    make_volume(&tables, 30);
    begin(&tables);
    for (int i = 0; i < 20000; i++) {
        const double a = 1e-3 * i;
        const struct point at = {{50 + 40 * sin(a), 50 + 40 * cos(a), 50 + 30 * sin(0.7 * a)}};
        struct point set;

        takt_correction_switch(&c, CORRECTION_VOLUME, i < 5000 || i > 12000);
        takt_correction_cycle(&c, &at, &move, &set);
        faded += takt_correction_get_running(&c) == 0 ? 1 : 0;
        TEST_ASSERT_TRUE(takt_correction_get_running(&c) == 0 ||
                         c.patches.patch[c.patches.used].valid);
    }
    TEST_ASSERT_TRUE(faded > 20 && faded < 7000);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_anything_to_correct_the_setpoint_is_the_command_to_the_last_bit);
    RUN_TEST(test_a_diagonal_matrix_takes_back_a_pitch_error);
    RUN_TEST(test_the_matrix_is_composed_of_machine_workpiece_and_overhang);
    RUN_TEST(test_thermal_growth_of_fifteen_kelvin_is_taken_back);
    RUN_TEST(test_the_need_of_thermal_growth_is_that_of_thirty_kelvin);
    RUN_TEST(test_backlash_follows_the_direction_of_the_last_motion);
    RUN_TEST(test_a_reversal_fades_within_the_need);
    RUN_TEST(test_a_worn_tool_is_followed_along_and_across);
    RUN_TEST(test_wear_is_kept_per_tool);
    RUN_TEST(test_layers_add_up);
    RUN_TEST(test_machine_file_operator_and_program_switch_layers);
    RUN_TEST(test_tables_are_exchanged_without_a_jump);
    RUN_TEST(test_a_table_that_needs_more_than_is_reserved_is_refused_and_the_old_one_kept);
    RUN_TEST(test_leaving_a_table_is_told_once_until_it_is_asked);
    RUN_TEST(test_the_settled_correction_is_what_the_cycle_comes_to);
    RUN_TEST(test_a_pair_of_axes_given_twice_and_too_many_points_are_refused);
    RUN_TEST(test_a_volume_fades_in_when_its_first_patch_is_there_at_rest_and_in_motion);
    return UNITY_END();
}
