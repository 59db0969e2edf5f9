/*
 * Flow, subprograms and orders of Siemens' language (siemens.c).
 */
#include "siemens/scan.h"
#include "siemens/siemens.h"
#include "translation/jumps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK_LABEL  98000000U
#define REPEAT_LABEL 99000000U
/* Jumps go to names: their numbers begin behind those of blocks. */
#define NAME_NUMBER 100000000U

/* ---- flow ---- */

static uint32_t number_of(struct translator *t, const char *name)
{
    for (unsigned i = 0; i < t->names; i++) {
        if (strcmp(t->name[i], name) == 0)
            return NAME_NUMBER + i;
    }
    if (t->names == TRANSLATE_PROGRAMS_MAX)
        return NAME_NUMBER + TRANSLATE_PROGRAMS_MAX;
    (void)snprintf(t->name[t->names], sizeof t->name[0], "%s", name);
    return NAME_NUMBER + t->names++;
}

static void clear(struct translator *t)
{
    (void)line_read(&t->line, "", 0);
}

static bool take_jump(struct scan *s, const char *name)
{
    char target[NAME_MAX_];

    if (strcmp(name, "GOTOF") != 0 && strcmp(name, "GOTOB") != 0 && strcmp(name, "GOTO") != 0)
        return false;
    s->failed = s->failed || !scan_name(s, target);
    if (s->failed)
        return true;
    clear(s->t);
    const bool numbered = target[0] == 'N' && scan_is_digit(target[1]);

    jumps_go_to(s->t, numbered ? (uint32_t)strtoul(target + 1, NULL, 10) : number_of(s->t, target));
    return true;
}

static uint32_t open_block(struct translator *t, uint32_t first)
{
    const uint32_t label = first + t->number % 1000000U;

    if (t->blocks < TRANSLATE_LINES_MAX)
        t->block[t->blocks++] = label;
    return label;
}

static uint32_t close_block(struct translator *t)
{
    return t->blocks > 0 ? t->block[--t->blocks] : 0;
}

static void take_if(struct scan *s)
{
    struct translator *t = s->t;
    char name[NAME_MAX_];
    const char *before;

    scan_brackets(s);
    before = s->at;
    const bool jumps = scan_name(s, name) && strncmp(name, "GOTO", 4) == 0;

    if (s->failed)
        return;
    clear(t);
    if (!jumps) {
        s->at = before;
        translate_add(&t->before, "o%u if %s", (unsigned)open_block(t, BLOCK_LABEL), s->out);
        return;
    }
    translate_add(&t->behind, "o%u if %s", (unsigned)(BLOCK_LABEL + t->number % 1000000U), s->out);
    (void)take_jump(s, name);
    translate_add(&t->behind, "o%u endif", (unsigned)(BLOCK_LABEL + t->number % 1000000U));
}

static void take_for(struct scan *s)
{
    struct translator *t = s->t;
    char name[NAME_MAX_];
    char variable[NAME_MAX_];

    s->failed = s->failed || !scan_name(s, name) || !scan_take(s, "=");
    scan_operand(s, name);
    (void)snprintf(variable, sizeof variable, "%.31s", s->out);
    s->length = 0;
    scan_brackets(s);
    s->failed = s->failed || !scan_name(s, name) || strcmp(name, "TO") != 0;
    if (s->failed)
        return;
    translate_add(&t->before, "%s=[%s-1]", variable, s->out);
    s->length = 0;
    scan_brackets(s);
    translate_add(&t->before, "o%u while [%s LT %s]", (unsigned)open_block(t, REPEAT_LABEL),
                  variable, s->out);
    translate_add(&t->before, "%s=[%s+1]", variable, variable);
    t->depth++;
    clear(t);
}

static void take_loop(struct scan *s, const char *condition)
{
    struct translator *t = s->t;

    t->depth++;
    translate_add(&t->before, "o%u while %s", (unsigned)open_block(t, REPEAT_LABEL), condition);
    clear(t);
}

static void end_loop(struct scan *s)
{
    struct translator *t = s->t;

    t->depth -= t->depth > 0 ? 1 : 0;
    translate_add(&t->behind, "o%u endwhile", (unsigned)close_block(t));
    clear(t);
}

/* REPEAT ... UNTIL a */
static void take_until(struct scan *s)
{
    struct translator *t = s->t;

    scan_brackets(s);
    if (s->failed)
        return;
    t->depth -= t->depth > 0 ? 1 : 0;
    translate_add(&t->behind, "o%u while [1-%s]", (unsigned)close_block(t), s->out);
    clear(t);
}

/* CASE(a) OF 1 GOTOF B 2 GOTOF C DEFAULT GOTOF D */
static void take_case(struct scan *s)
{
    struct translator *t = s->t;
    const unsigned label = BLOCK_LABEL + t->number % 1000000U;
    char asked[LINE_MAX_BYTES + 1];
    char name[NAME_MAX_];

    scan_brackets(s);
    (void)snprintf(asked, sizeof asked, "%s", s->out);
    s->failed = s->failed || !scan_name(s, name) || strcmp(name, "OF") != 0;
    for (scan_skip(s); !s->failed && !scan_is_end(s); scan_skip(s)) {
        const char *before = s->at;
        const bool rest = scan_name(s, name) && strcmp(name, "DEFAULT") == 0;

        s->at = rest ? s->at : before;
        s->length = 0;
        if (!rest)
            scan_single(s);
        if (s->failed)
            return;
        translate_add(&t->behind, "o%u if [%s EQ %s]", label, rest ? "0" : asked,
                      rest ? "0" : s->out);
        s->failed = !scan_name(s, name) || !take_jump(s, name);
        translate_add(&t->behind, "o%u endif", label);
    }
}

static bool take_flow(struct scan *s, const char *name)
{
    struct translator *t = s->t;

    if (take_jump(s, name))
        return true;
    if (strcmp(name, "IF") == 0) {
        take_if(s);
    } else if (strcmp(name, "CASE") == 0) {
        take_case(s);
    } else if (strcmp(name, "FOR") == 0) {
        take_for(s);
    } else if (strcmp(name, "WHILE") == 0) {
        scan_brackets(s);
        if (!s->failed)
            take_loop(s, s->out);
    } else if (strcmp(name, "LOOP") == 0) {
        take_loop(s, "[1]");
    } else if (strcmp(name, "ENDFOR") == 0 || strcmp(name, "ENDWHILE") == 0 ||
               strcmp(name, "ENDLOOP") == 0) {
        end_loop(s);
    } else if (strcmp(name, "REPEAT") == 0 && scan_is_end(s)) {
        t->depth++;
        translate_add(&t->before, "o%u do", (unsigned)open_block(t, REPEAT_LABEL));
        clear(t);
    } else if (strcmp(name, "UNTIL") == 0) {
        take_until(s);
    } else if (strcmp(name, "ELSE") == 0 && t->blocks > 0) {
        translate_add(&t->behind, "o%u else", (unsigned)t->block[t->blocks - 1]);
        clear(t);
    } else if (strcmp(name, "ENDIF") == 0) {
        translate_add(&t->behind, "o%u endif", (unsigned)close_block(t));
        clear(t);
    } else {
        return false;
    }
    return true;
}

/* ---- subprograms ---- */

static void end_subprogram(struct translator *t)
{
    if (t->subprogram[0] != '\0')
        translate_add(&t->before, "o<%s> endsub", t->subprogram);
    t->subprogram[0] = '\0';
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

/* %_N_L100_SPF, and the same of a main program. */
static bool take_section(struct translator *t, const char *text)
{
    char name[NAME_MAX_];
    struct scan s = {.t = t, .at = text + 4};

    if (strncmp(text, "%_N_", 4) != 0 || !scan_name(&s, name))
        return false;
    const size_t length = strlen(name);

    end_subprogram(t);
    if (length > 4 && strcmp(&name[length - 4], "_SPF") == 0) {
        name[length - 4] = '\0';
        begin_subprogram(t, name);
    }
    clear(t);
    return true;
}

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

/* L100 P2, NAME, NAME(1, 2): the whole line. */
static bool take_call(struct scan *s, char *name)
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
    clear(t);
    return true;
}

static bool take_return(struct scan *s, const char *name)
{
    struct translator *t = s->t;

    if (t->subprogram[0] == '\0' || (strcmp(name, "M17") != 0 && strcmp(name, "RET") != 0))
        return false;
    clear(t);
    translate_add(&t->behind, "o<%s> return", t->subprogram);
    return true;
}

/* ---- orders ---- */

/* MSG("text"); without a text it takes the last one away. */
static void take_text(struct scan *s)
{
    const char *begin = strchr(s->at, '"');
    const char *end = begin != NULL ? strchr(begin + 1, '"') : NULL;

    clear(s->t);
    if (end == NULL)
        return;
    translate_message(s->t, begin + 1, (size_t)(end - begin - 1));
}

/* TRANS without axes takes all away. */
static void take_shift(struct scan *s)
{
    scan_put(s, "G52 ");
    scan_skip(s);
    if (scan_is_end(s))
        scan_put(s, "X0 Y0 Z0");
    scan_words(s);
}

/* DEF REAL A=1, B */
static void take_definitions(struct scan *s)
{
    struct translator *t = s->t;
    char name[NAME_MAX_];

    s->failed = s->failed || !scan_name(s, name);
    do {
        s->failed = s->failed || !scan_name(s, name) || t->variables == TRANSLATE_PROGRAMS_MAX;
        if (s->failed)
            return;
        memcpy(t->variable[t->variables++], name, sizeof name);
        if (scan_take(s, "="))
            scan_assign(s, name);
    } while (scan_take(s, ","));
    clear(t);
}

/* PROC NAME(REAL A, INT B=2, VAR REAL C): #1, #2 ... of the subroutine. */
static void take_parameters(struct scan *s)
{
    struct translator *t = s->t;
    unsigned number = 0;
    bool more = scan_take(s, "(");
    char type[NAME_MAX_];
    char name[NAME_MAX_];

    while (more && !s->failed) {
        s->failed = !scan_name(s, type) || (strcmp(type, "VAR") == 0 && !scan_name(s, type)) ||
                    !scan_name(s, name) || t->variables == TRANSLATE_PROGRAMS_MAX;
        if (s->failed)
            return;
        memcpy(t->variable[t->variables++], name, sizeof name);
        s->length = 0;
        scan_operand(s, name);
        translate_add(&t->before, "%s=#%u", s->out, ++number);
        if (scan_take(s, "="))
            scan_brackets(s);
        more = scan_take(s, ",");
    }
    clear(t);
}

/* ---- a line ---- */

/* N100, and NAME: where jumps go to. */
static bool take_label(struct scan *s)
{
    const char *before = s->at;
    char name[NAME_MAX_];

    if (!scan_name(s, name))
        return false;
    if (*s->at == ':' && s->at[1] != '=') {
        s->at++;
        jumps_add_label(s->t, number_of(s->t, name));
        return true;
    }
    if (name[0] == 'N' && scan_is_digit(name[1]) &&
        strspn(name + 1, "0123456789") == strlen(name + 1)) {
        jumps_add_label(s->t, (uint32_t)strtoul(name + 1, NULL, 10));
        return true;
    }
    s->at = before;
    return false;
}

static bool take_order(struct scan *s, char *name)
{
    if (take_flow(s, name) || take_return(s, name) || siemens_cycle(s, name))
        return true;
    if (strcmp(name, "MSG") == 0) {
        take_text(s);
        return true;
    }
    if (strcmp(name, "DEF") == 0) {
        take_definitions(s);
        return true;
    }
    if (strcmp(name, "PROC") == 0 && scan_name(s, name)) {
        if (s->t->subprogram[0] == '\0')
            begin_subprogram(s->t, name);
        take_parameters(s);
        return true;
    }
    return *s->at != '=' && strcmp(name, "TRANS") != 0 && take_call(s, name);
}

void siemens_translate(struct translator *t)
{
    static _Thread_local struct line found;
    struct scan s = {.t = t, .at = found.text};
    const char *before;
    char name[NAME_MAX_];

    found = t->line;
    if (take_section(t, found.text))
        return;
    if (*s.at == '/')
        scan_put(&s, "%c", *s.at++);
    while (take_label(&s))
        ;
    before = s.at;
    if (scan_name(&s, name)) {
        if (take_order(&s, name)) {
            if (s.failed)
                t->line = found;
            return;
        }
        if (strcmp(name, "TRANS") != 0)
            s.at = before;
        else
            take_shift(&s);
    }
    scan_words(&s);
    if (!s.failed)
        siemens_drill(&s);
    if (!s.failed)
        (void)line_read(&t->line, s.out, s.length);
}

void siemens_finish(struct translator *t)
{
    end_subprogram(t);
    output_add(&t->result->text, t->before.bytes, t->before.length);
}
