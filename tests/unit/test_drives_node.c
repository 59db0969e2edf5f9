/*
 * The drive as a node of CiA 301: heartbeats, errors, PDOs that are mapped anew, stored parameters.
 */
#define _POSIX_C_SOURCE 200809L /* fmemopen */

#include "lone_drive.h"

#include "canopen/emcy.h"
#include "drives/drive_store.h"

#include <stdio.h>

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
}

static unsigned count_sent(unsigned id)
{
    unsigned count = 0;
    for (unsigned i = 0; i < lone.sent_count; i++)
        count += lone.sent[i].id == id;
    return count;
}

/* ---- Heartbeats ---- */

static void test_a_heartbeat_is_produced_as_often_as_1017_says_and_shows_the_state(void)
{
    lone_step(&lone, 1000);
    TEST_ASSERT_EQUAL_UINT(0, count_sent(0x705));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1017, 0, 2, 100));
    lone_step(&lone, 1000);
    TEST_ASSERT_EQUAL_UINT(10, count_sent(0x705));
    TEST_ASSERT_EQUAL_HEX8(0x7F, lone_find(&lone, 0x705)->data[0]);
    lone_nmt(&lone, NMT_STOP);
    lone_step(&lone, 100);
    TEST_ASSERT_EQUAL_HEX8(0x04, lone_find(&lone, 0x705)->data[0]);
}

static void hear_heartbeat(unsigned node)
{
    lone_take(&lone, 0x700 + node, 1, NMT_OPERATIONAL, 0);
}

static void test_a_heartbeat_that_stays_out_stops_the_drive_and_tells_8130(void)
{
    struct emcy emcy;
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1016, 1, 4, 127u << 16 | 50));
    lone_enable(&lone, 8);
    lone_step(&lone, 200);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
    hear_heartbeat(127);
    lone_step(&lone, 49);
    TEST_ASSERT_NULL(lone_find(&lone, 0x085));
    lone_step(&lone, 1);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x085));
    TEST_ASSERT_TRUE(takt_emcy_read(lone_find(&lone, 0x085), &emcy));
    TEST_ASSERT_EQUAL_HEX16(0x8130, emcy.code);
    TEST_ASSERT_EQUAL_HEX8(0x11, emcy.error_register);
    TEST_ASSERT_EQUAL_INT(NMT_PREOPERATIONAL, virtual_drive_get_nmt_state(&lone.drive));
    TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, virtual_drive_get_state(&lone.drive));
    hear_heartbeat(127);
    TEST_ASSERT_TRUE(takt_emcy_read(lone_find(&lone, 0x085), &emcy));
    TEST_ASSERT_EQUAL_HEX16(0x0000, emcy.code);
}

static void test_1029_says_what_becomes_of_the_node(void)
{
    static const struct {
        uint32_t behaviour;
        enum nmt_state state;
    } rows[] = {{0, NMT_PREOPERATIONAL}, {1, NMT_OPERATIONAL}, {2, NMT_STOPPED}};
    for (unsigned i = 0; i < 3; i++) {
        setUp();
        (void)lone_write(&lone, 0x1016, 1, 4, 127u << 16 | 50);
        TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1029, 1, 1, rows[i].behaviour));
        lone_enable(&lone, 8);
        hear_heartbeat(127);
        lone_step(&lone, 51);
        TEST_ASSERT_EQUAL_INT(rows[i].state, virtual_drive_get_nmt_state(&lone.drive));
    }
}

static void test_a_sync_that_stays_out_is_8700(void)
{
    struct emcy emcy;
    (void)lone_write(&lone, 0x1006, 0, 4, 1000);
    lone_enable(&lone, 8);
    for (unsigned i = 0; i < 100; i++) {
        lone_sync(&lone);
        lone_step(&lone, 1);
    }
    TEST_ASSERT_NULL(lone_find(&lone, 0x085));
    lone_step(&lone, 2);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x085));
    TEST_ASSERT_TRUE(takt_emcy_read(lone_find(&lone, 0x085), &emcy));
    TEST_ASSERT_EQUAL_HEX16(0x8700, emcy.code);
    TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, virtual_drive_get_state(&lone.drive));
}

static void test_6007_says_what_a_lost_connection_does_to_the_motor(void)
{
    static const enum cia402_state states[] = {CIA402_ENABLED, CIA402_FAULT_REACTION,
                                               CIA402_SWITCH_ON_DISABLED, CIA402_QUICK_STOP};
    for (uint32_t option = 0; option < 4; option++) {
        setUp();
        TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6007, 0, 2, option));
        lone_enable(&lone, 8);
        lone_nmt(&lone, NMT_ENTER_PREOPERATIONAL);
        TEST_ASSERT_EQUAL_INT(states[option], virtual_drive_get_state(&lone.drive));
    }
}

/* ---- Errors ---- */

static void provoke_8210(void)
{
    lone_take(&lone, 0x300 + LONE_NODE, 2, 0, 0);
}

static void test_errors_are_remembered_the_newest_first(void)
{
    bool aborted;
    lone_nmt(&lone, NMT_START);
    TEST_ASSERT_EQUAL_UINT32(0, lone_read(&lone, 0x1003, 0));
    TEST_ASSERT_EQUAL_HEX32(0x08000024, lone_try_read(&lone, 0x1003, 1, &aborted));
    provoke_8210();
    virtual_drive_write_object(&lone.drive, CIA402_MODE, 8);
    lone_enable(&lone, 8);
    lone_take(&lone, 0x300 + LONE_NODE, 4, 5000, 0);
    lone_sync(&lone);
    lone_step(&lone, 2);
    TEST_ASSERT_EQUAL_UINT32(2, lone_read(&lone, 0x1003, 0));
    TEST_ASSERT_EQUAL_HEX32(0x8611, lone_read(&lone, 0x1003, 1));
    TEST_ASSERT_EQUAL_HEX32(0x8210, lone_read(&lone, 0x1003, 2));
    TEST_ASSERT_EQUAL_HEX32(0x21, lone_read(&lone, 0x1001, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06090031, lone_write(&lone, 0x1003, 0, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1003, 0, 1, 0));
    TEST_ASSERT_EQUAL_UINT32(0, lone_read(&lone, 0x1003, 0));
}

static void test_emergencies_keep_their_inhibit_time_and_none_is_lost(void)
{
    (void)lone_write(&lone, 0x1015, 0, 2, 100); /* 10 ms */
    lone_nmt(&lone, NMT_START);
    provoke_8210();
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x085));
    provoke_8210();
    TEST_ASSERT_EQUAL_UINT(0, count_sent(0x085));
    provoke_8210();
    lone_step(&lone, 9);
    TEST_ASSERT_EQUAL_UINT(0, count_sent(0x085));
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x085));
    lone_step(&lone, 100);
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x085));
}

static void test_emergencies_have_the_identifier_of_1014_or_none(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1014, 0, 4, 0x123));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1014, 0, 4, 0x80000085));
    lone_nmt(&lone, NMT_START);
    provoke_8210();
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1014, 0, 4, 0x123));
    provoke_8210();
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x123));
}

/* ---- Process data ---- */

static void map(unsigned parameters, uint32_t cob_id, uint32_t type, const uint32_t *entries,
                unsigned count)
{
    uint16_t index = (uint16_t)parameters, mapping = (uint16_t)(parameters + 0x200);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, index, 1, 4, cob_id | 0x80000000));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, index, 2, 1, type));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, mapping, 0, 1, 0));
    for (unsigned i = 0; i < count; i++)
        TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, mapping, (uint8_t)(i + 1), 4, entries[i]));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, mapping, 0, 1, count));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, index, 1, 4, cob_id));
}

static void test_a_tpdo_is_mapped_anew_while_the_node_is_operational(void)
{
    static const uint32_t entries[] = {0x60610008, 0x60640020, 0x60410010, 0x10010008};
    lone_enable(&lone, 8);
    map(0x1802, 0x285, 1, entries, 4);
    lone_sync(&lone);
    const struct can_frame *frame = lone_find(&lone, 0x285);
    TEST_ASSERT_NOT_NULL(frame);
    TEST_ASSERT_EQUAL_UINT8(8, frame->length);
    TEST_ASSERT_EQUAL_UINT8(8, frame->data[0]);
    TEST_ASSERT_EQUAL_HEX16(0x1237, little_endian_read16(frame->data + 5));
    TEST_ASSERT_EQUAL_UINT8(0, frame->data[7]);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x185));
}

static void test_two_drives_share_a_frame_by_dummies(void)
{
    static const uint32_t entries[] = {0x00070020, 0x607A0020};
    lone_enable(&lone, 8);
    map(0x1401, 0x304, 1, entries, 2);
    lone_take(&lone, 0x304, 8, 111, 222);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_INT(222, lone_read(&lone, 0x607A, 0));
}

static void test_mapping_another_pdo_does_not_lose_a_target_that_waits(void)
{
    static const uint32_t entries[] = {0x60410010};
    lone_enable(&lone, 8);
    lone_take(&lone, 0x300 + LONE_NODE, 4, 7, 0);
    map(0x1803, 0x385, 1, entries, 1);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_INT(7, lone_read(&lone, 0x607A, 0));
}

static void test_the_rules_of_remapping_are_kept(void)
{
    /* A valid PDO keeps its mapping, its identifier, its inhibit time and its start value. */
    TEST_ASSERT_EQUAL_HEX32(0x06010000, lone_write(&lone, 0x1A00, 0, 1, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06010000, lone_write(&lone, 0x1A00, 1, 4, 0x60410010));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1800, 1, 4, 0x186));
    TEST_ASSERT_EQUAL_HEX32(0x08000022, lone_write(&lone, 0x1800, 3, 2, 10));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1800, 2, 1, 2));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1800, 2, 1, 241));
    /* Identifiers of others are refused. */
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1800, 1, 4, 0x80000185));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1800, 1, 4, 0x000));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1800, 1, 4, 0x585));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1800, 1, 4, 0x20000185));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1800, 1, 4, 0x701));
    /* Entries change only while none is in use, and must exist and fit. */
    TEST_ASSERT_EQUAL_HEX32(0x06010000, lone_write(&lone, 0x1A00, 1, 4, 0x60410010));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1A00, 0, 1, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06020000, lone_write(&lone, 0x1A00, 1, 4, 0x50000010));
    TEST_ASSERT_EQUAL_HEX32(0x06090011, lone_write(&lone, 0x1A00, 1, 4, 0x60410110));
    TEST_ASSERT_EQUAL_HEX32(0x06040041, lone_write(&lone, 0x1A00, 1, 4, 0x60410020));
    TEST_ASSERT_EQUAL_HEX32(0x06040041, lone_write(&lone, 0x1A00, 1, 4, 0x10000020));
    TEST_ASSERT_EQUAL_HEX32(0x06040041, lone_write(&lone, 0x1A00, 1, 4, 0x00070020));
    TEST_ASSERT_EQUAL_HEX32(0x06040041, lone_write(&lone, 0x1A00, 1, 4, 0x60400010));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1A00, 1, 4, 0x60640020));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1A00, 2, 4, 0x60640020));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1A00, 3, 4, 0x60410010));
    TEST_ASSERT_EQUAL_HEX32(0x06040042, lone_write(&lone, 0x1A00, 0, 1, 3));
    TEST_ASSERT_EQUAL_HEX32(0x06040041, lone_write(&lone, 0x1A00, 0, 1, 4));
    TEST_ASSERT_EQUAL_HEX32(0x06090031, lone_write(&lone, 0x1A00, 0, 1, 9));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1A00, 0, 1, 2));
}

static void test_a_synchronous_tpdo_comes_at_every_nth_sync(void)
{
    unsigned count = 0;
    (void)lone_write(&lone, 0x1800, 2, 1, 3);
    lone_nmt(&lone, NMT_START);
    for (unsigned i = 0; i < 12; i++) {
        lone_sync(&lone);
        count += count_sent(0x185);
    }
    TEST_ASSERT_EQUAL_UINT(4, count);
}

static void test_a_tpdo_begins_at_its_sync_counter(void)
{
    (void)lone_write(&lone, 0x1019, 0, 1, 10);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1800, 1, 4, 0x80000185));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1800, 6, 1, 4));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1800, 1, 4, 0x185));
    lone_nmt(&lone, NMT_START);
    for (uint32_t counter = 1; counter <= 6; counter++) {
        lone_take(&lone, SYNC_COB_ID, 1, counter, 0);
        TEST_ASSERT_EQUAL_UINT(counter >= 4, count_sent(0x185));
    }
}

/* TPDO3: statusword and mode, by event, at most every 20 ms. */
static void test_an_event_sends_a_tpdo_but_not_within_its_inhibit_time(void)
{
    (void)lone_write(&lone, 0x1802, 3, 2, 200);
    (void)lone_write(&lone, 0x1802, 1, 4, 0x385);
    lone_nmt(&lone, NMT_START);
    lone_step(&lone, 50);
    lone_control(&lone, CIA402_SHUTDOWN, 8);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x385));
    lone_control(&lone, CIA402_SWITCH_ON, 8);
    lone_step(&lone, 19);
    TEST_ASSERT_EQUAL_UINT(0, count_sent(0x385));
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x385));
    TEST_ASSERT_EQUAL_HEX16(0x0233, little_endian_read16(lone_find(&lone, 0x385)->data));
    lone_step(&lone, 200);
    TEST_ASSERT_EQUAL_UINT(0, count_sent(0x385));
}

static void test_type_0_answers_the_sync_after_a_change(void)
{
    (void)lone_write(&lone, 0x1802, 2, 1, 0);
    (void)lone_write(&lone, 0x1802, 1, 4, 0x385);
    lone_nmt(&lone, NMT_START);
    lone_step(&lone, 1);
    lone_sync(&lone);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, count_sent(0x385));
    lone_control(&lone, CIA402_SHUTDOWN, 8);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(0, count_sent(0x385));
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x385));
}

static void test_sync_may_have_another_identifier(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1005, 0, 4, 0x40000080));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1005, 0, 4, 0x222));
    lone_nmt(&lone, NMT_START);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_take(&lone, 0x222, 0, 0, 0);
    TEST_ASSERT_EQUAL_UINT(1, count_sent(0x185));
}

/* ---- Clocks ---- */

/* RPDO2, the target, is taken within 300 us of a SYNC; the frames come so much behind it. */
static void test_targets_behind_the_window_of_1007_are_none(void)
{
    static const uint32_t behind_us[] = {299, 301, 300};
    static const int32_t expected_inc[] = {1, 1, 3};
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1007, 0, 4, 300));
    lone_enable(&lone, 8);
    for (unsigned i = 0; i < 3; i++) {
        const struct can_frame sync = {.id = 0x080};
        const struct can_frame target = {.id = 0x305, .length = 4, .data = {(uint8_t)(i + 1)}};
        uint64_t sync_ns = 1000000000u + i * LONE_CYCLE_NS;
        lone.sent_count = 0;
        virtual_drive_on_frame_at(&lone.drive, &sync, sync_ns);
        virtual_drive_on_frame_at(&lone.drive, &target, sync_ns + behind_us[i] * UINT64_C(1000));
        virtual_drive_on_frame_at(&lone.drive, &sync, sync_ns + 999999);
        TEST_ASSERT_EQUAL_INT(expected_inc[i], (int32_t)lone_read(&lone, 0x607A, 0));
    }
}

static void test_the_time_of_day_is_taken_where_1012_says_so_and_goes_on(void)
{
    struct can_frame frame;
    const struct time_stamp time = {.ms = TIME_MS_PER_DAY - 1, .days = 15000};
    takt_time_stamp_write(&frame, &time);
    virtual_drive_on_frame(&lone.drive, &frame);
    TEST_ASSERT_EQUAL_UINT32(0, lone_read(&lone, 0x2002, 2));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1012, 0, 4, 0x80000000 | 0x100));
    virtual_drive_on_frame(&lone.drive, &frame);
    TEST_ASSERT_EQUAL_UINT32(15000, lone_read(&lone, 0x2002, 2));
    TEST_ASSERT_EQUAL_UINT32(TIME_MS_PER_DAY - 1, lone_read(&lone, 0x2002, 1));
    lone_step(&lone, 6);
    TEST_ASSERT_EQUAL_UINT32(15001, lone_read(&lone, 0x2002, 2));
    TEST_ASSERT_EQUAL_UINT32(5, lone_read(&lone, 0x2002, 1));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1012, 0, 4, 0x80000000 | 0x101));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1012, 0, 4, 0x40000100));
}

static void test_the_high_resolution_time_counts_on_from_what_is_written(void)
{
    lone_step(&lone, 3);
    TEST_ASSERT_EQUAL_UINT32(3000, lone_read(&lone, 0x1013, 0));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1013, 0, 4, 0xFFFFFFFF));
    lone_step(&lone, 2);
    TEST_ASSERT_EQUAL_UINT32(1999, lone_read(&lone, 0x1013, 0));
}

/* ---- Stored parameters ---- */

static void test_a_reset_forgets_what_was_not_stored(void)
{
    (void)lone_write(&lone, 0x6081, 0, 4, 1234);
    (void)lone_write(&lone, 0x1017, 0, 2, 500);
    lone_nmt(&lone, NMT_RESET_COMMUNICATION);
    TEST_ASSERT_EQUAL_UINT32(0, lone_read(&lone, 0x1017, 0));
    TEST_ASSERT_EQUAL_UINT32(1234, lone_read(&lone, 0x6081, 0));
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_EQUAL_UINT32(50000, lone_read(&lone, 0x6081, 0));
}

static void test_stored_parameters_survive_a_reset_until_defaults_are_restored(void)
{
    (void)lone_write(&lone, 0x6081, 0, 4, 1234);
    TEST_ASSERT_EQUAL_HEX32(0x08000020, lone_write(&lone, 0x1010, 1, 4, 1));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1010, 1, 4, 0x65766173));
    TEST_ASSERT_EQUAL_UINT32(1, lone_read(&lone, 0x1010, 1));
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_EQUAL_UINT32(1234, lone_read(&lone, 0x6081, 0));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1011, 1, 4, 0x64616F6C));
    TEST_ASSERT_EQUAL_UINT32(1234, lone_read(&lone, 0x6081, 0));
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_EQUAL_UINT32(50000, lone_read(&lone, 0x6081, 0));
}

static unsigned kept;
static bool keeps;
static char kept_text[4096];

static bool keep(void *context, const struct servo *drive)
{
    FILE *stream = fmemopen(context, sizeof kept_text, "w");
    TEST_ASSERT_NOT_NULL(stream);
    drive_store_write(stream, drive);
    (void)fclose(stream);
    kept++;
    return keeps;
}

static void keep_stored(bool succeeds)
{
    keeps = succeeds;
    kept = 0;
    takt_servo_keep(&lone.drive.servo, &(struct drive_keeper){keep, kept_text});
}

static void test_what_is_stored_is_kept_and_is_there_at_the_next_power_on(void)
{
    struct drive_store_problem wrong;
    keep_stored(true);
    (void)lone_write(&lone, 0x1017, 0, 2, 100);
    (void)lone_write(&lone, 0x6081, 0, 4, 1234);
    (void)lone_write(&lone, 0x607D, 1, 4, (uint32_t)-5);
    (void)lone_write(&lone, 0x2000, 0, 2, 0x5A58); /* XZ */
    (void)lone_write(&lone, 0x1800, 1, 4, 0xC0000185);
    (void)lone_write(&lone, 0x607A, 0, 4, 77);
    TEST_ASSERT_EQUAL_UINT(0, kept);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1010, 1, 4, 0x65766173));
    TEST_ASSERT_EQUAL_UINT(1, kept);
    TEST_ASSERT_EQUAL_STRING("# stored by node 5, object 1010\n1017:00 0064\n"
                             "1800:01 C0000185\n2000:00 \"585A\"\n607D:01 FFFFFFFB\n"
                             "6081:00 000004D2\n",
                             kept_text);
    lone_start(&lone);
    TEST_ASSERT_EQUAL_UINT32(0, lone_read(&lone, 0x1017, 0));
    const struct can_port port = {.send = lone_send, .receive = lone_receive, .context = &lone};
    virtual_drive_init(&lone.drive, &lone.config, NULL, &port);
    TEST_ASSERT_TRUE(drive_store_read(&lone.drive.servo, kept_text, strlen(kept_text), &wrong));
    virtual_drive_boot(&lone.drive);
    TEST_ASSERT_EQUAL_UINT32(100, lone_read(&lone, 0x1017, 0));
    TEST_ASSERT_EQUAL_UINT32(1234, lone_read(&lone, 0x6081, 0));
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFB, lone_read(&lone, 0x607D, 1));
    TEST_ASSERT_EQUAL_HEX32(0xC0000185, lone_read(&lone, 0x1800, 1));
    lone_nmt(&lone, NMT_START);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count); /* TPDO1 is not valid */
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_EQUAL_UINT32(1234, lone_read(&lone, 0x6081, 0));
}

static void test_values_that_could_not_be_kept_are_not_stored(void)
{
    keep_stored(false);
    (void)lone_write(&lone, 0x6081, 0, 4, 1234);
    TEST_ASSERT_EQUAL_HEX32(0x06060000, lone_write(&lone, 0x1010, 1, 4, 0x65766173));
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_EQUAL_UINT32(50000, lone_read(&lone, 0x6081, 0));
}

static void test_restored_defaults_are_kept_too(void)
{
    keep_stored(true);
    (void)lone_write(&lone, 0x6081, 0, 4, 1234);
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1010, 1, 4, 0x65766173));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1011, 1, 4, 0x64616F6C));
    TEST_ASSERT_EQUAL_STRING("# stored by node 5, object 1010\n", kept_text);
}

static void test_a_store_that_is_none_of_this_drive_is_refused_by_its_line(void)
{
    static const char *const lines[] = {
        "nonsense",   "1017",          "1017:00",          "1017:00 12345", "1017:00 12x",
        "5000:00 00", "6041:00 0000",  "607A:00 00000000", "6007:00 0004",  "1600:00 09",
        "2000:00 00", "2000:00 \"5\"", "2000:00 \"5G\""};
    struct drive_store_problem wrong;
    char text[80];
    for (unsigned i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        (void)snprintf(text, sizeof text, "# a comment\n\n%s\n", lines[i]);
        TEST_ASSERT_FALSE_MESSAGE(drive_store_read(&lone.drive.servo, text, strlen(text), &wrong),
                                  lines[i]);
        TEST_ASSERT_EQUAL_UINT(3, wrong.line);
        TEST_ASSERT_TRUE(wrong.text[0] != '\0');
    }
}

/* ---- The dictionary ---- */

static void test_reads_and_writes_that_cannot_be_say_why(void)
{
    bool aborted;
    TEST_ASSERT_EQUAL_HEX32(0x06020000, lone_try_read(&lone, 0x5000, 0, &aborted));
    TEST_ASSERT_EQUAL_HEX32(0x06090011, lone_try_read(&lone, 0x6099, 3, &aborted));
    TEST_ASSERT_EQUAL_HEX32(0x06010001, lone_try_read(&lone, 0x60C4, 6, &aborted));
    TEST_ASSERT_EQUAL_HEX32(0x06010002, lone_write(&lone, 0x6041, 0, 2, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06010002, lone_write(&lone, 0x1000, 0, 4, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06070012, lone_write(&lone, 0x6040, 0, 4, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06070013, lone_write(&lone, 0x607A, 0, 2, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06090031, lone_write(&lone, 0x605C, 0, 2, 2));
    TEST_ASSERT_EQUAL_HEX32(0x06090032, lone_write(&lone, 0x6099, 1, 4, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x6060, 0, 1, 2));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x6098, 0, 1, 15));
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x605A, 0, 2, 3));
    (void)lone_write(&lone, 0x1006, 0, 4, 1000);
    TEST_ASSERT_EQUAL_HEX32(0x08000022, lone_write(&lone, 0x1019, 0, 1, 10));
    TEST_ASSERT_EQUAL_HEX32(0x08000024, lone_try_read(&lone, 0x1021, 0, &aborted));
}

static void test_a_stopped_node_answers_no_request(void)
{
    lone_nmt(&lone, NMT_STOP);
    lone_take(&lone, 0x605, 8, 0x00100040, 0);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
}

/* 10 mm a turn: 10,000 increments; 5000 make the increment twice as long. */
static void test_the_feed_constant_says_how_long_an_increment_is(void)
{
    lone.config.plant.start_mm = 4;
    lone_start(&lone);
    TEST_ASSERT_EQUAL_UINT32(10000, lone_read(&lone, 0x6092, 1));
    TEST_ASSERT_EQUAL_INT(4000, lone_actual(&lone));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6092, 1, 4, 5000));
    TEST_ASSERT_EQUAL_INT(2000, lone_actual(&lone));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6091, 2, 4, 3));
    TEST_ASSERT_EQUAL_INT(6000, lone_actual(&lone));
    lone_enable(&lone, 8);
    TEST_ASSERT_EQUAL_HEX32(0x08000022, lone_write(&lone, 0x6092, 1, 4, 10000));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_heartbeat_is_produced_as_often_as_1017_says_and_shows_the_state);
    RUN_TEST(test_a_heartbeat_that_stays_out_stops_the_drive_and_tells_8130);
    RUN_TEST(test_1029_says_what_becomes_of_the_node);
    RUN_TEST(test_a_sync_that_stays_out_is_8700);
    RUN_TEST(test_6007_says_what_a_lost_connection_does_to_the_motor);
    RUN_TEST(test_errors_are_remembered_the_newest_first);
    RUN_TEST(test_emergencies_keep_their_inhibit_time_and_none_is_lost);
    RUN_TEST(test_emergencies_have_the_identifier_of_1014_or_none);
    RUN_TEST(test_a_tpdo_is_mapped_anew_while_the_node_is_operational);
    RUN_TEST(test_two_drives_share_a_frame_by_dummies);
    RUN_TEST(test_mapping_another_pdo_does_not_lose_a_target_that_waits);
    RUN_TEST(test_the_rules_of_remapping_are_kept);
    RUN_TEST(test_a_synchronous_tpdo_comes_at_every_nth_sync);
    RUN_TEST(test_a_tpdo_begins_at_its_sync_counter);
    RUN_TEST(test_an_event_sends_a_tpdo_but_not_within_its_inhibit_time);
    RUN_TEST(test_type_0_answers_the_sync_after_a_change);
    RUN_TEST(test_sync_may_have_another_identifier);
    RUN_TEST(test_targets_behind_the_window_of_1007_are_none);
    RUN_TEST(test_the_time_of_day_is_taken_where_1012_says_so_and_goes_on);
    RUN_TEST(test_the_high_resolution_time_counts_on_from_what_is_written);
    RUN_TEST(test_a_reset_forgets_what_was_not_stored);
    RUN_TEST(test_stored_parameters_survive_a_reset_until_defaults_are_restored);
    RUN_TEST(test_what_is_stored_is_kept_and_is_there_at_the_next_power_on);
    RUN_TEST(test_values_that_could_not_be_kept_are_not_stored);
    RUN_TEST(test_restored_defaults_are_kept_too);
    RUN_TEST(test_a_store_that_is_none_of_this_drive_is_refused_by_its_line);
    RUN_TEST(test_reads_and_writes_that_cannot_be_say_why);
    RUN_TEST(test_a_stopped_node_answers_no_request);
    RUN_TEST(test_the_feed_constant_says_how_long_an_increment_is);
    return UNITY_END();
}
