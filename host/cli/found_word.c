#include "cli/found_word.h"

#include "words/line.h"

#include <string.h>

/* In front of names of variables. */
#define VARIABLE "DEF_"

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_part_of_name(char c)
{
    const char low = line_lower(c);

    return is_digit(c) || (low >= 'a' && low <= 'z') || c == '_';
}

bool found_word_is_oword(const char *word)
{
    return word[0] == 'O' && (is_digit(word[1]) || word[1] == '<') && strchr(word, ' ') != NULL;
}

/* Does a word, whatever its case, begin there? */
static bool begins(const char *line, size_t length, size_t at, const char *word)
{
    for (; *word != '\0'; word++, at++) {
        if (at == length || line_lower(line[at]) != line_lower(*word))
            return false;
    }
    return true;
}

/* Behind N100 and NAME:, which say nothing. */
static size_t statement_of(const char *line, size_t length)
{
    size_t at = 0;

    while (at < length) {
        size_t end = at;

        while (end < length && is_part_of_name(line[end]))
            end++;
        const bool number = line_lower(line[at]) == 'n' && end > at + 1 && is_digit(line[at + 1]);
        const bool label = end > at && end < length && line[end] == ':';

        if (label)
            at = end + 1;
        else if (number)
            at = end;
        else if (line[at] == ' ' || line[at] == '\t' || line[at] == '/')
            at++;
        else
            return at;
    }
    return 0;
}

/* Where the keyword is in the line, else where its statement begins. */
static size_t place_of(const char *line, size_t length, const char *keyword)
{
    for (size_t at = 0; keyword != NULL && at < length; at++) {
        if ((at == 0 || !is_part_of_name(line[at - 1])) && begins(line, length, at, keyword + 1))
            return at;
    }
    return statement_of(line, length);
}

/* Up to a comment. */
static size_t end_of(const char *line, size_t length, size_t at)
{
    while (at < length && line[at] != ';' && line[at] != '\r' &&
           !(line[at] == '(' && at > 0 && line[at - 1] == ' '))
        at++;
    while (at > 0 && (line[at - 1] == ' ' || line[at - 1] == '\t'))
        at--;
    return at;
}

static bool is_letter(char c)
{
    return is_part_of_name(c) && !is_digit(c);
}

/* A letter without a number, or of an axis that is not there, that begins a name. */
static bool is_name(const char *line, size_t length, const struct diagnostic *d)
{
    const bool letter = d->code == TAKT_ERROR_NUMBER_EXPECTED || d->code == TAKT_ERROR_AXIS_MISSING;

    return letter && d->column > 0 && d->column < length && is_letter(line[d->column - 1]) &&
           is_letter(line[d->column]);
}

void found_word_restore(const char *line, size_t length, struct diagnostic *d)
{
    const size_t variable = strlen(VARIABLE);

    if (strncmp(d->word, VARIABLE, variable) == 0)
        memmove(d->word, d->word + variable, strlen(d->word) + 1 - variable);
    const bool name = is_name(line, length, d);

    if (!name && (!found_word_is_oword(d->word) ||
                  begins(line, length, statement_of(line, length), d->word)))
        return;
    const size_t at = name ? d->column - 1 : place_of(line, length, strchr(d->word, ' '));
    const size_t end = end_of(line, length, at);

    if (end > at)
        takt_diagnostic_set(d, name ? TAKT_ERROR_WORD_UNKNOWN : d->code, d->line, (uint32_t)at + 1,
                            line + at, end - at, d->value);
}
