/*
 * What pages are told of a machine once, and what its owner does for them.
 */
#ifndef TAKT_PAGE_PAGE_SETUP_H
#define TAKT_PAGE_PAGE_SETUP_H

#include "base/point.h"
#include "page/page_link.h"
#include "page/page_path.h"
#include "servo/dictionary.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PAGE_DRIVES_MAX 16
#define PAGE_NAME_MAX   127

/* mm, rad, s. */
struct page_axis {
    bool is_present;
    double velocity, acceleration, jerk, following; /* limits; following 0: not watched */
    double travel_min, travel_max;
};

/* A virtual drive, or an I/O node. */
struct page_drive {
    char name[PAGE_NAME_MAX + 1]; /* "X" */
    unsigned node;
    const struct dictionary *dictionary; /* must stay */
};

struct page_setup {
    char machine[PAGE_NAME_MAX + 1];
    char version[PAGE_NAME_MAX + 1];
    uint32_t cycle_us, bitrate;
    struct page_axis axis[AXIS_COUNT];
    struct page_drive drive[PAGE_DRIVES_MAX];
    unsigned drives; /* 0: they are not in this process, and faults cannot be ordered */
};

/* Called by the page's threads; context is its owner's. */
struct page_owner {
    /*
     * The program that CYCLE_START starts; valid while the panel is locked. False: there is none.
     */
    bool (*get_program)(void *context, const char **text, size_t *size);
    /* Where the program goes; may take long, and runs in a thread of its own. */
    void (*draw)(void *context, const struct page_source *source, struct page_path *path);
    void *context;
};

#endif
