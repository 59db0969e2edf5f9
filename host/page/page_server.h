/*
 * The page in the browser: an HTTP server with one thread of its own, by libwebsockets. It looks at
 * what the control cycle has published and gives orders by the panel's rules; the control cycle
 * waits for none of it.
 *
 * Without the library the room builds with page_server_absent.c: page_server_is_there says so.
 */
#ifndef TAKT_PAGE_PAGE_SERVER_H
#define TAKT_PAGE_PAGE_SERVER_H

#include "page/page_setup.h"
#include "serve/allow_list.h"
#include "serve/panel_host.h"

#include <stdbool.h>
#include <stdint.h>

struct page_server_config {
    const char *address, *port; /* "127.0.0.1", "8080"; port "0": any */
    struct allow_list allowed;
    struct panel_host *panel; /* these must stay */
    struct page_link *link;
    const struct page_setup *setup;
    struct page_owner owner;
    size_t tools_max;
};

struct page_server;

bool page_server_is_there(void);

/* Opens and starts. NULL: *problem says why, until the next call. */
struct page_server *page_server_open(const struct page_server_config *config, const char **problem);
/* NULL is allowed. */
void page_server_close(struct page_server *server);

uint16_t page_server_get_port(const struct page_server *server);

#endif
