/*
 * The page in the browser beside `takt serve`: what it is told of the machine, and what the control
 * thread does for it between two cycles.
 */
#ifndef TAKT_HOST_SERVING_PAGE_H
#define TAKT_HOST_SERVING_PAGE_H

#include "cli/status.h"
#include "inject/inject.h"
#include "machine/machine.h"
#include "page/page_link.h"
#include "page/page_server.h"
#include "page/page_setup.h"

#include <stdint.h>

struct serving;

struct serving_page {
    struct page_link link;
    struct page_setup setup;
    struct inject faults;       /* ordered by pages, of the virtual drives and their bus */
    struct page_server *server; /* NULL: there is none */
    const char *problem;        /* why there is none though nobody said so; NULL: there is */
};

/* What pages are told of a machine without drives of this process. */
void serving_page_set_up(struct page_setup *setup, const struct machine *machine);
/* "page on http://..."; host: as --http says it, apart from the port. */
void serving_page_print(const char *host, const struct page_server *server);

/* The service is open. STATUS_DONE; else after a message. */
enum command_status serving_page_open(struct serving *s);
void serving_page_close(struct serving *s);

/* After each control cycle. */
void serving_page_cycle(struct serving *s);

#endif
