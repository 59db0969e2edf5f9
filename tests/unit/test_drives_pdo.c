/* PDOs of the drive: mapped anew, and when they are sent and taken; SYNC and the time of day. */
#include "canopen/emcy.h"
#include "lone_drive.h"

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
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
        count += lone_count_sent(&lone, 0x185);
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
        TEST_ASSERT_EQUAL_UINT(counter >= 4, lone_count_sent(&lone, 0x185));
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
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x385));
    lone_control(&lone, CIA402_SWITCH_ON, 8);
    lone_step(&lone, 19);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x385));
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x385));
    TEST_ASSERT_EQUAL_HEX16(0x0233, little_endian_read16(lone_find(&lone, 0x385)->data));
    lone_step(&lone, 200);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x385));
}

static void test_type_0_answers_the_sync_after_a_change(void)
{
    (void)lone_write(&lone, 0x1802, 2, 1, 0);
    (void)lone_write(&lone, 0x1802, 1, 4, 0x385);
    lone_nmt(&lone, NMT_START);
    lone_step(&lone, 1);
    lone_sync(&lone);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x385));
    lone_control(&lone, CIA402_SHUTDOWN, 8);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x385));
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x385));
}

/* ---- Remote frames ---- */

static unsigned ask_for(unsigned id)
{
    lone_take(&lone, CAN_REMOTE | id, 0, 0, 0);
    return lone_count_sent(&lone, id);
}

static void set_tpdo(unsigned index, uint32_t cob_id, uint32_t type)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, (uint16_t)index, 1, 4, cob_id | 0x80000000));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, (uint16_t)index, 2, 1, type));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, (uint16_t)index, 1, 4, cob_id));
}

static void test_a_remote_frame_is_answered_by_the_tpdo_it_asks_for(void)
{
    set_tpdo(0x1800, 0x185, 1);
    lone_nmt(&lone, NMT_START);
    TEST_ASSERT_EQUAL_UINT(1, ask_for(0x185));
    const struct can_frame *frame = lone_find(&lone, 0x185);
    TEST_ASSERT_EQUAL_UINT8(6, frame->length);
    TEST_ASSERT_EQUAL_HEX16(0x0250, little_endian_read16(frame->data));
    TEST_ASSERT_EQUAL_UINT(0, ask_for(0x186));
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x185));
}

static void test_no_remote_frame_is_answered_where_bit_30_or_the_state_forbids_it(void)
{
    lone_nmt(&lone, NMT_START);
    TEST_ASSERT_EQUAL_UINT(0, ask_for(0x185)); /* as it is at power-on */
    set_tpdo(0x1800, 0x40000185, 1);
    TEST_ASSERT_EQUAL_UINT(0, ask_for(0x185));
    set_tpdo(0x1800, 0x185, 1);
    TEST_ASSERT_EQUAL_UINT(1, ask_for(0x185));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1800, 1, 4, 0x80000185));
    TEST_ASSERT_EQUAL_UINT(0, ask_for(0x185)); /* not valid */
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1800, 1, 4, 0x185));
    lone_nmt(&lone, NMT_ENTER_PREOPERATIONAL);
    TEST_ASSERT_EQUAL_UINT(0, ask_for(0x185));
}

static void test_a_remote_frame_within_the_inhibit_time_is_answered_after_it(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1802, 3, 2, 200));
    set_tpdo(0x1802, 0x385, 255);
    lone_nmt(&lone, NMT_START);
    lone_step(&lone, 50);
    TEST_ASSERT_EQUAL_UINT(1, ask_for(0x385));
    TEST_ASSERT_EQUAL_UINT(0, ask_for(0x385));
    lone_step(&lone, 19);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x385));
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x385));
    lone_step(&lone, 100);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x385));
}

static void test_a_remote_frame_does_not_take_the_event_from_the_next_sync(void)
{
    set_tpdo(0x1802, 0x385, 0);
    lone_nmt(&lone, NMT_START);
    lone_step(&lone, 1);
    lone_sync(&lone);
    lone_control(&lone, CIA402_SHUTDOWN, 8);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(1, ask_for(0x385));
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x385));
}

/* ---- SYNC ---- */

static void test_sync_may_have_another_identifier(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1005, 0, 4, 0x40000080));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1005, 0, 4, 0x222));
    lone_nmt(&lone, NMT_START);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_take(&lone, 0x222, 0, 0, 0);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x185));
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tpdo_is_mapped_anew_while_the_node_is_operational);
    RUN_TEST(test_two_drives_share_a_frame_by_dummies);
    RUN_TEST(test_mapping_another_pdo_does_not_lose_a_target_that_waits);
    RUN_TEST(test_the_rules_of_remapping_are_kept);
    RUN_TEST(test_a_synchronous_tpdo_comes_at_every_nth_sync);
    RUN_TEST(test_a_tpdo_begins_at_its_sync_counter);
    RUN_TEST(test_an_event_sends_a_tpdo_but_not_within_its_inhibit_time);
    RUN_TEST(test_type_0_answers_the_sync_after_a_change);
    RUN_TEST(test_a_remote_frame_is_answered_by_the_tpdo_it_asks_for);
    RUN_TEST(test_no_remote_frame_is_answered_where_bit_30_or_the_state_forbids_it);
    RUN_TEST(test_a_remote_frame_within_the_inhibit_time_is_answered_after_it);
    RUN_TEST(test_a_remote_frame_does_not_take_the_event_from_the_next_sync);
    RUN_TEST(test_sync_may_have_another_identifier);
    RUN_TEST(test_targets_behind_the_window_of_1007_are_none);
    RUN_TEST(test_the_time_of_day_is_taken_where_1012_says_so_and_goes_on);
    RUN_TEST(test_the_high_resolution_time_counts_on_from_what_is_written);
    return UNITY_END();
}
