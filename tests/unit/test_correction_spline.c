/* Splines and fades: smooth, exact where they must be, and bounded. */
#include "correction/fade.h"
#include "correction/spline.h"
#include "unity.h"

#include <math.h>
#include <stdint.h>

void setUp(void)
{
}

void tearDown(void)
{
}

/* The spline at x, from its bends. */
static double spline_at(unsigned count, const double *knot, const double *value, const double *bend,
                        double x)
{
    unsigned i = 0;

    while (i + 2 < count && x >= knot[i + 1])
        i++;
    const double h = knot[i + 1] - knot[i], t = (x - knot[i]) / h, s = 1 - t;

    return s * value[i] + t * value[i + 1] +
           h * h / 6 * ((s * s * s - s) * bend[i] + (t * t * t - t) * bend[i + 1]);
}

static double cubic(double x)
{
    return 3 - 2 * x + 0.5 * x * x - 0.25 * x * x * x;
}

static void test_a_cubic_through_uneven_points_is_reproduced(void)
{
    const double knot[] = {-2, -1.5, 0, 0.25, 3, 4};
    double value[6], bend[6];

    for (unsigned i = 0; i < 6; i++)
        value[i] = cubic(knot[i]);
    takt_spline_second_derivatives(6, knot, value, bend);
    for (int i = 0; i <= 600; i++) {
        const double x = -2 + 0.01 * i;

        TEST_ASSERT_DOUBLE_WITHIN(1e-12, cubic(x), spline_at(6, knot, value, bend, x));
    }
}

static void test_a_cubic_through_four_points_is_reproduced(void)
{
    const double knot[] = {0, 1, 3, 4};
    double value[4], bend[4];

    for (unsigned i = 0; i < 4; i++)
        value[i] = cubic(knot[i]);
    takt_spline_second_derivatives(4, knot, value, bend);
    for (int i = 0; i <= 400; i++) {
        const double x = 0.01 * i;

        TEST_ASSERT_DOUBLE_WITHIN(1e-12, cubic(x), spline_at(4, knot, value, bend, x));
    }
}

static void test_three_points_make_a_parabola_and_two_a_line(void)
{
    const double knot[] = {0, 1, 4}, value[] = {1, 0, 9}; /* (x - 1)^2 */
    double bend[3];

    takt_spline_second_derivatives(3, knot, value, bend);
    for (unsigned i = 0; i < 3; i++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, 2.0, bend[i]);
    takt_spline_second_derivatives(2, knot, value, bend);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bend[0]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bend[1]);
}

static void test_a_spline_is_continuous_with_two_derivatives(void)
{
    const double knot[] = {0, 2, 3, 7, 8, 12, 13};
    const double value[] = {0, 5, -3, 4, 4, -6, 2};
    double bend[7];

    takt_spline_second_derivatives(7, knot, value, bend);
    for (unsigned i = 1; i < 6; i++) {
        const double d = 1e-4, x = knot[i];
        const double y[5] = {spline_at(7, knot, value, bend, x - 2 * d),
                             spline_at(7, knot, value, bend, x - d), value[i],
                             spline_at(7, knot, value, bend, x + d),
                             spline_at(7, knot, value, bend, x + 2 * d)};

        TEST_ASSERT_DOUBLE_WITHIN(1e-2, (y[2] - y[1]) / d, (y[3] - y[2]) / d);
        TEST_ASSERT_DOUBLE_WITHIN(2e-2, (y[2] - 2 * y[1] + y[0]) / (d * d),
                                  (y[4] - 2 * y[3] + y[2]) / (d * d));
    }
}

static void test_a_fade_comes_to_its_target_exactly_and_does_not_overshoot(void)
{
    struct fade f = {0.0, 0.0, 0.0};
    struct fade_pace pace;
    unsigned cycles = 0, at_99 = 0;

    takt_fade_pace_set(&pace, 0.5, 0.001);
    while (fade_cycle(&f, 1.0, &pace)) {
        cycles++;
        if (f.value < 0.99)
            at_99 = cycles;
        TEST_ASSERT_TRUE(f.value >= 0.0 && f.value < 1.0 + 2e-5);
        TEST_ASSERT_TRUE(cycles < 5000);
    }
    TEST_ASSERT_TRUE(fade_is_at(&f, 1.0));
    TEST_ASSERT_UINT32_WITHIN(10, 500, at_99);
}

/* xorshift64 */
static uint64_t random_next(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return *state;
}

static void raise_to(double *most, double value)
{
    if (fabs(value) > *most)
        *most = fabs(value);
}

static void test_a_fade_keeps_its_bounds_however_its_target_jumps(void)
{
    const double cycle_s = 0.001;
    double v = 0, a = 0, j = 0, x[4] = {0};
    uint64_t state = 42;
    struct fade f = {0.0, 0.0, 0.0};
    struct fade_pace pace;
    double target = 1.0;

    takt_fade_pace_set(&pace, 0.3, cycle_s);
    for (int k = 0; k < 1000000; k++) {
        if (random_next(&state) % 60 == 0)
            target = 1.0 - target;
        (void)fade_cycle(&f, target, &pace);
        x[3] = x[2], x[2] = x[1], x[1] = x[0], x[0] = f.value;
        if (k < 4)
            continue;
        raise_to(&v, (x[0] - x[1]) / cycle_s);
        raise_to(&a, (x[0] - 2 * x[1] + x[2]) / (cycle_s * cycle_s));
        raise_to(&j, (x[0] - 3 * x[1] + 3 * x[2] - x[3]) / (cycle_s * cycle_s * cycle_s));
    }
    TEST_ASSERT_TRUE(v <= takt_fade_velocity_per_s(&pace));
    TEST_ASSERT_TRUE(a <= takt_fade_acceleration_per_s2(&pace));
    TEST_ASSERT_TRUE(j <= takt_fade_jerk_per_s3(&pace));
    TEST_ASSERT_TRUE(v > 0.8 * takt_fade_velocity_per_s(&pace)); /* the bounds are not idle */
    TEST_ASSERT_TRUE(j > 0.7 * takt_fade_jerk_per_s3(&pace));
}

static void test_a_fade_takes_forty_cycles_at_least(void)
{
    struct fade_pace pace;

    takt_fade_pace_set(&pace, 0.0, 0.001);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 8.406 / FADE_CYCLES_MIN, pace.rate);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_cubic_through_uneven_points_is_reproduced);
    RUN_TEST(test_a_cubic_through_four_points_is_reproduced);
    RUN_TEST(test_three_points_make_a_parabola_and_two_a_line);
    RUN_TEST(test_a_spline_is_continuous_with_two_derivatives);
    RUN_TEST(test_a_fade_comes_to_its_target_exactly_and_does_not_overshoot);
    RUN_TEST(test_a_fade_keeps_its_bounds_however_its_target_jumps);
    RUN_TEST(test_a_fade_takes_forty_cycles_at_least);
    return UNITY_END();
}
