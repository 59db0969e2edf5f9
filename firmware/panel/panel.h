/*
 * The operator's panel: the register table behind a Modbus server, for several clients at once.
 *
 *     request -> rows of the table -> who may, value, state -> mailbox, or an order to the controller
 *     snapshot of the controller   -> reply
 *
 * No input or output: what it asks for goes through a panel_port and a panel_store. One thread
 * calls it.
 */
#ifndef TAKT_PANEL_PANEL_H
#define TAKT_PANEL_PANEL_H

#include "modbus/modbus.h"
#include "panel/snapshot.h"
#include "panel/upload.h"

struct panel_config {
    struct panel_port port;
    struct panel_store store;
    struct panel_store settings; /* begin is NULL: none can be brought */
    struct panel_store plans;    /* programs planned ahead; begin_stream is NULL: likewise */
    uint32_t password; /* clients must write it before anything else; 0: none is asked for */
};

/* What clients write and the controller does not see. */
struct panel_mailbox {
    uint32_t upload_size, upload_crc;
    enum panel_upload_kind upload_kind;
    uint32_t chunk_offset;
    uint16_t chunk_length;
    uint8_t chunk[PANEL_CHUNK_MAX];
    uint8_t mdi[PANEL_MDI_MAX];
};

struct panel {
    struct panel_config config;
    struct panel_mailbox mailbox;
    struct panel_upload upload;
    enum panel_upload_kind kind;            /* of that upload */
    char upload_text[PANEL_ALARM_TEXT_MAX]; /* why the last one was refused; ends with a zero */
    unsigned wrong;                         /* passwords in a row */
    uint32_t wrong_cycles;                  /* register CYCLES at the last of them */
    const struct panel_client *owner;       /* has claimed control; NULL: nobody */
};

/* A connection, or a serial line. */
struct panel_client {
    struct panel *panel;
    bool unlocked;
    enum panel_refusal refusal;
};

void takt_panel_init(struct panel *panel, const struct panel_config *config);

/* A client has come; it stays at its address until it leaves. */
void takt_panel_client_enter(struct panel_client *client, struct panel *panel);
/* Control that it has claimed is left to the watchdog. */
void takt_panel_client_leave(struct panel_client *client);

/* An order as this client's, by the rules of a write. PANEL_REFUSAL_NONE: it is done. */
enum panel_refusal takt_panel_client_order(struct panel_client *client,
                                           const struct panel_order *order);

/* To hold the feed and to stop in an emergency nobody needs leave, at any time. */
bool takt_panel_is_for_everybody(const struct panel_order *order);

/* The client writes PASSWORD. */
enum panel_refusal takt_panel_client_unlock(struct panel_client *client, uint32_t password);

/* The registers as this client sees them. */
struct modbus_map takt_panel_client_map(struct panel_client *client);

#endif
