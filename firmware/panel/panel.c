#include "panel/panel.h"

#include "base/assert.h"
#include "panel/panel_private.h"

#include <string.h>

void takt_panel_init(struct panel *panel, const struct panel_config *config)
{
    memset(panel, 0, sizeof *panel);
    panel->config = *config;
}

void takt_panel_client_enter(struct panel_client *client, struct panel *panel)
{
    *client = (struct panel_client){.panel = panel};
}

void takt_panel_client_leave(struct panel_client *client)
{
    struct panel *panel = client->panel;

    TAKT_ASSERT(client->panel != NULL);
    /*
     * Nobody else becomes the owner by it: the register WATCHDOG stays until the watchdog has
     * bitten.
     */
    if (panel->owner == client)
        panel->owner = NULL;
}

struct modbus_map takt_panel_client_map(struct panel_client *client)
{
    return (struct modbus_map){
        .read = takt_panel_read, .write = takt_panel_write, .context = client};
}

void takt_panel_look(struct panel *panel, struct panel_snapshot *snapshot)
{
    panel->config.port.look(panel->config.port.context, snapshot);
    if (snapshot->value[REGISTER_WATCHDOG] == 0)
        panel->owner = NULL;
}

const struct panel_store *takt_panel_get_store(const struct panel *panel)
{
    switch (panel->kind) {
    case PANEL_UPLOAD_SETTINGS:
        return &panel->config.settings;
    case PANEL_UPLOAD_PLAN:
        return &panel->config.plans;
    case PANEL_UPLOAD_PROGRAM:
        break;
    }
    return &panel->config.store;
}

static enum panel_control control_of(const struct panel_client *client,
                                     const struct panel_snapshot *snapshot)
{
    if (snapshot->value[REGISTER_WATCHDOG] == 0)
        return PANEL_CONTROL_FREE;
    return client->panel->owner == client ? PANEL_CONTROL_MINE : PANEL_CONTROL_OTHER;
}

/* The registers that the controller does not know. */
static void add_own(struct panel_client *client, struct panel_snapshot *snapshot)
{
    const struct panel *panel = client->panel;
    const struct panel_mailbox *mailbox = &panel->mailbox;
    uint32_t *value = snapshot->value;

    value[REGISTER_VERSION] = PANEL_TABLE_VERSION;
    value[REGISTER_REFUSAL] = client->refusal;
    value[REGISTER_CONTROL] = control_of(client, snapshot);
    value[REGISTER_UPLOAD_STATE] = panel->upload.state;
    value[REGISTER_UPLOAD_RECEIVED] = panel->upload.received;
    value[REGISTER_UPLOAD_ROOM] =
        takt_panel_upload_room(&panel->upload, takt_panel_get_store(panel));
    value[REGISTER_PROGRAM_MAX] = PANEL_PROGRAM_BYTES_MAX;
    value[REGISTER_UPLOAD_KIND] = mailbox->upload_kind;
    value[REGISTER_UPLOAD_SIZE] = mailbox->upload_size;
    value[REGISTER_UPLOAD_CRC] = mailbox->upload_crc;
    value[REGISTER_UPLOAD_OFFSET] = mailbox->chunk_offset;
    value[REGISTER_UPLOAD_LENGTH] = mailbox->chunk_length;
    value[REGISTER_UPLOAD_COMMAND] = 0;
    value[REGISTER_UPLOAD_CHECK] = 0;
    value[REGISTER_PASSWORD] = 0;
}

/* Word number index of a row that holds characters or bytes. */
static uint16_t word_of_bytes(const struct panel *panel, const struct panel_snapshot *snapshot,
                              enum panel_id id, unsigned index)
{
    const size_t at = (size_t)2 * index;
    const char *text;

    if (id == REGISTER_UPLOAD_DATA)
        return modbus_read16(panel->mailbox.chunk + at);
    if (id == REGISTER_MDI_TEXT)
        return modbus_read16(panel->mailbox.mdi + at);
    text = id == REGISTER_UPLOAD_TEXT ? panel->upload_text : snapshot->alarm_text;
    return (uint16_t)((uint8_t)text[at] << 8 | (uint8_t)text[at + 1]);
}

/* Word number index of a row: negative numbers in two's complement. */
static uint16_t word_of_row(const struct panel *panel, const struct panel_snapshot *snapshot,
                            enum panel_id id, unsigned index)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const uint32_t bits = snapshot->value[id];

    TAKT_ASSERT(index < row->words);
    if (row->form == PANEL_TEXT || row->form == PANEL_BYTES)
        return word_of_bytes(panel, snapshot, id, index);
    return (uint16_t)(index + 1 < row->words ? bits >> 16 : bits);
}

static void put_value(uint8_t *data, enum modbus_table table, unsigned at, uint16_t word)
{
    if (table != MODBUS_COILS)
        modbus_write16(data + (size_t)2 * at, word);
    else if (word != 0)
        data[at / 8] = (uint8_t)(data[at / 8] | 1U << at % 8);
}

static void sign_of_life(const struct panel_client *client)
{
    const struct panel_port *port = &client->panel->config.port;

    if (client->panel->owner == client)
        port->alive(port->context);
}

enum modbus_exception takt_panel_read(void *context, enum modbus_table table, uint16_t address,
                                      uint16_t count, uint8_t *data)
{
    struct panel_client *client = context;
    struct panel_snapshot snapshot;

    takt_panel_look(client->panel, &snapshot);
    add_own(client, &snapshot);
    sign_of_life(client);
    if (table == MODBUS_COILS)
        memset(data, 0, ((size_t)count + 7) / 8);
    for (unsigned i = 0; i < count; i++) {
        const uint16_t here = (uint16_t)(address + i);
        const enum panel_id id = takt_panel_find(table, here);
        uint16_t word = 0;

        if (id != REGISTER_COUNT)
            word =
                word_of_row(client->panel, &snapshot, id, here - takt_panel_registers[id].address);
        else if (!takt_panel_is_gap(table, here))
            return MODBUS_ADDRESS;
        put_value(data, table, i, word);
    }
    return MODBUS_GOOD;
}
