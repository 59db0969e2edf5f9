/*
 * #<_ini[SECTION]NAME> and #<_hal[PIN]>: what LinuxCNC takes from its configuration and its signals is a number of the machine
 * file here.
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

/* Spaces and case do not count in names. The length of what has been passed; 0: it is another name. */
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

static bool replace_at(struct translator *t, size_t at)
{
    struct line *l = &t->line;

    for (unsigned i = 0; i < t->codes->values; i++) {
        const struct dialect_value *v = &t->codes->value[i];
        const size_t length = match(&l->text[at + 2], v->name);
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

void names_translate(struct translator *t)
{
    for (size_t at = 0; at < t->line.length && strchr("(;", t->line.text[at]) == NULL; at++) {
        if (t->line.text[at] == '#' && t->line.text[at + 1] == '0')
            nothing_translate(t, at);
        if (t->line.text[at] == '#' && line_name_length(&t->line, at + 1) > 0)
            name_translate(t, at);
    }
}

void values_translate(struct translator *t)
{
    for (size_t at = 0; t->codes->values > 0 && at + 2 < t->line.length; at++) {
        const char *text = &t->line.text[at];

        if (text[0] == '#' && text[1] == '<')
            (void)replace_at(t, at);
    }
}
