#define _XOPEN_SOURCE 700

#include "serve/program_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FILE_MODE 0644

bool program_store_open(struct program_store *store, const char *path)
{
    memset(store, 0, sizeof *store);
    store->path = path;
    return path == NULL || strlen(path) < PROGRAM_STORE_PATH_MAX;
}

static void forget_file(struct program_store *store)
{
    if (store->aside[0] != '\0')
        (void)unlink(store->aside);
    store->aside[0] = '\0';
}

void program_store_close(struct program_store *store)
{
    forget_file(store);
    free(store->program);
    free(store->staged);
    store->stream = NULL;
    memset(store, 0, sizeof *store);
}

bool program_store_set(struct program_store *store, const char *bytes, size_t size)
{
    char *copy = malloc(size > 0 ? size : 1);

    if (copy == NULL)
        return false;
    memcpy(copy, bytes, size);
    free(store->program);
    store->program = copy;
    store->size = size;
    return true;
}

/* A stream that has not come to its end never will: its place is another's. */
static void end_stream_before(struct program_store *store)
{
    unsigned coming = PROGRAM_STREAM_COMING;

    (void)atomic_compare_exchange_strong(&store->coming, &coming, PROGRAM_STREAM_WRONG);
    if (store->stream == store->staged)
        store->stream = NULL;
}

static bool begin(void *context, uint32_t size)
{
    struct program_store *store = context;
    char *room = malloc(size);

    if (room == NULL)
        return false;
    end_stream_before(store);
    forget_file(store);
    free(store->staged);
    store->staged = room;
    store->staged_size = size;
    return true;
}

static bool begin_stream(void *context, uint32_t size)
{
    struct program_store *store = context;

    if (!begin(store, size))
        return false;
    store->stream = store->staged;
    store->stream_size = size;
    atomic_store(&store->has_come, 0);
    atomic_store(&store->coming, PROGRAM_STREAM_COMING);
    return true;
}

/* Where the last line that these bytes end ends; before them, if they end none. */
static unsigned end_of_lines(const struct program_store *store, uint32_t offset, size_t length)
{
    for (size_t at = offset + length; at > offset; at--) {
        if (store->stream[at - 1] == '\n')
            return (unsigned)at;
    }
    return atomic_load(&store->has_come);
}

static bool take_stream(struct program_store *store, uint32_t offset, const uint8_t *data,
                        size_t length)
{
    if (offset > store->stream_size || length > store->stream_size - offset)
        return false;
    memcpy(store->stream + offset, data, length);
    atomic_store(&store->has_come, end_of_lines(store, offset, length));
    return true;
}

static bool take(void *context, uint32_t offset, const uint8_t *data, size_t length)
{
    struct program_store *store = context;

    if (atomic_load(&store->coming) == PROGRAM_STREAM_COMING)
        return take_stream(store, offset, data, length);
    if (offset > store->staged_size || length > store->staged_size - offset)
        return false;
    memcpy(store->staged + offset, data, length);
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
static bool write_aside(struct program_store *store, const char *bytes, size_t size)
{
    bool good;
    int file;

    if (store->path == NULL)
        return true;
    forget_file(store);
    (void)snprintf(store->aside, sizeof store->aside, "%s.part-XXXXXX", store->path);
    file = mkstemp(store->aside);
    if (file < 0) {
        store->aside[0] = '\0';
        return false;
    }
    good = write_all(file, bytes, size) && fchmod(file, FILE_MODE) == 0 && fsync(file) == 0;
    good = close(file) == 0 && good;
    if (!good)
        forget_file(store);
    return good;
}

static bool prepare(void *context)
{
    struct program_store *store = context;

    return write_aside(store, store->staged, store->staged_size);
}

static bool place(void *context)
{
    struct program_store *store = context;
    bool good = store->path == NULL || rename(store->aside, store->path) == 0;

    if (good)
        store->aside[0] = '\0';
    forget_file(store);
    return good;
}

/* What has come whole is kept as any program. */
static void end_stream(void *context, bool right)
{
    struct program_store *store = context;

    if (right) {
        atomic_store(&store->has_come, (unsigned)store->stream_size);
        (void)(write_aside(store, store->stream, store->stream_size) && place(store));
    }
    atomic_store(&store->coming, right ? PROGRAM_STREAM_WHOLE : PROGRAM_STREAM_WRONG);
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

static bool is_stream(const struct program_store *store)
{
    return store->program != NULL && store->program == store->stream;
}

bool program_store_get(const struct program_store *store, const char **text, size_t *size)
{
    *text = store->program;
    *size = is_stream(store) ? atomic_load(&store->has_come) : store->size;
    return store->program != NULL;
}

/* As far as it has come. How it ends is looked at first: then all that came before is there. */
static long read_stream(void *context, char *buffer, size_t size)
{
    struct program_store *store = context;
    const unsigned coming = atomic_load(&store->coming);
    const size_t left = atomic_load(&store->has_come) - store->text.position;
    const size_t count = left < size ? left : size;

    if (coming == PROGRAM_STREAM_WRONG)
        return SOURCE_ERROR;
    if (count == 0)
        return coming == PROGRAM_STREAM_WHOLE ? SOURCE_END : SOURCE_LATER;
    memcpy(buffer, store->program + store->text.position, count);
    store->text.position += count;
    return (long)count;
}

/* What has been read may be read again. */
static bool seek_stream(void *context, uint64_t offset)
{
    struct program_store *store = context;

    if (offset > atomic_load(&store->has_come))
        return false;
    store->text.position = (size_t)offset;
    return true;
}

bool program_store_read(void *context, struct source *source)
{
    struct program_store *store = context;

    if (store->program == NULL)
        return false;
    if (is_stream(store)) {
        store->text.position = 0;
        *source = (struct source){.read = read_stream, .seek = seek_stream, .context = store};
        return true;
    }
    takt_source_open_text(source, &store->text, store->program, store->size);
    return true;
}

/* The one before is kept until the next upload: nothing is freed in the control thread. */
void program_store_adopt(void *context)
{
    struct program_store *store = context;
    char *before = store->program;
    const size_t before_size = store->size;

    store->program = store->staged;
    store->size = store->staged_size;
    store->staged = before;
    store->staged_size = before_size;
}
