#define _XOPEN_SOURCE 700

#include "serve/state_disk.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILE_MODE   0644
#define NAME_MAX_IN 16
#define BLANK       0xFF

uint8_t *state_disk_mirror(struct state_disk *disk, unsigned sector)
{
    return disk->mirror[sector];
}

/* The old head goes first: half a set with the head of another would be looked at. */
static bool erase(void *context, unsigned sector)
{
    struct state_disk *disk = context;

    memset(disk->mirror[sector], BLANK, disk->sector_bytes);
    return true;
}

static bool put(struct state_disk *disk, unsigned sector, uint32_t from, uint32_t to)
{
    return disk->ops.write(disk->ops.context, sector, from, disk->mirror[sector] + from,
                           to - from) &&
           disk->ops.sync(disk->ops.context, sector);
}

/* The head is the last that comes, at the beginning. */
static bool program(void *context, unsigned sector, uint32_t offset, const uint8_t *bytes,
                    uint32_t words)
{
    struct state_disk *disk = context;
    const uint32_t size = words * FLASH_WORD_BYTES;

    memcpy(disk->mirror[sector] + offset, bytes, size);
    if (offset > 0) {
        disk->written[sector] = offset + size;
        return true;
    }
    return put(disk, sector, size, disk->written[sector]) && put(disk, sector, 0, size);
}

struct flash_port state_disk_get_port(struct state_disk *disk)
{
    return (struct flash_port){
        .sector_bytes = disk->sector_bytes,
        .sector = {disk->mirror[0], disk->mirror[1]},
        .erase = erase,
        .program = program,
        .context = disk,
    };
}

/* A file that is not there comes with its first bytes: one that is there has held something. */
static bool open_file(struct state_disk *disk, unsigned i, int flags)
{
    char name[NAME_MAX_IN];

    (void)snprintf(name, sizeof name, "state-%u", i);
    disk->file[i] = openat(disk->folder, name, O_RDWR | O_CLOEXEC | flags, FILE_MODE);
    return disk->file[i] >= 0;
}

static bool write_file(void *context, unsigned file, uint32_t offset, const uint8_t *bytes,
                       size_t size)
{
    struct state_disk *disk = context;

    if (disk->file[file] < 0 && !open_file(disk, file, O_CREAT))
        return false;
    while (size > 0) {
        const ssize_t written = pwrite(disk->file[file], bytes, size, (off_t)offset);

        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        bytes += written;
        offset += (uint32_t)written;
        size -= (size_t)written;
    }
    return true;
}

static bool sync_file(void *context, unsigned file)
{
    const struct state_disk *disk = context;

    return fsync(disk->file[file]) == 0 && fsync(disk->folder) == 0;
}

static bool make_mirrors(struct state_disk *disk, uint32_t sector_bytes)
{
    disk->sector_bytes = sector_bytes;
    for (unsigned i = 0; i < FLASH_SECTORS; i++) {
        disk->file[i] = -1;
        disk->mirror[i] = malloc(sector_bytes);
        if (disk->mirror[i] == NULL)
            return false;
        memset(disk->mirror[i], BLANK, sector_bytes);
    }
    return true;
}

bool state_disk_open_on(struct state_disk *disk, const struct state_disk_ops *ops,
                        uint32_t sector_bytes)
{
    memset(disk, 0, sizeof *disk);
    disk->folder = -1;
    disk->ops = *ops;
    if (make_mirrors(disk, sector_bytes))
        return true;
    state_disk_close(disk);
    return false;
}

/* What is longer than a sector is none of ours, and fails the checks. */
static bool read_file(struct state_disk *disk, unsigned i)
{
    uint32_t at = 0;

    while (at < disk->sector_bytes) {
        const ssize_t got =
            pread(disk->file[i], disk->mirror[i] + at, disk->sector_bytes - at, (off_t)at);

        if (got == 0)
            return true;
        if (got < 0 && errno != EINTR)
            return false;
        at += got > 0 ? (uint32_t)got : 0;
    }
    return true;
}

static bool find_file(struct state_disk *disk, unsigned i)
{
    if (!open_file(disk, i, 0))
        return errno == ENOENT;
    disk->was_there = true;
    return read_file(disk, i);
}

bool state_disk_open(struct state_disk *disk, const char *folder, uint32_t sector_bytes)
{
    const struct state_disk_ops ops = {write_file, sync_file, disk};

    if (!state_disk_open_on(disk, &ops, sector_bytes))
        return false;
    disk->folder = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (disk->folder >= 0 && find_file(disk, 0) && find_file(disk, 1) && fsync(disk->folder) == 0)
        return true;
    state_disk_close(disk);
    return false;
}

static void close_one(int *file)
{
    if (*file >= 0)
        (void)close(*file);
    *file = -1;
}

void state_disk_close(struct state_disk *disk)
{
    const int because = errno;

    for (unsigned i = 0; i < FLASH_SECTORS; i++) {
        if (disk->mirror[i] != NULL)
            close_one(&disk->file[i]);
        free(disk->mirror[i]);
        disk->mirror[i] = NULL;
    }
    close_one(&disk->folder);
    errno = because;
}
