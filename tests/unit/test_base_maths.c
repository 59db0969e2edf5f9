/*
 * firmware/base/maths.h against the long double functions of the host, and against itself: the digests at the
 * end are the same on every processor, or a bit differs.
 */
#include "base/fnv.h"
#include "base/maths.h"

#include "unity.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#define RANDOM_COUNT 200000
#define NOT_A_NUMBER ((double)NAN)

/* Where long double is no longer than double, the functions compared with are off by up to 3 ulp themselves. */
#define REFERENCE_ERROR_ULP (LDBL_MANT_DIG > DBL_MANT_DIG ? 0.0 : 3.0)

void setUp(void)
{
}

void tearDown(void)
{
}

/* SplitMix64 (G. Steele, D. Lea, C. Flood, 2014): the same numbers everywhere. */
static uint64_t random_bits(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * ((double)(random_bits(state) >> 11) * 0x1p-53);
}

/* Any finite double, all exponents alike. */
static double random_finite(uint64_t *state)
{
    union {
        uint64_t bits;
        double value;
    } any;
    do
        any.bits = random_bits(state);
    while (!maths_is_finite(any.value));
    return any.value;
}

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

/* The hardest arguments: the doubles nearest to the multiples of pi/2, where almost all digits cancel. */
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

/*
 * Whole numbers.
 */
static void check_whole(double x)
{
    TEST_ASSERT_TRUE(takt_maths_floor(x) == floor(x));
    TEST_ASSERT_TRUE(takt_maths_ceil(x) == ceil(x));
    TEST_ASSERT_TRUE(takt_maths_round(x) == round(x));
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
    RUN_TEST(test_functions_keep_their_stated_accuracy);
    RUN_TEST(test_atan2_is_within_one_ulp_in_all_directions_and_of_any_length);
    RUN_TEST(test_atan2_is_within_one_ulp_near_the_slopes_where_its_method_changes);
    RUN_TEST(test_power_is_within_four_ulp_up_to_overflow);
    RUN_TEST(test_cbrt_and_ln_are_accurate_for_all_exponents);
    RUN_TEST(test_sine_and_cosine_keep_all_digits_next_to_every_quarter_turn);
    RUN_TEST(test_large_angles_lose_accuracy_gracefully);
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
