/* firmware/base/maths.h against the long double functions of the host: how accurate it is. */
#include "random_bits.h"

#include <float.h>
#include <stdio.h>

/*
 * Where long double is no longer than double, the functions compared with are off by up to 3 ulp
 * themselves.
 */
#define REFERENCE_ERROR_ULP (LDBL_MANT_DIG > DBL_MANT_DIG ? 0.0 : 3.0)

/* |result - exact| in units of the last place of a double as large as exact. */
static double error_ulp(double result, long double exact)
{
    if (isnan(exact) || isinf((double)exact))
        return isnan(exact)              ? (isnan(result) ? 0.0 : HUGE_VAL)
               : result == (double)exact ? 0.0
                                         : HUGE_VAL;
    int exponent;
    frexpl(exact, &exponent);
    long double ulp = ldexpl(1.0L, exponent < -1021 ? -1074 : exponent - 53);
    return (double)(fabsl((long double)result - exact) / ulp);
}

/*
 * Accuracy: random arguments of one function.
 */
struct claim {
    const char *name;
    double (*function)(double);
    long double (*exact)(long double);
    double low, high;
    double error_max_ulp;
};

static const struct claim CLAIMS[] = {
    {"sin", takt_maths_sin, sinl, -0.8, 0.8, 1.0},
    {"sin", takt_maths_sin, sinl, -10.0, 10.0, 1.0},
    {"sin", takt_maths_sin, sinl, -1e5, 1e5, 1.0},
    {"cos", takt_maths_cos, cosl, -0.8, 0.8, 1.0},
    {"cos", takt_maths_cos, cosl, -10.0, 10.0, 1.0},
    {"cos", takt_maths_cos, cosl, -1e5, 1e5, 1.0},
    {"tan", takt_maths_tan, tanl, -10.0, 10.0, 2.5},
    {"tan", takt_maths_tan, tanl, -1e5, 1e5, 2.5},
    {"asin", takt_maths_asin, asinl, -1.0, 1.0, 2.0},
    {"asin", takt_maths_asin, asinl, 0.999, 1.0, 2.0},
    {"asin", takt_maths_asin, asinl, -1e-6, 1e-6, 2.0},
    {"acos", takt_maths_acos, acosl, -1.0, 1.0, 2.0},
    {"acos", takt_maths_acos, acosl, 0.999, 1.0, 2.0},
    {"acos", takt_maths_acos, acosl, -1.0, -0.999, 2.0},
    {"cbrt", takt_maths_cbrt, cbrtl, -8.0, 8.0, 1.0},
    {"cbrt", takt_maths_cbrt, cbrtl, 0.0, 1e9, 1.0},
    {"exp", takt_maths_exp, expl, -1.0, 1.0, 2.0},
    {"exp", takt_maths_exp, expl, -708.0, 709.7, 2.0},
    {"exp", takt_maths_exp, expl, -745.0, -708.0, 2.0},
    {"ln", takt_maths_ln, logl, 0.0, 2.0, 2.0},
    {"ln", takt_maths_ln, logl, 0.999, 1.001, 2.0},
    {"ln", takt_maths_ln, logl, 0.0, 1e9, 2.0},
};

static void report(const char *name, double error, double at)
{
    printf("%-6s worst error %.3f ulp at %a\n", name, error, at);
}

static void check_claim(const struct claim *claim)
{
    uint64_t state = 1;
    double worst = 0.0, worst_at = 0.0;
    for (int i = 0; i < RANDOM_COUNT; i++) {
        double x = random_between(&state, claim->low, claim->high);
        double error = error_ulp(claim->function(x), claim->exact((long double)x));
        if (error > worst) {
            worst = error;
            worst_at = x;
        }
    }
    report(claim->name, worst, worst_at);
    TEST_ASSERT_TRUE_MESSAGE(worst <= claim->error_max_ulp + REFERENCE_ERROR_ULP, claim->name);
}

static void test_functions_keep_their_stated_accuracy(void)
{
    for (size_t i = 0; i < sizeof CLAIMS / sizeof CLAIMS[0]; i++)
        check_claim(&CLAIMS[i]);
}

struct worst_pair {
    double error, y, x;
};

static void note_worst(struct worst_pair *worst, double error, double y, double x)
{
    if (error > worst->error)
        *worst = (struct worst_pair){error, y, x};
}

static void report_pair(const char *name, const struct worst_pair *worst)
{
    printf("%-6s worst error %.3f ulp at (%a, %a)\n", name, worst->error, worst->y, worst->x);
}

static void test_atan2_is_within_one_ulp_in_all_directions_and_of_any_length(void)
{
    uint64_t state = 2;
    struct worst_pair worst = {0};
    for (int i = 0; i < 2 * RANDOM_COUNT; i++) {
        bool plain = i % 2 == 0;
        double y = plain ? random_between(&state, -100.0, 100.0) : random_finite(&state);
        double x = plain ? random_between(&state, -100.0, 100.0) : random_finite(&state);
        note_worst(&worst,
                   error_ulp(takt_maths_atan2(y, x), atan2l((long double)y, (long double)x)), y, x);
    }
    report_pair("atan2", &worst);
    TEST_ASSERT_TRUE(worst.error <= 1.0 + REFERENCE_ERROR_ULP);
}

static void test_atan2_is_within_one_ulp_near_the_slopes_where_its_method_changes(void)
{
    static const double SLOPES[] = {0.25, 0.5, 0.72, 1.0, 0x1p-60, 4.0, 2.0};
    uint64_t state = 3;
    struct worst_pair worst = {0};
    for (size_t i = 0; i < sizeof SLOPES / sizeof SLOPES[0]; i++) {
        for (int k = 0; k < 5000; k++) {
            double x = random_between(&state, -1.0, 1.0);
            double y = x * SLOPES[i] * random_between(&state, 1.0 - 1e-13, 1.0 + 1e-13);
            note_worst(&worst,
                       error_ulp(takt_maths_atan2(y, x), atan2l((long double)y, (long double)x)), y,
                       x);
        }
    }
    report_pair("atan2", &worst);
    TEST_ASSERT_TRUE(worst.error <= 1.0 + REFERENCE_ERROR_ULP);
}

static void test_power_is_within_four_ulp_up_to_overflow(void)
{
    uint64_t state = 4;
    struct worst_pair worst = {0};
    for (int i = 0; i < RANDOM_COUNT; i++) {
        double ln_x =
            i % 2 == 0 ? random_between(&state, -10.0, 10.0) : random_between(&state, -0.35, 0.35);
        double x = exp(ln_x);
        double y = random_between(&state, -708.0, 709.0) / log(x);
        note_worst(&worst, error_ulp(takt_maths_power(x, y), powl((long double)x, (long double)y)),
                   x, y);
    }
    report_pair("power", &worst);
    TEST_ASSERT_TRUE(worst.error <= 4.0 + REFERENCE_ERROR_ULP);
}

static void test_cbrt_and_ln_are_accurate_for_all_exponents(void)
{
    uint64_t state = 5;
    for (int i = 0; i < RANDOM_COUNT; i++) {
        double x = random_finite(&state);
        TEST_ASSERT_TRUE(error_ulp(takt_maths_cbrt(x), cbrtl((long double)x)) <=
                         1.0 + REFERENCE_ERROR_ULP);
        TEST_ASSERT_TRUE(error_ulp(takt_maths_ln(fabs(x)), logl((long double)fabs(x))) <=
                         2.0 + REFERENCE_ERROR_ULP);
    }
    TEST_ASSERT_TRUE(takt_maths_cbrt(0x1p-1074) == 0x1p-358);
    TEST_ASSERT_TRUE(error_ulp(takt_maths_ln(0x1p-1074), logl(0x1p-1074L)) <=
                     2.0 + REFERENCE_ERROR_ULP);
    TEST_ASSERT_TRUE(error_ulp(takt_maths_cbrt(0x1.8p-1060), cbrtl(0x1.8p-1060L)) <=
                     1.0 + REFERENCE_ERROR_ULP);
}

/*
 * The hardest arguments: the doubles nearest to the multiples of pi/2, where almost all digits
 * cancel.
 */
static void test_sine_and_cosine_keep_all_digits_next_to_every_quarter_turn(void)
{
    const long double half_pi = 1.570796326794896619231321691639751442L;
    double worst = 0.0, worst_at = 0.0;
    for (int n = 1; n <= 63661; n++) {
        double nearest = (double)((long double)n * half_pi);
        for (int step = -1; step <= 1; step++) {
            double x = step == 0 ? nearest : nextafter(nearest, step * HUGE_VAL);
            double error = fmax(error_ulp(takt_maths_sin(x), sinl((long double)x)),
                                error_ulp(takt_maths_cos(x), cosl((long double)x)));
            if (error > worst) {
                worst = error;
                worst_at = x;
            }
        }
    }
    report("sincos", worst, worst_at);
    TEST_ASSERT_TRUE(worst <= 1.0 + REFERENCE_ERROR_ULP);
}

/* Off by what a change of the angle by one ulp of the angle makes. */
static void test_large_angles_lose_accuracy_gracefully(void)
{
    uint64_t state = 6;
    for (int i = 0; i < RANDOM_COUNT; i++) {
        double x = random_between(&state, 1e5, 1e15);
        double sine, cosine;
        takt_maths_sincos(x, &sine, &cosine);
        double angle_ulp = nextafter(x, HUGE_VAL) - x;
        TEST_ASSERT_TRUE(fabs((double)((long double)sine - sinl((long double)x))) <=
                         angle_ulp + 1e-15);
        TEST_ASSERT_TRUE(fabs(sine * sine + cosine * cosine - 1.0) <= 1e-15);
    }
    double sine, cosine;
    takt_maths_sincos(-0x1.fffffffffffffp1023, &sine, &cosine);
    TEST_ASSERT_TRUE(fabs(sine * sine + cosine * cosine - 1.0) <= 1e-15);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_functions_keep_their_stated_accuracy);
    RUN_TEST(test_atan2_is_within_one_ulp_in_all_directions_and_of_any_length);
    RUN_TEST(test_atan2_is_within_one_ulp_near_the_slopes_where_its_method_changes);
    RUN_TEST(test_power_is_within_four_ulp_up_to_overflow);
    RUN_TEST(test_cbrt_and_ln_are_accurate_for_all_exponents);
    RUN_TEST(test_sine_and_cosine_keep_all_digits_next_to_every_quarter_turn);
    RUN_TEST(test_large_angles_lose_accuracy_gracefully);
    return UNITY_END();
}
