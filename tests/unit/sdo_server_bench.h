/*
 * The SDO server by itself, frame by frame, with an owner of three objects: a number, a short text
 * and a long one.
 */
#ifndef TAKT_TESTS_SDO_SERVER_BENCH_H
#define TAKT_TESTS_SDO_SERVER_BENCH_H

#include "canopen/little_endian.h"
#include "canopen/sdo_server.h"
#include "unity.h"

#include <string.h>

#define NODE       9
#define FRAMES_MAX 512

#define TIMEOUT_NS (UINT64_C(1000000) * SDO_SERVER_TIMEOUT_MS)

#define NUMBER   SDO_OBJECT(0x6040, 0)
#define TEXT     SDO_OBJECT(0x2000, 0)
#define LONG     SDO_OBJECT(0x2001, 0)
#define READONLY SDO_OBJECT(0x6041, 0)
#define MISSING  SDO_OBJECT(0x5000, 1)

static struct sdo_server server;
static struct can_frame sent[FRAMES_MAX];
static unsigned sent_count;
static unsigned room;   /* frames that may still be sent */
static uint64_t now_ns; /* the server's clock */

static uint8_t stored[SDO_SERVER_WRITE_MAX];
static size_t stored_length;
static uint32_t stored_object;

static inline uint32_t owner_read(void *context, uint32_t object, uint8_t number[4],
                                  const uint8_t **bytes, size_t *length)
{
    (void)context;
    if (object == MISSING)
        return SDO_ABORT_NO_OBJECT;
    *bytes = stored;
    *length = stored_length;
    if (object == NUMBER) {
        little_endian_write16(number, 0x1234);
        *bytes = number;
        *length = 2;
    }
    return SDO_ABORT_NONE;
}

static inline uint32_t owner_may_write(void *context, uint32_t object, size_t *size)
{
    (void)context;
    *size = object == NUMBER ? 2 : 0;
    return object == READONLY ? SDO_ABORT_READ_ONLY : SDO_ABORT_NONE;
}

static inline uint32_t owner_write(void *context, uint32_t object, const uint8_t *bytes,
                                   size_t length)
{
    (void)context;
    if (object == NUMBER && length != 2)
        return SDO_ABORT_LENGTH;
    stored_object = object;
    stored_length = length;
    memcpy(stored, bytes, length);
    return SDO_ABORT_NONE;
}

static inline bool owner_send(void *context, const struct can_frame *frame)
{
    (void)context;
    if (room == 0)
        return false;
    room--;
    TEST_ASSERT_TRUE(sent_count < FRAMES_MAX);
    sent[sent_count++] = *frame;
    return true;
}

void setUp(void)
{
    const struct sdo_server_owner owner = {owner_read, owner_may_write, owner_write, owner_send,
                                           NULL};
    takt_sdo_server_init(&server, NODE, &owner);
    sent_count = 0;
    room = UINT32_MAX;
    now_ns = 0;
    stored_length = 0;
    stored_object = 0;
}

void tearDown(void)
{
}

static inline void ask(uint8_t command, uint32_t object, uint32_t value)
{
    struct can_frame frame;
    takt_sdo_write_initiate(&frame, SDO_REQUEST_FUNCTION + NODE, command, object, value);
    sent_count = 0;
    takt_sdo_server_take(&server, &frame, now_ns);
}

/* A frame that is not the first of a transfer. */
static inline void tell(uint8_t command, const void *bytes, size_t length)
{
    struct can_frame frame = {.id = SDO_REQUEST_FUNCTION + NODE, .length = 8};
    frame.data[0] = command;
    if (length > 0)
        memcpy(frame.data + 1, bytes, length);
    sent_count = 0;
    takt_sdo_server_take(&server, &frame, now_ns);
}

static inline void assert_answer(uint8_t command, uint32_t object, uint32_t value)
{
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_HEX16(SDO_RESPONSE_FUNCTION + NODE, sent[0].id);
    TEST_ASSERT_EQUAL_UINT8(8, sent[0].length);
    TEST_ASSERT_EQUAL_HEX8(command, sent[0].data[0]);
    TEST_ASSERT_EQUAL_HEX32(object, takt_sdo_read_object(&sent[0]));
    TEST_ASSERT_EQUAL_HEX32(value, little_endian_read32(sent[0].data + 4));
}

/* A client that says nothing more is waited for until then. */
static inline void assert_given_up_at(uint64_t due_ns, uint32_t object)
{
    TEST_ASSERT_EQUAL_UINT64(due_ns, takt_sdo_server_due_ns(&server));
    sent_count = 0;
    takt_sdo_server_give_up(&server);
    assert_answer(0x80, object, 0x05040000);
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, takt_sdo_server_due_ns(&server));
    ask(0x40, NUMBER, 0);
    assert_answer(0x4B, NUMBER, 0x1234);
}

static inline void fill(size_t length)
{
    stored_length = length;
    for (size_t i = 0; i < length; i++)
        stored[i] = (uint8_t)(i * 7 + 1);
}

static inline const uint8_t *data_of(size_t length)
{
    static uint8_t data[SDO_SERVER_WRITE_MAX + 16];
    for (size_t i = 0; i < length; i++)
        data[i] = (uint8_t)(i * 11 + 3);
    return data;
}

#endif
