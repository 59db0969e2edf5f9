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

static bool begin(void *context, uint32_t size)
{
    struct program_store *store = context;
    char *room = malloc(size);

    if (room == NULL)
        return false;
    forget_file(store);
    free(store->staged);
    store->staged = room;
    store->staged_size = size;
    return true;
}

static bool take(void *context, uint32_t offset, const uint8_t *data, size_t length)
{
    struct program_store *store = context;

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
static bool prepare(void *context)
{
    struct program_store *store = context;
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
    good = write_all(file, store->staged, store->staged_size) && fchmod(file, FILE_MODE) == 0 &&
           fsync(file) == 0;
    good = close(file) == 0 && good;
    if (!good)
        forget_file(store);
    return good;
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

struct panel_store program_store_get_staging(struct program_store *store)
{
    return (struct panel_store){
        .begin = begin, .write = take, .prepare = prepare, .place = place, .context = store};
}

bool program_store_read(void *context, struct source *source)
{
    struct program_store *store = context;

    if (store->program == NULL)
        return false;
    source_open_text(source, &store->text, store->program, store->size);
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
