#define _POSIX_C_SOURCE 200809L

#include "session/subroutine_file.h"

#include "words/line.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* Endings of files of programs, the more usual first. */
static const char *const endings[] = {".ngc", ".nc",  ".cnc", ".tap", ".spf", ".mpf",
                                      ".eia", ".prg", ".min", ".txt", ""};
#define ENDINGS (sizeof endings / sizeof endings[0])

/* The place of a file's ending among them; ENDINGS: it is none of them. */
static size_t ending_of(const char *file, size_t *stem)
{
    const char *point = strrchr(file, '.');
    size_t i = 0;

    *stem = point != NULL ? (size_t)(point - file) : strlen(file);
    while (i < ENDINGS && strcasecmp(file + *stem, endings[i]) != 0)
        i++;
    return i;
}

/* Without its ending a file has the name, or is 1000, O1000 or o01000. */
static bool is_named(const char *file, size_t stem, const char *label)
{
    const size_t length = strlen(label);

    if (label[0] == '<')
        return stem == length - 1 && strncasecmp(file, label + 1, stem) == 0;
    if (stem > 0 && line_lower(*file) == 'o') {
        file++;
        stem--;
    }
    for (; stem > length && *file == '0'; stem--)
        file++;
    return stem == length && strncmp(file, label, length) == 0;
}

/* The file of a subroutine in a folder, which ends with '/' or is empty. */
static bool find_in(const char *folder, const char *label, char *path, size_t size)
{
    DIR *entries = opendir(folder[0] != '\0' ? folder : ".");
    size_t best = ENDINGS;
    char chosen[256] = "";
    const struct dirent *entry;
    struct stat status;

    while (entries != NULL && (entry = readdir(entries)) != NULL) {
        size_t stem;
        const size_t ending = ending_of(entry->d_name, &stem);

        if (ending > best || ending == ENDINGS || !is_named(entry->d_name, stem, label) ||
            (ending == best && strcmp(entry->d_name, chosen) > 0))
            continue;
        best = ending;
        (void)snprintf(chosen, sizeof chosen, "%s", entry->d_name);
    }
    if (entries != NULL)
        (void)closedir(entries);
    (void)snprintf(path, size, "%s%s", folder, chosen);
    return best < ENDINGS && stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

bool subroutine_file_find(const struct program_front *front, const char *program, const char *label,
                          char *path, size_t size)
{
    const char *slash = strrchr(program, '/');
    char folder[4096];
    int length = snprintf(folder, sizeof folder, "%.*s",
                          slash != NULL ? (int)(slash - program) + 1 : 0, program);

    if (strchr(label, '/') != NULL)
        return false;
    if (length < (int)sizeof folder && find_in(folder, label, path, size))
        return true;
    for (unsigned i = 0; i < front->folders; i++) {
        length = snprintf(folder, sizeof folder, "%s/", front->folder[i]);
        if (length < (int)sizeof folder && find_in(folder, label, path, size))
            return true;
    }
    return false;
}
