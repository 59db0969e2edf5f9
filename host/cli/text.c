#include "cli/text.h"

#include "cli/files_read.h"
#include "cli/message.h"
#include "cli/utf8.h"

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

static _Thread_local const struct text_held *text_held;
static _Thread_local unsigned text_held_count;

void text_hold(const struct text_held *held, unsigned count)
{
    text_held = held;
    text_held_count = count;
}

const struct text_held *text_find_held(const char *name)
{
    for (unsigned i = 0; i < text_held_count; i++) {
        if (strcmp(name, text_held[i].name) == 0)
            return &text_held[i];
    }
    return NULL;
}

static bool text_copy(struct text *text, const struct text_held *held)
{
    *text = (struct text){.name = held->name, .bytes = malloc(held->length + 1)};
    if (text->bytes == NULL) {
        message_command_error("out of memory");
        return false;
    }
    memcpy(text->bytes, held->bytes, held->length);
    text->bytes[held->length] = '\0';
    text->length = held->length;
    return true;
}

static bool text_load(struct text *text, const char *path)
{
    bool standard = strcmp(path, "-") == 0;
    FILE *file = standard ? stdin : fopen(path, "rb");
    bool good;

    *text = (struct text){.name = standard ? "<stdin>" : path};
    if (file == NULL) {
        message_error(text->name, 0, 0, "cannot be opened: %s", strerror(errno));
        return false;
    }
    files_read_note(path);
    good = text_fill(text, file);
    if (!good) {
        message_error(text->name, 0, 0, "cannot be read: %s", strerror(errno));
        text_free(text);
    }
    if (!standard)
        (void)fclose(file);
    return good;
}

/* It is no part of the text. Nothing binary that is read begins so. */
static void text_drop_mark(struct text *text)
{
    const size_t size = sizeof UTF8_MARK - 1;

    if (text->length < size || memcmp(text->bytes, UTF8_MARK, size) != 0)
        return;
    text->length -= size;
    memmove(text->bytes, text->bytes + size, text->length + 1);
}

bool text_read(struct text *text, const char *path)
{
    const struct text_held *held = text_find_held(path);
    const bool good = held != NULL ? text_copy(text, held) : text_load(text, path);

    if (good)
        text_drop_mark(text);
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
