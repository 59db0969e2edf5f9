/*
 * One virtual drive, frame by frame, without a bus.
 */
#include "canopen/emcy.h"
#include "canopen/little_endian.h"
#include "canopen/sync.h"
#include "canopen/target_pdo.h"
#include "drives/virtual_drive.h"
#include "unity.h"

#include <math.h>

#define NODE       5
#define CYCLE_NS   1000000u
#define FRAMES_MAX 64

static struct virtual_drive drive;
static struct can_frame sent[FRAMES_MAX];
static unsigned sent_count;

static bool port_send(void *context, const struct can_frame *frame)
{
    (void)context;
    if (sent_count == FRAMES_MAX)
        return false;
    sent[sent_count++] = *frame;
    return true;
}

static bool port_receive(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

static void init_drive(double following_error_window_mm)
{
    static const struct can_port port = {.send = port_send, .receive = port_receive};
    static const uint8_t nodes[] = {NODE};
    struct virtual_drive_config config = {.node = NODE, .increments_per_mm = 1000};
    struct pdo target;
    drive_plant_set_default(&config.plant);
    config.plant.start_mm = 2.5;
    config.plant.following_error_window_mm = following_error_window_mm;
    takt_target_pdo_set(&target, nodes, 1, 0, TARGET_PDO_PAIR);
    virtual_drive_init(&drive, &config, &target, &port);
    virtual_drive_boot(&drive);
}

void setUp(void)
{
    sent_count = 0;
    init_drive(2);
}

void tearDown(void)
{
}

static void take(unsigned id, unsigned length, uint32_t low, uint32_t high)
{
    struct can_frame frame = {.id = (uint16_t)id, .length = (uint8_t)length};
    little_endian_write32(frame.data, low);
    little_endian_write32(frame.data + 4, high);
    sent_count = 0;
    virtual_drive_on_frame(&drive, &frame);
}

static void nmt(enum nmt_command command, uint8_t node)
{
    take(0x000, 2, (uint32_t)command | (uint32_t)node << 8, 0);
}

static void control(uint16_t controlword)
{
    take(0x200 + NODE, 3, controlword | 8u << 16, 0);
}

static void target(int32_t target_inc)
{
    take(0x300 + NODE, 4, (uint32_t)target_inc, 0);
}

static void sync_and_step(void)
{
    take(SYNC_COB_ID, 0, 0, 0);
    virtual_drive_step(&drive, CYCLE_NS);
}

static void enable(void)
{
    nmt(NMT_START, NODE);
    control(CIA402_SHUTDOWN);
    control(CIA402_SWITCH_ON);
    control(CIA402_ENABLE_OPERATION);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&drive));
}

/* Runs at a constant velocity from where the drive stands. */
static void run(double velocity_mm_s, unsigned cycles)
{
    double from_mm = virtual_drive_get_position_mm(&drive);
    for (unsigned i = 1; i <= cycles; i++) {
        target((int32_t)lround(1000 * (from_mm + velocity_mm_s * 1e-3 * i)));
        sync_and_step();
    }
}

static const struct can_frame *find_sent(unsigned id)
{
    for (unsigned i = 0; i < sent_count; i++)
        if (sent[i].id == id)
            return &sent[i];
    return NULL;
}

static void test_a_drive_boots_into_preoperational_and_says_so(void)
{
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x705, sent[0].id);
    TEST_ASSERT_EQUAL_HEX8(0x00, sent[0].data[0]);
    TEST_ASSERT_EQUAL_INT(NMT_PREOPERATIONAL, virtual_drive_get_nmt_state(&drive));
}

static void test_before_it_is_started_pdos_and_sync_do_nothing(void)
{
    control(CIA402_SHUTDOWN);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&drive));
    take(SYNC_COB_ID, 0, 0, 0);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

static void test_nmt_commands_for_others_are_not_obeyed(void)
{
    nmt(NMT_START, NODE + 1);
    TEST_ASSERT_EQUAL_INT(NMT_PREOPERATIONAL, virtual_drive_get_nmt_state(&drive));
    nmt(NMT_START, NMT_ALL_NODES);
    TEST_ASSERT_EQUAL_INT(NMT_OPERATIONAL, virtual_drive_get_nmt_state(&drive));
}

static void test_sync_is_answered_by_statusword_and_position(void)
{
    nmt(NMT_START, NODE);
    take(SYNC_COB_ID, 0, 0, 0);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x185, sent[0].id);
    TEST_ASSERT_EQUAL_INT(6, sent[0].length);
    TEST_ASSERT_EQUAL_HEX16(0x0250, little_endian_read16(sent[0].data));
    TEST_ASSERT_EQUAL_INT(2500, little_endian_read32(sent[0].data + 2));
}

static void test_the_way_to_enabled_shows_in_the_statusword(void)
{
    static const uint16_t controlwords[] = {0x0006, 0x0007, 0x000F};
    static const uint16_t statuswords[] = {0x0231, 0x0233, 0x1237};
    nmt(NMT_START, NODE);
    for (unsigned i = 0; i < 3; i++) {
        control(controlwords[i]);
        take(SYNC_COB_ID, 0, 0, 0);
        TEST_ASSERT_EQUAL_HEX16(statuswords[i], little_endian_read16(sent[0].data));
    }
}

static void test_enabling_does_not_move_the_axis_even_without_a_target(void)
{
    enable();
    for (unsigned i = 0; i < 100; i++)
        sync_and_step();
    TEST_ASSERT_TRUE(fabs(virtual_drive_get_position_mm(&drive) - 2.5) < 1e-5);
}

static void test_a_target_waits_for_sync(void)
{
    uint32_t value;
    enable();
    target(2510);
    TEST_ASSERT_TRUE(virtual_drive_read_object(&drive, CIA402_TARGET_POSITION, &value));
    TEST_ASSERT_EQUAL_INT(2500, value);
    take(SYNC_COB_ID, 0, 0, 0);
    TEST_ASSERT_TRUE(virtual_drive_read_object(&drive, CIA402_TARGET_POSITION, &value));
    TEST_ASSERT_EQUAL_INT(2510, value);
}

static void test_in_another_mode_targets_are_not_followed(void)
{
    enable();
    take(0x200 + NODE, 3, 0x000F | 1u << 16, 0);
    target(2600);
    for (unsigned i = 0; i < 100; i++)
        sync_and_step();
    TEST_ASSERT_TRUE(fabs(virtual_drive_get_position_mm(&drive) - 2.5) < 1e-5);
    take(SYNC_COB_ID, 0, 0, 0);
    TEST_ASSERT_EQUAL_HEX16(0x0637, little_endian_read16(sent[0].data));
}

static void test_a_pdo_that_is_too_short_is_an_emergency_and_changes_nothing(void)
{
    struct emcy emcy;
    enable();
    take(0x300 + NODE, 3, 0, 0);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_TRUE(takt_emcy_read(&sent[0], &emcy));
    TEST_ASSERT_EQUAL_INT(NODE, emcy.node);
    TEST_ASSERT_EQUAL_HEX16(0x8210, emcy.code);
    sync_and_step();
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&drive));
    TEST_ASSERT_TRUE(fabs(virtual_drive_get_position_mm(&drive) - 2.5) < 1e-5);
}

/* A jump of the target beyond the window: emergency, fault reaction, standstill, fault. */
static void fail_by_following(void)
{
    struct emcy emcy;
    enable();
    target(7500);
    sync_and_step();
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT_REACTION, virtual_drive_get_state(&drive));
    const struct can_frame *frame = find_sent(0x080 + NODE);
    TEST_ASSERT_NOT_NULL(frame);
    TEST_ASSERT_TRUE(takt_emcy_read(frame, &emcy));
    TEST_ASSERT_EQUAL_HEX16(0x8611, emcy.code);
    for (unsigned i = 0; i < 5000; i++)
        sync_and_step();
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT, virtual_drive_get_state(&drive));
}

static void test_a_following_error_beyond_the_window_ends_in_fault(void)
{
    uint32_t value;
    fail_by_following();
    TEST_ASSERT_TRUE(virtual_drive_read_object(&drive, CIA402_ERROR_CODE, &value));
    TEST_ASSERT_EQUAL_HEX16(0x8611, value);
    take(SYNC_COB_ID, 0, 0, 0);
    TEST_ASSERT_EQUAL_HEX16(0x2218, little_endian_read16(sent[0].data));
}

static void test_a_window_of_0_is_not_watched(void)
{
    init_drive(0);
    enable();
    target(7500);
    sync_and_step();
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&drive));
}

static void test_fault_reset_tells_that_the_error_is_gone(void)
{
    struct emcy emcy;
    fail_by_following();
    control(CIA402_FAULT_RESET);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&drive));
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_TRUE(takt_emcy_read(&sent[0], &emcy));
    TEST_ASSERT_EQUAL_HEX16(0x0000, emcy.code);
    enable();
}

static void assert_brakes_to(enum cia402_state end)
{
    for (unsigned i = 0; i < 200; i++)
        virtual_drive_step(&drive, CYCLE_NS);
    TEST_ASSERT_EQUAL_INT(end, virtual_drive_get_state(&drive));
    double at_mm = virtual_drive_get_position_mm(&drive);
    for (unsigned i = 0; i < 100; i++)
        virtual_drive_step(&drive, CYCLE_NS);
    TEST_ASSERT_TRUE(fabs(virtual_drive_get_position_mm(&drive) - at_mm) < 0.01);
}

static void test_quick_stop_brakes_in_the_time_of_its_deceleration(void)
{
    enable();
    run(100, 200);
    double from_mm = virtual_drive_get_position_mm(&drive);
    control(CIA402_QUICK_STOP_NOW);
    TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, virtual_drive_get_state(&drive));
    assert_brakes_to(CIA402_SWITCH_ON_DISABLED);
    /* v^2 / 2a = 100^2 / 4000 = 2.5 mm */
    double way_mm = virtual_drive_get_position_mm(&drive) - from_mm;
    TEST_ASSERT_TRUE(fabs(way_mm - 2.5) < 0.05);
}

static void test_an_old_target_is_forgotten_when_the_drive_is_enabled_again(void)
{
    enable();
    run(100, 200);
    control(CIA402_DISABLE_VOLTAGE);
    for (unsigned i = 0; i < 10000; i++)
        sync_and_step();
    double stands_mm = virtual_drive_get_position_mm(&drive);
    enable();
    for (unsigned i = 0; i < 100; i++)
        sync_and_step();
    TEST_ASSERT_TRUE(fabs(virtual_drive_get_position_mm(&drive) - stands_mm) < 0.002);
}

static void test_a_lost_connection_stops_an_enabled_drive(void)
{
    static const enum nmt_command commands[] = {NMT_STOP, NMT_ENTER_PREOPERATIONAL,
                                                NMT_RESET_COMMUNICATION};
    for (unsigned i = 0; i < 3; i++) {
        setUp();
        enable();
        run(100, 200);
        nmt(commands[i], NODE);
        TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, virtual_drive_get_state(&drive));
        assert_brakes_to(CIA402_SWITCH_ON_DISABLED);
    }
}

static void test_reset_node_boots_again_with_everything_off(void)
{
    enable();
    run(100, 200);
    nmt(NMT_RESET_NODE, NMT_ALL_NODES);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x705, sent[0].id);
    TEST_ASSERT_EQUAL_INT(NMT_PREOPERATIONAL, virtual_drive_get_nmt_state(&drive));
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, virtual_drive_get_state(&drive));
    enable();
}

static void test_a_stopped_node_answers_no_sync(void)
{
    enable();
    nmt(NMT_STOP, NODE);
    take(SYNC_COB_ID, 0, 0, 0);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

static void test_the_event_status_comes_every_100_ms(void)
{
    unsigned count = 0;
    enable();
    for (unsigned i = 0; i < 1000; i++) {
        sync_and_step();
        const struct can_frame *frame = find_sent(0x280 + NODE);
        count += frame != NULL;
        TEST_ASSERT_TRUE(!frame || frame->length == 6);
    }
    TEST_ASSERT_EQUAL_UINT(10, count);
}

static void test_unknown_objects_are_refused(void)
{
    uint32_t value;
    TEST_ASSERT_FALSE(virtual_drive_read_object(&drive, PDO_MAPPED(0x2000, 0, 32), &value));
    TEST_ASSERT_FALSE(virtual_drive_write_object(&drive, CIA402_STATUSWORD, 0));
}

static uint32_t seed;

static uint32_t lcg(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

/* Any frames at all: no crash, no torque outside of operation, and a position that is a number. */
static void test_a_million_random_frames_leave_a_sane_drive(void)
{
    seed = 3;
    for (unsigned i = 0; i < 1000000; i++) {
        static const uint16_t ids[] = {0x000,        0x080,        0x200 + NODE, 0x300 + NODE,
                                       0x200 + NODE, 0x600 + NODE, 0x600 + NODE, 0x77F};
        uint32_t dice = lcg();
        unsigned id = dice % 12 < 8 ? ids[dice % 12] : dice >> 4 & 0x7FF;
        unsigned length = id == 0x600 + NODE ? 8 : lcg() % 9;
        uint32_t low = id == 0 ? (lcg() & 3) | NODE << 8 : lcg();
        take(id, length, low, lcg());
        virtual_drive_step(&drive, CYCLE_NS);
        TEST_ASSERT_TRUE(isfinite(virtual_drive_get_position_mm(&drive)));
        sent_count = 0;
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_drive_boots_into_preoperational_and_says_so);
    RUN_TEST(test_before_it_is_started_pdos_and_sync_do_nothing);
    RUN_TEST(test_nmt_commands_for_others_are_not_obeyed);
    RUN_TEST(test_sync_is_answered_by_statusword_and_position);
    RUN_TEST(test_the_way_to_enabled_shows_in_the_statusword);
    RUN_TEST(test_enabling_does_not_move_the_axis_even_without_a_target);
    RUN_TEST(test_a_target_waits_for_sync);
    RUN_TEST(test_in_another_mode_targets_are_not_followed);
    RUN_TEST(test_a_pdo_that_is_too_short_is_an_emergency_and_changes_nothing);
    RUN_TEST(test_a_following_error_beyond_the_window_ends_in_fault);
    RUN_TEST(test_a_window_of_0_is_not_watched);
    RUN_TEST(test_fault_reset_tells_that_the_error_is_gone);
    RUN_TEST(test_quick_stop_brakes_in_the_time_of_its_deceleration);
    RUN_TEST(test_an_old_target_is_forgotten_when_the_drive_is_enabled_again);
    RUN_TEST(test_a_lost_connection_stops_an_enabled_drive);
    RUN_TEST(test_reset_node_boots_again_with_everything_off);
    RUN_TEST(test_a_stopped_node_answers_no_sync);
    RUN_TEST(test_the_event_status_comes_every_100_ms);
    RUN_TEST(test_unknown_objects_are_refused);
    RUN_TEST(test_a_million_random_frames_leave_a_sane_drive);
    return UNITY_END();
}
