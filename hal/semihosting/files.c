#include "semihosting/files.h"

#include <stdint.h>

/* Takes the next word off the line. NULL: there is none. */
static char *next_word(struct files *files)
{
    char *word = files->rest;
    char *end;

    while (*word == ' ')
        word++;
    if (*word == '\0')
        return NULL;
    for (end = word; *end != ' ' && *end != '\0';)
        end++;
    files->rest = *end == '\0' ? end : end + 1;
    *end = '\0';
    return word;
}

bool takt_files_begin(struct files *files)
{
    files->rest = files->words;
    return takt_semihosting_command_line(files->words, sizeof files->words) &&
           next_word(files) != NULL;
}

int takt_files_open_next(struct files *files, enum semihosting_mode mode)
{
    const char *name = next_word(files);

    return name == NULL ? -1 : takt_semihosting_open(name, mode);
}

bool takt_files_read_all(int file, void *bytes, size_t size)
{
    uint8_t *at = bytes;

    while (size > 0) {
        const size_t count = takt_semihosting_read(file, at, size);

        if (count == 0)
            return false;
        at += count;
        size -= count;
    }
    return true;
}
