/*
 * The program of the service, and the one that is on its way in. In memory; with a path also in a
 * file, which is replaced at once or not at all.
 *
 * The panel's thread brings the new one, the control thread adopts it between two cycles, while the
 * panel waits. A program that is streamed is adopted before its text has come, and read as far as
 * it has, in whole lines.
 */
#ifndef TAKT_SERVE_PROGRAM_STORE_H
#define TAKT_SERVE_PROGRAM_STORE_H

#include "panel/upload.h"
#include "program/source.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#define PROGRAM_STORE_PATH_MAX 4096

/* State of a streamed program. */
enum program_stream {
    PROGRAM_STREAM_NONE, /* it is no stream */
    PROGRAM_STREAM_COMING,
    PROGRAM_STREAM_WHOLE,
    PROGRAM_STREAM_WRONG /* given up, or not what was announced */
};

struct stored_text {
    char *bytes; /* owned; NULL: none */
    size_t size;
    atomic_uint coming;        /* enum program_stream */
    atomic_uint has_come;      /* of a stream: whole lines of it, bytes; all, at its end */
    struct source_text source; /* where it is being read */
};

struct program_store {
    struct stored_text text[2];
    struct stored_text *program; /* what runs */
    struct stored_text *staged;  /* what is coming, or the program before the last */
    struct stored_text *brought; /* by the last upload: staged, or once it is adopted, program */
    const char *path;            /* NULL: in memory alone */
    char aside[PROGRAM_STORE_PATH_MAX + 16];
    bool is_aside; /* that file is there */
};

/*
 * path stays the caller's. What a power cut has left beside it is removed. False: it is too long.
 */
bool program_store_open(struct program_store *store, const char *path);
/* A file could be put at its path. False: errno says why. */
bool program_store_can_keep(struct program_store *store);
void program_store_close(struct program_store *store);

/* A program from elsewhere, before anything runs. False: out of memory. */
bool program_store_set(struct program_store *store, const char *bytes, size_t size);

/* Panel thread. */
struct panel_store program_store_get_staging(struct program_store *store);

/* What there is of the program; while it is streamed, what has come. False: there is none. */
bool program_store_get(const struct program_store *store, const char **text, size_t *size);

/* Control thread. */
bool program_store_read(void *store, struct source *source);
void program_store_adopt(void *store);

#endif
