/*
 * A whole text in memory: a machine file, a table, a trace.
 */
#ifndef TAKT_HOST_TEXT_H
#define TAKT_HOST_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct text {
    const char *name; /* for messages: the path, or "<stdin>". Not owned */
    char *bytes;      /* owned; a zero follows the last byte */
    size_t length;
};

/*
 * A text that is in memory, and the name it is read by in place of a path. Both are the caller's.
 */
struct text_held {
    char *name;
    char *bytes;
    size_t length;
};

/*
 * From now on this thread finds texts by these names in memory instead of on disk; count 0: none.
 * They must stay.
 */
void text_hold(const struct text_held *held, unsigned count);
/* NULL: it is a path. */
const struct text_held *text_find_held(const char *name);

/* Reads path, "-" for standard input; without the mark of UTF-8 before it. False after a message: it cannot be opened or read. */
bool text_read(struct text *text, const char *path);
void text_free(struct text *text);

/*
 * Reads text line by line: true and the next line without its end ("\n" or "\r\n") while there is
 * one. *position starts at 0 and belongs to this function.
 */
bool text_next_line(const struct text *text, size_t *position, const char **line, size_t *length);

#endif
