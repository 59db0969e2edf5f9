#include "translation/result.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void output_add(struct dialect_text *t, const char *bytes, size_t length)
{
    if (t->length + length > t->room) {
        const size_t room = 2 * (t->length + length) + 4096;
        char *grown = t->failed ? NULL : realloc(t->bytes, room);

        t->failed = grown == NULL;
        if (t->failed)
            return;
        t->bytes = grown;
        t->room = room;
    }
    if (length > 0)
        memcpy(t->bytes + t->length, bytes, length);
    t->length += length;
}

void output_print(struct dialect_text *t, const char *format, ...)
{
    char text[256];
    va_list arguments;

    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);

    va_end(arguments);
    if (length > 0)
        output_add(t, text, (size_t)length < sizeof text ? (size_t)length : sizeof text - 1);
}

void dialect_text_free(struct dialect_text *t)
{
    free(t->bytes);
    *t = (struct dialect_text){0};
}
