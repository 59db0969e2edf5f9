/*
 * Whole messages over a pipe.
 */
#ifndef TAKT_TARGET_WIRE_H
#define TAKT_TARGET_WIRE_H

#include <stdbool.h>
#include <stddef.h>

/* False: the other side is gone. */
bool wire_read(int file, void *bytes, size_t size);
bool wire_write(int file, const void *bytes, size_t size);

#endif
