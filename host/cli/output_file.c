#define _XOPEN_SOURCE 700

#include "cli/output_file.h"

#include "cli/files_read.h"
#include "cli/message.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool output_file_fail(struct output_file *file, const char *what)
{
    message_command_error("%s %s: %s", file->path, what, strerror(errno));
    output_file_discard(file);
    return false;
}

/*
 * Where the bytes will end up: behind links, so that renaming replaces the file and not the link.
 */
static bool output_file_resolve(struct output_file *file, const char *path, bool *straight)
{
    struct stat status;
    char *real = realpath(path, NULL);

    (void)snprintf(file->path, sizeof file->path, "%s", real != NULL ? real : path);
    free(real);
    if (strlen(path) >= sizeof file->path) {
        errno = ENAMETOOLONG;
        return false;
    }
    *straight = stat(file->path, &status) == 0 && !S_ISREG(status.st_mode);
    return true;
}

static FILE *output_file_open_aside(struct output_file *file)
{
    mode_t mask = umask(0);
    int descriptor;

    (void)umask(mask);
    (void)snprintf(file->aside, sizeof file->aside, "%s.part-XXXXXX", file->path);
    descriptor = mkstemp(file->aside);
    if (descriptor < 0) {
        file->aside[0] = '\0';
        return NULL;
    }
    /* mkstemp makes files only their owner can read; give it the rights any new file would have. */
    (void)fchmod(descriptor, 0666 & ~mask);
    return fdopen(descriptor, "w+b");
}

/* Both exist and are the same, whatever links lead to them. */
static bool is_same(const char *a, const char *b)
{
    struct stat first, second;

    return stat(a, &first) == 0 && stat(b, &second) == 0 && S_ISREG(first.st_mode) &&
           first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

bool output_file_differ(const char *const option[], const char *const path[], unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        for (unsigned k = 0; k < i && path[i] != NULL; k++) {
            if (path[k] != NULL && (strcmp(path[k], path[i]) == 0 || is_same(path[k], path[i]))) {
                message_command_error("--%s and --%s name the same file", option[k], option[i]);
                return false;
            }
        }
    }
    return true;
}

bool output_file_may_write(const char *path)
{
    if (strcmp(path, "-") == 0 || !files_read_has(path))
        return true;
    message_command_error("%s is read and would be written over; another name is needed", path);
    return false;
}

bool output_file_open(struct output_file *file, const char *path)
{
    return output_file_replace(file, path, NULL);
}

bool output_file_replace(struct output_file *file, const char *path, const char *over)
{
    bool straight = false;

    file->stream = NULL;
    file->aside[0] = '\0';
    file->replaces = over != NULL && is_same(path, over);
    if (strcmp(path, "-") == 0) {
        (void)snprintf(file->path, sizeof file->path, "<stdout>");
        file->stream = stdout;
        return true;
    }
    if (!output_file_resolve(file, path, &straight))
        return output_file_fail(file, "cannot be created");
    if (!file->replaces && !output_file_may_write(file->path))
        return false;
    file->stream = straight ? fopen(file->path, "wb") : output_file_open_aside(file);
    return file->stream != NULL || output_file_fail(file, "cannot be created");
}

static bool output_file_close(struct output_file *file)
{
    FILE *stream = file->stream;
    bool good = fflush(stream) == 0 && ferror(stream) == 0;

    file->stream = NULL;
    if (stream != stdout)
        good = fclose(stream) == 0 && good;
    return good;
}

/* Why is asked by a last byte: errno of the write that failed may be of another call by now. */
bool output_file_tell_failed(struct output_file *file)
{
    if (file->stream == NULL || ferror(file->stream) == 0)
        return false;
    clearerr(file->stream);
    errno = 0;
    if (fputc('\n', file->stream) == EOF || fflush(file->stream) != 0)
        message_command_error("%s cannot be written: %s", file->path, strerror(errno));
    else
        message_command_error("%s: not everything could be written", file->path);
    return true;
}

/*
 * A name may reach the disk before what it names: then a power cut leaves an empty file under it.
 */
static bool output_file_keep(const struct output_file *file)
{
    return file->aside[0] == '\0' ||
           (fflush(file->stream) == 0 && fsync(fileno(file->stream)) == 0);
}

/* A file may have been read after this one was opened: a subroutine's, say. */
bool output_file_finish(struct output_file *file)
{
    if (file->aside[0] != '\0' && !file->replaces && !output_file_may_write(file->path)) {
        output_file_discard(file);
        return false;
    }
    return (output_file_keep(file) && output_file_close(file)) ||
           output_file_fail(file, "cannot be written");
}

/*
 * The new name, too. Where folders cannot be kept so, a power cut may leave the old file: that is
 * whole as well.
 */
static void keep_folder(const char *path)
{
    char folder[OUTPUT_PATH_MAX];
    char *name;
    int descriptor;

    (void)snprintf(folder, sizeof folder, "%s", path);
    name = strrchr(folder, '/');
    if (name == NULL)
        (void)snprintf(folder, sizeof folder, ".");
    else
        name[name == folder ? 1 : 0] = '\0';
    descriptor = open(folder, O_RDONLY);
    if (descriptor < 0)
        return;
    (void)fsync(descriptor);
    (void)close(descriptor);
}

bool output_file_place(struct output_file *file)
{
    if (file->aside[0] == '\0')
        return true;
    if (rename(file->aside, file->path) != 0)
        return output_file_fail(file, "cannot be put in place");
    file->aside[0] = '\0';
    keep_folder(file->path);
    return true;
}

void output_file_discard(struct output_file *file)
{
    if (file->stream != NULL)
        (void)output_file_close(file);
    if (file->aside[0] != '\0')
        (void)unlink(file->aside);
    file->aside[0] = '\0';
}
