/*
 * The pages that are open: texts that wait for them, and what they say. For the thread of
 * page_server alone.
 */
#ifndef TAKT_PAGE_PAGE_VISITORS_H
#define TAKT_PAGE_PAGE_VISITORS_H

#include "page/page_data.h"
#include "page/page_orders.h"
#include "page/page_server.h"
#include "page/page_text.h"

#include <libwebsockets.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Texts that wait for a page that does not read them; then it is sent away. */
#define PAGE_QUEUE_MAX 64

struct page_waiting {
    unsigned char *bytes; /* LWS_PRE, then the text */
    size_t length;
};

struct page_visitor {
    struct lws *wsi;
    bool is_open;
    struct page_client client;
    struct page_waiting queue[PAGE_QUEUE_MAX];
    unsigned queued;
    unsigned char *message; /* being received */
    size_t received;
    uint32_t shown; /* frame */
};

struct page_visitors {
    struct panel_host *panel;
    const struct page_setup *setup;
    struct page_data data;
    struct page_visitor *visitor[PANEL_HOST_PAGES]; /* NULL: free */
    struct page_text text;
    uint64_t ticked_ms;
};

/* It must not be moved once opened. False: out of memory. */
bool page_visitors_open(struct page_visitors *all, const struct page_server_config *config);
void page_visitors_close(struct page_visitors *all);

/* A page comes, and is told everything. -1: all places are taken. */
int page_visitor_enter(struct page_visitors *all, struct lws *wsi, struct page_visitor *s);
void page_visitor_leave(struct page_visitors *all, struct page_visitor *s);
/* Its timer has run out: there is a new picture for all. */
void page_visitors_tick(struct page_visitors *all, struct page_visitor *s);
/* It can be written to: the first text that waits, else the picture. -1: it is gone. */
int page_visitor_send(struct page_visitors *all, struct page_visitor *s);
/* A piece of a message. -1: it is too long. */
int page_visitor_receive(struct page_visitors *all, struct page_visitor *s, const void *bytes,
                         size_t length);

#endif
