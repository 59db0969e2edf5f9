/* Modes are found again in what closed forms say an accelerometer would measure. */
#include "base/maths.h"
#include "resonance/fit.h"

#include <math.h>
#include <unity.h>

#define CYCLE_S 0.001
#define CYCLES  4000
#define STEP_MM 0.1
#define EVERY   800 /* cycles from step to step of the foot */

static struct resonance_record record;
static double tool_mm[CYCLES];

void setUp(void)
{
    record = (struct resonance_record){.cycle_s = CYCLE_S};
}

void tearDown(void)
{
    resonance_record_free(&record);
}

static double foot_at(int k)
{
    return k < EVERY ? 0 : STEP_MM * ((k / EVERY) % 2);
}

/*
 * Behind a change D of its foot's velocity a mode is away by -D exp(-d w t) sin(v t) / v, v = w
 * sqrt(1 - d^2). A step in one cycle is two of them.
 */
static double away_at(int k, double hz, double damping)
{
    const double w = 2 * MATHS_PI * hz, v = w * sqrt(1 - damping * damping);
    double away = 0;

    for (int from = 1; from <= k; from++) {
        const double now = (foot_at(from) - foot_at(from - 1)) / CYCLE_S;
        const double before = from > 1 ? (foot_at(from - 1) - foot_at(from - 2)) / CYCLE_S : 0;
        const double t = (k - from + 1) * CYCLE_S;

        if (now != before)
            away -= (now - before) * exp(-damping * w * t) * sin(v * t) / v;
    }
    return away;
}

static double noise(void)
{
    static unsigned state = 1;

    state = state * 1664525U + 1013904223U;
    return (double)state / 4294967296.0 - 0.5;
}

/* up to two modes of {hz, damping, part}; amplitude of noise, mm/s2 */
static void measure(const double modes[][3], unsigned count, double noise_mm_s2)
{
    for (int k = 0; k < CYCLES; k++) {
        tool_mm[k] = foot_at(k);
        for (unsigned m = 0; m < count; m++)
            tool_mm[k] += modes[m][2] * away_at(k, modes[m][0], modes[m][1]);
    }
    for (int k = 1; k + 1 < CYCLES; k++)
        resonance_record_add(&record, foot_at(k),
                             (tool_mm[k + 1] - 2 * tool_mm[k] + tool_mm[k - 1]) /
                                     (CYCLE_S * CYCLE_S) +
                                 2 * noise_mm_s2 * noise());
}

static void assert_mode(const double wanted[3], const struct resonance_mode *got, double ratio)
{
    TEST_ASSERT_DOUBLE_WITHIN(ratio * wanted[0], wanted[0], got->hz.value);
    TEST_ASSERT_DOUBLE_WITHIN(20 * ratio * wanted[1], wanted[1], got->damping.value);
    TEST_ASSERT_DOUBLE_WITHIN(20 * ratio, wanted[2], got->part.value);
}

static void test_one_mode(void)
{
    const double mode[1][3] = {{23.7, 0.034, 0.8}};
    struct resonance_fit fit;

    measure(mode, 1, 0);
    TEST_ASSERT_TRUE(resonance_fit(&record, &fit));
    TEST_ASSERT_TRUE(fit.modes >= 1);
    assert_mode(mode[0], &fit.mode[0], 1e-6);
}

static void test_two_modes_from_the_lower(void)
{
    const double modes[2][3] = {{41.5, 0.06, 0.4}, {17.2, 0.025, 0.6}};
    struct resonance_fit fit;

    measure(modes, 2, 0.5);
    TEST_ASSERT_TRUE(resonance_fit(&record, &fit));
    TEST_ASSERT_EQUAL_UINT(2, fit.modes);
    assert_mode(modes[1], &fit.mode[0], 1e-3);
    assert_mode(modes[0], &fit.mode[1], 1e-3);
}

static void test_deviations_are_what_noise_makes(void)
{
    const double mode[1][3] = {{30, 0.05, 1}};
    struct resonance_fit fit;
    unsigned within = 0;

    for (int i = 0; i < 20; i++) {
        setUp();
        measure(mode, 1, 50);
        TEST_ASSERT_TRUE(resonance_fit(&record, &fit));
        TEST_ASSERT_EQUAL_UINT(1, fit.modes);
        TEST_ASSERT_DOUBLE_WITHIN(3, 50 / sqrt(3), fit.left_mm_s2); /* of even noise */
        within += fabs(fit.mode[0].hz.value - 30) < 2 * fit.mode[0].hz.deviation;
        resonance_record_free(&record);
    }
    TEST_ASSERT_TRUE(within >= 16); /* 95 of 100 on the average */
}

static void test_no_mode_in_noise(void)
{
    struct resonance_fit fit;

    measure(NULL, 0, 100);
    TEST_ASSERT_TRUE(resonance_fit(&record, &fit));
    TEST_ASSERT_EQUAL_UINT(0, fit.modes);
}

static void test_nothing_measured_is_said(void)
{
    struct resonance_fit fit;

    TEST_ASSERT_FALSE(resonance_fit(&record, &fit));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_one_mode);
    RUN_TEST(test_two_modes_from_the_lower);
    RUN_TEST(test_deviations_are_what_noise_makes);
    RUN_TEST(test_no_mode_in_noise);
    RUN_TEST(test_nothing_measured_is_said);
    return UNITY_END();
}
