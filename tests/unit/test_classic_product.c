/*
 * The source's feed: S-curve, diagram of a block with kl, limiter of axis velocities. By hand, and
 * by sums.
 */
#include "classic/diagram.h"
#include "classic/limiter.h"
#include "classic/product.h"
#include "classic/s_curve.h"

#include "base/maths.h"
#include "motion/handover.h"

#include <string.h>
#include <unity.h>

#define CYCLE_S 1e-3

static const struct plan_limits mill = {
    7,       {100, 100, 100}, {1000, 1000, 1000}, {50000, 50000, 50000},
    CYCLE_S, CYCLE_S,         RAMP_PROFILE_JERK,  LANDING_SCALE};

static struct path path;
static struct motion motion;
static struct product product;
static struct motion_operator asked;
static struct cycle_record record;

void setUp(void)
{
    const struct product_config config = {.limiter = LIMITER_CEILING, .cycle_s = CYCLE_S};
    const struct point start = {{0}};

    takt_path_init(&path, &mill, &start);
    takt_motion_init(&motion, &path, &start, false);
    takt_handover_allow(&motion, MOTION_HANDS_OVER_ALL);
    takt_product_init(&product, &config);
    record = (struct cycle_record){0};
    asked = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
}

void tearDown(void)
{
}

static const struct diagram_limits limits = {
    .length_mm = 10.0, .feed_mm_s = 100.0, .a_mm_s2 = 1000.0, .j_mm_s3 = 50000.0};

/* a = 1000, j = 50000: a is reached from 20 mm/s on. */
static void test_a_ramp_takes_the_time_of_the_formula(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(2.0 * maths_sqrt(10.0 / 50000.0), takt_diagram_ramp_s(&limits, 10.0));
    TEST_ASSERT_EQUAL_DOUBLE(0.1 + 0.02, takt_diagram_ramp_s(&limits, 100.0));
    TEST_ASSERT_EQUAL_DOUBLE(0.04, takt_diagram_ramp_s(&limits, 20.0));
}

static void test_the_integral_of_an_s_curve_is_its_sum(void)
{
    static const double rounds[] = {0.1, 0.3, 0.5};

    for (unsigned r = 0; r < 3; r++) {
        double sum = 0.0;

        for (unsigned i = 0; i < 1000; i++) {
            sum += 1e-3 * takt_s_curve(1e-3 * (i + 0.5), rounds[r]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, sum, takt_s_curve_integral(1e-3 * (i + 1), rounds[r]));
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, takt_s_curve_integral(1.0, rounds[r]));
    }
}

/* Whole cycles, kl from the way, and mid-cycle samples that add up to the length. */
static void check_diagram(double length, double start, double end)
{
    struct diagram_limits l = limits;
    struct diagram d;
    double sum = 0.0;

    l.length_mm = length;
    takt_diagram_set(&d, &l, start, end, CYCLE_S);
    const double cycles = takt_diagram_time(&d) / CYCLE_S;

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, takt_maths_round(cycles), cycles);
    TEST_ASSERT_TRUE(d.kl <= 1.0 + 1e-9 && d.kl > 0.0);
    TEST_ASSERT_TRUE(d.cruise_mm_s >= start && d.cruise_mm_s >= end && d.cruise_mm_s <= 100.0);
    for (unsigned i = 0; i < (unsigned)takt_maths_round(cycles); i++) {
        sum += takt_diagram_feed(&d, (i + 0.5) * CYCLE_S) * CYCLE_S;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9 * length, length, takt_diagram_way(&d, takt_diagram_time(&d)));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * length, length, sum);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, d.kl * start, takt_diagram_feed(&d, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, d.kl * end, takt_diagram_feed(&d, takt_diagram_time(&d)));
}

static void test_a_diagram_lasts_whole_cycles_and_ends_at_the_end(void)
{
    check_diagram(10.0, 0.0, 0.0);
    check_diagram(33.3, 20.0, 100.0);
    check_diagram(33.3, 100.0, 7.0);
    check_diagram(0.5, 0.0, 0.0);
    check_diagram(0.01, 0.0, 0.0);
    check_diagram(0.25, 100.0, 100.0);
    check_diagram(123.4, 0.0, 50.0);
}

/* 0.25 mm at 100 mm/s are 2.5 cycles: three, and kl = 2.5/3. */
static void test_kl_stretches_a_part_of_a_cycle_to_a_whole_one(void)
{
    struct diagram_limits l = limits;
    struct diagram d;

    l.length_mm = 0.25;
    takt_diagram_set(&d, &l, 100.0, 100.0, CYCLE_S);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.5 / 3.0, d.kl);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 250.0 / 3.0, takt_diagram_feed(&d, 1.5e-3));
}

static void test_a_block_that_is_too_short_for_its_feed_has_no_even_part(void)
{
    struct diagram d;

    takt_diagram_set(&d, &limits, 0.0, 0.0, CYCLE_S);
    TEST_ASSERT_TRUE(d.cruise_mm_s < 100.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, d.up_s, d.down_s);
    TEST_ASSERT_TRUE(takt_diagram_brakes(&d, d.up_s + d.even_s + 0.5 * CYCLE_S));
    TEST_ASSERT_FALSE(takt_diagram_brakes(&d, d.up_s));
}

/* (v/a + a/j) v/2 = L */
static void test_reach_is_the_feed_whose_ramp_is_as_long_as_the_block(void)
{
    struct diagram_limits l = limits;

    l.length_mm = 5.0;
    const double v = takt_diagram_reach(&l, 0.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5.0, 0.5 * v * (v / 1000.0 + 0.02));
    TEST_ASSERT_TRUE(takt_diagram_reach(&l, 95.0) == 100.0);
}

static void test_the_threshold_cuts_and_nothing_else(void)
{
    TEST_ASSERT_TRUE(takt_limiter_axis(LIMITER_THRESHOLD, 99.9, 100.0, 5) == 1.0);
    TEST_ASSERT_EQUAL_DOUBLE(100.0 / 120.0, takt_limiter_axis(LIMITER_THRESHOLD, 120.0, 100.0, 5));
    TEST_ASSERT_TRUE(takt_limiter_axis(LIMITER_CEILING, 120.0, 100.0, 5) == 1.0);
}

/* What comes out, F K: with slope 1 below the band and 0 above it, both of them without a bend. */
static void check_bends(double band, uint8_t band_percent)
{
    const double h = 1e-4 * band;
    const double ends[] = {100.0 - band, 100.0 + band};

    for (unsigned i = 0; i < 2; i++) {
        double out[5];

        for (int k = 0; k < 5; k++) {
            const double f = ends[i] + (k - 2) * h;

            out[k] = f * takt_limiter_axis(LIMITER_SMOOTH, f, 100.0, band_percent);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, i == 0 ? 1.0 : 0.0, (out[3] - out[1]) / (2.0 * h));
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, (out[3] - 2.0 * out[2] + out[1]) / (h * h) * band);
    }
    TEST_ASSERT_DOUBLE_WITHIN(
        1e-9, 100.0 - band,
        (100.0 - band) * takt_limiter_axis(LIMITER_SMOOTH, 100.0 - band, 100.0, band_percent));
    TEST_ASSERT_DOUBLE_WITHIN(
        1e-9, 100.0,
        (100.0 + band) * takt_limiter_axis(LIMITER_SMOOTH, 100.0 + band, 100.0, band_percent));
}

static void test_the_smooth_form_bends_twice_without_a_corner(void)
{
    check_bends(5.0, 5);
    check_bends(1.0, 1);
    check_bends(50.0, 50);
    check_bends(99.0, LIMITER_BAND_PERCENT_MAX);
}

/* At F_max, x = 1/2 and k = 1/4 - 1/16: F K = F_max - d + 13/16 d. */
static void test_at_the_limit_the_smooth_form_takes_three_sixteenths_of_its_band(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0 - 0.05 * 3.0 / 16.0,
                              takt_limiter_axis(LIMITER_SMOOTH, 100.0, 100.0, 5));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0 - 0.40 * 3.0 / 16.0,
                              takt_limiter_axis(LIMITER_SMOOTH, 3.0, 3.0, 40));
}

static void test_a_band_without_width_is_a_threshold(void)
{
    for (unsigned k = 1; k < 400; k++) {
        const double f = 0.5 * (double)k;

        TEST_ASSERT_TRUE(takt_limiter_axis(LIMITER_SMOOTH, f, 100.0, 0) ==
                         takt_limiter_axis(LIMITER_THRESHOLD, f, 100.0, 0));
    }
}

static void test_the_least_factor_of_the_axes_counts(void)
{
    const double most[AXIS_COUNT] = {100.0, 50.0, 0.0};
    const struct point velocity = {{-110.0, 60.0, 1000.0}};

    const uint8_t narrow[AXIS_COUNT] = {0}, wide_x[AXIS_COUNT] = {99, 0};

    TEST_ASSERT_EQUAL_DOUBLE(50.0 / 60.0,
                             takt_limiter_factor(LIMITER_THRESHOLD, &velocity, most, narrow));
    TEST_ASSERT_EQUAL_DOUBLE(50.0 / 60.0,
                             takt_limiter_factor(LIMITER_SMOOTH, &velocity, most, narrow));
    TEST_ASSERT_TRUE(takt_limiter_factor(LIMITER_SMOOTH, &velocity, most, wide_x) < 50.0 / 60.0);
}

/* Along X, at 100 mm/s. */
static void push(double x)
{
    const struct move m = {.kind = MOVE_FEED,
                           .end = {{x}},
                           .feed_mm_s = 100.0,
                           .overrides = OVERRIDE_FEED | OVERRIDE_HOLD,
                           .turns = 1};

    takt_path_push(&path, &m);
}

static void push_end(void)
{
    const struct move m = {.kind = MOVE_END};

    takt_path_push(&path, &m);
    takt_path_finish(&path);
}

static void cycle(void)
{
    if (takt_motion_wanted(&motion) != NULL) {
        takt_path_go_on(&path);
        takt_motion_build(&motion);
    }
    if (takt_motion_cycle(&motion, &asked, &record) == MOTION_HANDED_OVER) {
        takt_product_cycle(&product, &motion, &asked, &record);
    }
}

static void run_to(double x)
{
    for (unsigned i = 0; i < 10000 && record.cmd.at[AXIS_X] < x; i++) {
        cycle();
    }
    TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] >= x);
}

/* 50 mm/s fewer at 1000 mm/s2 and 50000 mm/s3: 0.05 s + 0.02 s. */
static void test_the_override_changes_feed_by_the_limits_of_the_block(void)
{
    unsigned cycles = 0;

    push(300.0);
    push_end();
    run_to(50.0);
    asked.feed_ratio = 0.5;
    while (cycles < 1000 && record.override_percent != 50.0) {
        const double before = record.feed_mm_s;

        cycle();
        cycles++;
        TEST_ASSERT_TRUE(before - record.feed_mm_s <= 1.001 * 1000.0 * CYCLE_S);
    }
    TEST_ASSERT_UINT_WITHIN(1, 70, cycles);
}

/* Braking begins at 44: the override has got 3 mm on its way by then, and stands still. */
static void test_behind_a_stop_the_override_is_at_once_as_wanted(void)
{
    push(50.0);
    push(0.0);
    push_end();
    run_to(41.0);
    asked.feed_ratio = 0.5;
    run_to(50.0);
    TEST_ASSERT_TRUE(record.override_percent > 60.0);
    for (unsigned i = 0; i < 10 && record.cmd.at[AXIS_X] == 50.0; i++) {
        cycle();
    }
    TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] < 50.0);
    for (unsigned i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(50.0, record.override_percent);
        cycle();
    }
}

/* From 10 mm/s to rest at 50000 mm/s3 takes 2 sqrt(10 / 50000) s, at 5 mm/s in the mean. */
static void test_the_end_of_what_is_known_is_taken_for_a_stop(void)
{
    const double way = 10.0 * maths_sqrt(10.0 / 50000.0);

    push(100.0);
    push(100.0 + way);
    push(200.0);
    run_to(50.0);
    TEST_ASSERT_EQUAL_UINT(2, path.closed - path.first);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 10.0, product.diagram.end_mm_s);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_ramp_takes_the_time_of_the_formula);
    RUN_TEST(test_the_integral_of_an_s_curve_is_its_sum);
    RUN_TEST(test_a_diagram_lasts_whole_cycles_and_ends_at_the_end);
    RUN_TEST(test_kl_stretches_a_part_of_a_cycle_to_a_whole_one);
    RUN_TEST(test_a_block_that_is_too_short_for_its_feed_has_no_even_part);
    RUN_TEST(test_reach_is_the_feed_whose_ramp_is_as_long_as_the_block);
    RUN_TEST(test_the_threshold_cuts_and_nothing_else);
    RUN_TEST(test_the_smooth_form_bends_twice_without_a_corner);
    RUN_TEST(test_at_the_limit_the_smooth_form_takes_three_sixteenths_of_its_band);
    RUN_TEST(test_a_band_without_width_is_a_threshold);
    RUN_TEST(test_the_least_factor_of_the_axes_counts);
    RUN_TEST(test_the_override_changes_feed_by_the_limits_of_the_block);
    RUN_TEST(test_behind_a_stop_the_override_is_at_once_as_wanted);
    RUN_TEST(test_the_end_of_what_is_known_is_taken_for_a_stop);
    return UNITY_END();
}
