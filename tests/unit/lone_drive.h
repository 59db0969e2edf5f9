/*
 * One virtual drive without a bus: what it sends is caught, what it is to hear is handed in.
 */
#ifndef TAKT_TESTS_LONE_DRIVE_H
#define TAKT_TESTS_LONE_DRIVE_H

#include "canopen/little_endian.h"
#include "canopen/sdo.h"
#include "canopen/sync.h"
#include "drives/virtual_drive.h"
#include "unity.h"

#include <string.h>

#define LONE_NODE       5
#define LONE_CYCLE_NS   1000000u
#define LONE_FRAMES_MAX 256

struct lone_drive {
    struct virtual_drive drive;
    struct virtual_drive_config config;
    struct can_frame sent[LONE_FRAMES_MAX];
    unsigned sent_count;
};

static inline bool lone_send(void *context, const struct can_frame *frame)
{
    struct lone_drive *lone = context;
    TEST_ASSERT_TRUE(lone->sent_count < LONE_FRAMES_MAX);
    lone->sent[lone->sent_count++] = *frame;
    return true;
}

static inline bool lone_receive(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

/* 1000 increments/mm, the default plant. */
static inline void lone_set_default(struct lone_drive *lone)
{
    memset(lone, 0, sizeof *lone);
    lone->config = (struct virtual_drive_config){
        .node = LONE_NODE, .increments_per_mm = 1000, .cycle_us = 1000};
    drive_plant_set_default(&lone->config.plant);
}

/* Switches it on with lone->config and boots it. */
static inline void lone_start(struct lone_drive *lone)
{
    const struct can_port port = {.send = lone_send, .receive = lone_receive, .context = lone};
    TEST_ASSERT_NULL(drive_plant_check(&lone->config.plant));
    virtual_drive_init(&lone->drive, &lone->config, NULL, &port);
    virtual_drive_boot(&lone->drive);
}

static inline void lone_take(struct lone_drive *lone, unsigned id, unsigned length, uint32_t low,
                             uint32_t high)
{
    struct can_frame frame = {.id = (uint16_t)id, .length = (uint8_t)length};
    little_endian_write32(frame.data, low);
    little_endian_write32(frame.data + 4, high);
    lone->sent_count = 0;
    virtual_drive_on_frame(&lone->drive, &frame);
}

static inline void lone_nmt(struct lone_drive *lone, enum nmt_command command)
{
    lone_take(lone, 0x000, 2, (uint32_t)command | LONE_NODE << 8, 0);
}

/* RPDO1: controlword and mode. */
static inline void lone_control(struct lone_drive *lone, uint16_t controlword, int8_t mode)
{
    lone_take(lone, 0x200 + LONE_NODE, 3, controlword | (uint32_t)(uint8_t)mode << 16, 0);
}

static inline void lone_sync(struct lone_drive *lone)
{
    lone_take(lone, SYNC_COB_ID, 0, 0, 0);
}

/* Cycles without SYNC; what is sent adds up. */
static inline void lone_step(struct lone_drive *lone, unsigned cycles)
{
    lone->sent_count = 0;
    for (unsigned i = 0; i < cycles; i++)
        virtual_drive_step(&lone->drive, LONE_CYCLE_NS);
}

static inline const struct can_frame *lone_find(const struct lone_drive *lone, unsigned id)
{
    for (unsigned i = 0; i < lone->sent_count; i++)
        if (lone->sent[i].id == id)
            return &lone->sent[i];
    return NULL;
}

/* Expedited upload; the abort code instead, if *aborted. */
static inline uint32_t lone_try_read(struct lone_drive *lone, uint16_t index, uint8_t sub,
                                     bool *aborted)
{
    lone_take(lone, SDO_REQUEST_FUNCTION + LONE_NODE, 8,
              0x40 | (uint32_t)index << 8 | (uint32_t)sub << 24, 0);
    const struct can_frame *answer = lone_find(lone, SDO_RESPONSE_FUNCTION + LONE_NODE);
    TEST_ASSERT_NOT_NULL(answer);
    *aborted = answer->data[0] == SDO_ABORT;
    return little_endian_read32(answer->data + 4);
}

static inline uint32_t lone_read(struct lone_drive *lone, uint16_t index, uint8_t sub)
{
    bool aborted;
    uint32_t value = lone_try_read(lone, index, sub, &aborted);
    TEST_ASSERT_FALSE(aborted);
    return value;
}

/* Expedited download of bytes; the abort code, or 0. */
static inline uint32_t lone_write(struct lone_drive *lone, uint16_t index, uint8_t sub,
                                  unsigned bytes, uint32_t value)
{
    uint32_t command = 0x23 | (4 - bytes) << 2;
    lone_take(lone, SDO_REQUEST_FUNCTION + LONE_NODE, 8,
              command | (uint32_t)index << 8 | (uint32_t)sub << 24, value);
    const struct can_frame *answer = lone_find(lone, SDO_RESPONSE_FUNCTION + LONE_NODE);
    TEST_ASSERT_NOT_NULL(answer);
    return answer->data[0] == SDO_ABORT ? little_endian_read32(answer->data + 4) : 0;
}

static inline void lone_enable(struct lone_drive *lone, int8_t mode)
{
    lone_nmt(lone, NMT_START);
    lone_control(lone, CIA402_SHUTDOWN, mode);
    lone_control(lone, CIA402_SWITCH_ON, mode);
    lone_control(lone, CIA402_ENABLE_OPERATION, mode);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone->drive));
}

static inline uint16_t lone_statusword(struct lone_drive *lone)
{
    return (uint16_t)lone_read(lone, 0x6041, 0);
}

static inline int32_t lone_actual(struct lone_drive *lone)
{
    return (int32_t)lone_read(lone, 0x6064, 0);
}

static inline unsigned lone_count_sent(const struct lone_drive *lone, unsigned id)
{
    unsigned count = 0;
    for (unsigned i = 0; i < lone->sent_count; i++)
        count += lone->sent[i].id == id;
    return count;
}

#endif
