/* Registers and coils written: values decoded, checked, and handed to the row they belong to. */
#include "base/assert.h"
#include "panel/panel_private.h"

#include <string.h>

static uint16_t word_at(enum modbus_table table, const uint8_t *data, unsigned at)
{
    if (table == MODBUS_COILS)
        return (uint16_t)((unsigned)data[at / 8] >> at % 8 & 1U);
    return modbus_read16(data + (size_t)2 * at);
}

/* A number out of one or two words. */
static int64_t decode(const struct panel_register *row, const uint8_t *data, unsigned at)
{
    uint32_t bits = word_at(row->table, data, at);

    TAKT_ASSERT(row->words == 1 || row->words == 2);
    if (row->words == 2)
        bits = bits << 16 | word_at(row->table, data, at + 1);
    return row->form == PANEL_S32 ? (int32_t)bits : (int64_t)bits;
}

void takt_panel_add_order(struct panel_request *r, enum panel_id id, int64_t value)
{
    TAKT_ASSERT(r->order.count < PANEL_ORDER_MAX);
    TAKT_ASSERT(id < REGISTER_COUNT);
    r->order.item[r->order.count++] = (struct panel_order_item){id, value};
}

/* A checked number goes into the mailbox, or becomes part of the order. */
static void take_number(struct panel_request *r, enum panel_id id, int64_t value)
{
    TAKT_ASSERT(id < REGISTER_COUNT);
    /* The mailbox's registers are a few; all others are for the controller. */
    if (id == REGISTER_PASSWORD) {
        r->has_password = true;
        r->password = (uint32_t)value;
    } else if (id == REGISTER_UPLOAD_KIND) {
        r->mailbox.upload_kind = (enum panel_upload_kind)value;
    } else if (id == REGISTER_UPLOAD_SIZE) {
        r->mailbox.upload_size = (uint32_t)value;
    } else if (id == REGISTER_UPLOAD_CRC) {
        r->mailbox.upload_crc = (uint32_t)value;
    } else if (id == REGISTER_UPLOAD_OFFSET) {
        r->mailbox.chunk_offset = (uint32_t)value;
    } else if (id == REGISTER_UPLOAD_LENGTH) {
        r->mailbox.chunk_length = (uint16_t)value;
    } else if (id == REGISTER_UPLOAD_CHECK) {
        r->has_chunk = true;
        r->check = (uint16_t)value;
    } else if (id == REGISTER_UPLOAD_COMMAND) {
        r->has_command = true;
        r->command = (enum panel_upload_command)value;
    } else {
        takt_panel_add_order(r, id, value);
    }
}

/* Words of a text or of bytes, from word number from of the row on. */
static void take_bytes(struct panel_request *r, enum panel_id id, unsigned from,
                       const uint8_t *data, unsigned words)
{
    uint8_t *to = id == REGISTER_UPLOAD_DATA ? r->mailbox.chunk : r->mailbox.mdi;

    TAKT_ASSERT(words > 0);
    memcpy(to + (size_t)2 * from, data, (size_t)2 * words);
}

/* What a request writes: count registers from address. */
struct written {
    enum modbus_table table;
    uint16_t address;
    uint16_t count;
    const uint8_t *data;
};

/* Takes the row that begins at register number *at of the request, and moves on behind it. */
static enum modbus_exception take_row(struct panel_request *r, const struct written *w,
                                      unsigned *at)
{
    const uint16_t here = (uint16_t)(w->address + *at);
    const enum panel_id id = takt_panel_find(w->table, here);
    const struct panel_register *row = &takt_panel_registers[id == REGISTER_COUNT ? 0 : id];
    const unsigned from = (unsigned)(here - row->address);
    unsigned words = row->words - from;

    if (id == REGISTER_COUNT || row->states == PANEL_NEVER)
        return MODBUS_ADDRESS;
    if (words > w->count - *at)
        words = w->count - *at;
    if (row->form == PANEL_TEXT || row->form == PANEL_BYTES) {
        take_bytes(r, id, from, w->data + (size_t)2 * *at, words);
    } else {
        const int64_t value = words == row->words ? decode(row, w->data, *at) : -1;

        /* Half a number is none. */
        if (words != row->words || value < takt_panel_least(row) || value > panel_most(row))
            return MODBUS_VALUE;
        take_number(r, id, value);
    }
    *at += words;
    return MODBUS_GOOD;
}

/* An address that is wrong counts before a value that is, wherever they stand. */
static enum modbus_exception take_rows(struct panel_request *r, const struct written *w)
{
    enum modbus_exception exception = MODBUS_GOOD;
    unsigned at = 0;

    while (at < w->count) {
        const enum modbus_exception this = take_row(r, w, &at);

        if (this == MODBUS_ADDRESS)
            return this;
        if (this != MODBUS_GOOD) {
            exception = this;
            at++;
        }
    }
    return exception;
}

static bool is_order_to(const struct panel_order_item *item, enum panel_id id)
{
    return item->id == id && item->value != 0;
}

bool takt_panel_is_for_everybody(const struct panel_order *order)
{
    for (unsigned i = 0; i < order->count; i++) {
        const struct panel_order_item *item = &order->item[i];

        if (!is_order_to(item, REGISTER_FEED_HOLD) && !is_order_to(item, REGISTER_EMERGENCY_STOP))
            return false;
    }
    return order->count > 0;
}

/*
 * After n wrong passwords in a row, whoever gave them, none is looked at for 500 2^n control
 * cycles: of 1 ms, from 1 s to 16 s. Guesses over all connections are then some thousand a day.
 */
#define WRONG_CYCLES 500U
#define WRONG_MOST   5U

static bool is_too_soon(const struct panel_request *r)
{
    const struct panel *panel = r->client->panel;

    return panel->wrong > 0 && r->cycles - panel->wrong_cycles < WRONG_CYCLES << panel->wrong;
}

static enum panel_refusal try_password(const struct panel_request *r)
{
    struct panel *panel = r->client->panel;

    if (is_too_soon(r))
        return PANEL_REFUSAL_BUSY;
    if (r->password == panel->config.password) {
        panel->wrong = 0;
        return PANEL_REFUSAL_NONE;
    }
    panel->wrong_cycles = r->cycles;
    panel->wrong += panel->wrong < WRONG_MOST;
    return PANEL_REFUSAL_VALUE;
}

static enum panel_refusal check_password(const struct panel_request *r)
{
    const uint32_t password = r->client->panel->config.password;

    if (r->has_password)
        return try_password(r);
    return password == 0 || r->client->unlocked ? PANEL_REFUSAL_NONE : PANEL_REFUSAL_LOCKED;
}

/* Whoever may write nothing else yet may give the password. */
static bool is_password_alone(const struct panel_request *r)
{
    return r->has_password && r->order.count == 0 && !r->has_chunk && !r->has_command;
}

static enum panel_refusal check_rights(const struct panel_request *r)
{
    const struct panel *panel = r->client->panel;

    if (takt_panel_is_for_everybody(&r->order))
        return PANEL_REFUSAL_NONE;
    if (r->has_owner && panel->owner != r->client && !is_password_alone(r))
        return PANEL_REFUSAL_CONTROL;
    return check_password(r);
}

/* Stays as it is written, and counts for what is started next. */
static bool is_switch(enum panel_id id)
{
    return id == REGISTER_BLOCK_DELETE;
}

/* To clear a coil that starts something is allowed in every state: nothing starts. */
static enum panel_refusal check_states(const struct panel_request *r)
{
    for (unsigned i = 0; i < r->order.count; i++) {
        const struct panel_order_item *item = &r->order.item[i];

        if (!takt_panel_may_write(item->id, r->state) &&
            (takt_panel_registers[item->id].form != PANEL_BIT || item->value != 0 ||
             is_switch(item->id)))
            return PANEL_REFUSAL_STATE;
    }
    return PANEL_REFUSAL_NONE;
}

static enum panel_refusal refusal_of(enum panel_verdict verdict)
{
    switch (verdict) {
    case PANEL_DONE:
        return PANEL_REFUSAL_NONE;
    case PANEL_WRONG_STATE:
        return PANEL_REFUSAL_STATE;
    case PANEL_WRONG_VALUE:
        return PANEL_REFUSAL_VALUE;
    case PANEL_TRY_AGAIN:
        break;
    }
    return PANEL_REFUSAL_BUSY;
}

enum panel_refusal takt_panel_give_order(struct panel_request *r)
{
    const struct panel_port *port = &r->client->panel->config.port;

    return refusal_of(port->order(port->context, &r->order));
}

static void remember_owner(const struct panel_request *r)
{
    for (unsigned i = 0; i < r->order.count; i++) {
        if (r->order.item[i].id == REGISTER_WATCHDOG)
            r->client->panel->owner = r->order.item[i].value != 0 ? r->client : NULL;
    }
}

/*
 * The table keeps chunk, upload command and orders so far apart that a request has one of them at
 * most.
 */
static enum panel_refusal carry_out(struct panel_request *r)
{
    enum panel_refusal refusal = PANEL_REFUSAL_NONE;

    if (r->has_chunk)
        refusal = takt_panel_take_chunk(r);
    else if (r->has_command)
        refusal = takt_panel_command_upload(r);
    else if (r->order.count > 0)
        refusal = takt_panel_give_order(r);
    if (refusal != PANEL_REFUSAL_NONE)
        return refusal;
    r->client->panel->mailbox = r->mailbox;
    r->client->unlocked = r->client->unlocked || r->has_password;
    remember_owner(r);
    return refusal;
}

static enum panel_refusal refusal_of_rows(enum modbus_exception exception)
{
    if (exception == MODBUS_GOOD)
        return PANEL_REFUSAL_NONE;
    return exception == MODBUS_ADDRESS ? PANEL_REFUSAL_ADDRESS : PANEL_REFUSAL_VALUE;
}

/* Apart, so that the snapshot is gone from the stack before anything is done. */
static __attribute__((noinline)) void look_at_state(struct panel_request *r)
{
    struct panel_snapshot snapshot;

    takt_panel_look(r->client->panel, &snapshot);
    r->state = (enum panel_state)snapshot.value[REGISTER_STATE];
    r->cycles = snapshot.value[REGISTER_CYCLES];
    r->has_owner = snapshot.value[REGISTER_WATCHDOG] != 0;
    r->program_size = snapshot.value[REGISTER_PROGRAM_SIZE];
    r->program_crc = snapshot.value[REGISTER_PROGRAM_CRC];
}

/* All that it asks for is known. */
static enum panel_refusal decide(struct panel_request *r)
{
    enum panel_refusal refusal = check_rights(r);

    if (refusal == PANEL_REFUSAL_NONE)
        refusal = check_states(r);
    return refusal == PANEL_REFUSAL_NONE ? carry_out(r) : refusal;
}

static enum panel_refusal serve(struct panel_request *r, const struct written *w)
{
    enum panel_refusal refusal;

    look_at_state(r);
    r->mailbox = r->client->panel->mailbox;
    refusal = refusal_of_rows(take_rows(r, w));
    memcpy(r->order.mdi, r->mailbox.mdi, PANEL_MDI_MAX);
    r->order.mdi[PANEL_MDI_MAX] = '\0';
    return refusal == PANEL_REFUSAL_NONE ? decide(r) : refusal;
}

static enum modbus_exception exception_of(enum panel_refusal refusal)
{
    switch (refusal) {
    case PANEL_REFUSAL_NONE:
        return MODBUS_GOOD;
    case PANEL_REFUSAL_ADDRESS:
        return MODBUS_ADDRESS;
    case PANEL_REFUSAL_VALUE:
        return MODBUS_VALUE;
    case PANEL_REFUSAL_STATE:
    case PANEL_REFUSAL_LOCKED:
        return MODBUS_STATE;
    case PANEL_REFUSAL_CONTROL:
    case PANEL_REFUSAL_BUSY:
        break;
    }
    return MODBUS_BUSY;
}

static enum panel_refusal serve_here(struct panel_request *r)
{
    const struct panel_port *port = &r->client->panel->config.port;
    enum panel_refusal refusal;

    look_at_state(r);
    r->mailbox = r->client->panel->mailbox;
    refusal = decide(r);
    if (refusal != PANEL_REFUSAL_NONE)
        r->client->refusal = refusal;
    if (r->client->panel->owner == r->client)
        port->alive(port->context);
    return refusal;
}

enum panel_refusal takt_panel_client_order(struct panel_client *client,
                                           const struct panel_order *order)
{
    struct panel_request request = {.client = client, .order = *order};

    return serve_here(&request);
}

enum panel_refusal takt_panel_client_unlock(struct panel_client *client, uint32_t password)
{
    struct panel_request request = {.client = client, .has_password = true, .password = password};

    return serve_here(&request);
}

enum modbus_exception takt_panel_write(void *context, enum modbus_table table, uint16_t address,
                                       uint16_t count, const uint8_t *data)
{
    struct panel_client *client = context;
    struct panel_request request = {.client = client};
    const struct written written = {table, address, count, data};
    const enum panel_refusal refusal = serve(&request, &written);

    if (refusal != PANEL_REFUSAL_NONE)
        client->refusal = refusal;
    if (client->panel->owner == client)
        client->panel->config.port.alive(client->panel->config.port.context);
    return exception_of(refusal);
}
