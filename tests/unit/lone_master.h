/*
 * A master in operation, against a port under the test's control: what it sends is kept, what it
 * receives is put in by hand, but for the start, which fake nodes answer. Shared by
 * test_drive_master.c, test_drive_faults.c and test_drive_stopping.c.
 */
#ifndef TAKT_TESTS_LONE_MASTER_H
#define TAKT_TESTS_LONE_MASTER_H

#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "canopen/target_pdo.h"
#include "drive/drives.h"
#include "fake_nodes.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define FRAMES_MAX   64
#define START_CYCLES 400

static struct can_frame sent[FRAMES_MAX];
static unsigned sent_count;
static struct fake_nodes nodes;
static unsigned cycles_run;
static uint16_t refused_id; /* frames of this identifier are refused; 0xFFFF: none */

static inline bool port_send(void *context, const struct can_frame *frame)
{
    (void)context;
    if (frame->id == refused_id)
        return false;
    TEST_ASSERT_TRUE(sent_count < FRAMES_MAX);
    sent[sent_count++] = *frame;
    fake_nodes_take(&nodes, frame);
    return true;
}

static inline bool port_receive(void *context, struct can_frame *frame)
{
    (void)context;
    return fake_nodes_receive(&nodes, frame);
}

static const struct can_port port = {.send = port_send, .receive = port_receive};
static struct drives drives;
static struct point setpoint;

/* Axes X Y Z at nodes 1 2 3, 1000 increments/mm, 0.5 mm following error. */
static inline struct drives_config three_axes(void)
{
    struct drives_config config = {
        .count = 3,
        .cycle_us = 1000,
        .rates = {1000000, 0},
        .controller_node = 127,
        .boot_timeout_cycles = 100,
        .start_timeout_cycles = START_CYCLES,
        .answer_timeout_cycles = 2,
        .sdo_timeout_cycles = 10,
        .brake_timeout_cycles = 100,
    };
    for (unsigned i = 0; i < 3; i++)
        config.axis[i] = (struct drives_config_axis){.axis = (enum axis)(AXIS_X + (int)i),
                                                     .node = (uint8_t)(i + 1),
                                                     .increments_per_mm = 1000,
                                                     .following_error_max_mm = 0.5};
    return config;
}

/* Everything sent in a cycle is in sent[]; what was put in before is received. */
static inline void cycle(void)
{
    sent_count = 0;
    takt_drives_receive(&drives, &port);
    takt_drives_sync(&drives, &port);
    takt_drives_send(&drives, &port, &setpoint);
    cycles_run++;
}

/* Until every drive has been configured and started: its statusword is waited for. */
static inline void boot(const struct drives_config *config)
{
    memset(&nodes, 0, sizeof nodes);
    memset(&setpoint, 0, sizeof setpoint);
    refused_id = 0xFFFF;
    cycles_run = 0;
    takt_drives_init(&drives, config);
    while (nodes.starts[1] == 0 && cycles_run < START_CYCLES)
        cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
    cycle();
}

void setUp(void)
{
    struct drives_config config = three_axes();
    boot(&config);
}

void tearDown(void)
{
}

static inline void put_status(unsigned node, enum cia402_state state, int32_t actual_inc)
{
    struct can_frame *frame = fake_nodes_add(&nodes);
    frame->id = (uint16_t)(PDO_TPDO1_FUNCTION + node);
    frame->length = 6;
    little_endian_write16(frame->data, (uint16_t)(takt_cia402_statusword(state) | 0x1210));
    little_endian_write32(frame->data + 2, (uint32_t)actual_inc);
}

static inline void put_all(enum cia402_state state, int32_t actual_inc)
{
    for (unsigned node = 1; node <= 3; node++)
        put_status(node, state, actual_inc);
}

static inline const struct can_frame *find_sent(unsigned id)
{
    for (unsigned i = 0; i < sent_count; i++)
        if (sent[i].id == id)
            return &sent[i];
    return NULL;
}

/* Fails the test if there is none. */
static inline const struct can_frame *get_sent(unsigned id)
{
    const struct can_frame *frame = find_sent(id);
    if (!frame)
        TEST_FAIL_MESSAGE("the frame has not been sent");
    return frame ? frame : &sent[0];
}

static inline int32_t sent_target(unsigned id, unsigned offset)
{
    return (int32_t)little_endian_read32(get_sent(id)->data + offset);
}

/* Enabled, and each has shown its mode. */
static inline void enable_at(int32_t actual_inc)
{
    for (unsigned i = 0; i < 10 && drives_get_state(&drives) == DRIVES_STARTING; i++) {
        put_all(CIA402_ENABLED, actual_inc);
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

/* Runs cycles in which the drives do exactly as told, DRIVES_LATENCY_CYCLES later. */
static inline void follow(unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++) {
        put_all(CIA402_ENABLED, (int32_t)lround(setpoint.at[AXIS_X] * 1000));
        cycle();
    }
}

static inline void assert_fault(enum takt_error error, char axis)
{
    const struct diagnostic *fault = takt_drives_get_fault(&drives);
    char word[] = "? (node ?)";
    word[0] = axis;
    word[8] = (char)('1' + axis - 'X');
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_INT(error, fault->code);
    TEST_ASSERT_EQUAL_STRING(word, fault->word);
}

/*
 * A setpoint that runs at a constant 100 mm/s and drives that report it delay cycles later. At the
 * true delay there is no following error; one cycle more is 0.1 mm.
 */
static inline void run_delayed(unsigned delay, unsigned cycles)
{
    enable_at(0);
    for (unsigned k = 1; k < cycles; k++) {
        int32_t reached = k > delay ? (int32_t)(100 * (k - delay)) : 0;
        setpoint.at[AXIS_X] = setpoint.at[AXIS_Y] = setpoint.at[AXIS_Z] = 0.1 * k;
        put_all(CIA402_ENABLED, reached);
        cycle();
    }
}

#endif
