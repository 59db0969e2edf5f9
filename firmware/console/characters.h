/*
 * Text without a C library.
 */
#ifndef TAKT_CONSOLE_CHARACTERS_H
#define TAKT_CONSOLE_CHARACTERS_H

#include <stdbool.h>
#include <stddef.h>

static inline size_t characters_length(const char *text)
{
    size_t length = 0;

    while (text[length] != '\0')
        length++;
    return length;
}

static inline const char *characters_skip_spaces(const char *text)
{
    while (*text == ' ' || *text == '\t')
        text++;
    return text;
}

static inline bool characters_are_blank(const char *text)
{
    return *characters_skip_spaces(text) == '\0';
}

static inline char characters_upper(char c)
{
    if (c >= 'a' && c <= 'z')
        c = (char)(c - 'a' + 'A');
    return c;
}

#endif
