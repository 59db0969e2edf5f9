/*
 * Subprograms of Siemens' language (siemens.c): where they begin and end, and calls.
 *
 *     %_N_L100_SPF, PROC NAME(REAL A)     o<l100> sub, o<name> sub
 *     M17, RET                            o<name> return
 *     L100 P2, NAME(5)                    o<l100> call, twice; o<name> call [5]
 *
 * What the text begins with is the main program, also under PROC, and under SPF if the text has no
 * MPF. A text that has been called is the subprogram of this name.
 */
#include "siemens/scan.h"
#include "siemens/siemens.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void end_subprogram(struct translator *t)
{
    if (t->subprogram[0] != '\0')
        translate_add(&t->before, "o<%s> endsub", t->subprogram);
    t->subprogram[0] = '\0';
    t->blocks = t->depth = 0;
    t->program++;
}

static void lower(char *text)
{
    for (; *text != '\0'; text++)
        *text = line_lower(*text);
}

static void begin_subprogram(struct translator *t, const char *name)
{
    end_subprogram(t);
    (void)snprintf(t->subprogram, sizeof t->subprogram, "%.31s", name);
    lower(t->subprogram);
    translate_add(&t->before, "o<%s> sub", t->subprogram);
}

/* Neither a program nor anything of one stands before this line. */
static bool is_first(const struct translator *t)
{
    return t->program == 0 && !t->worded && t->called == NULL;
}

/* A section of a main program. */
static bool has_main(const struct translator *t)
{
    static const char end[] = {'_', 'M', 'P', 'F'};

    for (size_t i = 0; i + sizeof end <= t->source_length; i++) {
        if (memcmp(t->source + i, end, sizeof end) == 0)
            return true;
    }
    return false;
}

bool scan_section(struct scan *s)
{
    struct translator *t = s->t;
    char name[NAME_MAX_];

    if (strncmp(s->at, "%_N_", 4) != 0)
        return false;
    s->at += 4;
    if (!scan_name(s, name))
        return false;
    const bool main = is_first(t) && !has_main(t);
    const size_t length = strlen(name);

    end_subprogram(t);
    if (length > 4 && strcmp(&name[length - 4], "_SPF") == 0 && !main) {
        name[length - 4] = '\0';
        begin_subprogram(t, name);
    }
    t->worded = false;
    scan_clear(s);
    return true;
}

/* PROC NAME(REAL A, INT B=2, VAR REAL C): #1, #2 ... of the subroutine. */
static void take_parameters(struct scan *s)
{
    struct translator *t = s->t;
    unsigned number = 0;
    bool more = scan_take(s, "(") && !scan_take(s, ")");
    char type[NAME_MAX_];
    char name[NAME_MAX_];

    while (more && !s->failed) {
        s->failed = !scan_name(s, type);
        const bool is_var = strcmp(type, "VAR") == 0;

        s->failed = s->failed || (is_var && !scan_name(s, type)) || !scan_name(s, name);
        const bool is_whole = strcmp(type, "INT") == 0;

        const char *kind = is_var ? "v" : is_whole ? "i" : " ";

        scan_define(s, name, *kind);
        if (s->failed)
            return;
        s->length = 0;
        scan_operand(s, name);
        number++;
        translate_add(&t->before, is_whole ? "%s=ROUND[#%u]" : "%s=#%u", s->out, number);
        if (scan_take(s, "="))
            scan_brackets(s);
        more = scan_take(s, ",");
    }
    scan_clear(s);
}

bool scan_program(struct scan *s, const char *order)
{
    struct translator *t = s->t;
    const bool begun = !t->worded && (t->subprogram[0] != '\0' || t->called == NULL);
    char name[NAME_MAX_];

    if (strcmp(order, "PROC") != 0 || !scan_name(s, name))
        return false;
    if (!begun)
        begin_subprogram(t, name);
    take_parameters(s);
    return true;
}

void scan_begin_called(struct scan *s)
{
    const char *before = s->at;
    char name[NAME_MAX_] = "";

    (void)scan_name(s, name);
    s->at = before;
    if (s->t->called != NULL && s->t->program == 0 && strcmp(name, "PROC") != 0)
        begin_subprogram(s->t, s->t->called);
}

/* ---- calls ---- */

/* L100 P2; arguments that are left out are 0. */
static void put_calls(struct scan *s, char *name, char argument[SCAN_ARGUMENTS][48],
                      unsigned arguments)
{
    unsigned times = 1;
    char text[TRANSLATE_CALL_MAX];
    char count[NAME_MAX_];
    const char *before = s->at;
    size_t length;

    if (name[0] == 'L' && scan_name(s, count) && count[0] == 'P' && scan_is_digit(count[1]))
        times = (unsigned)strtoul(count + 1, NULL, 10);
    else
        s->at = before;
    s->failed = s->failed || times == 0 || times > 9999;
    lower(name);
    length = (size_t)snprintf(text, sizeof text, "o<%s> call", name);
    for (unsigned i = 0; i < arguments; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, " [%s]",
                                   argument[i][0] != '\0' ? argument[i] : "0");
    for (unsigned i = 0; i < times && i < TRANSLATE_PROGRAMS_MAX && !s->failed; i++)
        translate_add(&s->t->behind, "%s", text);
}

bool siemens_call(struct scan *s, char *name)
{
    if (name[0] != 'L' || !scan_is_digit(name[1]) ||
        strspn(name + 1, "0123456789") != strlen(name + 1))
        return false;
    put_calls(s, name, NULL, 0);
    return true;
}

bool scan_call(struct scan *s, char *name)
{
    struct translator *t = s->t;
    char argument[SCAN_ARGUMENTS][48] = {{0}};
    unsigned arguments = 0;

    if (scan_keyword(s, name) || (scan_is_digit(name[1]) && name[0] != 'L')) {
        s->length = 0;
        return false;
    }
    scan_skip(s);
    if (*s->at == '(')
        arguments = scan_arguments(s, argument);
    if (s->failed || name[1] == '\0')
        return false;
    put_calls(s, name, argument, arguments);
    scan_skip(s);
    if (!scan_is_end(s) || s->failed) {
        t->behind.length = 0;
        return false;
    }
    scan_clear(s);
    return true;
}

bool scan_return(struct scan *s, const char *name)
{
    struct translator *t = s->t;

    if (t->subprogram[0] == '\0' || (strcmp(name, "M17") != 0 && strcmp(name, "RET") != 0))
        return false;
    translate_add(&t->behind, "o<%s> return", t->subprogram);
    return true;
}

void siemens_finish(struct translator *t)
{
    end_subprogram(t);
    output_add(&t->result->text, t->before.bytes, t->before.length);
}
