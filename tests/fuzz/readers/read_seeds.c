/*
 * read_seeds FOLDER: every file of FOLDER/NAME, for the reader NAME. What fuzzing has found stays
 * tried without a fuzzer.
 */
#include "readers.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>

#define BYTES_MAX 65536U
#define PATH_MAX_ 4096

static void read_seed(const char *path)
{
    static uint8_t data[BYTES_MAX];
    FILE *stream = fopen(path, "rb");

    require(stream != NULL);
    (void)LLVMFuzzerTestOneInput(data, fread(data, 1, sizeof data, stream));
    (void)fclose(stream);
}

/* How many entries that are not hidden; each is handed on with its path. */
static unsigned each(const char *folder, unsigned (*use)(const char *path, const char *name))
{
    DIR *entries = opendir(folder);
    char path[PATH_MAX_];
    unsigned count = 0;

    require(entries != NULL);
    for (const struct dirent *e; (e = readdir(entries)) != NULL;) {
        if (e->d_name[0] == '.')
            continue;
        (void)snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        count += use(path, e->d_name);
    }
    (void)closedir(entries);
    return count;
}

static unsigned use_seed(const char *path, const char *name)
{
    (void)name;
    read_seed(path);
    return 1;
}

static unsigned use_folder(const char *path, const char *name)
{
    if (!readers_choose(name)) {
        (void)fprintf(stderr, "no reader is called %s\n", name);
        exit(1);
    }
    return each(path, use_seed);
}

int main(int argc, char **argv)
{
    require(argc == 2);
    (void)printf("%u inputs\n", each(argv[1], use_folder));
    return 0;
}
