#include "takt/text.h"

#include "takt/message.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_CHUNK 65536

static bool text_grow(struct text *text, size_t *room)
{
    char *bytes;

    if (*room - text->length > TEXT_CHUNK)
        return true;
    *room = *room * 2 + (size_t)2 * TEXT_CHUNK;
    bytes = realloc(text->bytes, *room);
    if (bytes == NULL)
        return false;
    text->bytes = bytes;
    return true;
}

/* False: errno says why. */
static bool text_fill(struct text *text, FILE *file)
{
    size_t room = 0;

    for (;;) {
        size_t got;

        if (!text_grow(text, &room))
            return false;
        got = fread(text->bytes + text->length, 1, TEXT_CHUNK, file);
        text->length += got;
        text->bytes[text->length] = '\0';
        if (got == 0)
            return ferror(file) == 0;
    }
}

bool text_read(struct text *text, const char *path)
{
    bool standard = strcmp(path, "-") == 0;
    FILE *file = standard ? stdin : fopen(path, "rb");
    bool good;

    *text = (struct text){.name = standard ? "<stdin>" : path};
    if (file == NULL) {
        message_error(text->name, 0, 0, "cannot be opened: %s", strerror(errno));
        return false;
    }
    good = text_fill(text, file);
    if (!good) {
        message_error(text->name, 0, 0, "cannot be read: %s", strerror(errno));
        text_free(text);
    }
    if (!standard)
        (void)fclose(file);
    return good;
}

void text_free(struct text *text)
{
    free(text->bytes);
    text->bytes = NULL;
    text->length = 0;
}

bool text_next_line(const struct text *text, size_t *position, const char **line, size_t *length)
{
    const char *start = text->bytes + *position;
    size_t left = text->length - *position;
    const char *end;

    if (left == 0)
        return false;
    end = memchr(start, '\n', left);
    *line = start;
    *length = end != NULL ? (size_t)(end - start) : left;
    *position += *length + (end != NULL);
    if (*length > 0 && start[*length - 1] == '\r')
        (*length)--;
    return true;
}
