#include "program/expression.h"

#include "base/assert.h"
#include "base/decimal.h"
#include "base/maths.h"
#include "program/calculation.h"
#include "program/lexer.h"
#include "program/names.h"
#include "program/predefined.h"
#include "program/report.h"
#include "program/system_parameters.h"

/* How far a value that must be whole may be from it. */
#define WHOLE_MAX 1e-4

bool takt_expression_whole(double value, double *whole)
{
    *whole = takt_maths_round(value);
    return maths_abs(value - *whole) <= WHOLE_MAX;
}

/* About what stands before the next character; the caller has read something. */
static bool missing_here(struct program *p, enum takt_error code)
{
    return takt_report_error_at(p, code, p->lexer.at - 1U, 0.0);
}

static bool read_number(struct program *p, double *value)
{
    struct program_lexer *l = &p->lexer;
    const size_t count = takt_decimal_read(l->text + l->at, (size_t)(l->length - l->at), value);

    if (count == 0) {
        return missing_here(p, TAKT_ERROR_NUMBER_EXPECTED);
    }
    l->at = (uint16_t)(l->at + count);
    return true;
}

static struct program_span span_from(const struct program *p, unsigned begin)
{
    return (struct program_span){(uint16_t)begin, p->lexer.at};
}

/*
 * Operators whose right sides have not been read yet; the last binds tightest. LEVEL_END never
 * waits.
 */
struct pending {
    unsigned count;
    double left[LEVEL_COUNT - 1];
    const struct operation_entry *operation[LEVEL_COUNT - 1];
    uint16_t begin[LEVEL_COUNT - 1]; /* where its name does */
};

/* The last of them, whose right side is *value. */
static bool apply_operator(struct program *p, struct pending *pending, double *value)
{
    const unsigned last = --pending->count;
    const struct operation_entry *operation = pending->operation[last];
    const struct program_span span = {pending->begin[last],
                                      (uint16_t)(pending->begin[last] + operation->length)};
    const double left = pending->left[last];
    const enum takt_error code = operation->apply(left, *value, value);

    if (code != TAKT_OK) {
        return takt_report_error(p, code, span, left);
    }
    return maths_is_finite(*value) ||
           takt_report_error(p, TAKT_ERROR_CALCULATION_NOT_FINITE, span, *value);
}

/* NULL after an error. */
static const struct operation_entry *read_operator(struct program *p)
{
    struct program_lexer *l = &p->lexer;
    const struct operation_entry *next = takt_operation_find(l->text + l->at);

    if (next == NULL) {
        (void)missing_here(p, l->text[l->at] == '\0' ? TAKT_ERROR_BRACKET_UNCLOSED
                                                     : TAKT_ERROR_OPERATOR_EXPECTED);
        return NULL;
    }
    l->at = (uint16_t)(l->at + next->length);
    return next;
}

/* An operator that has just been read. */
static void add_operator(const struct program *p, struct pending *pending,
                         const struct operation_entry *next, double left)
{
    pending->left[pending->count] = left;
    pending->operation[pending->count] = next;
    pending->begin[pending->count] = (uint16_t)(p->lexer.at - next->length);
    pending->count++;
}

/*
 * Operators wait until one that binds no tighter follows. Levels rise from the first to the last,
 * so there are never more of them than levels.
 */
static bool read_bracket(struct program *p, double *value)
{
    struct pending pending;
    const struct operation_entry *next;

    pending.count = 0;
    if (!takt_lexer_accept(&p->lexer, '[')) {
        return missing_here(p, TAKT_ERROR_BRACKET_EXPECTED);
    }
    for (;;) {
        if (!takt_expression_read(p, value)) {
            return false;
        }
        next = read_operator(p);
        if (next == NULL) {
            return false;
        }
        while (pending.count > 0 && pending.operation[pending.count - 1]->level >= next->level) {
            if (!apply_operator(p, &pending, value)) {
                return false;
            }
        }
        if (next->level == LEVEL_END) {
            return true;
        }
        add_operator(p, &pending, next, *value);
    }
}

static bool read_name(struct program *p, struct program_reference *reference)
{
    struct program_lexer *l = &p->lexer;
    const unsigned begin = l->at;

    while (l->text[l->at] != '\0' && l->text[l->at] != '>') {
        l->at++;
    }
    reference->number = 0;
    reference->span = span_from(p, begin);
    const unsigned length = l->at - begin;

    if (!takt_lexer_accept(l, '>') || length == 0 || length > PROGRAM_NAME_MAX) {
        return takt_report_error_at(p, TAKT_ERROR_PARAMETER_NAME, begin - 1U, PROGRAM_NAME_MAX);
    }
    return true;
}

/* *value: what stands for its number, if it has no name. */
static bool read_reference(struct program *p, struct program_reference *reference, double *value)
{
    const unsigned begin = p->lexer.at - 1U;

    if (takt_lexer_accept(&p->lexer, '<')) {
        return read_name(p, reference);
    }
    if (!takt_expression_read(p, value)) {
        return false;
    }
    double number;
    const bool whole = takt_expression_whole(*value, &number);

    reference->span = span_from(p, begin);
    reference->number =
        whole && number >= 1.0 && number <= PARAMETER_NUMBER_MAX ? (uint16_t)number : 0;
    return true;
}

bool takt_expression_read_reference(struct program *p, struct program_reference *reference)
{
    const bool named = p->lexer.text[p->lexer.at] == '<';
    double value = 0.0;

    return read_reference(p, reference, &value) &&
           (named || reference->number != 0 ||
            takt_report_error(p, TAKT_ERROR_PARAMETER_NUMBER, reference->span, value));
}

bool takt_expression_find_named(const struct program *p, const char *name, size_t length,
                                double *value)
{
    const int place = takt_names_find(&p->names, name, length);

    if (place < 0) {
        return takt_predefined_get(p, name, length, value);
    }
    *value = p->names.value[place];
    return true;
}

static bool find_named(const struct program *p, const struct program_reference *reference,
                       double *value)
{
    return takt_expression_find_named(p, p->lexer.text + reference->span.begin,
                                      (size_t)(reference->span.end - reference->span.begin), value);
}

static bool read_parameter(struct program *p, double *value)
{
    struct program_reference reference = {0};

    p->lexer.at++;
    if (!takt_expression_read_reference(p, &reference)) {
        return false;
    }
    if (reference.number != 0) {
        *value = takt_system_parameter_get(p, reference.number);
        return true;
    }
    return find_named(p, &reference, value) ||
           takt_report_error(p, TAKT_ERROR_PARAMETER_UNDEFINED, reference.span, 0.0);
}

static bool read_atan(struct program *p, double *value)
{
    double x;

    if (!read_bracket(p, value)) {
        return false;
    }
    if (!takt_lexer_accept(&p->lexer, '/')) {
        return missing_here(p, TAKT_ERROR_SLASH_EXPECTED);
    }
    if (!read_bracket(p, &x)) {
        return false;
    }
    *value = takt_calculation_atan(*value, x);
    return true;
}

/*
 * EXISTS[#<name>], from its bracket on: 1 when it has been set, or when there is a parameter of
 * this number.
 */
static bool read_exists(struct program *p, double *value)
{
    struct program_reference reference = {0};

    p->lexer.at++;
    if (!takt_lexer_accept(&p->lexer, '#')) {
        return missing_here(p, TAKT_ERROR_NUMBER_EXPECTED);
    }
    const bool named = p->lexer.text[p->lexer.at] == '<';

    if (!read_reference(p, &reference, value)) {
        return false;
    }
    if (!takt_lexer_accept(&p->lexer, ']')) {
        return missing_here(p, TAKT_ERROR_BRACKET_UNCLOSED);
    }
    *value = reference.number != 0 || (named && find_named(p, &reference, value)) ? 1.0 : 0.0;
    return true;
}

static bool read_function(struct program *p, double *value)
{
    struct program_lexer *l = &p->lexer;
    const unsigned begin = l->at;
    const struct function_entry *function = takt_function_find(l->text + begin);

    if (function == NULL) {
        return missing_here(p, TAKT_ERROR_NUMBER_EXPECTED);
    }
    l->at = (uint16_t)(begin + function->length);
    while (l->text[l->at] >= 'a' && l->text[l->at] <= 'z') {
        l->at++;
    }
    const struct program_span span = span_from(p, begin);

    if (l->at != begin + function->length) {
        return takt_report_error(p, TAKT_ERROR_FUNCTION_UNKNOWN, span, 0.0);
    }
    if (l->text[l->at] != '[') {
        return takt_report_error(p, TAKT_ERROR_BRACKET_EXPECTED, span, 0.0);
    }
    if (function->apply == NULL) {
        return function->name[0] == 'a' ? read_atan(p, value) : read_exists(p, value);
    }
    if (!read_bracket(p, value)) {
        return false;
    }
    const double x = *value;
    const enum takt_error code = function->apply(x, value);

    return code == TAKT_OK || takt_report_error(p, code, span, x);
}

static bool read_sign(struct program_lexer *l)
{
    bool negative = false;

    while (l->text[l->at] == '-' || l->text[l->at] == '+') {
        negative ^= l->text[l->at] == '-';
        l->at++;
    }
    return negative;
}

static bool read_unsigned(struct program *p, double *value)
{
    const char c = p->lexer.text[p->lexer.at];

    if (c == '[') {
        return read_bracket(p, value);
    }
    if (c == '#') {
        return read_parameter(p, value);
    }
    if (c >= 'a' && c <= 'z') {
        return read_function(p, value);
    }
    return read_number(p, value);
}

bool takt_expression_read(struct program *p, double *value)
{
    struct program_lexer *l = &p->lexer;
    const unsigned begin = l->at;

    if (l->nesting == PROGRAM_NESTING_MAX) {
        return takt_report_error_at(p, TAKT_ERROR_NESTING_TOO_DEEP, begin, PROGRAM_NESTING_MAX);
    }
    l->nesting++;
    const bool negative = read_sign(l);

    if (!read_unsigned(p, value)) {
        return false;
    }
    l->nesting--;
    if (!maths_is_finite(*value)) {
        return takt_report_error(p, TAKT_ERROR_CALCULATION_NOT_FINITE, span_from(p, begin), *value);
    }
    if (negative) {
        *value = -*value;
    }
    return true;
}
