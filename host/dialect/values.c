/*
 * #<_ini[SECTION]NAME> and #<_hal[PIN]>: what LinuxCNC takes from its configuration and its signals
 * is a number of the machine file here.
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*
 * Spaces and case do not count in names. The length of what has been passed; 0: it is another name.
 */
static size_t match(const char *text, const char *name)
{
    size_t at = 0;

    for (; *name != '\0'; name++) {
        while (text[at] == ' ' || text[at] == '\t')
            at++;
        if (line_lower(text[at++]) != line_lower(*name))
            return 0;
    }
    while (text[at] == ' ' || text[at] == '\t')
        at++;
    return text[at] == '>' ? at + 1 : 0;
}

static bool is_global(const struct dialect_value *v)
{
    return v->name[0] == '_' && strchr(v->name, '[') == NULL;
}

static bool replace_at(struct translator *t, size_t at)
{
    struct line *l = &t->line;

    for (unsigned i = 0; i < t->codes->values; i++) {
        const struct dialect_value *v = &t->codes->value[i];
        const size_t length = is_global(v) ? 0 : match(&l->text[at + 2], v->name);
        char text[48];

        if (length > 0) {
            struct line_word whole = {.begin = (uint16_t)at, .end = (uint16_t)(at + 2 + length)};

            (void)snprintf(text, sizeof text, "[%.9f]", v->value);
            return line_replace(l, &whole, text);
        }
    }
    return false;
}

/* #name of senders and other languages is #<name>, or a number of the machine file. */
static void name_translate(struct translator *t, size_t at)
{
    struct line *l = &t->line;
    const size_t length = line_name_length(l, at + 1);
    struct line_word whole = {.begin = (uint16_t)at, .end = (uint16_t)(at + 1 + length)};
    char text[80];

    (void)snprintf(text, sizeof text, "#<%.*s>", (int)length, &l->text[at + 1]);
    for (unsigned i = 0; i < t->codes->values; i++) {
        const struct dialect_value *v = &t->codes->value[i];

        if (match(text + 2, v->name) > 0)
            (void)snprintf(text, sizeof text, "[%.9f]", v->value);
    }
    if (length < 64)
        (void)line_replace(l, &whole, text);
}

/* #0 is what has no value; here everything has one, 0 before it is given. */
static void nothing_translate(struct translator *t, size_t at)
{
    struct line_word whole = {.begin = (uint16_t)at, .end = (uint16_t)(at + 2)};
    const char behind = t->line.text[at + 2];

    if ((behind < '0' || behind > '9') && behind != '.' && !line_is_assigned(&t->line, at + 2))
        (void)line_replace(&t->line, &whole, "[0]");
}

/* The last parameter of LinuxCNC; those of 10100 and on are 100 and on by another name (Haas). */
#define NUMBER_LAST  5601U
#define AGAIN_FIRST  10100U
#define AGAIN_LAST   10999U
#define AGAIN_OFFSET 10000U

/* The number of a parameter that LinuxCNC does not have; 0: it has it, or there is none. */
static uint32_t number_at(const struct line *l, size_t at, size_t *length)
{
    char *end;
    const unsigned long number = strtoul(&l->text[at + 1], &end, 10);

    *length = (size_t)(end - &l->text[at]);
    if (l->text[at] != '#' || l->text[at + 1] < '0' || l->text[at + 1] > '9' || *length > 8)
        return 0;
    return number > NUMBER_LAST ? (uint32_t)number : 0;
}

static bool is_again(uint32_t number)
{
    return number >= AGAIN_FIRST && number <= AGAIN_LAST;
}

void names_survey(struct survey *s, const struct line *l)
{
    size_t length;

    for (size_t at = 0; at < l->length && strchr("(;", l->text[at]) == NULL; at++) {
        const uint32_t number = number_at(l, at, &length);
        unsigned i = 0;

        while (i < s->numbers && s->number[i] != number)
            i++;
        if (number != 0 && !is_again(number) && i == s->numbers && i < TRANSLATE_NUMBERS_MAX)
            s->number[s->numbers++] = number;
    }
}

void names_begin(struct translator *t)
{
    if (t->line.words == 0 || t->line.text[0] == '%')
        return;
    for (unsigned i = 0; i < t->survey.numbers; i++)
        translate_add(&t->before, "#<_n%u>=0", (unsigned)t->survey.number[i]);
    t->survey.numbers = 0;
}

static void number_translate(struct translator *t, size_t at)
{
    size_t length;
    const uint32_t number = number_at(&t->line, at, &length);
    struct line_word whole = {.begin = (uint16_t)at, .end = (uint16_t)(at + length)};
    char text[32];

    if (is_again(number))
        (void)snprintf(text, sizeof text, "#%u", (unsigned)(number - AGAIN_OFFSET));
    else
        (void)snprintf(text, sizeof text, "#<_n%u>", (unsigned)number);
    if (number != 0)
        (void)line_replace(&t->line, &whole, text);
}

void names_translate(struct translator *t)
{
    const bool macros = t->dialect == DIALECT_FANUC || t->dialect == DIALECT_HAAS;

    for (size_t at = 0; at < t->line.length && strchr("(;", t->line.text[at]) == NULL; at++) {
        if (macros && t->line.text[at] == '#')
            number_translate(t, at);
        if (t->line.text[at] == '#' && t->line.text[at + 1] == '0')
            nothing_translate(t, at);
        if (t->line.text[at] == '#' && line_name_length(&t->line, at + 1) > 0)
            name_translate(t, at);
    }
}

/* Global names keep what another program has given them: the machine file can say what. */
void globals_begin(struct translator *t)
{
    if (t->globals_given || t->line.words == 0 || strchr("%(;", t->line.text[0]) != NULL)
        return;
    for (unsigned i = 0; i < t->codes->values; i++) {
        const struct dialect_value *v = &t->codes->value[i];

        if (is_global(v))
            translate_add(&t->before, "#<%s>=%.9f", v->name, v->value);
    }
    t->globals_given = true;
}

void values_translate(struct translator *t)
{
    for (size_t at = 0; t->codes->values > 0 && at + 2 < t->line.length; at++) {
        const char *text = &t->line.text[at];

        if (text[0] == '#' && text[1] == '<')
            (void)replace_at(t, at);
    }
}
