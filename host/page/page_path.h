/*
 * Where a program goes, as points to be drawn: however long it is, the points are no more than a
 * browser can draw.
 *
 * When the room is full every second point is left out, and from then on as many more of those that
 * come; ends of lines of the program are points like any others.
 */
#ifndef TAKT_PAGE_PAGE_PATH_H
#define TAKT_PAGE_PAGE_PATH_H

#include "base/point.h"
#include "program/parameters.h"
#include "program/tools.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PAGE_PATH_MAX 262144

/* As it is sent: little-endian, 20 bytes. */
struct page_path_point {
    float x_mm, y_mm, z_mm; /* machine coordinates */
    uint32_t line;
    uint32_t is_rapid;
};

struct page_path {
    struct page_path_point *point; /* owned; PAGE_PATH_MAX */
    size_t count;
    size_t every, skipped; /* one of this many is kept */
    struct page_path_point last;
    char problem[256]; /* what is wrong with the program from some line on; empty: nothing */
    atomic_bool is_to_end;
};

/* What a program is read with, copied. */
struct page_source {
    char *text;
    size_t size;
    struct parameters parameters;
    struct tool *tools;
    size_t tools_count;
};

/* False: out of memory. */
bool page_path_open(struct page_path *path);
void page_path_close(struct page_path *path);

/* False: nobody wants it any more. */
bool page_path_add(struct page_path *path, const struct point *at, uint32_t line, bool is_rapid);
/* The last point is kept in any case. */
void page_path_finish(struct page_path *path);

#endif
