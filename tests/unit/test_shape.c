/*
 * Trains of impulses that meet a machine's modes: what they leave of a swing, when, and of which
 * limits.
 */
#include "base/maths.h"
#include "classic/shapers.h"
#include "shape/shape.h"
#include "unity.h"

#include <string.h>

#define CYCLE_S 0.001
#define CASES   400

static struct shape shape;
static struct shape_config config;
static uint64_t seed;

void setUp(void)
{
    memset(&config, 0, sizeof config);
    config.train = takt_zv_train;
    config.cycle_s = CYCLE_S;
    seed = 26;
}

void tearDown(void)
{
}

static double between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/* The ranges that were tried: 10 to 60 Hz, damping 0.02 to 0.1. */
static struct shape_mode random_mode(void)
{
    return (struct shape_mode){between(10, 60), between(0.02, 0.1), 1};
}

/*
 * What is left of a swing, as part of that of one impulse at the end of the train: |sum of w
 * z^(length - c)|.
 */
static double left_of(const struct train *t, const struct shape_mode *mode)
{
    const double w = MATHS_TWO_PI * mode->hz * CYCLE_S;
    const double turn = w * maths_sqrt(1 - mode->damping * mode->damping);
    double re = 0, im = 0;

    for (uint32_t i = 0; i < t->count; i++) {
        const double n = (double)takt_train_length(t) - (double)t->impulse[i].cycles;
        const double size = t->impulse[i].weight * takt_maths_exp(-mode->damping * w * n);

        re += size * takt_maths_cos(turn * n);
        im += size * takt_maths_sin(turn * n);
    }
    return maths_sqrt(re * re + im * im);
}

static double sum_of(const struct train *t)
{
    double sum = 0;

    for (uint32_t i = 0; i < t->count; i++)
        sum += t->impulse[i].weight;
    return sum;
}

static void test_zv_leaves_nothing_of_a_mode_whatever_its_period_is_of_a_cycle(void)
{
    for (unsigned i = 0; i < CASES; i++) {
        const struct shape_mode mode = random_mode();
        struct train t;

        takt_zv_train(&mode, CYCLE_S, &t);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, left_of(&t, &mode));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, sum_of(&t));
        TEST_ASSERT_TRUE(takt_train_below_zero(&t) == 0);
        TEST_ASSERT_TRUE(takt_train_length(&t) <= 0.5 * takt_zv_period(&mode, CYCLE_S) + 1);
    }
}

/*
 * Residuals of the textbook: MZV none, EI 5 %, but for standing between cycles: (w tau)^2/8 at
 * most.
 */
static void test_classic_trains_leave_what_the_textbook_says(void)
{
    for (unsigned i = 0; i < CASES; i++) {
        const struct shape_mode mode = {between(10, 60), 0, 1};
        const double angle = MATHS_TWO_PI * mode.hz * CYCLE_S;
        struct train t;

        takt_shapers_mzv(&mode, CYCLE_S, &t);
        TEST_ASSERT_DOUBLE_WITHIN(angle * angle / 8, 0, left_of(&t, &mode));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, sum_of(&t));
        takt_shapers_ei(&mode, CYCLE_S, &t);
        TEST_ASSERT_DOUBLE_WITHIN(angle * angle / 8, 0.05, left_of(&t, &mode));
    }
}

static void test_two_modes_of_an_axis_are_both_met(void)
{
    for (unsigned i = 0; i < CASES; i++) {
        for (unsigned n = 0; n < SHAPE_MODES; n++) {
            config.mode[AXIS_X][n] = random_mode();
            config.mode[AXIS_X][n].part = 0.5;
        }
        config.keeps_way = i % 2 == 1;
        TEST_ASSERT_NULL(takt_shape_init(&shape, &config));
        for (unsigned n = 0; n < SHAPE_MODES; n++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0,
                                      left_of(&shape.train[AXIS_X], &config.mode[AXIS_X][n]));
    }
}

static void test_all_axes_are_equally_late(void)
{
    config.mode[AXIS_X][0] = (struct shape_mode){11.3, 0.05, 1};
    config.mode[AXIS_Y][0] = (struct shape_mode){57.9, 0.02, 1};
    config.mode[AXIS_Y][1] = (struct shape_mode){33.1, 0.02, 0.3};
    takt_shape_init(&shape, &config);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, takt_train_mean(&shape.train[AXIS_X]),
                                  takt_train_mean(&shape.train[i]));
}

/* Part/w^2 of the mode is half the spread. */
static void test_the_neutral_train_bends_a_way_as_the_mode_bends_it_back(void)
{
    config.keeps_way = true;
    for (unsigned i = 0; i < CASES; i++) {
        const struct shape_mode mode = random_mode();
        const double angle = MATHS_TWO_PI * mode.hz * CYCLE_S;

        config.mode[AXIS_X][0] = mode;
        takt_shape_init(&shape, &config);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2 / (angle * angle),
                                  takt_train_spread(&shape.train[AXIS_X]));
        TEST_ASSERT_TRUE(takt_train_below_zero(&shape.train[AXIS_X]) < 0.05);
    }
}

static void test_an_axis_at_rest_is_sent_where_it_is_to_the_last_bit(void)
{
    const struct point at = {{0.1, 1.0 / 3.0, -77.7, 0.3, 0, 2e-5}};
    struct point set = {{0}};

    config.keeps_way = true;
    config.mode[AXIS_X][0] = random_mode();
    config.mode[AXIS_Z][0] = random_mode();
    takt_shape_init(&shape, &config);
    TEST_ASSERT_TRUE(takt_shape_is_settled(&shape));
    set = at;
    takt_shape_cycle(&shape, &set);
    TEST_ASSERT_FALSE(point_is_same(&set, &at));
    TEST_ASSERT_FALSE(takt_shape_is_settled(&shape));
    for (uint32_t n = 0; n < shape.cycles; n++) {
        set = at;
        TEST_ASSERT_FALSE(takt_shape_is_settled(&shape));
        takt_shape_cycle(&shape, &set);
        TEST_ASSERT_TRUE(point_is_same(takt_shape_input(&shape), &at));
    }
    TEST_ASSERT_TRUE(takt_shape_is_settled(&shape));
    TEST_ASSERT_TRUE(point_is_same(&set, &at));
}

static void test_a_restart_forgets_what_came_before(void)
{
    const struct point there = {{5, 6, 7, 0, 0, 0}};
    struct point set = {{1, 2, 3, 0, 0, 0}};

    config.mode[AXIS_X][0] = random_mode();
    takt_shape_init(&shape, &config);
    takt_shape_cycle(&shape, &set);
    takt_shape_restart(&shape, &there);
    set = there;
    takt_shape_cycle(&shape, &set);
    TEST_ASSERT_TRUE(point_is_same(&set, &there));
    TEST_ASSERT_TRUE(takt_shape_is_settled(&shape));
}

static void test_trains_without_negative_weights_take_nothing_of_the_limits(void)
{
    struct plan_limits limits = {
        .velocity_mm_s = {100}, .acceleration_mm_s2 = {1000}, .jerk_mm_s3 = {50000}};

    config.mode[AXIS_X][0] = (struct shape_mode){25, 0.03, 1};
    takt_shape_init(&shape, &config);
    takt_shape_leave(&shape, &limits);
    TEST_ASSERT_TRUE(limits.velocity_mm_s[AXIS_X] == 100);
    TEST_ASSERT_TRUE(limits.acceleration_mm_s2[AXIS_X] == 1000);
    TEST_ASSERT_TRUE(limits.jerk_mm_s3[AXIS_X] == 50000);
}

/* 1 + 2 m, m = (pi^2/4 - 2)/(2 pi^2) of a mode without damping. */
static void test_the_neutral_train_takes_a_twentieth_at_most(void)
{
    struct plan_limits limits = {
        .velocity_mm_s = {100}, .acceleration_mm_s2 = {1000}, .jerk_mm_s3 = {50000}};

    config.keeps_way = true;
    config.mode[AXIS_X][0] = (struct shape_mode){25, 0.03, 1};
    takt_shape_init(&shape, &config);
    takt_shape_leave(&shape, &limits);
    TEST_ASSERT_DOUBLE_WITHIN(50, 50000 / 1.0473, limits.jerk_mm_s3[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1, 1000 / 1.0473, limits.acceleration_mm_s2[AXIS_X]);
    TEST_ASSERT_TRUE(limits.velocity_mm_s[AXIS_X] > 98);
}

static void test_modes_that_do_not_fit_the_cycle_are_refused(void)
{
    config.mode[AXIS_X][0] = (struct shape_mode){251, 0.03, 1};
    TEST_ASSERT_NOT_NULL(takt_shape_init(&shape, &config));
    config.mode[AXIS_X][0].hz = 250;
    TEST_ASSERT_NULL(takt_shape_init(&shape, &config));
    config.mode[AXIS_X][0].hz = 1e-9;
    TEST_ASSERT_NOT_NULL(takt_shape_init(&shape, &config));
    config.mode[AXIS_X][0].hz = config.mode[AXIS_X][1].hz = 1.9;
    config.keeps_way = true;
    TEST_ASSERT_NOT_NULL(takt_shape_init(&shape, &config));
    config.mode[AXIS_X][1].hz = 0;
    TEST_ASSERT_NULL(takt_shape_init(&shape, &config));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_zv_leaves_nothing_of_a_mode_whatever_its_period_is_of_a_cycle);
    RUN_TEST(test_classic_trains_leave_what_the_textbook_says);
    RUN_TEST(test_two_modes_of_an_axis_are_both_met);
    RUN_TEST(test_all_axes_are_equally_late);
    RUN_TEST(test_the_neutral_train_bends_a_way_as_the_mode_bends_it_back);
    RUN_TEST(test_an_axis_at_rest_is_sent_where_it_is_to_the_last_bit);
    RUN_TEST(test_a_restart_forgets_what_came_before);
    RUN_TEST(test_trains_without_negative_weights_take_nothing_of_the_limits);
    RUN_TEST(test_the_neutral_train_takes_a_twentieth_at_most);
    RUN_TEST(test_modes_that_do_not_fit_the_cycle_are_refused);
    return UNITY_END();
}
