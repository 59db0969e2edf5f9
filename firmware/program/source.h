/*
 * Where the text of a program comes from: a file, a buffer, a stream. Only the current line is ever
 * kept.
 */
#ifndef TAKT_PROGRAM_SOURCE_H
#define TAKT_PROGRAM_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SOURCE_END   (-1) /* no more text */
#define SOURCE_ERROR (-2) /* the text cannot be read */
#define SOURCE_LATER (-3) /* the next line has not come yet: ask again */

struct source {
    /*
     * Up to size bytes into buffer; returns how many (>= 1), SOURCE_END, SOURCE_ERROR or
     * SOURCE_LATER. Whoever may say SOURCE_LATER hands out whole lines, in any pieces: between two
     * lines the answer is taken, within one it is an error.
     */
    long (*read)(void *context, char *buffer, size_t size);
    /* Next read starts at offset bytes from the beginning. NULL for a stream. False: cannot. */
    bool (*seek)(void *context, uint64_t offset);
    void *context; /* the caller's */
};

/* A source over text the caller keeps alive and unchanged. */
struct source_text {
    const char *text;
    size_t length;
    size_t position;
};

void takt_source_open_text(struct source *source, struct source_text *context, const char *text,
                           size_t length);

#endif
