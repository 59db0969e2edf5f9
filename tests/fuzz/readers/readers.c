/* The readers by name, and any bytes for one of them. */
#define _GNU_SOURCE

#include "readers.h"

#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static const struct reader {
    const char *name;
    void (*of_file)(const char *path);
    void (*of_bytes)(const uint8_t *data, size_t size);
} readers[] = {
    {"machine", read_machine, NULL},
    {"tools", read_tools, NULL},
    {"parameters", read_parameters, NULL},
    {"correction", read_correction, NULL},
    {"triplets", read_triplets, NULL},
    {"override", read_override, NULL},
    {"inject", read_inject, NULL},
    {"sheet", read_sheet, NULL},
    {"probe", read_probe, NULL},
    {"trace", read_trace, NULL},
    {"candump", NULL, read_candump},
    {"slcan", NULL, read_slcan},
    {"socketcand", NULL, read_socketcand},
    {"editor", NULL, read_editor},
    {"dialects", NULL, read_dialects},
    {"drives", NULL, read_frames_of_master},
    {"master", NULL, read_frames_of_drives},
    {"plan", NULL, read_plan},
    {"configuration", NULL, read_configuration},
    {"drive_store", NULL, read_drive_store},
    {"settings", NULL, read_settings},
    {"flash", NULL, read_flash},
    {"state", NULL, read_state},
};

static const struct reader *reader;
static int file = -1;
static char path[64];

static const struct reader *find(const char *name)
{
    for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++) {
        if (strcmp(readers[i].name, name) == 0)
            return &readers[i];
    }
    return NULL;
}

bool readers_choose(const char *name)
{
    if (name == NULL) {
        for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++)
            (void)puts(readers[i].name);
        return false;
    }
    reader = find(name);
    return reader != NULL;
}

/* The input as a file without a place on a disk. */
static void open_file(void)
{
    if (file >= 0)
        return;
    file = memfd_create("input", 0);
    require(file >= 0);
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", file);
}

static void fill(const uint8_t *data, size_t size)
{
    open_file();
    require(ftruncate(file, 0) == 0);
    require(pwrite(file, data, size, 0) == (ssize_t)size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (reader->of_bytes != NULL) {
        reader->of_bytes(data, size);
        return 0;
    }
    fill(data, size);
    reader->of_file(path);
    return 0;
}
