/*
 * Settings brought through the panel's mailbox to flash: looked at as a whole before they count,
 * which they do from the next start on.
 */
#ifndef TAKT_PORT_SETTINGS_UPLOAD_H
#define TAKT_PORT_SETTINGS_UPLOAD_H

#include "panel/upload.h"
#include "storage/settings.h"
#include "storage/store.h"

#include <stdbool.h>

struct settings_upload_port {
    /* Are the drives off? Flash may keep the processor waiting. */
    bool (*may_load)(void *context);
    /* Memory that tables are read into, to be looked at; it is needed no longer than that. */
    struct correction_tables *(*borrow)(void *context);
    /* A line of the log. */
    void (*log)(void *context, const char *text);
    void *context; /* owned by whoever made the port */
};

/* Private. */
struct settings_upload {
    struct store *store;
    struct settings_upload_port port;
    const char *why;         /* they were refused; NULL: as wrong says */
    struct diagnostic wrong; /* with them */
};

/* For struct panel_config. store: opened; must outlive it. */
struct panel_store takt_settings_upload_open(struct settings_upload *upload, struct store *store,
                                             const struct settings_upload_port *port);

#endif
