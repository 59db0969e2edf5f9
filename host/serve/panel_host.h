/*
 * The operator's panel behind its servers: a client of the panel for every place of the Modbus
 * server, and for every page in a browser. Servers have threads of their own; the panel is one of
 * them at a time.
 */
#ifndef TAKT_SERVE_PANEL_HOST_H
#define TAKT_SERVE_PANEL_HOST_H

#include "panel/panel.h"
#include "serve/server.h"

#include <pthread.h>

#define PANEL_HOST_PAGES 64

/* Pages come behind the places of the server, then the console. */
#define PANEL_HOST_CONSOLE (SERVER_PLACES + PANEL_HOST_PAGES)
#define PANEL_HOST_SEATS   (PANEL_HOST_CONSOLE + 1)

struct panel_seat {
    struct panel_host *host;
    struct panel_client client;
};

/* It must not be moved once opened. */
struct panel_host {
    struct panel panel;
    pthread_mutex_t lock; /* of the panel and all seats; a thread may take it twice */
    struct panel_seat seat[PANEL_HOST_SEATS];
};

void panel_host_init(struct panel_host *host, const struct panel_config *config);

struct server_host panel_host_get(struct panel_host *host);

/* For pages, 0 ... PANEL_HOST_PAGES - 1: the registers as this one sees them. */
struct modbus_map panel_host_enter_page(struct panel_host *host, unsigned page);
void panel_host_leave_page(struct panel_host *host, unsigned page);

/* For the console. */
void panel_host_enter_console(struct panel_host *host);
void panel_host_leave_console(struct panel_host *host);
enum panel_refusal panel_host_order(struct panel_host *host, const struct panel_order *order);
enum panel_refusal panel_host_give_password(struct panel_host *host, uint32_t password);

/* What runs between these two is not interrupted by another server's requests. */
void panel_host_lock(struct panel_host *host);
void panel_host_unlock(struct panel_host *host);

/* All registers of the controller. No sign of life. */
void panel_host_look(struct panel_host *host, struct panel_snapshot *snapshot);
/* The page's own register CONTROL. */
enum panel_control panel_host_get_control(struct panel_host *host, unsigned page,
                                          const struct panel_snapshot *snapshot);
/* Why the page's last write was refused. */
enum panel_refusal panel_host_get_refusal(struct panel_host *host, unsigned page);
/* Whether it may change what is no register; PANEL_REFUSAL_NONE: it may. */
enum panel_refusal panel_host_check_page(struct panel_host *host, unsigned page);

#endif
