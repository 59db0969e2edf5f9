#include "drives/dictionary_text.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define MARK_LENGTH 2 /* of UTF-16, which is FE FF or FF FE */

static bool begins_with(const char *text, size_t length, const char *mark)
{
    return length >= MARK_LENGTH && memcmp(text, mark, MARK_LENGTH) == 0;
}

/* first: of the two bytes of a character the lower one, 0 or 1. */
static size_t take_utf16(char *plain, const char *text, size_t length, size_t first)
{
    size_t count = 0;
    for (size_t i = MARK_LENGTH; i + 1 < length; i += 2) {
        const char low = text[i + first], high = text[i + 1 - first];
        plain[count++] = (char)(high == 0 && (unsigned char)low < 0x80 ? low : '?');
    }
    return count;
}

char *dictionary_plain_text(const char *text, size_t *length)
{
    char *plain = malloc(*length + 1);
    if (plain == NULL)
        return NULL;
    if (begins_with(text, *length, "\xFF\xFE"))
        *length = take_utf16(plain, text, *length, 0);
    else if (begins_with(text, *length, "\xFE\xFF"))
        *length = take_utf16(plain, text, *length, 1);
    else if (*length > 0)
        memcpy(plain, text, *length);
    for (size_t i = 0; i < *length; i++)
        if (plain[i] == '\r')
            plain[i] = '\n';
    return plain;
}
