#include "page/page_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_SIZE 4096
#define NUMBER_MAX 64

void page_text_clear(struct page_text *text)
{
    text->length = 0;
    text->has_failed = false;
    if (text->room != NULL)
        text->room[PAGE_TEXT_HEAD] = '\0';
}

void page_text_free(struct page_text *text)
{
    free(text->room);
    *text = (struct page_text){0};
}

const char *page_text_get(const struct page_text *text)
{
    return text->room != NULL ? text->room + PAGE_TEXT_HEAD : "";
}

/* False: out of memory. */
static bool make_room(struct page_text *text, size_t more)
{
    const size_t needed = PAGE_TEXT_HEAD + text->length + more + 1;
    size_t size = text->size > 0 ? text->size : FIRST_SIZE;
    char *room;

    if (needed <= text->size)
        return true;
    while (size < needed)
        size *= 2;
    room = realloc(text->room, size);
    text->has_failed = room == NULL;
    if (room == NULL)
        return false;
    text->room = room;
    text->size = size;
    return true;
}

static void add_bytes(struct page_text *text, const char *bytes, size_t length)
{
    if (text->has_failed || !make_room(text, length))
        return;
    memcpy(text->room + PAGE_TEXT_HEAD + text->length, bytes, length);
    text->length += length;
    text->room[PAGE_TEXT_HEAD + text->length] = '\0';
}

void page_text_add(struct page_text *text, const char *format, ...)
{
    va_list arguments;
    int length;

    va_start(arguments, format);
    length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length <= 0 || text->has_failed || !make_room(text, (size_t)length))
        return;
    va_start(arguments, format);
    (void)vsnprintf(text->room + PAGE_TEXT_HEAD + text->length, (size_t)length + 1, format,
                    arguments);
    va_end(arguments);
    text->length += (size_t)length;
}

/*
 * Bytes of the character that begins here, 0: it is none (RFC 3629, overlong forms and surrogates
 * left to the reader).
 */
static size_t character_length(const unsigned char *at)
{
    const size_t length = at[0] < 0x80                    ? 1
                          : at[0] >= 0xC2 && at[0] < 0xE0 ? 2
                          : at[0] >= 0xE0 && at[0] < 0xF0 ? 3
                          : at[0] >= 0xF0 && at[0] < 0xF5 ? 4
                                                          : 0;

    for (size_t i = 1; i < length; i++) {
        if ((at[i] & 0xC0) != 0x80)
            return 0;
    }
    return length;
}

void page_text_add_string(struct page_text *text, const char *string)
{
    const unsigned char *at = (const unsigned char *)string;

    add_bytes(text, "\"", 1);
    while (*at != '\0') {
        const size_t length = character_length(at);

        if (length == 0)
            add_bytes(text, "?", 1);
        else if (*at < ' ' || *at == '"' || *at == '\\')
            page_text_add(text, "\\u%04x", *at);
        else
            add_bytes(text, (const char *)at, length);
        at += length > 0 ? length : 1;
    }
    add_bytes(text, "\"", 1);
}

void page_text_add_number(struct page_text *text, double value)
{
    if (isfinite(value))
        page_text_add(text, "%.9g", value);
    else
        page_text_add(text, "null");
}
