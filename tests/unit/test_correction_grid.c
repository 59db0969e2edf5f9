/*
 * Grids: the spline through a table's points, close to it by patches, and what following it takes.
 */
#include "correction/grid.h"
#include "correction/grid_bound.h"
#include "correction/grid_patch.h"
#include "unity.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static struct table table;
static struct grid grid;
static uint64_t state;

void setUp(void)
{
    memset(&table, 0, sizeof table);
    state = 20240607;
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

/* A smooth field of some 50 um, different for each output. */
static double wavy(unsigned output, const double *x)
{
    return 1e-3 * (20 * sin(x[0] / 110 + output) + 15 * cos(x[1] / 90 + x[2] / 150 + output) +
                   x[3] * 4 + 1e-4 * x[0] * x[1] * (output + 1.0) / 3);
}

/* Cubic along each input: the spline has to reproduce it. */
static double polynomial(unsigned output, const double *x)
{
    double product = 0.01 * (output + 1.0);

    for (unsigned i = 0; i < 4; i++) {
        const double s = x[i] / 300;

        product *= 1 + 0.5 * s - 0.25 * s * s + 0.1 * s * s * s;
    }
    return product;
}

typedef double field(unsigned output, const double *x);

/* inputs of the axes X, Y, Z, C with these numbers of points from -100 to 300 (or rad). */
static void make(unsigned inputs, const uint16_t *points, const uint8_t *axes, field *f)
{
    struct diagnostic wrong;

    table.inputs = (uint8_t)inputs;
    table.outputs = 3;
    for (unsigned i = 0; i < inputs; i++) {
        table.input[i] = axes[i];
        table.knots[i] = points[i];
        for (unsigned k = 0; k < points[i]; k++)
            table.knot_mm[i][k] = -100.0 + 400.0 * k / (points[i] - 1);
    }
    for (uint8_t i = 0; i < 3; i++)
        table.output[i].axis = i;
    for (uint32_t row = 0; row < takt_table_rows(&table); row++) {
        double x[4] = {0};
        uint32_t rest = row;

        for (unsigned i = 0; i < inputs; i++) {
            x[i] = table.knot_mm[i][rest % points[i]];
            rest /= points[i];
        }
        for (unsigned o = 0; o < 3; o++)
            table.value_mm[3 * row + o] = (float)f(o, x);
    }
    TEST_ASSERT_TRUE(takt_grid_set(&grid, &table, &wrong));
}

static void make_volume(field *f)
{
    make(3, (const uint16_t[]){9, 7, 6}, (const uint8_t[]){AXIS_X, AXIS_Y, AXIS_Z}, f);
}

static void evaluate(const struct point *at, float k[AXIS_COUNT])
{
    memset(k, 0, sizeof(float) * AXIS_COUNT);
    TEST_ASSERT_EQUAL_UINT(0, takt_grid_add(&grid, at, 1.0F, k));
}

static void test_a_grid_goes_through_its_points(void)
{
    make_volume(wavy);
    for (uint32_t row = 0; row < takt_table_rows(&table); row++) {
        const struct point at = {
            {table.knot_mm[0][row % 9], table.knot_mm[1][row / 9 % 7], table.knot_mm[2][row / 63]}};
        float k[AXIS_COUNT];

        evaluate(&at, k);
        for (unsigned o = 0; o < 3; o++)
            TEST_ASSERT_FLOAT_WITHIN(2e-8F, table.value_mm[3 * row + o], k[o]);
    }
}

static void check_polynomial(const uint8_t *axes, unsigned inputs)
{
    for (int n = 0; n < 2000; n++) {
        struct point at = {{0}};
        double x[4] = {0};
        float k[AXIS_COUNT];

        for (unsigned i = 0; i < inputs; i++)
            x[i] = at.at[axes[i]] = random_between(-100, 300);
        evaluate(&at, k);
        for (unsigned o = 0; o < 3; o++)
            TEST_ASSERT_DOUBLE_WITHIN(3e-8, polynomial(o, x), (double)k[o]);
    }
}

static void test_a_product_of_cubics_is_reproduced_over_two_three_and_four_axes(void)
{
    const uint8_t axes[] = {AXIS_X, AXIS_Y, AXIS_Z, AXIS_C};
    const uint8_t plane[] = {AXIS_Z, AXIS_X};

    make(2, (const uint16_t[]){5, 4}, plane, polynomial);
    check_polynomial(plane, 2);
    make(3, (const uint16_t[]){5, 4, 6}, axes, polynomial);
    check_polynomial(axes, 3);
    make(4, (const uint16_t[]){5, 4, 4, 6}, axes, polynomial);
    check_polynomial(axes, 4);
}

static void test_the_turning_axis_is_corrected_too(void)
{
    struct diagnostic wrong;
    float k[AXIS_COUNT] = {0};

    make(4, (const uint16_t[]){4, 4, 4, 4}, (const uint8_t[]){AXIS_X, AXIS_Y, AXIS_Z, AXIS_B},
         polynomial);
    table.output[0].axis = AXIS_B;
    TEST_ASSERT_TRUE(takt_grid_set(&grid, &table, &wrong));
    (void)takt_grid_add(&grid, &(struct point){{0}}, 1.0F, k);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, k[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(3e-8, polynomial(0, (const double[]){0, 0, 0, 0}), (double)k[AXIS_B]);
}

static void test_a_smooth_field_between_points_is_met_to_a_fraction_of_a_micrometre(void)
{
    double worst = 0;

    make_volume(wavy);
    for (int n = 0; n < 10000; n++) {
        const double x[4] = {random_between(-100, 300), random_between(-100, 300),
                             random_between(-100, 300), 0};
        const struct point at = {{x[0], x[1], x[2]}};
        float k[AXIS_COUNT];

        evaluate(&at, k);
        for (unsigned o = 0; o < 3; o++)
            worst = fmax(worst, fabs((double)k[o] - wavy(o, x)));
    }
    TEST_ASSERT_TRUE(worst < 0.5e-3);
}

static void test_outside_the_edge_value_holds_from_one_step_on(void)
{
    const struct point edge = {{300, 40, 70}}, far = {{350.001, 40, 70}}, farther = {{900, 40, 70}};
    float at_edge[AXIS_COUNT] = {0}, k[AXIS_COUNT] = {0}, l[AXIS_COUNT] = {0};

    make_volume(wavy);
    TEST_ASSERT_EQUAL_UINT(0, takt_grid_add(&grid, &edge, 1.0F, at_edge));
    TEST_ASSERT_EQUAL_UINT(1U << AXIS_X, takt_grid_add(&grid, &far, 1.0F, k));
    TEST_ASSERT_EQUAL_UINT(1U << AXIS_X, takt_grid_add(&grid, &farther, 1.0F, l));
    for (unsigned o = 0; o < 3; o++) {
        TEST_ASSERT_FLOAT_WITHIN(1e-8F, at_edge[o], k[o]);
        TEST_ASSERT_FLOAT_WITHIN(1e-8F, at_edge[o], l[o]);
    }
}

/*
 * Differences along a straight way at a constant speed: with two continuous derivatives the third
 * difference stays as small as the field's third derivative, at cell borders and at the edges of
 * the table alike.
 */
static void test_a_way_through_cells_and_edges_has_no_jump_in_acceleration(void)
{
    const double speed = 100, cycle_s = 0.01;
    double k0[4] = {0}, worst = 0;
    int n = 0;

    make_volume(wavy);
    for (; n < 500; n++) {
        const double s = -150 + n * speed * cycle_s;
        const struct point at = {{s, 0.7 * s + 20, 0.3 * s}};
        float k[AXIS_COUNT] = {0};

        (void)takt_grid_add(&grid, &at, 1.0F, k);
        k0[3] = k0[2], k0[2] = k0[1], k0[1] = k0[0], k0[0] = (double)k[0];
        if (n > 3)
            worst = fmax(worst, fabs(k0[0] - 3 * k0[1] + 3 * k0[2] - k0[3]) / pow(cycle_s, 3));
    }
    /* a step of slope 1e-4 would be 1e-4 * 100 / 0.01^2 = 100 mm/s3 */
    TEST_ASSERT_TRUE(worst < 10);
}

/* With a noise that calibration leaves: 0.1 um. */
static double noisy(unsigned output, const double *x)
{
    return wavy(output, x) + random_between(-1e-4, 1e-4);
}

static bool by_patch(const struct grid_patches *patches)
{
    return patches->patch[patches->used].valid;
}

/*
 * What a cycle at a point adds by patches, compared with the grid itself: the largest difference.
 */
static double patch_error(struct grid_patches *patches, const struct point *at)
{
    float direct[AXIS_COUNT] = {0}, near[AXIS_COUNT] = {0};
    double worst = 0;

    TEST_ASSERT_EQUAL_UINT(takt_grid_add(&grid, at, 1.0F, direct),
                           takt_grid_patch_add(&grid, patches, at, 1.0F, near));
    for (unsigned o = 0; o < 3; o++)
        worst = fmax(worst, fabs((double)(near[o] - direct[o])));
    return worst;
}

static struct point around(double s)
{
    return (struct point){{100 + 230 * sin(s), 90 + 190 * cos(1.3 * s), 60 + 150 * sin(2.1 * s)}};
}

static void test_patches_are_the_grid_to_a_few_nanometres(void)
{
    struct grid_patches patches = {0};
    unsigned within = 0; /* cycles since the axes came into the table */
    double worst = 0;

    make_volume(wavy);
    for (int n = 0; n < 200000; n++) {
        const struct point at = around(n * 1e-4); /* 0.03 mm a cycle, through the edges as well */

        worst = fmax(worst, patch_error(&patches, &at));
        within = fabs(at.at[AXIS_X] - 100) > 200 ? 0 : within + 1;
        TEST_ASSERT_TRUE(within < 30 || by_patch(&patches));
    }
    TEST_ASSERT_TRUE(worst < 4e-6);
}

static void test_patches_of_a_noisy_table_keep_to_their_error_at_any_speed(void)
{
    make_volume(noisy);
    for (int i = 0; i < 17; i++) {
        const double speed = 1e-5 * pow(1.5, i);
        struct grid_patches patches = {0};
        double worst = 0;

        for (int n = 0; n < 20000; n++) {
            const struct point at = around(n * speed);

            worst = fmax(worst, patch_error(&patches, &at));
        }
        TEST_ASSERT_TRUE(worst < GRID_PATCH_ERROR_MM + 2e-8);
    }
}

static void
test_up_to_their_fastest_the_axes_are_followed_by_patches_alone_and_beyond_by_the_grid(void)
{
    make_volume(noisy);
    for (int fast = 0; fast < 2; fast++) {
        const double step_mm = (fast ? 1.2 : 0.9) * (double)grid.fastest / grid.input[0].per_mm;
        struct grid_patches patches = {0};

        for (int n = 0; n < 600; n++) {
            const struct point at = {{-90 + step_mm * (n < 400 ? n * n / 800.0 : n - 200), 40, 70}};
            const double error = patch_error(&patches, &at);

            TEST_ASSERT_TRUE(n < 40 || n > 300 || by_patch(&patches));
            TEST_ASSERT_TRUE(n <= 420 || by_patch(&patches) == (fast == 0));
            TEST_ASSERT_TRUE(n <= 420 || fast == 0 || error == 0);
        }
    }
}

static void test_axes_that_have_come_to_rest_are_corrected_as_the_grid_says(void)
{
    struct grid_patches patches = {0};
    struct point at = {{0}};

    make_volume(noisy);
    for (int n = 0; n < 2000; n++) {
        at.at[AXIS_X] = 50 + 60 * sin(n < 1570 ? n * 1e-3 : 1.57);
        at.at[AXIS_Z] = 20 + 90 * cos(n < 1570 ? n * 1e-3 : 1.57);
        const double error = patch_error(&patches, &at);

        TEST_ASSERT_TRUE(n <= 1700 || error < GRID_PATCH_NEAR_MM + 1e-8);
    }
}

static void test_a_place_that_is_set_anew_is_corrected_by_the_grid_itself_at_once(void)
{
    struct grid_patches patches = {0};

    make_volume(noisy);
    for (int n = 0; n < 1000; n++) {
        const struct point at = {{n < 500 ? 30 + 0.01 * n : 200 - 0.01 * n, 40, 70}};
        const double error = patch_error(&patches, &at);

        TEST_ASSERT_TRUE(n != 500 || error == 0);
        TEST_ASSERT_TRUE(error < GRID_PATCH_ERROR_MM + 2e-8);
    }
    TEST_ASSERT_TRUE(by_patch(&patches));
}

static double noise(unsigned output, const double *x)
{
    (void)output;
    (void)x;
    return random_between(-1, 1) < 0 ? -1e-3 : 1e-3;
}

/* A place in or beside a volume's corner, where what stands outside of the table counts most. */
static struct point near_a_corner(void)
{
    const double step_mm[3] = {400.0 / 8, 400.0 / 6, 400.0 / 5};
    struct point at = {{0}};

    for (unsigned i = 0; i < 3; i++) {
        const double steps = random_between(-0.7, 0.7);

        at.at[i] = random_between(-1, 1) < 0 ? -100 + steps * step_mm[i] : 300 + steps * step_mm[i];
    }
    return at;
}

/*
 * Bounds of K itself, and of its slope along an input: by the step of a table, over a thousandth of
 * one.
 */
static void test_the_bounds_of_value_and_slope_hold_beyond_the_ends_of_a_table_as_well(void)
{
    const double step_mm[3] = {400.0 / 8, 400.0 / 6, 400.0 / 5};
    double most_value = 0, most_slope = 0;

    for (int tables = 0; tables < 40; tables++) {
        make_volume(noise);
        for (int n = 0; n < 2000; n++) {
            const struct point at = near_a_corner();
            const unsigned i = (unsigned)n % 3;
            struct point beside = at;
            float k[AXIS_COUNT] = {0}, next[AXIS_COUNT] = {0};

            beside.at[i] += 1e-2 * step_mm[i];
            (void)takt_grid_add(&grid, &at, 1.0F, k);
            (void)takt_grid_add(&grid, &beside, 1.0F, next);
            for (unsigned o = 0; o < 3; o++) {
                const double value =
                    (double)takt_grid_bound(&grid, o, GRID_NO_INPUT, GRID_NO_INPUT, GRID_NO_INPUT);
                const double slope =
                    (double)takt_grid_bound(&grid, o, i, GRID_NO_INPUT, GRID_NO_INPUT);

                most_value = fmax(most_value, fabs((double)k[o]) / value);
                most_slope = fmax(most_slope, fabs((double)(next[o] - k[o])) / 1e-2 / slope);
            }
        }
    }
    TEST_ASSERT_TRUE(most_value > 0.3 && most_value <= 1.00001);
    TEST_ASSERT_TRUE(most_slope > 0.3 && most_slope <= 1.001);
}

/* The most that differences of K over cycles are, of the last four values. */
struct differences {
    double last[4], v, a, j;
    int count;
};

static void take(struct differences *d, double k, double cycle_s)
{
    d->last[3] = d->last[2], d->last[2] = d->last[1], d->last[1] = d->last[0], d->last[0] = k;
    if (++d->count < 4)
        return;
    d->v = fmax(d->v, fabs(d->last[0] - d->last[1]) / cycle_s);
    d->a = fmax(d->a, fabs(d->last[0] - 2 * d->last[1] + d->last[2]) / pow(cycle_s, 2));
    d->j = fmax(d->j,
                fabs(d->last[0] - 3 * d->last[1] + 3 * d->last[2] - d->last[3]) / pow(cycle_s, 3));
}

static void check_need(const struct differences *d, const struct need *need, unsigned axis,
                       double noise_mm, double cycle_s)
{
    TEST_ASSERT_TRUE(d->v > 0 && d->v <= need->velocity_mm_s[axis] + 2 * noise_mm / cycle_s);
    TEST_ASSERT_TRUE(d->a <= need->acceleration_mm_s2[axis] + 4 * noise_mm / pow(cycle_s, 2));
    TEST_ASSERT_TRUE(d->j <= need->jerk_mm_s3[axis] + 8 * noise_mm / pow(cycle_s, 3));
}

/* Motion of all three axes within most, on a table: what is added stays within the need. */
static void test_the_need_bounds_what_following_the_table_takes(void)
{
    struct motion_bound most = {{100, 100, 100}, {1000, 1000, 1000}, {50000, 50000, 50000}, {0}};
    const double cycle_s = 0.01; /* coarse, so that rounding is small beside it */
    struct differences d = {.count = 0};
    struct need need;

    memset(&need, 0, sizeof need);
    make_volume(wavy);
    takt_grid_need(&grid, &most, cycle_s, &need);
    for (int n = 0; n < 20000; n++) {
        const double t = n * cycle_s;
        const struct point at = {
            {100 + 150 * sin(0.66 * t), 100 + 110 * cos(0.9 * t), 90 + 80 * sin(1.2 * t)}};
        float k[AXIS_COUNT] = {0};

        (void)takt_grid_add(&grid, &at, 1.0F, k);
        take(&d, (double)k[0], cycle_s);
    }
    check_need(&d, &need, AXIS_X, 0, cycle_s);
}

/*
 * The same by patches, of a noisy table, with the rounding that need counts: from slow motion to
 * the fastest, and into the corners beyond the ends of all three inputs.
 */
static void test_the_need_bounds_what_patches_take_while_one_goes_over_into_the_other(void)
{
    make_volume(noisy);
    for (int slower = 0; slower < 13; slower++) {
        const double size = 1.4 * pow(0.7, slower);
        const double cycle_s = 0.001, w = (double)grid.fastest / 0.02 / cycle_s / 600 * size;
        struct motion_bound most = {{280 * w, 250 * w, 410 * w}, {0}, {0}, {0}};
        struct grid_patches patches = {0};
        struct differences d[3] = {{.count = 0}};
        struct need need;

        memset(&need, 0, sizeof need);
        for (unsigned i = 0; i < 3; i++) {
            most.acceleration_mm_s2[i] = most.velocity_mm_s[i] * 2 * w;
            most.jerk_mm_s3[i] = most.acceleration_mm_s2[i] * 2 * w;
        }
        takt_grid_need(&grid, &most, cycle_s, &need);
        for (int n = 0; n < 60000; n++) {
            const double t = w * n * cycle_s;
            const struct point at = {
                {100 + 280 * sin(t), 100 + 275 * cos(0.9 * t), 90 + 240 * sin(1.7 * t)}};
            float k[AXIS_COUNT] = {0};

            (void)takt_grid_patch_add(&grid, &patches, &at, 1.0F, k);
            for (unsigned i = 0; i < 3 && n > 60; i++)
                take(&d[i], (double)k[i], cycle_s);
        }
        for (unsigned i = 0; i < 3; i++)
            check_need(&d[i], &need, i, need.noise_mm[i], cycle_s);
    }
}

static void test_a_grid_that_finds_no_room_and_a_table_of_one_axis_are_refused(void)
{
    struct diagnostic wrong;

    make(2, (const uint16_t[]){70, 70}, (const uint8_t[]){AXIS_X, AXIS_Y}, wavy);
    table.inputs = 1;
    TEST_ASSERT_FALSE(takt_grid_set(&grid, &table, &wrong));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_KIND, wrong.code);
    table.inputs = 3;
    table.knots[0] = table.knots[1] = table.knots[2] = 17;
    TEST_ASSERT_FALSE(takt_grid_set(&grid, &table, &wrong));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_FULL, wrong.code);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_grid_goes_through_its_points);
    RUN_TEST(test_a_product_of_cubics_is_reproduced_over_two_three_and_four_axes);
    RUN_TEST(test_the_turning_axis_is_corrected_too);
    RUN_TEST(test_a_smooth_field_between_points_is_met_to_a_fraction_of_a_micrometre);
    RUN_TEST(test_outside_the_edge_value_holds_from_one_step_on);
    RUN_TEST(test_a_way_through_cells_and_edges_has_no_jump_in_acceleration);
    RUN_TEST(test_patches_are_the_grid_to_a_few_nanometres);
    RUN_TEST(test_patches_of_a_noisy_table_keep_to_their_error_at_any_speed);
    RUN_TEST(
        test_up_to_their_fastest_the_axes_are_followed_by_patches_alone_and_beyond_by_the_grid);
    RUN_TEST(test_axes_that_have_come_to_rest_are_corrected_as_the_grid_says);
    RUN_TEST(test_a_place_that_is_set_anew_is_corrected_by_the_grid_itself_at_once);
    RUN_TEST(test_the_need_bounds_what_following_the_table_takes);
    RUN_TEST(test_the_bounds_of_value_and_slope_hold_beyond_the_ends_of_a_table_as_well);
    RUN_TEST(test_the_need_bounds_what_patches_take_while_one_goes_over_into_the_other);
    RUN_TEST(test_a_grid_that_finds_no_room_and_a_table_of_one_axis_are_refused);
    return UNITY_END();
}
