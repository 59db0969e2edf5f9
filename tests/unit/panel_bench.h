/*
 * A panel with two clients, before a controller and a store of programs that note what they are
 * asked.
 */
#ifndef TAKT_TESTS_PANEL_BENCH_H
#define TAKT_TESTS_PANEL_BENCH_H

#include "base/crc32.h"
#include "modbus/crc.h"
#include "panel/panel.h"
#include "unity.h"

#include <string.h>

static struct panel_snapshot shown;
static struct panel_order ordered;
static unsigned orders, alive;
static enum panel_verdict verdict;
static uint8_t stored[1000];
static uint32_t room;
static unsigned prepared, placed, streams, ended;
static bool no_place; /* what is prepared cannot be put in its place */

static struct panel panel;
static struct panel_client one, other;
static uint8_t data[2 * MODBUS_READ_WORDS_MAX];

static inline void look(void *context, struct panel_snapshot *snapshot)
{
    (void)context;
    *snapshot = shown;
}

static inline enum panel_verdict order(void *context, const struct panel_order *wanted)
{
    (void)context;
    orders++;
    ordered = *wanted;
    for (unsigned i = 0; i < wanted->count && verdict == PANEL_DONE; i++)
        shown.value[wanted->item[i].id] = (uint32_t)wanted->item[i].value;
    return verdict;
}

static inline void hear(void *context)
{
    (void)context;
    alive++;
}

static inline bool takt_store_begin(void *context, uint32_t size)
{
    (void)context;
    room = size;
    return size <= sizeof stored;
}

static inline bool takt_store_write(void *context, uint32_t offset, const uint8_t *bytes,
                                    size_t size)
{
    (void)context;
    TEST_ASSERT_TRUE(offset + size <= room);
    memcpy(stored + offset, bytes, size);
    return true;
}

static inline bool store_prepare(void *context)
{
    (void)context;
    prepared++;
    return true;
}

static inline bool store_place(void *context)
{
    (void)context;
    placed++;
    return !no_place;
}

static inline bool store_begin_stream(void *context, uint32_t size)
{
    streams++;
    return takt_store_begin(context, size);
}

static inline void store_end_stream(void *context, bool right)
{
    (void)context;
    (void)right;
    ended++;
}

static inline void start_with(uint32_t password)
{
    const struct panel_config config = {
        .port = {look, order, hear, NULL},
        .store = {.begin = takt_store_begin,
                  .write = takt_store_write,
                  .prepare = store_prepare,
                  .place = store_place,
                  .begin_stream = store_begin_stream,
                  .end_stream = store_end_stream},
        .password = password,
    };

    takt_panel_init(&panel, &config);
    takt_panel_client_enter(&one, &panel);
    takt_panel_client_enter(&other, &panel);
}

void setUp(void)
{
    memset(&shown, 0, sizeof shown);
    memset(&ordered, 0, sizeof ordered);
    orders = alive = prepared = placed = streams = ended = 0;
    no_place = false;
    verdict = PANEL_DONE;
    shown.value[REGISTER_STATE] = PANEL_IDLE;
    start_with(0);
}

void tearDown(void)
{
}

static inline enum modbus_exception read_row(struct panel_client *client, enum panel_id id)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const struct modbus_map map = takt_panel_client_map(client);

    return map.read(map.context, row->table, row->address, row->words, data);
}

static inline int64_t value_of(struct panel_client *client, enum panel_id id)
{
    const struct panel_register *row = &takt_panel_registers[id];
    uint32_t bits;

    TEST_ASSERT_EQUAL_INT(MODBUS_GOOD, read_row(client, id));
    if (row->table == MODBUS_COILS)
        return data[0] & 1;
    bits = modbus_read16(data);
    if (row->words == 2)
        bits = bits << 16 | modbus_read16(data + 2);
    return row->form == PANEL_S32 ? (int32_t)bits : (int64_t)bits;
}

static inline enum modbus_exception write_words(struct panel_client *client, uint16_t address,
                                                uint16_t count, const uint8_t *bytes)
{
    const struct modbus_map map = takt_panel_client_map(client);

    return map.write(map.context, MODBUS_HOLDINGS, address, count, bytes);
}

static inline enum modbus_exception write_row(struct panel_client *client, enum panel_id id,
                                              int64_t value)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const struct modbus_map map = takt_panel_client_map(client);
    const uint32_t bits = (uint32_t)(uint64_t)value;
    uint8_t bytes[4] = {0};

    if (row->words == 2)
        modbus_write16(bytes, (uint16_t)(bits >> 16));
    modbus_write16(bytes + (size_t)2 * (row->words - 1U), (uint16_t)bits);
    if (row->table == MODBUS_COILS)
        bytes[0] = value != 0;
    return map.write(map.context, row->table, row->address, row->words, bytes);
}

static inline enum modbus_exception begin_by(enum panel_upload_command command, uint32_t size,
                                             uint32_t crc)
{
    uint8_t words[10];

    modbus_write16(words, (uint16_t)(size >> 16));
    modbus_write16(words + 2, (uint16_t)size);
    modbus_write16(words + 4, (uint16_t)(crc >> 16));
    modbus_write16(words + 6, (uint16_t)crc);
    modbus_write16(words + 8, (uint16_t)command);
    return write_words(&one, takt_panel_registers[REGISTER_UPLOAD_SIZE].address, 5, words);
}

static inline enum modbus_exception begin(uint32_t size, uint32_t crc)
{
    return begin_by(PANEL_UPLOAD_BEGIN, size, crc);
}

#endif
