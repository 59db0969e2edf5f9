/*
 * What a reader of foreign bytes is to the fuzzer. Each is one function: any bytes may come,
 * nothing may crash, hang or leak. What a reader promises beyond that is required where it is read.
 */
#ifndef TAKT_TESTS_READERS_H
#define TAKT_TESTS_READERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

static inline void require(bool held)
{
    if (!held)
        abort();
}

/* All that comes goes to this one. False: nobody has this name; NULL: names are printed. */
bool readers_choose(const char *name);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Texts in files. path: of a file with these bytes. */
void read_machine(const char *path);
void read_tools(const char *path);
void read_parameters(const char *path);
void read_correction(const char *path);
void read_triplets(const char *path);
void read_override(const char *path);
void read_inject(const char *path);
void read_sheet(const char *path);
void read_probe(const char *path);
void read_trace(const char *path);

/* Bytes as they come on lines and buses. */
void read_slcan(const uint8_t *data, size_t size);
void read_socketcand(const uint8_t *data, size_t size);
void read_candump(const uint8_t *data, size_t size);
void read_editor(const uint8_t *data, size_t size);
void read_dialects(const uint8_t *data, size_t size);
void read_frames_of_drives(const uint8_t *data, size_t size);
void read_frames_of_master(const uint8_t *data, size_t size);

/* What is stored. */
void read_plan(const uint8_t *data, size_t size);
void read_configuration(const uint8_t *data, size_t size);
void read_drive_store(const uint8_t *data, size_t size);
void read_settings(const uint8_t *data, size_t size);
void read_flash(const uint8_t *data, size_t size);
void read_state(const uint8_t *data, size_t size);

#endif
