#define _POSIX_C_SOURCE 200809L

#include "cli/files_read.h"

#include <stddef.h>
#include <stdlib.h>
#include <sys/stat.h>

struct file_read {
    dev_t device;
    ino_t number;
};

/* Of a thread, so that programs beside which takt is a library are not noted for ever. */
static _Thread_local bool is_noting;
static _Thread_local struct file_read *noted;
static _Thread_local size_t noted_count, noted_room;

void files_read_begin(void)
{
    is_noting = true;
    noted_count = 0;
}

static bool is_noted(const struct stat *status)
{
    for (size_t i = 0; i < noted_count; i++) {
        if (noted[i].device == status->st_dev && noted[i].number == status->st_ino)
            return true;
    }
    return false;
}

static bool make_room(void)
{
    const size_t room = noted_room * 2 + 16;
    struct file_read *more;

    if (noted_count < noted_room)
        return true;
    more = realloc(noted, room * sizeof *noted);
    if (more == NULL)
        return false;
    noted = more;
    noted_room = room;
    return true;
}

void files_read_note(const char *path)
{
    struct stat status;

    if (!is_noting || stat(path, &status) != 0 || !S_ISREG(status.st_mode) || is_noted(&status) ||
        !make_room())
        return;
    noted[noted_count++] = (struct file_read){status.st_dev, status.st_ino};
}

bool files_read_has(const char *path)
{
    struct stat status;

    return noted_count > 0 && stat(path, &status) == 0 && is_noted(&status);
}
