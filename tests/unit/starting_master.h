/*
 * A master at the start of its drives, against fake nodes that do what their controlwords say:
 * shared by the tests of the start (test_drive_boot.c, test_drive_refusals.c) and of homing
 * (test_drive_homing.c).
 */
#ifndef TAKT_TESTS_STARTING_MASTER_H
#define TAKT_TESTS_STARTING_MASTER_H

#include "canopen/cia402.h"
#include "drive/drives.h"
#include "fake_nodes.h"
#include "unity.h"

#define DRIVES       3
#define START_CYCLES 2000

static struct fake_nodes nodes;
static struct drives_config config;
static struct drives drives;
static unsigned cycles_run, frames_sent;
static enum cia402_state shown[128]; /* by the statusword of a node that has been started */
static uint16_t shown_bits[128];
static uint16_t control[128]; /* last controlword of a node */
static int32_t shown_inc;     /* actual position of all */
static int32_t target_of_3;   /* last target of node 3 */
static unsigned lost_starts;  /* NMT starts that get lost */
static bool refuses_starts;   /* the bus takes none */

static inline bool port_send(void *context, const struct can_frame *frame)
{
    const bool is_start = frame->id == 0 && frame->data[0] == NMT_START;
    (void)context;
    if (is_start && refuses_starts)
        return false;
    frames_sent++;
    if (is_start && lost_starts > 0) {
        lost_starts--;
        return true;
    }
    fake_nodes_take(&nodes, frame);
    if ((frame->id & 0x780) == 0x200)
        control[frame->id & 0x7F] = little_endian_read16(frame->data);
    if (frame->id == 0x303)
        target_of_3 = (int32_t)little_endian_read32(frame->data);
    return true;
}

static inline bool port_receive(void *context, struct can_frame *frame)
{
    (void)context;
    return fake_nodes_receive(&nodes, frame);
}

static const struct can_port port = {.send = port_send, .receive = port_receive};

static bool follows_at_once = true;

static inline uint16_t bits_of_following(unsigned node)
{
    bool is_cyclic = nodes.mode[node] == CIA402_MODE_CYCLIC_SYNC_POSITION;
    return is_cyclic && shown[node] == CIA402_ENABLED ? CIA402_FOLLOWS_TARGET : 0;
}

static unsigned deaf_edges;  /* how many fault resets come too early */
static uint16_t before[128]; /* controlwords */

static unsigned held_cycles; /* over which a fault reset has to stand */
static unsigned slow_cycles; /* a controlword has to stand so long before its state is shown */
static unsigned stands[128]; /* controlwords, for so many cycles */

static inline bool stands_long_enough(unsigned node, uint16_t previous)
{
    const bool is_reset = shown[node] == CIA402_FAULT && control[node] & 0x80;
    stands[node] = control[node] == previous ? stands[node] + 1 : 0;
    return stands[node] >= (is_reset ? held_cycles : slow_cycles);
}

static inline enum cia402_state next_state(unsigned node)
{
    const uint16_t previous = before[node];
    before[node] = control[node];
    if (!stands_long_enough(node, previous))
        return shown[node];
    if (slow_cycles > 0)
        stands[node] = 0;
    if (held_cycles > 0 && shown[node] == CIA402_FAULT)
        return control[node] & 0x80 ? CIA402_SWITCH_ON_DISABLED : CIA402_FAULT;
    if (shown[node] == CIA402_FAULT && control[node] & ~previous & 0x80 && deaf_edges > 0) {
        deaf_edges--;
        return CIA402_FAULT;
    }
    return takt_cia402_next_state(shown[node], control[node], previous);
}

/* Drives that do what the controlword says. */
static inline void put_statuses(void)
{
    for (unsigned i = 0; i < config.count; i++) {
        unsigned node = config.axis[i].node;
        struct can_frame *frame;
        const bool is_started = nodes.starts[node] > 0;
        if (nodes.resets[node] == 0 || node == nodes.mute)
            continue;
        if (cycles_run % 100 == node)
            takt_nmt_write_heartbeat(fake_nodes_add(&nodes), (uint8_t)node,
                                     is_started ? NMT_OPERATIONAL : NMT_PREOPERATIONAL);
        if (!is_started)
            continue;
        shown[node] = next_state(node);
        frame = fake_nodes_add(&nodes);
        *frame = (struct can_frame){.id = (uint16_t)(PDO_TPDO1_FUNCTION + node), .length = 6};
        little_endian_write16(frame->data,
                              (uint16_t)(takt_cia402_statusword(shown[node]) | shown_bits[node] |
                                         (follows_at_once ? bits_of_following(node) : 0)));
        little_endian_write32(frame->data + 2, (uint32_t)shown_inc);
    }
}

static inline void cycle(void)
{
    static const struct point nowhere;
    put_statuses();
    takt_drives_receive(&drives, &port);
    takt_drives_sync(&drives, &port);
    takt_drives_send(&drives, &port, &nowhere);
    cycles_run++;
}

static inline void run_until(enum drives_state state)
{
    while (drives_get_state(&drives) != state && cycles_run < 2 * START_CYCLES)
        cycle();
    TEST_ASSERT_EQUAL_INT(state, drives_get_state(&drives));
}

static inline void run_start(void)
{
    takt_drives_init(&drives, &config);
    while (drives_get_state(&drives) == DRIVES_STARTING && cycles_run < 2 * START_CYCLES)
        cycle();
}

void setUp(void)
{
    memset(&nodes, 0, sizeof nodes);
    memset(shown_bits, 0, sizeof shown_bits);
    memset(control, 0, sizeof control);
    for (unsigned i = 0; i < 128; i++)
        shown[i] = CIA402_SWITCH_ON_DISABLED;
    cycles_run = frames_sent = lost_starts = 0;
    refuses_starts = false;
    shown_inc = 0;
    follows_at_once = true;
    deaf_edges = held_cycles = slow_cycles = 0;
    memset(stands, 0, sizeof stands);
    memset(before, 0, sizeof before);
    config = (struct drives_config){
        .count = DRIVES,
        .cycle_us = 1000,
        .rates = {1000000, 0},
        .controller_node = 127,
        .heartbeat_ms = 100,
        .boot_timeout_cycles = 500,
        .start_timeout_cycles = START_CYCLES,
        .answer_timeout_cycles = 20,
        .sdo_timeout_cycles = 10,
        .brake_timeout_cycles = 100,
    };
    for (unsigned i = 0; i < DRIVES; i++)
        config.axis[i] = (struct drives_config_axis){.axis = (enum axis)(AXIS_X + (int)i),
                                                     .node = (uint8_t)(i + 1),
                                                     .increments_per_mm = 1000,
                                                     .following_error_max_mm = 0.5};
}

void tearDown(void)
{
}

static inline void set_rule(struct fake_rule rule)
{
    nodes.rule[nodes.rule_count++] = rule;
}

static inline void assert_text(const char *expected)
{
    char text[DIAGNOSTIC_TEXT_MAX];
    (void)takt_diagnostic_text(takt_drives_get_fault(&drives), text);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static inline void assert_told(uint8_t node, uint32_t object, uint32_t value)
{
    const struct fake_written *told = fake_nodes_told(&nodes, node, object);
    TEST_ASSERT_NOT_NULL(told);
    TEST_ASSERT_EQUAL_HEX32(value, told->value);
}

#endif
