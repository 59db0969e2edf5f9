#include "program/source.h"

#include <string.h>

static long text_read(void *context, char *buffer, size_t size)
{
    struct source_text *t = context;
    size_t count = t->length - t->position;

    if (count == 0) {
        return SOURCE_END;
    }
    if (count > size) {
        count = size;
    }
    memcpy(buffer, t->text + t->position, count);
    t->position += count;
    return (long)count;
}

static bool text_seek(void *context, uint64_t offset)
{
    struct source_text *t = context;

    if (offset > t->length) {
        return false;
    }
    t->position = (size_t)offset;
    return true;
}

void takt_source_open_text(struct source *source, struct source_text *context, const char *text,
                           size_t length)
{
    context->text = text;
    context->length = length;
    context->position = 0;
    source->read = text_read;
    source->seek = text_seek;
    source->context = context;
}
