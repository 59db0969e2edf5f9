#include "program/calculation.h"

#include "base/assert.h"
#include "base/maths.h"

#include <stddef.h>

/* Values closer than this are equal to EQ, NE, GE and LE, as in LinuxCNC. */
#define EQUAL_MAX 1e-6

#define DEGREES_PER_RAD (180.0 / MATHS_PI)
#define RAD_PER_DEGREE  (MATHS_PI / 180.0)

static enum takt_error add(double left, double right, double *result)
{
    *result = left + right;
    return TAKT_OK;
}

static enum takt_error subtract(double left, double right, double *result)
{
    *result = left - right;
    return TAKT_OK;
}

static enum takt_error multiply(double left, double right, double *result)
{
    *result = left * right;
    return TAKT_OK;
}

static enum takt_error divide(double left, double right, double *result)
{
    if (right == 0.0) {
        return TAKT_ERROR_DIVISION_BY_ZERO;
    }
    *result = left / right;
    return TAKT_OK;
}

/*
 * x modulo y for x >= 0, y > 0, exact: subtracts y times falling powers of two. Both the doubling
 * and each difference are exact, and there are at most 2 * 2098 steps (the binary orders of a
 * double).
 */
static double remainder_of(double x, double y)
{
    double step = y;

    TAKT_ASSERT(x >= 0.0 && y > 0.0);
    while (step <= x * 0.5) {
        step += step;
    }
    while (step >= y) {
        if (x >= step) {
            x -= step;
        }
        step *= 0.5;
    }
    return x;
}

/* The remainder is never negative: -1 MOD 3 is 2, as in LinuxCNC. */
static enum takt_error modulo(double left, double right, double *result)
{
    if (right == 0.0) {
        return TAKT_ERROR_DIVISION_BY_ZERO;
    }
    const double size = maths_abs(right);
    const double rest = remainder_of(maths_abs(left), size);

    *result = left < 0.0 && rest > 0.0 ? size - rest : rest;
    return TAKT_OK;
}

static enum takt_error power(double left, double right, double *result)
{
    if (left < 0.0 && takt_maths_floor(right) != right) {
        return TAKT_ERROR_CALCULATION_UNDEFINED;
    }
    *result = takt_maths_power(left, right);
    return TAKT_OK;
}

static enum takt_error logic_and(double left, double right, double *result)
{
    *result = left != 0.0 && right != 0.0 ? 1.0 : 0.0;
    return TAKT_OK;
}

static enum takt_error logic_or(double left, double right, double *result)
{
    *result = left != 0.0 || right != 0.0 ? 1.0 : 0.0;
    return TAKT_OK;
}

static enum takt_error logic_xor(double left, double right, double *result)
{
    *result = (left != 0.0) != (right != 0.0) ? 1.0 : 0.0;
    return TAKT_OK;
}

static bool is_equal(double left, double right)
{
    return maths_abs(left - right) < EQUAL_MAX;
}

static enum takt_error equal(double left, double right, double *result)
{
    *result = is_equal(left, right) ? 1.0 : 0.0;
    return TAKT_OK;
}

static enum takt_error not_equal(double left, double right, double *result)
{
    *result = is_equal(left, right) ? 0.0 : 1.0;
    return TAKT_OK;
}

static enum takt_error greater(double left, double right, double *result)
{
    *result = left > right ? 1.0 : 0.0;
    return TAKT_OK;
}

static enum takt_error greater_or_equal(double left, double right, double *result)
{
    *result = left >= right || is_equal(left, right) ? 1.0 : 0.0;
    return TAKT_OK;
}

static enum takt_error less(double left, double right, double *result)
{
    *result = left < right ? 1.0 : 0.0;
    return TAKT_OK;
}

static enum takt_error less_or_equal(double left, double right, double *result)
{
    *result = left <= right || is_equal(left, right) ? 1.0 : 0.0;
    return TAKT_OK;
}

/* A name that begins another stands behind it. */
#define OPERATION(name, level, apply)                                                              \
    {                                                                                              \
        name, sizeof(name) - 1, level, apply                                                       \
    }

static const struct operation_entry operations[] = {
    OPERATION("]", LEVEL_END, NULL),
    OPERATION("**", LEVEL_POWER, power),
    OPERATION("*", LEVEL_PRODUCT, multiply),
    OPERATION("/", LEVEL_PRODUCT, divide),
    OPERATION("mod", LEVEL_PRODUCT, modulo),
    OPERATION("+", LEVEL_SUM, add),
    OPERATION("-", LEVEL_SUM, subtract),
    OPERATION("eq", LEVEL_COMPARISON, equal),
    OPERATION("ne", LEVEL_COMPARISON, not_equal),
    OPERATION("gt", LEVEL_COMPARISON, greater),
    OPERATION("ge", LEVEL_COMPARISON, greater_or_equal),
    OPERATION("lt", LEVEL_COMPARISON, less),
    OPERATION("le", LEVEL_COMPARISON, less_or_equal),
    OPERATION("and", LEVEL_LOGIC, logic_and),
    OPERATION("or", LEVEL_LOGIC, logic_or),
    OPERATION("xor", LEVEL_LOGIC, logic_xor),
};

#undef OPERATION

/* Both end in zero. */
static bool begins_with(const char *text, const char *name)
{
    while (*name != '\0' && *text == *name) {
        text++;
        name++;
    }
    return *name == '\0';
}

const struct operation_entry *takt_operation_find(const char *text)
{
    for (size_t i = 0; i < sizeof(operations) / sizeof(operations[0]); i++) {
        if (begins_with(text, operations[i].name)) {
            return &operations[i];
        }
    }
    return NULL;
}

static enum takt_error function_abs(double x, double *result)
{
    *result = maths_abs(x);
    return TAKT_OK;
}

static enum takt_error function_acos(double x, double *result)
{
    if (maths_abs(x) > 1.0) {
        return TAKT_ERROR_CALCULATION_UNDEFINED;
    }
    *result = takt_maths_acos(x) * DEGREES_PER_RAD;
    return TAKT_OK;
}

static enum takt_error function_asin(double x, double *result)
{
    if (maths_abs(x) > 1.0) {
        return TAKT_ERROR_CALCULATION_UNDEFINED;
    }
    *result = takt_maths_asin(x) * DEGREES_PER_RAD;
    return TAKT_OK;
}

static enum takt_error function_cos(double x, double *result)
{
    *result = takt_maths_cos(x * RAD_PER_DEGREE);
    return TAKT_OK;
}

static enum takt_error function_exp(double x, double *result)
{
    *result = takt_maths_exp(x);
    return TAKT_OK;
}

static enum takt_error function_fix(double x, double *result)
{
    *result = takt_maths_floor(x);
    return TAKT_OK;
}

static enum takt_error function_fup(double x, double *result)
{
    *result = takt_maths_ceil(x);
    return TAKT_OK;
}

static enum takt_error function_ln(double x, double *result)
{
    if (x <= 0.0) {
        return TAKT_ERROR_CALCULATION_UNDEFINED;
    }
    *result = takt_maths_ln(x);
    return TAKT_OK;
}

static enum takt_error function_round(double x, double *result)
{
    *result = takt_maths_round(x);
    return TAKT_OK;
}

static enum takt_error function_sin(double x, double *result)
{
    *result = takt_maths_sin(x * RAD_PER_DEGREE);
    return TAKT_OK;
}

static enum takt_error function_sqrt(double x, double *result)
{
    if (x < 0.0) {
        return TAKT_ERROR_CALCULATION_UNDEFINED;
    }
    *result = maths_sqrt(x);
    return TAKT_OK;
}

static enum takt_error function_tan(double x, double *result)
{
    *result = takt_maths_tan(x * RAD_PER_DEGREE);
    return TAKT_OK;
}

#define FUNCTION(name, apply)                                                                      \
    {                                                                                              \
        name, sizeof(name) - 1, apply                                                              \
    }

static const struct function_entry functions[] = {
    FUNCTION("abs", function_abs),     FUNCTION("acos", function_acos),
    FUNCTION("asin", function_asin),   FUNCTION("atan", NULL),
    FUNCTION("cos", function_cos),     FUNCTION("exists", NULL),
    FUNCTION("exp", function_exp),     FUNCTION("fix", function_fix),
    FUNCTION("fup", function_fup),     FUNCTION("ln", function_ln),
    FUNCTION("round", function_round), FUNCTION("sin", function_sin),
    FUNCTION("sqrt", function_sqrt),   FUNCTION("tan", function_tan),
};

#undef FUNCTION

const struct function_entry *takt_function_find(const char *text)
{
    for (size_t i = 0; i < sizeof(functions) / sizeof(functions[0]); i++) {
        if (begins_with(text, functions[i].name)) {
            return &functions[i];
        }
    }
    return NULL;
}

double takt_calculation_atan(double y, double x)
{
    return takt_maths_atan2(y, x) * DEGREES_PER_RAD;
}
