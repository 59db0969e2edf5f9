/* The layers: what each corrects, their sum, switching, fading, and loading while in motion. */
#include "base/maths.h"
#include "correction/correction.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define CYCLE_S 0.001

static struct correction c;
static struct correction_settings settings;
static struct correction_tables tables, other_tables;
static struct table table;
static struct move move;
static struct diagnostic wrong;
static const struct point origin = {{0}};

void setUp(void)
{
    takt_correction_settings_set_default(&settings);
    memset(&tables, 0, sizeof tables);
    memset(&other_tables, 0, sizeof other_tables);
    memset(&move, 0, sizeof move);
    move.kind = MOVE_FEED;
}

void tearDown(void)
{
}

static void begin(const struct correction_tables *with)
{
    takt_correction_init(&c, &settings, 0x27, CYCLE_S, with, &origin); /* X Y Z C */
}

/* Stands at a point until everything has faded. */
static struct point settle(double x, double y, double z, double turn)
{
    const struct point at = {{x, y, z, 0, 0, turn}};
    struct point set = at;

    for (int i = 0; i < 6000; i++)
        takt_correction_cycle(&c, &at, &move, &set);
    for (int i = 0; i < AXIS_COUNT; i++)
        set.at[i] -= at.at[i];
    return set;
}

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

static void test_the_setup_layer_moves_no_axis_that_is_not_there(void)
{
    const struct point at = {{100, 50, 0}};
    struct point set;

    settings.setup_rotation_rad[AXIS_X] = 0.01;
    settings.setup_offset_mm[AXIS_Z] = 0.2;
    takt_correction_init(&c, &settings, 0x3, CYCLE_S, NULL, &origin); /* X Y */
    for (int i = 0; i < 6000; i++)
        takt_correction_cycle(&c, &at, &move, &set);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, set.at[AXIS_Z]);
    TEST_ASSERT_TRUE(set.at[AXIS_Y] != at.at[AXIS_Y]);
}

static void test_the_setup_layer_takes_back_a_turned_and_displaced_pallet(void)
{
    const double angle = 0.5 * MATHS_PI / 180, x = 220, y = 90;
    struct point k;

    settings.turn_axis = AXIS_C;
    settings.setup_offset_mm[AXIS_X] = 0.3;
    settings.setup_rotation_rad[AXIS_Z] = angle;
    settings.setup_pivot_mm[AXIS_X] = 20;
    settings.setup_turn_rad = 0.001;
    begin(NULL);
    k = settle(x, y, 10, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 20 + 200 * cos(angle) - 90 * sin(angle) + 0.3,
                              x + k.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 200 * sin(angle) + 90 * cos(angle), y + k.at[AXIS_Y]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, k.at[AXIS_Z]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.001, k.at[AXIS_C]);
}

/* Where a feature of the part is, by a displacement D of the part on its table and the table's own turn about P. */
static void place_of(const double q[3], double psi, const double angle[3], double p[3])
{
    double v[3], w[3];

    for (int i = 0; i < 3; i++)
        v[i] = q[i] - settings.setup_pivot_mm[i];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        memcpy(w, v, sizeof w);
        v[j] = cos(angle[i]) * w[j] - sin(angle[i]) * w[k];
        v[k] = sin(angle[i]) * w[j] + cos(angle[i]) * w[k];
    }
    for (int i = 0; i < 3; i++)
        v[i] += settings.setup_offset_mm[i];
    p[0] = cos(psi) * v[0] - sin(psi) * v[1] + settings.setup_pivot_mm[0];
    p[1] = sin(psi) * v[0] + cos(psi) * v[1] + settings.setup_pivot_mm[1];
    p[2] = v[2] + settings.setup_pivot_mm[2];
}

static void set_up_askew(void)
{
    settings.turn_axis = AXIS_C;
    settings.setup_offset_mm[AXIS_X] = 0.7;
    settings.setup_offset_mm[AXIS_Y] = -0.43;
    settings.setup_offset_mm[AXIS_Z] = 0.2;
    settings.setup_rotation_rad[AXIS_X] = 0.004;
    settings.setup_rotation_rad[AXIS_Y] = -0.003;
    settings.setup_rotation_rad[AXIS_Z] = 0.01;
    settings.setup_pivot_mm[AXIS_X] = 30;
    settings.setup_pivot_mm[AXIS_Y] = -12;
    settings.setup_pivot_mm[AXIS_Z] = 5;
}

static void test_the_set_up_turns_with_the_table_that_bears_the_part(void)
{
    const double straight[3] = {0}, q[3] = {120, 45, -20};
    double wanted[3], is[3];

    set_up_askew();
    begin(NULL);
    for (int quarter = -4; quarter < 5; quarter++) {
        const double psi = quarter * MATHS_PI / 2 + (quarter == 3 ? 0.3 : 0);
        const double offset[3] = {settings.setup_offset_mm[0], settings.setup_offset_mm[1],
                                  settings.setup_offset_mm[2]};

        memset(settings.setup_offset_mm, 0, sizeof settings.setup_offset_mm);
        place_of(q, psi, straight, wanted);
        memcpy(settings.setup_offset_mm, offset, sizeof offset);
        place_of(q, psi, settings.setup_rotation_rad, is);
        const struct point k = settle(wanted[0], wanted[1], wanted[2], psi);

        for (int i = 0; i < 3; i++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, is[i], wanted[i] + k.at[i]);
    }
}

/* Sines of all axes: the derivatives of K by differences. */
static void test_a_set_up_on_a_table_takes_no_more_of_the_axes_than_it_asked_for(void)
{
    static const double size[AXIS_COUNT] = {200, 150, 100, 0, 0, 3},
                        rate[AXIS_COUNT] = {3.1, 2.3, 4.7, 0, 0, 5.9};
    struct motion_bound most = {{0}, {0}, {0}, {0}};
    double k[4][AXIS_COUNT] = {{0}};
    struct need need;

    set_up_askew();
    begin(NULL);
    for (int i = 0; i < AXIS_COUNT; i++) {
        most.farthest_mm[i] = size[i];
        most.velocity_mm_s[i] = size[i] * rate[i];
        most.acceleration_mm_s2[i] = most.velocity_mm_s[i] * rate[i];
        most.jerk_mm_s3[i] = most.acceleration_mm_s2[i] * rate[i];
    }
    takt_correction_get_need(&c, &most, &need);
    (void)settle(0, 0, 0, 0);
    for (int n = 0; n < 20000; n++) {
        struct point at, set;

        for (int i = 0; i < AXIS_COUNT; i++)
            at.at[i] = size[i] * sin(rate[i] * n * CYCLE_S + i);
        takt_correction_cycle(&c, &at, &move, &set);
        memmove(k[1], k[0], 3 * sizeof k[0]);
        for (int i = 0; i < 3; i++) {
            k[0][i] = set.at[i] - at.at[i];
            const double first = k[0][i] - k[1][i], second = first - (k[1][i] - k[2][i]);
            const double third = second - (k[1][i] - 2 * k[2][i] + k[3][i]);

            if (n < 3)
                continue;
            TEST_ASSERT_TRUE(fabs(first) <= need.velocity_mm_s[i] * CYCLE_S);
            TEST_ASSERT_TRUE(fabs(second) <= need.acceleration_mm_s2[i] * CYCLE_S * CYCLE_S);
            TEST_ASSERT_TRUE(fabs(third) <= need.jerk_mm_s3[i] * CYCLE_S * CYCLE_S * CYCLE_S);
        }
    }
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

static void test_a_set_up_that_is_told_while_axes_move_fades_in(void)
{
    const struct motion_bound most = {
        {100, 100, 100}, {1000, 1000, 1000}, {50000, 50000, 50000}, {500, 500, 500}};
    double before = 50, largest = 0;
    struct need need;
    struct point set;

    settings.setup_offset_mm[AXIS_X] = 0.3;
    settings.reserve_ratio = 0.05;
    begin(NULL);
    takt_correction_reserve(&c, &most, &need);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.3, settle(50, 0, 0, 0).at[AXIS_X]);
    before = 50.3;
    takt_correction_tell_setup(&c, AXIS_X, -0.2);
    takt_correction_tell_setup(&c, AXIS_Y, 0.1);
    TEST_ASSERT_FALSE(takt_correction_is_set_up(&c));
    TEST_ASSERT_TRUE(takt_correction_take_setup(&c));
    TEST_ASSERT_TRUE(takt_correction_is_set_up(&c) && takt_correction_is_setting_up(&c));
    for (int i = 0; i < 20000; i++) {
        const struct point at = {{50, 0, 0}};

        takt_correction_cycle(&c, &at, &move, &set);
        largest = fmax(largest, fabs(set.at[AXIS_X] - before));
        before = set.at[AXIS_X];
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 49.8, set.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, 0.1, set.at[AXIS_Y]);
    TEST_ASSERT_TRUE(largest < 1e-3); /* 1 mm/s */
    TEST_ASSERT_FALSE(takt_correction_is_setting_up(&c));
    takt_correction_tell_setup(&c, AXIS_X, 50.0);
    TEST_ASSERT_FALSE(takt_correction_take_setup(&c));
    TEST_ASSERT_TRUE(takt_correction_is_set_up(&c));
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, -0.2, settle(50, 0, 0, 0).at[AXIS_X]);
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
    RUN_TEST(test_the_setup_layer_moves_no_axis_that_is_not_there);
    RUN_TEST(test_the_setup_layer_takes_back_a_turned_and_displaced_pallet);
    RUN_TEST(test_the_set_up_turns_with_the_table_that_bears_the_part);
    RUN_TEST(test_a_set_up_on_a_table_takes_no_more_of_the_axes_than_it_asked_for);
    RUN_TEST(test_thermal_growth_of_fifteen_kelvin_is_taken_back);
    RUN_TEST(test_backlash_follows_the_direction_of_the_last_motion);
    RUN_TEST(test_a_reversal_fades_within_the_need);
    RUN_TEST(test_a_worn_tool_is_followed_along_and_across);
    RUN_TEST(test_wear_is_kept_per_tool);
    RUN_TEST(test_layers_add_up);
    RUN_TEST(test_machine_file_operator_and_program_switch_layers);
    RUN_TEST(test_tables_are_exchanged_without_a_jump);
    RUN_TEST(test_a_table_that_needs_more_than_is_reserved_is_refused_and_the_old_one_kept);
    RUN_TEST(test_a_set_up_that_is_told_while_axes_move_fades_in);
    RUN_TEST(test_leaving_a_table_is_told_once_until_it_is_asked);
    RUN_TEST(test_the_settled_correction_is_what_the_cycle_comes_to);
    RUN_TEST(test_a_pair_of_axes_given_twice_and_too_many_points_are_refused);
    RUN_TEST(test_a_volume_fades_in_when_its_first_patch_is_there_at_rest_and_in_motion);
    return UNITY_END();
}
