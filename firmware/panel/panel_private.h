/*
 * Inside the panel: reading, and the steps of a write.
 */
#ifndef TAKT_PANEL_PANEL_PRIVATE_H
#define TAKT_PANEL_PANEL_PRIVATE_H

#include "panel/panel.h"

/* For struct modbus_map. */
enum modbus_exception takt_panel_read(void *context, enum modbus_table table, uint16_t address,
                                      uint16_t count, uint8_t *data);
enum modbus_exception takt_panel_write(void *context, enum modbus_table table, uint16_t address,
                                       uint16_t count, const uint8_t *data);

/* Where the upload that is under way goes. */
const struct panel_store *takt_panel_get_store(const struct panel *panel);

/* An upload of another kind is given up. */
void takt_panel_turn_upload(struct panel *panel, enum panel_upload_kind kind);

/* The reason, as the store of this kind has it, for UPLOAD_TEXT. Returns the refusal. */
enum panel_refusal takt_panel_tell_why(struct panel *panel, enum panel_refusal refusal);

/* Settings: refused with a reason for UPLOAD_TEXT. */
enum panel_refusal takt_panel_begin_settings(struct panel *panel,
                                             const struct panel_mailbox *mailbox);
enum panel_refusal takt_panel_commit_settings(struct panel *panel);

/* A snapshot; control that the watchdog has taken from its owner is free again. */
void takt_panel_look(struct panel *panel, struct panel_snapshot *snapshot);

/* One write request on its way: everything is found out before anything is done. */
struct panel_request {
    struct panel_client *client;
    enum panel_state state;
    uint32_t cycles;
    bool has_owner;                     /* the watchdog watches a panel */
    uint32_t program_size, program_crc; /* of the program there is */
    struct panel_mailbox mailbox;       /* as it will be */
    struct panel_order order;           /* to the controller */
    enum panel_upload_command command;
    bool has_password, has_watchdog, has_chunk, has_command;
    uint32_t password;
    uint16_t check;
    int64_t watchdog_ms;
};

/* Part of what the request asks of the controller; then all of it, at once. */
void takt_panel_add_order(struct panel_request *request, enum panel_id id, int64_t value);
enum panel_refusal takt_panel_give_order(struct panel_request *request);

/* A request with UPLOAD_COMMAND, or with a chunk. */
enum panel_refusal takt_panel_command_upload(struct panel_request *request);
enum panel_refusal takt_panel_take_chunk(const struct panel_request *request);

#endif
