/*
 * Nanoseconds per call of the functions of firmware/base, the best of several rounds. Not a test: a
 * figure depends on the machine.
 */
#include "base/decimal.h"
#include "base/fnv.h"
#include "base/maths.h"

#include <stdio.h>
#include <time.h>

#define ROUNDS    9
#define ARGUMENTS 1024
#define PASSES    100

static double argument[ARGUMENTS];
static volatile double sink;

static double now_ns(void)
{
    struct timespec time;
    (void)timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

/* Spread over low to high without a pattern that a branch predictor could learn. */
static void prepare_arguments(double low, double high)
{
    uint32_t state = 1;
    for (int i = 0; i < ARGUMENTS; i++) {
        state = state * 1664525u + 1013904223u;
        argument[i] = low + (high - low) * ((double)state / 4294967296.0);
    }
}

static double both_of_sincos(double x)
{
    double sine, cosine;
    takt_maths_sincos(x, &sine, &cosine);
    return sine + cosine;
}

static double atan2_around(double x)
{
    return takt_maths_atan2(x, 0.7 - 0.3 * x);
}

static double power_of(double x)
{
    return takt_maths_power(x, 1.7);
}

static double digest_of(double x)
{
    return (double)takt_fnv_add_double(FNV_START, x);
}

static double written_with_9_places(double x)
{
    char written[DECIMAL_TEXT_MAX];
    return (double)takt_decimal_write(written, x, 9) + written[0];
}

/* The arguments as text, as a part program has them. */
static struct {
    char digits[DECIMAL_TEXT_MAX];
    size_t length;
} text[ARGUMENTS];

static void prepare_texts(unsigned places)
{
    prepare_arguments(0.0, 1e3);
    for (int i = 0; i < ARGUMENTS; i++) {
        text[i].length = takt_decimal_write(text[i].digits, argument[i], places);
        argument[i] = i;
    }
}

static double read_text(double i)
{
    double value = 0.0;
    (void)takt_decimal_read(text[(int)i].digits, text[(int)i].length, &value);
    return value;
}

static double best_ns(double (*function)(double))
{
    double best = 1e9;
    for (int round = 0; round < ROUNDS; round++) {
        double start = now_ns();
        double sum = 0.0;
        for (int pass = 0; pass < PASSES; pass++) {
            for (int i = 0; i < ARGUMENTS; i++)
                sum += function(argument[i]);
        }
        sink = sum;
        best = maths_min(best, (now_ns() - start) / (PASSES * ARGUMENTS));
    }
    return best;
}

static void print_cost(const char *name, double (*function)(double))
{
    printf("%-27s %6.1f ns\n", name, best_ns(function));
}

static void measure(const char *name, double (*function)(double), double low, double high)
{
    prepare_arguments(low, high);
    print_cost(name, function);
}

int main(void)
{
    measure("maths_sincos", both_of_sincos, -100.0, 100.0);
    measure("maths_sin", takt_maths_sin, -100.0, 100.0);
    measure("maths_cos", takt_maths_cos, -100.0, 100.0);
    measure("maths_tan", takt_maths_tan, -100.0, 100.0);
    measure("maths_atan2", atan2_around, -10.0, 10.0);
    measure("maths_asin", takt_maths_asin, -1.0, 1.0);
    measure("maths_acos", takt_maths_acos, -1.0, 1.0);
    measure("maths_cbrt", takt_maths_cbrt, 0.0, 1e6);
    measure("maths_exp", takt_maths_exp, -10.0, 10.0);
    measure("maths_ln", takt_maths_ln, 0.0, 1e6);
    measure("maths_power", power_of, 0.0, 1e3);
    measure("maths_floor", takt_maths_floor, -1e3, 1e3);
    measure("maths_round", takt_maths_round, -1e3, 1e3);
    measure("fnv_add_double", digest_of, -1e3, 1e3);
    measure("decimal_write, 9 places", written_with_9_places, -1e3, 1e3);
    prepare_texts(4);
    print_cost("decimal_read, 7 digits", read_text);
    prepare_texts(9);
    print_cost("decimal_read, 12 digits", read_text);
    return 0;
}
