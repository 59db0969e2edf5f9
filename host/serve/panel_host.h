/*
 * The operator's panel as the one whose server it is: a client of the panel for every place.
 */
#ifndef TAKT_SERVE_PANEL_HOST_H
#define TAKT_SERVE_PANEL_HOST_H

#include "panel/panel.h"
#include "serve/server.h"

/* It must not be moved once opened. */
struct panel_host {
    struct panel panel;
    struct panel_client client[SERVER_PLACES];
};

void panel_host_init(struct panel_host *host, const struct panel_config *config);

struct server_host panel_host_get(struct panel_host *host);

#endif
