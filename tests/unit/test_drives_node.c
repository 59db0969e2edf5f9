/*
 * The drive as a node of CiA 301: heartbeats, errors, PDOs that are mapped anew, stored parameters.
 */
#define _POSIX_C_SOURCE 200809L /* fmemopen */

#include "canopen/emcy.h"
#include "drives/drive_store.h"
#include "lone_drive.h"

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

/* ---- Heartbeats ---- */

static void test_a_heartbeat_is_produced_as_often_as_1017_says_and_shows_the_state(void)
{
    lone_step(&lone, 1000);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x705));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1017, 0, 2, 100));
    lone_step(&lone, 1000);
    TEST_ASSERT_EQUAL_UINT(10, lone_count_sent(&lone, 0x705));
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

static void test_no_node_is_watched_by_two_entries_of_1016(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1016, 1, 4, 127u << 16 | 50));
    TEST_ASSERT_EQUAL_HEX32(0x06040043, lone_write(&lone, 0x1016, 2, 4, 127u << 16 | 80));
    TEST_ASSERT_EQUAL_HEX32(0, lone_read(&lone, 0x1016, 2));
    /* A node without a time is not watched, nor is node 0; an entry may be written again. */
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1016, 2, 4, 127u << 16));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1016, 2, 4, 126u << 16 | 80));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1016, 2, 4, 126u << 16 | 90));
    TEST_ASSERT_EQUAL_HEX32(0x06040043, lone_write(&lone, 0x1016, 1, 4, 126u << 16 | 50));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1016, 1, 4, 80));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1016, 2, 4, 80));
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

static void lose_sync(void)
{
    (void)lone_write(&lone, 0x1006, 0, 4, 1000);
    lone_enable(&lone, 8);
    lone_sync(&lone);
    lone_step(&lone, 4);
    TEST_ASSERT_EQUAL_HEX8(0x11, lone_read(&lone, 0x1001, 0));
}

static void test_a_reset_of_the_communication_ends_its_error_in_1001_without_an_emergency(void)
{
    lose_sync();
    lone_nmt(&lone, NMT_RESET_COMMUNICATION);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x085));
    TEST_ASSERT_EQUAL_HEX8(0x00, lone_read(&lone, 0x1001, 0));
}

static void test_a_fault_of_the_drive_stays_in_1001_when_the_communication_is_reset(void)
{
    lose_sync();
    takt_servo_fail(&lone.drive.servo, 0x3210, EMCY_REGISTER_GENERIC | 0x04);
    TEST_ASSERT_EQUAL_HEX8(0x15, lone_read(&lone, 0x1001, 0));
    lone_nmt(&lone, NMT_RESET_COMMUNICATION);
    TEST_ASSERT_EQUAL_HEX8(0x05, lone_read(&lone, 0x1001, 0));
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
    TEST_ASSERT_EQUAL_HEX32(0x06090030, lone_write(&lone, 0x1003, 0, 1, 1));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x1003, 0, 1, 0));
    TEST_ASSERT_EQUAL_UINT32(0, lone_read(&lone, 0x1003, 0));
}

static void test_emergencies_keep_their_inhibit_time_and_none_is_lost(void)
{
    (void)lone_write(&lone, 0x1015, 0, 2, 100); /* 10 ms */
    lone_nmt(&lone, NMT_START);
    provoke_8210();
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x085));
    provoke_8210();
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x085));
    provoke_8210();
    lone_step(&lone, 9);
    TEST_ASSERT_EQUAL_UINT(0, lone_count_sent(&lone, 0x085));
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x085));
    lone_step(&lone, 100);
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x085));
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
    TEST_ASSERT_EQUAL_UINT(1, lone_count_sent(&lone, 0x123));
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

/* Command 22: expedited, the length not said. */
static uint32_t write_without_length(uint16_t index, uint32_t value)
{
    lone_take(&lone, 0x605, 8, 0x22 | (uint32_t)index << 8, value);
    const struct can_frame *answer = lone_find(&lone, 0x585);
    TEST_ASSERT_NOT_NULL(answer);
    return answer->data[0] == SDO_ABORT ? little_endian_read32(answer->data + 4) : 0;
}

static void test_a_number_written_without_its_length_is_the_first_bytes_of_the_four(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, write_without_length(0x1017, 0xAAAA0064));
    TEST_ASSERT_EQUAL_HEX32(100, lone_read(&lone, 0x1017, 0));
    TEST_ASSERT_EQUAL_HEX32(0, write_without_length(0x6060, 0xAAAAAA08));
    TEST_ASSERT_EQUAL_HEX32(8, lone_read(&lone, 0x6060, 0));
    TEST_ASSERT_EQUAL_HEX32(0, write_without_length(0x6081, 0x00010001));
    TEST_ASSERT_EQUAL_HEX32(0x00010001, lone_read(&lone, 0x6081, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06010002, write_without_length(0x6041, 0));
    TEST_ASSERT_EQUAL_HEX32(0x06020000, write_without_length(0x5000, 0));
    /* A name has no length of its own: all four bytes are meant. */
    TEST_ASSERT_EQUAL_HEX32(0, write_without_length(0x2000, 0x44434241));
    TEST_ASSERT_EQUAL_HEX32(0x44434241, lone_read(&lone, 0x2000, 0));
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
    RUN_TEST(test_no_node_is_watched_by_two_entries_of_1016);
    RUN_TEST(test_1029_says_what_becomes_of_the_node);
    RUN_TEST(test_a_sync_that_stays_out_is_8700);
    RUN_TEST(test_a_reset_of_the_communication_ends_its_error_in_1001_without_an_emergency);
    RUN_TEST(test_a_fault_of_the_drive_stays_in_1001_when_the_communication_is_reset);
    RUN_TEST(test_6007_says_what_a_lost_connection_does_to_the_motor);
    RUN_TEST(test_errors_are_remembered_the_newest_first);
    RUN_TEST(test_emergencies_keep_their_inhibit_time_and_none_is_lost);
    RUN_TEST(test_emergencies_have_the_identifier_of_1014_or_none);
    RUN_TEST(test_a_reset_forgets_what_was_not_stored);
    RUN_TEST(test_stored_parameters_survive_a_reset_until_defaults_are_restored);
    RUN_TEST(test_what_is_stored_is_kept_and_is_there_at_the_next_power_on);
    RUN_TEST(test_values_that_could_not_be_kept_are_not_stored);
    RUN_TEST(test_restored_defaults_are_kept_too);
    RUN_TEST(test_a_store_that_is_none_of_this_drive_is_refused_by_its_line);
    RUN_TEST(test_reads_and_writes_that_cannot_be_say_why);
    RUN_TEST(test_a_number_written_without_its_length_is_the_first_bytes_of_the_four);
    RUN_TEST(test_a_stopped_node_answers_no_request);
    RUN_TEST(test_the_feed_constant_says_how_long_an_increment_is);
    return UNITY_END();
}
