/*
 * Whatever comes over the bus, the master keeps its promises: it ends in no state it cannot leave
 * but "faulted", sends no setpoint once drives brake, and tells the first fault. Nodes that answer
 * properly are mixed with random frames.
 */
#include "canopen/cia402.h"
#include "drive/drives.h"
#include "fake_nodes.h"
#include "unity.h"

#include <stdio.h>

#define RUNS   300
#define CYCLES 800
#define DRIVES 3

static struct fake_nodes nodes;
static struct drives drives;
static uint64_t random_state;
static bool is_braking, has_sent_target;
static uint16_t control[128];
static enum cia402_state shown[128];
static unsigned beats;
static char message[128];

/* Knuth's linear congruential generator; the upper bits. */
static uint32_t draw(uint32_t below)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((random_state >> 33) % below);
}

static bool port_send(void *context, const struct can_frame *frame)
{
    (void)context;
    TEST_ASSERT_TRUE_MESSAGE(frame->length <= 8, message);
    if ((frame->id & 0x780) == 0x300)
        has_sent_target = true;
    if ((frame->id & 0x780) == 0x200)
        control[frame->id & 0x7F] = little_endian_read16(frame->data);
    fake_nodes_take(&nodes, frame);
    return draw(200) != 0;
}

static bool port_receive(void *context, struct can_frame *frame)
{
    (void)context;
    return fake_nodes_receive(&nodes, frame);
}

static const struct can_port port = {.send = port_send, .receive = port_receive};

/* Mostly of our nodes and of the kinds the master looks at. */
static void put_random_frame(void)
{
    static const uint16_t functions[] = {0x080, 0x180, 0x280, 0x580, 0x580, 0x700};
    struct can_frame *frame = fake_nodes_add(&nodes);
    frame->id = (uint16_t)(draw(8) ? functions[draw(6)] + draw(5) : draw(0x800));
    frame->length = (uint8_t)(draw(4) ? 8 : draw(9));
    for (unsigned i = 0; i < 8; i++)
        frame->data[i] = (uint8_t)(draw(3) ? draw(256) : 0);
}

static void put_statuses(void)
{
    for (unsigned node = 1; node <= DRIVES; node++) {
        struct can_frame *frame;
        if (nodes.starts[node] == 0)
            continue;
        shown[node] = takt_cia402_next_state(shown[node], control[node], 0);
        frame = fake_nodes_add(&nodes);
        *frame = (struct can_frame){.id = (uint16_t)(0x180 + node), .length = 6};
        little_endian_write16(frame->data, (uint16_t)(takt_cia402_statusword(shown[node]) |
                                                      (nodes.mode[node] == 8 ? 0x1000 : 0) |
                                                      (control[node] & 0x10 ? 0x1400 : 0)));
        if (++beats % 50 == 0)
            takt_nmt_write_heartbeat(fake_nodes_add(&nodes), (uint8_t)node, NMT_OPERATIONAL);
    }
}

static void init(uint64_t seed)
{
    struct drives_config config = {
        .count = DRIVES,
        .cycle_us = 1000,
        .rates = {1000000, 0},
        .controller_node = 127,
        .heartbeat_ms = 100,
        .boot_timeout_cycles = 100,
        .start_timeout_cycles = 400,
        .answer_timeout_cycles = 20,
        .sdo_timeout_cycles = 10,
        .stop_timeout_cycles = seed % 2 ? 20 : 0,
        .brake_timeout_cycles = 50,
    };
    for (unsigned i = 0; i < DRIVES; i++)
        config.axis[i] = (struct drives_config_axis){
            .axis = (enum axis)i, .node = (uint8_t)(i + 1), .increments_per_mm = 1e5};
    config.axis[0].homing = (struct drives_homing){.order = 1, .method = 37, .timeout_cycles = 200};
    memset(&nodes, 0, sizeof nodes);
    memset(control, 0, sizeof control);
    for (unsigned i = 0; i < 128; i++)
        shown[i] = CIA402_SWITCH_ON_DISABLED;
    takt_drives_init(&drives, &config);
    random_state = seed;
    beats = 0;
    (void)snprintf(message, sizeof message, "seed %u", (unsigned)seed);
}

/* One cycle, and what must hold of it. */
static void cycle(unsigned one_in)
{
    static const struct point setpoint;
    enum drives_state before = drives_get_state(&drives);
    struct diagnostic fault = *takt_drives_get_fault(&drives);
    put_statuses();
    while (draw(one_in) == 0)
        put_random_frame();
    has_sent_target = false;
    takt_drives_receive(&drives, &port);
    is_braking = drives_get_state(&drives) >= DRIVES_BRAKING;
    takt_drives_sync(&drives, &port);
    takt_drives_send(&drives, &port, &setpoint);
    TEST_ASSERT_TRUE_MESSAGE(drives_get_state(&drives) >= before, message);
    TEST_ASSERT_FALSE_MESSAGE(is_braking && has_sent_target, message);
    if (before > DRIVES_ENABLED) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(fault.code, takt_drives_get_fault(&drives)->code, message);
    }
    if (drives_get_state(&drives) > DRIVES_ENABLED) {
        TEST_ASSERT_NOT_EQUAL_MESSAGE(TAKT_OK, takt_drives_get_fault(&drives)->code, message);
    }
}

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_random_frames_lead_to_operation_or_to_a_fault_and_never_back(void)
{
    unsigned enabled = 0, faulted = 0;
    for (unsigned seed = 1; seed <= RUNS; seed++) {
        bool was_enabled = false;
        init(seed);
        for (unsigned k = 0; k < CYCLES; k++) {
            cycle(2 + seed * 4);
            was_enabled = was_enabled || drives_get_state(&drives) == DRIVES_ENABLED;
        }
        TEST_ASSERT_NOT_EQUAL_MESSAGE(DRIVES_STARTING, drives_get_state(&drives), message);
        enabled += was_enabled;
        faulted += drives_get_state(&drives) == DRIVES_FAULTED;
    }
    /* Both ends are reached, or the test would show little. */
    TEST_ASSERT_TRUE(enabled > 0 && enabled < RUNS);
    TEST_ASSERT_TRUE(faulted > RUNS / 10);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_frames_lead_to_operation_or_to_a_fault_and_never_back);
    return UNITY_END();
}
