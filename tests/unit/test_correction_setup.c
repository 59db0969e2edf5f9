/* The layer of the set-up: a part that is turned and displaced, on a table that turns. */
#include "correction_bench.h"

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

/*
 * Where a feature of the part is, by a displacement D of the part on its table and the table's own
 * turn about P.
 */
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_setup_layer_moves_no_axis_that_is_not_there);
    RUN_TEST(test_the_setup_layer_takes_back_a_turned_and_displaced_pallet);
    RUN_TEST(test_the_set_up_turns_with_the_table_that_bears_the_part);
    RUN_TEST(test_a_set_up_on_a_table_takes_no_more_of_the_axes_than_it_asked_for);
    RUN_TEST(test_a_set_up_that_is_told_while_axes_move_fades_in);
    return UNITY_END();
}
