#define _XOPEN_SOURCE 700

#include "serve/program_store.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FILE_MODE 0644

static void forget_file(struct program_store *store)
{
    if (store->is_aside)
        (void)unlink(store->aside);
    store->is_aside = false;
}

/* An upload that power has cut short is nobody's. */
static void name_aside(struct program_store *store)
{
    (void)snprintf(store->aside, sizeof store->aside, "%s.takt-part", store->path);
    (void)unlink(store->aside);
}

bool program_store_open(struct program_store *store, const char *path)
{
    memset(store, 0, sizeof *store);
    store->program = &store->text[0];
    store->staged = store->brought = &store->text[1];
    if (path != NULL && strlen(path) >= PROGRAM_STORE_PATH_MAX)
        return false;
    store->path = path;
    if (path != NULL)
        name_aside(store);
    return true;
}

void program_store_close(struct program_store *store)
{
    forget_file(store);
    free(store->text[0].bytes);
    free(store->text[1].bytes);
    memset(store, 0, sizeof *store);
}

bool program_store_set(struct program_store *store, const char *bytes, size_t size)
{
    char *copy = malloc(size > 0 ? size : 1);

    if (copy == NULL)
        return false;
    memcpy(copy, bytes, size);
    free(store->program->bytes);
    store->program->bytes = copy;
    store->program->size = size;
    return true;
}

static bool is_coming(const struct stored_text *text)
{
    return atomic_load(&text->coming) == PROGRAM_STREAM_COMING;
}

static bool begin_any(struct program_store *store, uint32_t size, enum program_stream coming)
{
    struct stored_text *text = store->staged;
    char *room = malloc(size);

    if (room == NULL)
        return false;
    /* A stream that has not come to its end never will: another upload takes its place. */
    if (is_coming(store->brought))
        atomic_store(&store->brought->coming, PROGRAM_STREAM_WRONG);
    forget_file(store);
    free(text->bytes);
    text->bytes = room;
    text->size = size;
    atomic_store(&text->has_come, 0);
    atomic_store(&text->coming, coming);
    store->brought = text;
    return true;
}

static bool begin(void *context, uint32_t size)
{
    return begin_any(context, size, PROGRAM_STREAM_NONE);
}

static bool begin_stream(void *context, uint32_t size)
{
    return begin_any(context, size, PROGRAM_STREAM_COMING);
}

/* Where the last line that these bytes end ends; before them, if they end none. */
static unsigned end_of_lines(const struct stored_text *text, uint32_t offset, size_t length)
{
    for (size_t at = offset + length; at > offset; at--) {
        if (text->bytes[at - 1] == '\n')
            return (unsigned)at;
    }
    return atomic_load(&text->has_come);
}

static bool take(void *context, uint32_t offset, const uint8_t *data, size_t length)
{
    struct stored_text *text = ((struct program_store *)context)->brought;

    if (offset > text->size || length > text->size - offset)
        return false;
    memcpy(text->bytes + offset, data, length);
    if (is_coming(text))
        atomic_store(&text->has_come, end_of_lines(text, offset, length));
    return true;
}

static bool write_all(int file, const char *bytes, size_t size)
{
    while (size > 0) {
        const ssize_t written = write(file, bytes, size);

        if (written <= 0)
            return false;
        bytes += written;
        size -= (size_t)written;
    }
    return true;
}

/* Beside its place, and on the disk. */
static bool write_aside(struct program_store *store, const struct stored_text *text)
{
    bool good;
    int file;

    if (store->path == NULL)
        return true;
    forget_file(store);
    file = open(store->aside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    store->is_aside = file >= 0;
    if (file < 0)
        return false;
    good = write_all(file, text->bytes, text->size) && fchmod(file, FILE_MODE) == 0 &&
           fsync(file) == 0;
    good = close(file) == 0 && good;
    if (!good)
        forget_file(store);
    return good;
}

bool program_store_can_keep(struct program_store *store)
{
    const struct stored_text nothing = {.size = 0};
    struct stat status;
    const bool good = write_aside(store, &nothing);

    forget_file(store);
    if (!good || store->path == NULL || stat(store->path, &status) != 0 || !S_ISDIR(status.st_mode))
        return good;
    errno = EISDIR;
    return false;
}

static bool prepare(void *context)
{
    struct program_store *store = context;

    return write_aside(store, store->staged);
}

static bool place(void *context)
{
    struct program_store *store = context;
    bool good = store->path == NULL || rename(store->aside, store->path) == 0;

    if (good)
        store->is_aside = false;
    forget_file(store);
    return good;
}

/* What has come whole is kept as any program. */
static void end_stream(void *context, bool right)
{
    struct program_store *store = context;
    struct stored_text *text = store->brought;

    if (right) {
        atomic_store(&text->has_come, (unsigned)text->size);
        (void)(write_aside(store, text) && place(store));
    }
    atomic_store(&text->coming, right ? PROGRAM_STREAM_WHOLE : PROGRAM_STREAM_WRONG);
}

struct panel_store program_store_get_staging(struct program_store *store)
{
    return (struct panel_store){.begin = begin,
                                .write = take,
                                .prepare = prepare,
                                .place = place,
                                .begin_stream = begin_stream,
                                .end_stream = end_stream,
                                .context = store};
}

static bool is_stream(const struct stored_text *text)
{
    return atomic_load(&text->coming) != PROGRAM_STREAM_NONE;
}

bool program_store_get(const struct program_store *store, const char **text, size_t *size)
{
    const struct stored_text *program = store->program;

    *text = program->bytes;
    *size = is_stream(program) ? atomic_load(&program->has_come) : program->size;
    return program->bytes != NULL;
}

/* As far as it has come. How it ends is looked at first: then all that came before is there. */
static long read_stream(void *context, char *buffer, size_t size)
{
    struct stored_text *text = context;
    const unsigned coming = atomic_load(&text->coming);
    const size_t has_come = atomic_load(&text->has_come);
    const size_t position = text->source.position;
    const size_t left = has_come > position ? has_come - position : 0;
    const size_t count = left < size ? left : size;

    if (coming == PROGRAM_STREAM_WRONG)
        return SOURCE_ERROR;
    if (count == 0)
        return coming == PROGRAM_STREAM_WHOLE ? SOURCE_END : SOURCE_LATER;
    memcpy(buffer, text->bytes + position, count);
    text->source.position += count;
    return (long)count;
}

/* What has been read may be read again. */
static bool seek_stream(void *context, uint64_t offset)
{
    struct stored_text *text = context;

    if (offset > atomic_load(&text->has_come))
        return false;
    text->source.position = (size_t)offset;
    return true;
}

bool program_store_read(void *context, struct source *source)
{
    struct stored_text *text = ((struct program_store *)context)->program;

    if (text->bytes == NULL)
        return false;
    takt_source_open_text(source, &text->source, text->bytes, text->size);
    if (is_stream(text))
        *source = (struct source){.read = read_stream, .seek = seek_stream, .context = text};
    return true;
}

/* The one before is kept until the next upload: nothing is freed in the control thread. */
void program_store_adopt(void *context)
{
    struct program_store *store = context;
    struct stored_text *before = store->program;

    store->program = store->staged;
    store->staged = before;
}
