/*
 * What pages are sent at each moment, and what the control thread is asked for on their behalf: the
 * part of the page's thread that knows nothing of sockets.
 */
#ifndef TAKT_PAGE_PAGE_DATA_H
#define TAKT_PAGE_PAGE_DATA_H

#include "page/page_json.h"
#include "page/page_orders.h"
#include "page/page_peaks.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define PAGE_TICK_MS      33
#define PAGE_COMMANDS_MAX 16

/* Who hears of something that is no frame. */
struct page_listener {
    void (*tell_all)(void *context, const struct page_text *text);
    void (*tell_one)(void *context, unsigned page, const struct page_text *text);
    /* A drive that some page looks at, the next after this one; -1: none. */
    int (*next_watched)(void *context, int drive);
    void *context;
};

struct page_data {
    struct panel_host *panel;
    struct page_link *link;
    const struct page_setup *setup;
    struct page_owner owner;
    struct page_listener listener;

    struct panel_snapshot snapshot;
    struct page_peaks peaks;
    struct page_text frame, other;
    uint32_t number; /* of the frame */

    struct page_command command[PAGE_COMMANDS_MAX]; /* that wait, the first is the next */
    unsigned commands;
    bool is_command; /* the job under way is the first of them */
    unsigned turn;
    int drive;               /* whose objects were read last */
    struct page_text tables; /* as told last */

    bool is_stale;   /* the tables have changed since the way was drawn */
    bool has_tables; /* have been read for the program that is to be drawn */
    bool is_drawing;
    atomic_bool is_drawn;
    uint32_t path_crc, path_size; /* the program that path shows, or will */
    struct page_source source;
    struct page_path path, ready; /* being drawn; to be looked at */
    pthread_t thread;
};

/* False: out of memory. */
bool page_data_open(struct page_data *data, size_t tools_max);
void page_data_close(struct page_data *data);

/*
 * 30 times a second: a new frame, and what else there is. time_ms: of the wall clock, since 1970.
 */
void page_data_tick(struct page_data *data, double time_ms);

/* False: there are too many already. */
bool page_data_command(struct page_data *data, const struct page_command *command);
/* A page has gone: nobody is told what comes of its orders. */
void page_data_forget(struct page_data *data, unsigned page);
/* A page has come: what it should know at once, beside the hello. */
void page_data_greet(const struct page_data *data, struct page_text *text);
void page_data_describe_path(const struct page_data *data, struct page_text *text);

#endif
