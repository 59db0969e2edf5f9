/*
 * firmware/base/maths.h against itself and against what is known exactly. The digests at the end
 * are the same on every processor, or a bit differs.
 */
#include "base/fnv.h"
#include "random_bits.h"

#include <float.h>
#include <stdio.h>

/*
 * Whole numbers.
 */
static void check_whole(double x)
{
    TEST_ASSERT_TRUE(takt_maths_floor(x) == floor(x));
    TEST_ASSERT_TRUE(takt_maths_ceil(x) == ceil(x));
    TEST_ASSERT_TRUE(takt_maths_round(x) == round(x));
    if (fabs(x) < 0x1p31 - 0.5) {
        TEST_ASSERT_TRUE(maths_nearest(x) == round(x));
    }
}

static void test_floor_ceil_and_round_are_exact(void)
{
    static const double EDGES[] = {0.0,
                                   0.5,
                                   0.49999999999999994,
                                   0.99999999999999989,
                                   1.0,
                                   1.5,
                                   2.5,
                                   2147483647.5,
                                   4503599627370495.5,
                                   4503599627370496.0,
                                   4503599627370497.0,
                                   9007199254740993.0,
                                   9223372036854775808.0,
                                   1e300,
                                   0x1p-1074,
                                   HUGE_VAL};
    uint64_t state = 7;
    for (size_t i = 0; i < sizeof EDGES / sizeof EDGES[0]; i++) {
        check_whole(EDGES[i]);
        check_whole(-EDGES[i]);
    }
    for (int i = 0; i < RANDOM_COUNT; i++) {
        check_whole(random_finite(&state));
        check_whole(random_between(&state, -1e6, 1e6));
        check_whole(0.5 * round(random_between(&state, -1e6, 1e6)));
    }
    TEST_ASSERT_TRUE(isnan(takt_maths_floor(NOT_A_NUMBER)) &&
                     isnan(takt_maths_ceil(NOT_A_NUMBER)) && isnan(takt_maths_round(NOT_A_NUMBER)));
}

/*
 * Identities and special values.
 */
static void test_quarter_turns_of_atan2_are_the_doubles_nearest_to_them(void)
{
    TEST_ASSERT_TRUE(takt_maths_atan2(0.0, 0.0) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_atan2(0.0, 1.0) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_atan2(3.0, 0.0) == MATHS_HALF_PI);
    TEST_ASSERT_TRUE(takt_maths_atan2(-3.0, 0.0) == -MATHS_HALF_PI);
    TEST_ASSERT_TRUE(takt_maths_atan2(0.0, -5.0) == MATHS_PI);
    TEST_ASSERT_TRUE(takt_maths_atan2(-0.0, -5.0) == MATHS_PI);
    TEST_ASSERT_TRUE(takt_maths_atan2(0.1, 0.1) == 0.25 * MATHS_PI);
    TEST_ASSERT_TRUE(takt_maths_atan2(0.1, -0.1) == 0.75 * MATHS_PI);
    TEST_ASSERT_TRUE(takt_maths_atan2(-0.1, -0.1) == -0.75 * MATHS_PI);
}

static void test_atan2_does_not_change_with_the_length_of_the_vector(void)
{
    uint64_t state = 8;
    for (int i = 0; i < 10000; i++) {
        double y = random_between(&state, -1.0, 1.0);
        double x = random_between(&state, -1.0, 1.0);
        double angle = takt_maths_atan2(y, x);
        TEST_ASSERT_TRUE(takt_maths_atan2(y * 0x1p1010, x * 0x1p1010) == angle);
        TEST_ASSERT_TRUE(takt_maths_atan2(y * 0x1p-900, x * 0x1p-900) == angle);
        TEST_ASSERT_TRUE(takt_maths_atan2(-y, x) == -angle);
    }
}

static void test_sincos_gives_the_same_bits_as_sin_and_cos(void)
{
    uint64_t state = 9;
    for (int i = 0; i < RANDOM_COUNT; i++) {
        double x = random_between(&state, -1e5, 1e5);
        double sine, cosine;
        takt_maths_sincos(x, &sine, &cosine);
        TEST_ASSERT_TRUE(sine == takt_maths_sin(x));
        TEST_ASSERT_TRUE(cosine == takt_maths_cos(x));
        TEST_ASSERT_TRUE(takt_maths_sin(-x) == -sine);
        TEST_ASSERT_TRUE(takt_maths_cos(-x) == cosine);
    }
}

static void test_sine_and_cosine_stay_within_one(void)
{
    for (int n = -63661; n <= 63661; n++) {
        double x = n * MATHS_HALF_PI;
        TEST_ASSERT_TRUE(fabs(takt_maths_sin(x)) <= 1.0);
        TEST_ASSERT_TRUE(fabs(takt_maths_cos(x)) <= 1.0);
    }
    TEST_ASSERT_TRUE(takt_maths_sin(0.0) == 0.0 && takt_maths_cos(0.0) == 1.0);
    TEST_ASSERT_TRUE(takt_maths_sin(MATHS_HALF_PI) == 1.0);
    TEST_ASSERT_TRUE(takt_maths_cos(MATHS_PI) == -1.0);
    TEST_ASSERT_TRUE(takt_maths_sin(0x1p-1074) == 0x1p-1074);
}

static void test_cubes_of_integers_have_exact_roots(void)
{
    for (int n = -100000; n <= 100000; n++) {
        double cube = (double)n * n * n;
        TEST_ASSERT_TRUE(takt_maths_cbrt(cube) == n);
    }
    TEST_ASSERT_TRUE(takt_maths_cbrt(-HUGE_VAL) == -HUGE_VAL);
}

static void test_integer_powers_that_fit_are_exact(void)
{
    for (int base = 2; base <= 100; base++) {
        double exact = 1.0;
        for (int n = 0; exact < 0x1p53; n++) {
            TEST_ASSERT_TRUE(takt_maths_power(base, n) == exact);
            TEST_ASSERT_TRUE(takt_maths_power(-base, n) == (n % 2 == 0 ? exact : -exact));
            exact *= base;
        }
    }
    TEST_ASSERT_TRUE(takt_maths_power(2.0, -1074.0) == 0x1p-1074);
    TEST_ASSERT_TRUE(takt_maths_power(2.0, 1023.0) == 0x1p1023);
    TEST_ASSERT_TRUE(takt_maths_power(0.25, 0.5) == 0.5);
}

static void test_power_has_the_stated_special_values(void)
{
    TEST_ASSERT_TRUE(takt_maths_power(0.0, 0.0) == 1.0);
    TEST_ASSERT_TRUE(takt_maths_power(0.0, 2.0) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_power(0.0, -2.0) == HUGE_VAL);
    TEST_ASSERT_TRUE(takt_maths_power(HUGE_VAL, -1.0) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_power(HUGE_VAL, 1.0) == HUGE_VAL);
    TEST_ASSERT_TRUE(isnan(takt_maths_power(-2.0, 0.5)));
    TEST_ASSERT_TRUE(takt_maths_power(-2.0, 3.0) == -8.0);
    TEST_ASSERT_TRUE(takt_maths_power(2.0, 1e300) == HUGE_VAL);
    TEST_ASSERT_TRUE(takt_maths_power(2.0, -HUGE_VAL) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_power(1.0, HUGE_VAL) == 1.0);
    TEST_ASSERT_TRUE(takt_maths_power(1.0 - 0x1p-53, 1e300) == 0.0);
}

static void test_exp_and_ln_have_the_stated_special_values(void)
{
    TEST_ASSERT_TRUE(takt_maths_exp(0.0) == 1.0);
    TEST_ASSERT_TRUE(takt_maths_exp(710.0) == HUGE_VAL);
    TEST_ASSERT_TRUE(takt_maths_exp(HUGE_VAL) == HUGE_VAL);
    TEST_ASSERT_TRUE(takt_maths_exp(-746.0) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_exp(-HUGE_VAL) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_ln(1.0) == 0.0);
    TEST_ASSERT_TRUE(takt_maths_ln(HUGE_VAL) == HUGE_VAL);
    TEST_ASSERT_TRUE(isnan(takt_maths_ln(0.0)) && isnan(takt_maths_ln(-1.0)));
}

static void test_arguments_outside_the_domain_give_not_a_number(void)
{
    static double (*const FUNCTIONS[])(double) = {takt_maths_sin,  takt_maths_cos,  takt_maths_tan,
                                                  takt_maths_asin, takt_maths_acos, takt_maths_cbrt,
                                                  takt_maths_exp,  takt_maths_ln};
    for (size_t i = 0; i < sizeof FUNCTIONS / sizeof FUNCTIONS[0]; i++)
        TEST_ASSERT_TRUE(isnan(FUNCTIONS[i](NOT_A_NUMBER)));
    TEST_ASSERT_TRUE(isnan(takt_maths_sin(HUGE_VAL)) && isnan(takt_maths_cos(-HUGE_VAL)));
    TEST_ASSERT_TRUE(isnan(takt_maths_asin(1.0000000000000002)) &&
                     isnan(takt_maths_acos(-1.0000000000000002)));
    TEST_ASSERT_TRUE(isnan(takt_maths_atan2(NOT_A_NUMBER, 1.0)) &&
                     isnan(takt_maths_atan2(1.0, NOT_A_NUMBER)));
    TEST_ASSERT_TRUE(isnan(takt_maths_atan2(HUGE_VAL, 1.0)) &&
                     isnan(takt_maths_atan2(1.0, HUGE_VAL)));
    TEST_ASSERT_TRUE(isnan(takt_maths_power(NOT_A_NUMBER, 0.0)) &&
                     isnan(takt_maths_power(1.0, NOT_A_NUMBER)));
    TEST_ASSERT_TRUE(takt_maths_asin(1.0) == MATHS_HALF_PI && takt_maths_acos(-1.0) == MATHS_PI);
    TEST_ASSERT_TRUE(takt_maths_acos(1.0) == 0.0 && takt_maths_asin(0.0) == 0.0);
}

/* Steps back by no more than the last bit where the method changes. */
static void check_never_falls(double (*function)(double), double low, double high)
{
    double before = function(low);
    for (int i = 1; i <= RANDOM_COUNT; i++) {
        double now = function(low + (high - low) * i / RANDOM_COUNT);
        TEST_ASSERT_TRUE(now >= before);
        before = now;
    }
}

static double atan_of(double x)
{
    return takt_maths_atan2(x, 1.0);
}

static void test_rising_functions_never_fall(void)
{
    check_never_falls(takt_maths_sin, -1.57, 1.57);
    check_never_falls(atan_of, -5.0, 5.0);
    check_never_falls(takt_maths_asin, -1.0, 1.0);
    check_never_falls(takt_maths_cbrt, -10.0, 10.0);
    check_never_falls(takt_maths_exp, -10.0, 10.0);
    check_never_falls(takt_maths_ln, 0.1, 10.0);
    check_never_falls(atan_of, 0.2499999, 0.2500001);
    check_never_falls(atan_of, 0.7199999, 0.7200001);
    check_never_falls(takt_maths_cbrt, 0.9999999, 1.0000001);
    check_never_falls(takt_maths_ln, 1.4142135, 1.4142136);
}

/*
 * The same bits everywhere.
 */
static double atan2_of_both(double x)
{
    return takt_maths_atan2(x, 3.0 - x);
}

static double power_of_both(double x)
{
    return takt_maths_power(maths_abs(x), 0.1 * x);
}

struct digest {
    const char *name;
    double (*function)(double);
    double low, high;
    uint64_t expected;
};

static const struct digest DIGESTS[] = {
    {"floor", takt_maths_floor, -100.0, 100.0, UINT64_C(0xe4b1d35abb7b4304)},
    {"ceil", takt_maths_ceil, -100.0, 100.0, UINT64_C(0x012f8f453cfead1c)},
    {"round", takt_maths_round, -100.0, 100.0, UINT64_C(0x399665facb3b0c79)},
    {"sin", takt_maths_sin, -1e5, 1e5, UINT64_C(0xc5753563a3d11efe)},
    {"cos", takt_maths_cos, -1e5, 1e5, UINT64_C(0x69004e94388d0552)},
    {"tan", takt_maths_tan, -10.0, 10.0, UINT64_C(0xec8e28df914f2dd0)},
    {"sin, large", takt_maths_sin, -1e18, 1e18, UINT64_C(0x9e610dc2ebb057a1)},
    {"atan2", atan2_of_both, -10.0, 10.0, UINT64_C(0xefd79d05a81d78b8)},
    {"asin", takt_maths_asin, -1.0, 1.0, UINT64_C(0x32912a0d12de043e)},
    {"acos", takt_maths_acos, -1.0, 1.0, UINT64_C(0xcc33ad60991616a4)},
    {"cbrt", takt_maths_cbrt, -1e6, 1e6, UINT64_C(0x89cd8261ffb0a687)},
    {"exp", takt_maths_exp, -745.0, 709.0, UINT64_C(0x3f3a9389547088dd)},
    {"ln", takt_maths_ln, 0.0, 1e6, UINT64_C(0xbe166e13b93bbab3)},
    {"power", power_of_both, -50.0, 50.0, UINT64_C(0x343cdd02afb756d2)},
};

static void test_results_have_the_same_bits_on_every_processor_and_compiler(void)
{
    bool all_equal = true;
    for (size_t i = 0; i < sizeof DIGESTS / sizeof DIGESTS[0]; i++) {
        const struct digest *d = &DIGESTS[i];
        uint64_t state = 10, digest = FNV_START;
        for (int k = 0; k < 10000; k++)
            digest =
                takt_fnv_add_double(digest, d->function(random_between(&state, d->low, d->high)));
        if (digest != d->expected) {
            printf("%s: digest 0x%016llx\n", d->name, (unsigned long long)digest);
            all_equal = false;
        }
    }
    TEST_ASSERT_TRUE_MESSAGE(all_equal, "some digest differs, see above");
}

static void test_the_float_below_a_number_is_the_nearest_that_is_not_above_it(void)
{
    uint64_t state = 21;

    for (int k = 0; k < RANDOM_COUNT; k++) {
        const double x = fabs(random_finite(&state));
        const float f = takt_maths_float_below(x);

        TEST_ASSERT_TRUE((double)f <= x);
        TEST_ASSERT_TRUE((double)nextafterf(f, INFINITY) > x);
    }
    TEST_ASSERT_TRUE(takt_maths_float_below(0.1) < 0.1F);
    TEST_ASSERT_TRUE(takt_maths_float_below(0.5) == 0.5F);
    TEST_ASSERT_TRUE(takt_maths_float_below(0.0) == 0.0F);
    TEST_ASSERT_TRUE(takt_maths_float_below(1e300) == FLT_MAX);
    TEST_ASSERT_TRUE(takt_maths_float_below((double)INFINITY) == INFINITY);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_floor_ceil_and_round_are_exact);
    RUN_TEST(test_quarter_turns_of_atan2_are_the_doubles_nearest_to_them);
    RUN_TEST(test_atan2_does_not_change_with_the_length_of_the_vector);
    RUN_TEST(test_sincos_gives_the_same_bits_as_sin_and_cos);
    RUN_TEST(test_sine_and_cosine_stay_within_one);
    RUN_TEST(test_cubes_of_integers_have_exact_roots);
    RUN_TEST(test_integer_powers_that_fit_are_exact);
    RUN_TEST(test_power_has_the_stated_special_values);
    RUN_TEST(test_exp_and_ln_have_the_stated_special_values);
    RUN_TEST(test_arguments_outside_the_domain_give_not_a_number);
    RUN_TEST(test_rising_functions_never_fall);
    RUN_TEST(test_the_float_below_a_number_is_the_nearest_that_is_not_above_it);
    RUN_TEST(test_results_have_the_same_bits_on_every_processor_and_compiler);
    return UNITY_END();
}
