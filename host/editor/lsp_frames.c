#include "editor/lsp_frames.h"

#include "words/line.h"

#include <stdlib.h>
#include <string.h>

static void drop_used(struct lsp_frames *f)
{
    if (f->used > 0)
        memmove(f->bytes, f->bytes + f->used, f->length - f->used);
    f->length -= f->used;
    f->used = 0;
}

bool lsp_frames_add(struct lsp_frames *f, const char *bytes, size_t length)
{
    drop_used(f);
    if (f->length + length > f->room) {
        const size_t room = 2 * (f->length + length) + 4096;
        char *grown = realloc(f->bytes, room);

        if (grown == NULL)
            return false;
        f->bytes = grown;
        f->room = room;
    }
    if (length > 0)
        memcpy(f->bytes + f->length, bytes, length);
    f->length += length;
    return true;
}

/* Behind the empty line that ends the header; 0: it has not come. */
static size_t header_end(const struct lsp_frames *f)
{
    static const char end[] = "\r\n\r\n";
    const size_t most = f->length < LSP_HEADER_MAX ? f->length : LSP_HEADER_MAX;

    for (size_t i = 0; i + sizeof end - 1 <= most; i++) {
        if (memcmp(f->bytes + i, end, sizeof end - 1) == 0)
            return i + sizeof end - 1;
    }
    return 0;
}

/* The number behind "Content-Length:" in a header; false: there is none that is right. */
static bool read_length(const char *header, size_t end, size_t *length)
{
    static const char name[] = "content-length:";
    size_t at = 0;

    while (at + sizeof name < end && !line_begins(header + at, name)) {
        while (header[at] != '\n')
            at++;
        at++;
    }
    if (at + sizeof name >= end)
        return false;
    at += sizeof name - 1;
    while (header[at] == ' ')
        at++;
    const size_t digits = at;

    for (*length = 0; header[at] >= '0' && header[at] <= '9' && *length <= LSP_MESSAGE_MAX; at++)
        *length = *length * 10 + (size_t)(header[at] - '0');
    return at > digits && header[at] == '\r' && *length <= LSP_MESSAGE_MAX;
}

enum lsp_frame lsp_frames_next(struct lsp_frames *f, const char **json, size_t *length)
{
    drop_used(f);
    const size_t begin = header_end(f);

    if (begin == 0)
        return f->length < LSP_HEADER_MAX ? LSP_FRAME_PART : LSP_FRAME_BROKEN;
    if (!read_length(f->bytes, begin, length))
        return LSP_FRAME_BROKEN;
    if (f->length - begin < *length)
        return LSP_FRAME_PART;
    *json = f->bytes + begin;
    f->used = begin + *length;
    return LSP_FRAME_WHOLE;
}

void lsp_frames_close(struct lsp_frames *f)
{
    free(f->bytes);
    *f = (struct lsp_frames){0};
}
