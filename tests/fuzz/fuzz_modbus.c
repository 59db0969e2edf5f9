/*
 * Any bytes as what a client of the panel sends, on TCP and on a serial line, behind them the panel
 * as it is.
 *
 * The first byte says how the others are taken: as a TCP stream, as a serial line, as requests
 * whose frame and checksum are made right here so that they reach the registers. Nothing may crash,
 * and three things must hold: replies fit their frame; a request that is refused has ordered and
 * stored nothing; what is ordered is within the table.
 */
#include "modbus/crc.h"
#include "modbus/rtu.h"
#include "modbus/tcp.h"
#include "panel/panel.h"

#include <stdlib.h>
#include <string.h>

#define STORE_SIZE  4096
#define UNIT        1
#define GAP_US      2000
#define EXCEPTION   0x80
#define REQUEST_MAX 255

enum how { AS_TCP, AS_LINE, AS_TCP_REQUESTS, AS_LINE_REQUESTS, HOWS };

static struct panel_snapshot shown;
static uint8_t stored[STORE_SIZE];
static uint32_t room;
static unsigned changes; /* orders and bytes stored */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool held)
{
    if (!held)
        abort();
}

static void look(void *context, struct panel_snapshot *snapshot)
{
    (void)context;
    *snapshot = shown;
}

/* The state moves on with what is ordered, so that all of them are met. */
static enum panel_verdict order(void *context, const struct panel_order *wanted)
{
    (void)context;
    for (unsigned i = 0; i < wanted->count; i++) {
        const struct panel_order_item *item = &wanted->item[i];
        const struct panel_register *row = &takt_panel_registers[item->id];

        require(row->states != PANEL_NEVER);
        require(item->value >= takt_panel_least(row) && item->value <= panel_most(row));
        shown.value[item->id] = (uint32_t)item->value;
    }
    if (shown.value[REGISTER_FEED_OVERRIDE] == 0)
        return PANEL_WRONG_STATE;
    shown.value[REGISTER_STATE] = (shown.value[REGISTER_STATE] + 1) % PANEL_STATES;
    changes++;
    return PANEL_DONE;
}

static void hear(void *context)
{
    (void)context;
}

/* Bytes that a stream takes now: more or less of them. */
static uint32_t takt_store_room(void *context)
{
    (void)context;
    return changes * 37 % 300;
}

static bool takt_store_begin(void *context, uint32_t size)
{
    (void)context;
    room = size;
    return size <= STORE_SIZE;
}

static bool takt_store_write(void *context, uint32_t offset, const uint8_t *bytes, size_t size)
{
    require(offset <= room && size <= room - offset);
    require(context == NULL || size <= takt_store_room(context));
    memcpy(stored + offset, bytes, size);
    changes++;
    return true;
}

static bool store_done(void *context)
{
    (void)context;
    return true;
}

static void store_end(void *context, bool right)
{
    (void)context;
    (void)right;
}

static void store_why(void *context, char *text)
{
    (void)context;
    memset(text, changes % 2 == 0 ? 'x' : '\0', PANEL_ALARM_TEXT_MAX - 1);
}

/* An exception is a promise that nothing has changed. */
static void check_reply(const uint8_t *pdu, size_t length, unsigned changes_before)
{
    require(length >= 2 && length <= MODBUS_PDU_MAX);
    if ((pdu[0] & EXCEPTION) != 0)
        require(length == 2 && changes == changes_before);
}

static void run_tcp(struct panel_client *client, struct modbus_tcp *tcp, const uint8_t *data,
                    size_t size)
{
    const struct modbus_map map = takt_panel_client_map(client);
    enum modbus_tcp_result result = MODBUS_TCP_REPLY;

    while (result == MODBUS_TCP_REPLY && size > 0) {
        uint8_t reply[MODBUS_TCP_MAX];
        const unsigned before = changes;
        size_t length = 0;

        result = takt_modbus_tcp_take(tcp, &map, &data, &size, reply, &length);
        if (result == MODBUS_TCP_REPLY)
            check_reply(reply + MODBUS_TCP_HEADER, length - MODBUS_TCP_HEADER, before);
    }
    if (result == MODBUS_TCP_BROKEN)
        takt_modbus_tcp_init(tcp);
}

static void check_line_reply(const uint8_t *reply, size_t length, unsigned changes_before)
{
    if (length == 0)
        return;
    require(length >= 4 && length <= MODBUS_RTU_MAX && reply[0] == UNIT);
    check_reply(reply + 1, length - 3, changes_before);
}

static void run_line(struct modbus_rtu *rtu, const uint8_t *data, size_t size, uint32_t *now_us)
{
    uint8_t reply[MODBUS_RTU_MAX];

    for (size_t i = 0; i < size; i++) {
        const unsigned before = changes;

        *now_us += 100;
        check_line_reply(reply, takt_modbus_rtu_take(rtu, data[i], *now_us, reply), before);
    }
    const unsigned before = changes;

    *now_us += GAP_US;
    check_line_reply(reply, takt_modbus_rtu_idle(rtu, *now_us, reply), before);
}

static void run_tcp_request(struct panel_client *client, struct modbus_tcp *tcp, const uint8_t *pdu,
                            size_t size)
{
    uint8_t frame[MODBUS_TCP_HEADER + REQUEST_MAX] = {0};

    modbus_write16(frame + 4, (uint16_t)(size + 1));
    memcpy(frame + MODBUS_TCP_HEADER, pdu, size);
    run_tcp(client, tcp, frame, MODBUS_TCP_HEADER + size);
}

static void run_line_request(struct modbus_rtu *rtu, const uint8_t *pdu, size_t size,
                             uint32_t *now_us)
{
    uint8_t frame[1 + REQUEST_MAX + 2] = {UNIT};
    uint16_t crc;

    memcpy(frame + 1, pdu, size);
    crc = takt_crc16(frame, size + 1);
    frame[size + 1] = (uint8_t)crc;
    frame[size + 2] = (uint8_t)(crc >> 8);
    run_line(rtu, frame, size + 3, now_us);
}

struct world {
    struct panel panel;
    struct panel_client client;
    struct modbus_tcp tcp;
    struct modbus_rtu rtu;
    uint32_t now_us;
};

/* streams: programs may come while they run. */
static struct panel_store make_store(bool streams)
{
    return (struct panel_store){
        .begin = takt_store_begin,
        .write = takt_store_write,
        .prepare = store_done,
        .place = store_done,
        .begin_stream = streams ? takt_store_begin : NULL,
        .end_stream = streams ? store_end : NULL,
        .why = store_why,
        .room = streams ? takt_store_room : NULL,
        .context = streams ? &room : NULL,
    };
}

static void open_world(struct world *world, uint32_t password, bool streams)
{
    const struct panel_config config = {
        .port = {look, order, hear, NULL},
        .store = make_store(streams),
        .settings = make_store(false),
        .password = password,
    };
    struct modbus_map map;

    memset(&shown, 0, sizeof shown);
    shown.value[REGISTER_STATE] = PANEL_IDLE;
    shown.value[REGISTER_FEED_OVERRIDE] = 1000;
    room = 0;
    takt_panel_init(&world->panel, &config);
    takt_panel_client_enter(&world->client, &world->panel);
    takt_modbus_tcp_init(&world->tcp);
    map = takt_panel_client_map(&world->client);
    takt_modbus_rtu_init(&world->rtu, &map, UNIT, GAP_US);
    world->now_us = 0;
}

/* Requests one after the other, each with its length before it. */
static void run_requests(struct world *world, enum how how, const uint8_t *data, size_t size)
{
    while (size > 1) {
        size_t length = data[0];

        data++;
        size--;
        if (length == 0 || length > size)
            length = size;
        if (length > MODBUS_PDU_MAX)
            length = MODBUS_PDU_MAX;
        if (how == AS_TCP_REQUESTS)
            run_tcp_request(&world->client, &world->tcp, data, length);
        else
            run_line_request(&world->rtu, data, length, &world->now_us);
        data += length;
        size -= length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct world world;
    enum how how;

    if (size < 2)
        return 0;
    open_world(&world, data[0] >= 0xF0 ? 0x00010001 : 0, (data[0] & 8) != 0);
    how = (enum how)(data[0] % HOWS);
    if (how == AS_TCP)
        run_tcp(&world.client, &world.tcp, data + 1, size - 1);
    else if (how == AS_LINE)
        run_line(&world.rtu, data + 1, size - 1, &world.now_us);
    else
        run_requests(&world, how, data + 1, size - 1);
    return 0;
}
