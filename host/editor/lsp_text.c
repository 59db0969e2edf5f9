#include "editor/lsp_text.h"

#include "cli/utf8.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FILE_SCHEME "file://"

const char *lsp_text_line(const char *text, size_t text_length, uint32_t line, size_t *length)
{
    const char *at = text;
    const char *end = text + text_length;

    for (; line > 0 && at < end; line--) {
        const char *next = memchr(at, '\n', (size_t)(end - at));

        at = next != NULL ? next + 1 : end;
    }
    const char *stop = at < end ? memchr(at, '\n', (size_t)(end - at)) : NULL;

    *length = (size_t)((stop != NULL ? stop : end) - at);
    if (*length > 0 && at[*length - 1] == '\r')
        (*length)--;
    return at;
}

/*
 * Code units that begin with a byte of UTF-8: none inside of a character, two beyond the first
 * plane.
 */
static size_t units_of(unsigned char byte)
{
    if ((byte & 0xc0U) == 0x80U)
        return 0;
    return byte >= 0xf0U ? 2 : 1;
}

size_t lsp_text_units(const char *line, size_t length, size_t bytes)
{
    size_t units = 0;

    for (size_t i = 0; i < bytes && i < length; i++)
        units += units_of((unsigned char)line[i]);
    return units;
}

size_t lsp_text_byte(const char *line, size_t length, size_t units)
{
    size_t at = 0;

    for (size_t seen = 0; at < length; at++) {
        seen += units_of((unsigned char)line[at]);
        if (seen > units)
            return at;
    }
    return at;
}

void lsp_text_clean(char *text)
{
    while (*text != '\0') {
        const size_t length = utf8_length(text);

        if (length == 0)
            *text = '?';
        text += length > 0 ? length : 1;
    }
}

/* The value of a hexadecimal digit; -1: it is none. */
static int hex(char c)
{
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *at = c != '\0' ? strchr(digits, c) : NULL;

    return at != NULL ? (int)(at - digits) % 16 : -1;
}

char *lsp_text_path(const char *uri)
{
    const bool is_file = strncmp(uri, FILE_SCHEME, strlen(FILE_SCHEME)) == 0;
    const char *from = is_file ? uri + strlen(FILE_SCHEME) : uri;
    char *path = malloc(strlen(from) + 1);
    char *to = path;

    while (path != NULL && *from != '\0') {
        const int high = is_file && from[0] == '%' ? hex(from[1]) : -1;
        const int low = high >= 0 ? hex(from[2]) : -1;

        *to = *from;
        if (low >= 0 && high + low > 0)
            *to = (char)(high * 16 + low);
        to++;
        from += low >= 0 ? 3 : 1;
    }
    if (path != NULL)
        *to = '\0';
    return path;
}

static bool is_plain(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           (c != '\0' && strchr("/-._~", c) != NULL);
}

char *lsp_text_uri(const char *path)
{
    const size_t room = strlen(FILE_SCHEME) + 3 * strlen(path) + 1;
    char *uri = malloc(room);
    size_t length;

    if (uri == NULL)
        return NULL;
    length = (size_t)snprintf(uri, room, "%s", FILE_SCHEME);
    for (; *path != '\0'; path++)
        length += (size_t)snprintf(uri + length, room - length, is_plain(*path) ? "%c" : "%%%02X",
                                   (unsigned)(unsigned char)*path);
    return uri;
}
