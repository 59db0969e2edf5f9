/*
 * What a page orders, as JSON, carried out on the registers of the panel by the rules of the panel:
 *
 *     {"id":1,"write":[["MODE",1],["MDI_TEXT","G0 X1"],["MDI_START",1]]}   in this order, up to the first that is refused
 *     {"alive":1}                                                          a sign of life of the page in control
 *     {"id":2,"upload":[SIZE,CRC32]}, bytes in binary messages, {"id":3,"commit":1}
 *     {"id":4,"fault":"drive 1 emcy code=4310"}, {"id":5,"clear":1}, {"id":6,"set":[DRIVE,INDEX,SUB,VALUE]}
 *     {"watch":DRIVE}                                                      -1: no drive
 *
 * What has an id is answered: {"reply":1,"refused":"..."}, refused is empty when it is done.
 */
#ifndef TAKT_PAGE_PAGE_ORDERS_H
#define TAKT_PAGE_PAGE_ORDERS_H

#include "page/page_setup.h"
#include "page/page_text.h"
#include "serve/panel_host.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A page that is open. */
struct page_client {
    struct panel_host *panel;
    const struct page_setup *setup;
    unsigned number; /* of the panel's pages */
    struct modbus_map map;
    uint32_t upload_at;
    const char *upload_problem; /* of a piece that could not be taken; NULL: none yet */
    int watched;                /* drive; -1: none */
    bool is_new_watch;
};

/* Only the control thread can do it; answered when it has. */
struct page_command {
    unsigned page;
    double id;
    enum page_job_kind kind; /* PAGE_JOB_WRITE, _FAULT, _CLEAR */
    unsigned drive;
    uint32_t object, value;
    struct inject_fault fault;
};

void page_client_open(struct page_client *client, unsigned number, struct panel_host *panel,
                      const struct page_setup *setup);
/*
 * The browser is gone: what it jogs stops at once, and the control it has claimed is given up if
 * nothing runs by it.
 */
void page_client_close(struct page_client *client);

/*
 * A message. What is to be answered now stands in reply, which else stays empty. True: *command is
 * for the control thread.
 */
bool page_orders_take(struct page_client *client, const char *text, size_t length,
                      struct page_text *reply, struct page_command *command);
/* The next bytes of an upload. */
void page_orders_take_bytes(struct page_client *client, const uint8_t *bytes, size_t length);

/* refused: NULL: it is done. */
void page_orders_reply(struct page_text *reply, double id, const char *refused);

#endif
