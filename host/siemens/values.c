/*
 * Values of Siemens' language (siemens.c): R12, variables, functions, and calculations with them.
 */
#include "siemens/scan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define R_FIRST 100U
#define R_END   900U
/* Values in values. */
#define NESTED_MAX 12
/* Of a function. */
#define ARGUMENTS_MAX 2
#define ARGUMENT_SIZE 256

/* Towards 0; FIX of LinuxCNC goes down. */
#define TRUNCATED "[FIX[ABS$1]*[1-2*[$1 LT 0]]]"

static bool take_number(struct scan *s)
{
    size_t length = 0;

    scan_skip(s);
    while (scan_is_digit(s->at[length]) || s->at[length] == '.')
        length++;
    scan_put(s, "%.*s", (int)length, s->at);
    s->at += length;
    return length > 0;
}

void scan_number(struct scan *s)
{
    s->failed = s->failed || !take_number(s);
}

/* ( value ) */
void scan_bracketed(struct scan *s)
{
    s->failed = s->failed || !scan_take(s, "(");
    scan_brackets(s);
    s->failed = s->failed || !scan_take(s, ")");
}

char scan_kind(const struct scan *s, const char *name)
{
    const struct translator *t = s->t;

    for (unsigned i = 0; i < t->variables; i++) {
        if (strcmp(t->variable[i], name) == 0)
            return t->kind[i];
    }
    return '\0';
}

bool scan_is_variable(const struct scan *s, const char *name)
{
    return scan_kind(s, name) != '\0';
}

void scan_given(struct scan *s, char kind)
{
    scan_put(s, kind == 'i' ? "ROUND" : "");
    scan_brackets(s);
}

static void put_variable(struct scan *s, const char *name)
{
    scan_put(s, "#<def_");
    for (; *name != '\0'; name++)
        scan_put(s, "%c", line_lower(*name));
    scan_put(s, ">");
}

/* ---- functions ---- */

/* What follows of what has been put out becomes an argument. */
static void cut_argument(struct scan *s, size_t from, char argument[ARGUMENT_SIZE])
{
    const size_t length = s->failed ? 0 : s->length - from;

    s->failed = s->failed || length >= ARGUMENT_SIZE;
    s->length = from;
    if (s->failed)
        return;
    memcpy(argument, s->out + from, length);
    argument[length] = '\0';
}

/* A pattern with its arguments, $1 and $2. */
static void put_pattern(struct scan *s, const char *pattern, char argument[][ARGUMENT_SIZE])
{
    for (const char *c = pattern; *c != '\0' && !s->failed; c++) {
        if (*c == '$')
            scan_put(s, "%s", argument[*++c - '1']);
        else
            scan_put(s, "%c", *c);
    }
}

static void put_function(struct scan *s, const char *pattern)
{
    const unsigned count = strstr(pattern, "$2") != NULL ? 2 : 1;
    char argument[ARGUMENTS_MAX][ARGUMENT_SIZE];

    for (unsigned i = 0; i < count && !s->failed; i++) {
        const size_t from = s->length;

        s->failed = !scan_take(s, i == 0 ? "(" : ",");
        scan_brackets(s);
        cut_argument(s, from, argument[i]);
    }
    s->failed = s->failed || !scan_take(s, ")");
    put_pattern(s, pattern, argument);
}

/* False: there is none of this name. */
static bool take_function(struct scan *s, const char *name)
{
    static const char *const functions[][2] = {{"SIN", "SIN$1"},
                                               {"COS", "COS$1"},
                                               {"TAN", "TAN$1"},
                                               {"ASIN", "ASIN$1"},
                                               {"ACOS", "ACOS$1"},
                                               {"ATAN2", "ATAN$1/$2"},
                                               {"SQRT", "SQRT$1"},
                                               {"POT", "[$1*$1]"},
                                               {"ABS", "ABS$1"},
                                               {"EXP", "EXP$1"},
                                               {"LN", "LN$1"},
                                               {"TRUNC", TRUNCATED},
                                               {"ROUND", "ROUND$1"},
                                               {"ROUNDUP", "FUP$1"},
                                               {"MINVAL", "[$1*[$1 LT $2]+$2*[1-[$1 LT $2]]]"},
                                               {"MAXVAL", "[$1*[$1 GT $2]+$2*[1-[$1 GT $2]]]"}};

    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        if (strcmp(name, functions[i][0]) == 0) {
            put_function(s, functions[i][1]);
            return true;
        }
    }
    return false;
}

/* ---- operands ---- */

static bool take_constant(struct scan *s, const char *name)
{
    static const char *const constants[][2] = {
        {"PI", "3.14159265358979"}, {"TRUE", "1"}, {"FALSE", "0"}};

    for (size_t i = 0; i < sizeof constants / sizeof constants[0]; i++) {
        if (strcmp(name, constants[i][0]) == 0) {
            scan_put(s, "%s", constants[i][1]);
            return true;
        }
    }
    return false;
}

void scan_operand(struct scan *s, const char *name)
{
    char *end;
    const unsigned long number = strtoul(name + 1, &end, 10);

    if (scan_is_variable(s, name))
        put_variable(s, name);
    else if (name[0] == 'R' && scan_is_digit(name[1]) && *end == '\0' && number < R_END)
        scan_put(s, "#%lu", R_FIRST + number);
    else
        s->failed = s->failed || (!take_constant(s, name) && !take_function(s, name));
}

/* NOT a */
static void put_negated(struct scan *s)
{
    scan_put(s, "[");
    scan_single(s);
    scan_put(s, " EQ 0]");
}

void scan_single(struct scan *s)
{
    char name[NAME_MAX_];

    scan_skip(s);
    if (*s->at == '-' || *s->at == '+') {
        scan_put(s, *s->at++ == '-' ? "[0-" : "[");
        scan_single(s);
        scan_put(s, "]");
    } else if (*s->at == '(') {
        scan_bracketed(s);
    } else if (*s->at == '$') {
        s->at++;
        s->failed = s->failed || !scan_name(s, name) || strcmp(name, "PI") != 0;
        scan_operand(s, "PI");
    } else if (!scan_name(s, name)) {
        scan_number(s);
    } else if (strcmp(name, "NOT") == 0) {
        put_negated(s);
    } else {
        scan_operand(s, name);
    }
}

/* ---- calculations ---- */

/* An operator and what it is here; weak: what stands before it is a value of its own. */
struct operation {
    const char *text, *put;
    bool weak;
};

static const struct operation signs[] = {
    {"==", " EQ ", true}, {"<>", " NE ", true}, {"<=", " LE ", true}, {">=", " GE ", true},
    {"<", " LT ", true},  {">", " GT ", true},  {"+", "+", true},     {"-", "-", true},
    {"*", "*", false},    {"/", "/", false}};
/* DIV is a division whose result is cut. */
static const struct operation words[] = {{"MOD", " MOD ", false},
                                         {"DIV", "/", false},
                                         {"AND", " AND ", true},
                                         {"OR", " OR ", true},
                                         {"XOR", " XOR ", true}};

/* NULL: none stands here. */
static const struct operation *operator(struct scan *s)
{
    const char *before = s->at;
    char name[NAME_MAX_];

    for (size_t i = 0; i < sizeof signs / sizeof signs[0]; i++) {
        if (scan_take(s, signs[i].text))
            return &signs[i];
    }
    if (scan_name(s, name)) {
        for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
            if (strcmp(name, words[i].text) == 0)
                return &words[i];
        }
    }
    s->at = before;
    return NULL;
}

/* The whole number of what has been put out from there. */
static void cut_quotient(struct scan *s, size_t from)
{
    char argument[1][ARGUMENT_SIZE];
    char quotient[ARGUMENT_SIZE];

    cut_argument(s, from, quotient);
    s->failed = s->failed || snprintf(argument[0], sizeof argument[0], "[%s]", quotient) >=
                                 (int)sizeof argument[0];
    put_pattern(s, TRUNCATED, argument);
}

void scan_value(struct scan *s)
{
    const struct operation *next = NULL;
    size_t from = s->length;

    if (s->t->nested > NESTED_MAX) {
        s->failed = true;
        return;
    }
    s->t->nested++;
    do {
        const bool divides = next != NULL && strcmp(next->text, "DIV") == 0;

        scan_single(s);
        if (divides)
            cut_quotient(s, from);
        next = s->failed ? NULL : operator(s);
        if (next != NULL)
            scan_put(s, "%s", next->put);
        from = next != NULL && next->weak ? s->length : from;
    } while (next != NULL);
    s->t->nested--;
}

void scan_brackets(struct scan *s)
{
    scan_put(s, "[");
    scan_value(s);
    scan_put(s, "]");
}

unsigned scan_arguments(struct scan *s, char argument[SCAN_ARGUMENTS][48])
{
    unsigned count = 0;

    s->failed = s->failed || !scan_take(s, "(");
    while (!s->failed && count < SCAN_ARGUMENTS && !scan_take(s, ")")) {
        s->length = 0;
        scan_skip(s);
        scan_put(s, "%s", "");
        if (*s->at != ',' && *s->at != ')')
            scan_brackets(s);
        s->out[s->length] = '\0';
        s->failed = s->failed || s->length >= 48;
        (void)snprintf(argument[count++], 48, "%.47s", s->out);
        (void)scan_take(s, ",");
    }
    s->length = 0;
    return count;
}
