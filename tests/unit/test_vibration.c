/* Modes between motor and tool: closed forms of a damped oscillator whose foot moves. */
#include "base/maths.h"
#include "unity.h"
#include "vibration/tool_way.h"
#include "vibration/vibration.h"

#include <math.h>
#include <string.h>

#define CYCLE_S 0.001

static struct vibration_config config;
static struct vibration vibration;
static struct tool_way way;

void setUp(void)
{
    memset(&config, 0, sizeof config);
    memset(&way, 0, sizeof way);
}

void tearDown(void)
{
}

static void set_mode(unsigned axis, unsigned mode, double hz, double damping, double part)
{
    double *number = &config.mode[axis][(size_t)mode * VIBRATION_NUMBERS];

    number[VIBRATION_HZ] = hz;
    number[VIBRATION_DAMPING] = damping;
    number[VIBRATION_PART] = part;
}

/* Where the tool's side of X is, off the drive's place. */
static double follow(double x_mm)
{
    struct point at = {{x_mm}};

    vibration_follow(&vibration, &at);
    return at.at[AXIS_X] - x_mm;
}

static void test_a_machine_without_modes_is_stiff(void)
{
    vibration_init(&vibration, &config, CYCLE_S);
    TEST_ASSERT_FALSE(vibration.any);
    TEST_ASSERT_EQUAL_DOUBLE(0, follow(0));
    TEST_ASSERT_EQUAL_DOUBLE(0, follow(1));
}

/* The foot sets off at v: x = v t, away = -v/wd exp(-d w t) sin(wd t), wd = w sqrt(1 - d^2). */
static void expect_ring(double hz, double damping, double cycle_s)
{
    const double w = 2 * MATHS_PI * hz, wd = w * sqrt(1 - damping * damping);

    set_mode(AXIS_X, 0, hz, damping, 1);
    vibration_init(&vibration, &config, cycle_s);
    (void)follow(5);
    for (int k = 1; k < 2000; k++) {
        const double t = k * cycle_s;
        const double wanted = -10 / wd * exp(-damping * w * t) * sin(wd * t);

        TEST_ASSERT_DOUBLE_WITHIN(1e-10 * (10 / wd) * (1 + w * t), wanted, follow(5 + 10 * t));
    }
}

static void test_a_foot_that_sets_off_rings_as_the_closed_form_says(void)
{
    expect_ring(25, 0.03, CYCLE_S);
    expect_ring(0.5, 0, 0.004);
    expect_ring(60, 0.9, 0.00025);
    expect_ring(800, 0.001, CYCLE_S); /* faster than cycles can show */
}

static void test_under_constant_acceleration_the_tool_lags_by_a_over_w_squared(void)
{
    const double w = 2 * MATHS_PI * 20, a = 500;
    double away = 0;

    set_mode(AXIS_X, 0, 20, 0.2, 1);
    vibration_init(&vibration, &config, CYCLE_S);
    for (int k = 0; k < 1000; k++)
        away = follow(0.5 * a * (k * CYCLE_S) * (k * CYCLE_S));
    /* Velocity in steps once a cycle in place of a ramp: (w cycle)^2/12 of it. */
    TEST_ASSERT_DOUBLE_WITHIN(1.05 * a * CYCLE_S * CYCLE_S / 12, -a / (w * w), away);
}

/* An average over one period has no part of it. */
static void test_a_ramp_of_one_period_leaves_nothing_behind(void)
{
    double x = 0, v = 0, largest = 0;

    set_mode(AXIS_X, 0, 25, 0, 1); /* 40 cycles */
    vibration_init(&vibration, &config, CYCLE_S);
    (void)follow(0);
    for (int k = 0; k < 200; k++) {
        v = k < 40 ? 20.0 * (k + 1) / 40 : 20;
        x += v * CYCLE_S;
        const double away = follow(x);

        if (k >= 40)
            largest = fmax(largest, fabs(away));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, largest);
}

static void test_modes_add_up_by_their_parts_and_axes_are_apart(void)
{
    double first, second;

    set_mode(AXIS_X, 0, 25, 0.1, 1);
    vibration_init(&vibration, &config, CYCLE_S);
    (void)follow(0);
    first = follow(0.01);
    setUp();
    set_mode(AXIS_X, 0, 70, 0.1, 1);
    vibration_init(&vibration, &config, CYCLE_S);
    (void)follow(0);
    second = follow(0.01);
    setUp();
    set_mode(AXIS_X, 0, 25, 0.1, 0.75);
    set_mode(AXIS_X, 1, 70, 0.1, 0.25);
    set_mode(AXIS_Y, 0, 10, 0.1, 1);
    vibration_init(&vibration, &config, CYCLE_S);
    (void)follow(0);
    struct point at = {{0.01}};

    vibration_follow(&vibration, &at);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.01 + 0.75 * first + 0.25 * second, at.at[AXIS_X]);
    TEST_ASSERT_EQUAL_DOUBLE(0, at.at[AXIS_Y]);
}

static void test_modes_that_make_no_sense_are_told_with_their_axis(void)
{
    static const double wrong[][3] = {{-1, 0, 1},    {1e9, 0, 1},  {25, 1, 1},
                                      {25, -0.1, 1}, {25, 0.1, 0}, {25, 0.1, 11}};
    unsigned axis = 0;

    for (size_t n = 0; n < sizeof wrong / sizeof wrong[0]; n++) {
        setUp();
        set_mode(AXIS_Z, 1, wrong[n][0], wrong[n][1], wrong[n][2]);
        TEST_ASSERT_NOT_NULL(vibration_check(&config, &axis));
        TEST_ASSERT_EQUAL(AXIS_Z, axis);
    }
    setUp();
    set_mode(AXIS_Z, 1, 25, 0.1, 0.5);
    TEST_ASSERT_NULL(vibration_check(&config, &axis));
}

/* The frequency of X along an axis: from here to there, straight. */
static void set_table(unsigned along, double from_mm, double to_mm, double from, double to)
{
    struct vibration_table *table = &config.table[AXIS_X];

    table->along = along;
    table->places_mm[0] = from_mm;
    table->places_mm[1] = to_mm;
    for (unsigned m = 0; m < VIBRATION_MODES; m++) {
        for (unsigned n = 0; n < VIBRATION_PLACES; n++)
            table->ratio[m][n] = from + (to - from) * n / (VIBRATION_PLACES - 1);
    }
}

/*
 * The foot of X rings at places of Z: each with the frequency that the table has there, beyond its
 * ends that of the end.
 */
static void test_a_mode_has_the_frequency_of_where_the_other_axis_stands(void)
{
    static const double places[][2] = {{-500, 0.5}, {0, 0.5}, {50, 0.75},
                                       {75, 0.875}, {100, 1}, {900, 1}};

    for (size_t n = 0; n < sizeof places / sizeof places[0]; n++) {
        const double w = 2 * MATHS_PI * 40 * places[n][1], wd = w * sqrt(1 - 0.1 * 0.1);

        setUp();
        set_mode(AXIS_X, 0, 40, 0.1, 1);
        set_table(AXIS_Z, 0, 100, 0.5, 1);
        vibration_init(&vibration, &config, CYCLE_S);
        for (int k = 0; k < 300; k++) {
            const double t = k * CYCLE_S;
            struct point at = {{10 * t, 0, places[n][0]}};

            vibration_follow(&vibration, &at);
            TEST_ASSERT_DOUBLE_WITHIN(1e-10, -10 / wd * exp(-0.1 * w * t) * sin(wd * t),
                                      at.at[AXIS_X] - 10 * t);
        }
    }
}

/*
 * Where Z jumps, away and its rate go on: A cos(w1 t) before, and from its crest A cos(w2 t)
 * behind.
 */
static void test_where_the_frequency_changes_the_swing_goes_on(void)
{
    const double w1 = 2 * MATHS_PI * 25, w2 = 2 * MATHS_PI * 50;
    struct vibration_mode *mode = &vibration.axis[AXIS_X].mode[0];

    set_mode(AXIS_X, 0, 25, 0, 1);
    set_table(AXIS_Z, 0, 100, 1, 2);
    vibration_init(&vibration, &config, CYCLE_S);
    (void)follow(0);
    mode->away_mm = 0.5;
    for (int k = 1; k <= 40; k++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5 * cos(w1 * k * CYCLE_S), follow(0));
    for (int k = 1; k <= 40; k++) {
        struct point at = {{0, 0, k == 1 ? 1e6 : 500}};

        vibration_follow(&vibration, &at);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5 * cos(w2 * k * CYCLE_S), at.at[AXIS_X]);
    }
}

/*
 * A frequency that changes slowly: energy over frequency stays, so the amplitude goes as 1/sqrt(w)
 * (Landau and Lifshitz, Mechanics, 49), here to a quarter.
 */
static void test_over_a_slow_change_the_amplitude_goes_as_one_over_the_root(void)
{
    const struct vibration_mode *mode = &vibration.axis[AXIS_X].mode[0];
    double square = 0;

    set_mode(AXIS_X, 0, 10, 0, 1);
    set_table(AXIS_Y, 0, 100, 1, 4);
    vibration_init(&vibration, &config, CYCLE_S);
    (void)follow(0);
    vibration.axis[AXIS_X].mode[0].away_mm = 1;
    for (int k = 0; k <= 20000; k++) {
        struct point at = {{0, 100.0 * k / 20000, 0}};

        vibration_follow(&vibration, &at);
    }
    square = mode->away_mm * mode->away_mm + pow(mode->rate_mm_s / (2 * MATHS_PI * 40), 2);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.25, square);
}

static void test_what_swings_across_is_a_part_of_the_axis_swing(void)
{
    set_mode(AXIS_X, 0, 25, 0.1, 0.75);
    set_mode(AXIS_X, 1, 60, 0.1, 0.25);
    config.across[AXIS_X][AXIS_Y] = 0.25;
    config.across[AXIS_X][AXIS_Z] = -2;
    vibration_init(&vibration, &config, CYCLE_S);
    for (int k = 0; k < 100; k++) {
        struct point at = {{0.01 * k, 7, 8}};

        vibration_follow(&vibration, &at);
        const double away = at.at[AXIS_X] - 0.01 * k;

        TEST_ASSERT_DOUBLE_WITHIN(1e-14, 7 + 0.25 * away, at.at[AXIS_Y]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-14, 8 - 2 * away, at.at[AXIS_Z]);
        TEST_ASSERT_TRUE(k == 0 || fabs(away) > 0);
    }
}

static void expect_wrong(const char *word)
{
    unsigned axis = AXIS_COUNT;
    const char *wrong = vibration_check(&config, &axis);

    TEST_ASSERT_NOT_NULL(wrong);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, word), wrong);
    TEST_ASSERT_EQUAL(AXIS_X, axis);
}

static void test_tables_and_parts_that_make_no_sense_are_told(void)
{
    unsigned axis;

    config.across[AXIS_X][AXIS_Y] = 0.1;
    expect_wrong("_across");
    set_mode(AXIS_X, 0, 2000, 0.1, 1);
    TEST_ASSERT_NULL(vibration_check(&config, &axis));
    config.across[AXIS_X][AXIS_X] = 0.1;
    expect_wrong("_across");
    config.across[AXIS_X][AXIS_X] = 0;
    set_table(AXIS_Z, 0, 100, 1, 4);
    TEST_ASSERT_NULL(vibration_check(&config, &axis));
    set_table(AXIS_Z, 0, 100, 1, 6);
    expect_wrong("10000 Hz");
    set_table(AXIS_Z, 0, 100, 0.05, 1);
    expect_wrong("_ratio");
    set_table(AXIS_Z, 100, 0, 1, 1);
    expect_wrong("_places_mm");
    set_table(AXIS_COUNT, 0, 100, 1, 1);
    expect_wrong("_along");
    set_table(AXIS_COUNT, 0, 0, 0, 0);
    TEST_ASSERT_NULL(vibration_check(&config, &axis));
}

static void add(double x, double y)
{
    tool_way_add(&way, &(struct point){{x, y}});
}

static void measure(double x, double y)
{
    tool_way_measure(&way, &(struct point){{x, y}});
}

static void test_what_is_behind_along_the_way_does_not_count(void)
{
    for (int k = 0; k < 100; k++) {
        add(k, 0);
        measure(k > 7 ? k - 7.5 : 0, 0.25);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, way.max_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, tool_way_rms_mm(&way));
}

/*
 * Along X, then along Y: the tool that is late is measured from where it is, not from what lies
 * near.
 */
static void test_a_corner_is_measured_from_both_of_its_sides(void)
{
    for (int k = 0; k <= 20; k++)
        add(k, 0);
    measure(19.5, 0.1);
    for (int k = 1; k <= 20; k++)
        add(20, k);
    measure(20.5, -0.5); /* outside of the corner */
    measure(19, 10);     /* beside the second side */
    TEST_ASSERT_EQUAL(3, way.measured);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, way.max_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, (0.01 + 0.5 + 1) / 3,
                              tool_way_rms_mm(&way) * tool_way_rms_mm(&way));
}

static void test_a_long_standstill_does_not_lose_the_tool(void)
{
    for (int k = 0; k < 3 * TOOL_WAY_KEPT; k++)
        add(0, 0);
    for (int k = 0; k < 200; k++) {
        add(k, 0);
        measure(k, 0.125);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.125, way.max_mm);
}

static void test_a_tool_that_is_left_behind_is_measured_from_the_oldest_point(void)
{
    for (int k = 0; k < 3 * TOOL_WAY_KEPT; k++)
        add(k, 0);
    measure(0, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2 * TOOL_WAY_KEPT, way.max_mm);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_machine_without_modes_is_stiff);
    RUN_TEST(test_a_foot_that_sets_off_rings_as_the_closed_form_says);
    RUN_TEST(test_under_constant_acceleration_the_tool_lags_by_a_over_w_squared);
    RUN_TEST(test_a_ramp_of_one_period_leaves_nothing_behind);
    RUN_TEST(test_modes_add_up_by_their_parts_and_axes_are_apart);
    RUN_TEST(test_modes_that_make_no_sense_are_told_with_their_axis);
    RUN_TEST(test_a_mode_has_the_frequency_of_where_the_other_axis_stands);
    RUN_TEST(test_where_the_frequency_changes_the_swing_goes_on);
    RUN_TEST(test_over_a_slow_change_the_amplitude_goes_as_one_over_the_root);
    RUN_TEST(test_what_swings_across_is_a_part_of_the_axis_swing);
    RUN_TEST(test_tables_and_parts_that_make_no_sense_are_told);
    RUN_TEST(test_what_is_behind_along_the_way_does_not_count);
    RUN_TEST(test_a_corner_is_measured_from_both_of_its_sides);
    RUN_TEST(test_a_long_standstill_does_not_lose_the_tool);
    RUN_TEST(test_a_tool_that_is_left_behind_is_measured_from_the_oldest_point);
    return UNITY_END();
}
