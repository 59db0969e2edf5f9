/*
 * A client of a drive's SDO server that leaves in the middle of a transfer: the drive's own time
 * ends it.
 */
#include "lone_drive.h"

#define TIMEOUT_CYCLES (SDO_SERVER_TIMEOUT_MS * 1000000u / LONE_CYCLE_NS)

static struct lone_drive lone;
static unsigned told;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
    told = 0;
}

void tearDown(void)
{
}

/* A frame of 8 bytes, of which the last four are high. */
static void ask(uint32_t low, uint32_t high)
{
    lone_take(&lone, SDO_REQUEST_FUNCTION + LONE_NODE, 8, low, high);
}

static const struct can_frame *answer(void)
{
    return lone_find(&lone, SDO_RESPONSE_FUNCTION + LONE_NODE);
}

static void assert_serves(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x00020192, lone_read(&lone, 0x1000, 0));
}

static void assert_given_up_after(unsigned cycles, uint32_t object)
{
    lone_step(&lone, cycles - 1);
    TEST_ASSERT_NULL(answer());
    lone_step(&lone, 1);
    TEST_ASSERT_NOT_NULL(answer());
    TEST_ASSERT_EQUAL_HEX8(0x80, answer()->data[0]);
    TEST_ASSERT_EQUAL_HEX32(object, takt_sdo_read_object(answer()));
    TEST_ASSERT_EQUAL_HEX32(0x05040000, little_endian_read32(answer()->data + 4));
    lone_step(&lone, 2 * TIMEOUT_CYCLES);
    TEST_ASSERT_NULL(answer());
}

/* 20 bytes of the notes, object 2001. */
static void begin_block_download(void)
{
    ask(0x002001C6, 20);
    TEST_ASSERT_EQUAL_HEX8(0xA4, answer()->data[0]);
}

static void test_a_block_download_that_its_client_has_left_ends_after_the_timeout(void)
{
    begin_block_download();
    assert_given_up_after(TIMEOUT_CYCLES, SDO_OBJECT(0x2001, 0));
    assert_serves();
}

static void test_requests_that_a_left_block_download_swallows_do_not_keep_it(void)
{
    begin_block_download();
    for (unsigned i = 0; i < 3; i++) {
        lone_step(&lone, TIMEOUT_CYCLES / 4);
        ask(0x00100040, 0);
        TEST_ASSERT_NULL(answer());
    }
    assert_given_up_after(TIMEOUT_CYCLES / 4, SDO_OBJECT(0x2001, 0));
    assert_serves();
}

/* 18 bytes, object 1008: in three segments, or in blocks of one. */
static void begin_left_uploads(unsigned which)
{
    ask(which == 0 ? 0x00100840 : 0x001008A4, which == 0 ? 0 : 1);
    TEST_ASSERT_EQUAL_HEX8(which == 0 ? 0x41 : 0xC6, answer()->data[0]);
    ask(which == 0 ? 0x60 : 0xA3, 0);
    TEST_ASSERT_NOT_NULL(answer());
}

static void test_a_left_upload_ends_after_the_timeout_and_for_a_new_request_at_once(void)
{
    for (unsigned which = 0; which < 2; which++) {
        begin_left_uploads(which);
        assert_given_up_after(TIMEOUT_CYCLES, SDO_OBJECT(0x1008, 0));
        assert_serves();
        begin_left_uploads(which);
        assert_serves();
        lone_step(&lone, 2 * TIMEOUT_CYCLES);
        TEST_ASSERT_NULL(answer());
    }
}

static void test_a_slow_client_that_goes_on_is_served(void)
{
    ask(0x00200121, 14);
    lone_step(&lone, TIMEOUT_CYCLES - 1);
    TEST_ASSERT_NULL(answer());
    ask(0x33323100, 0x37363534);
    TEST_ASSERT_EQUAL_HEX8(0x20, answer()->data[0]);
    lone_step(&lone, TIMEOUT_CYCLES - 1);
    ask(0x33323111, 0x37363534);
    TEST_ASSERT_EQUAL_HEX8(0x30, answer()->data[0]);
}

/* A drive that takes longer for an answer than the timeout. */
static void test_a_client_whose_request_waits_is_not_silent(void)
{
    lone.config.sdo_us = 1000u * SDO_SERVER_TIMEOUT_MS + 500000u;
    lone_start(&lone);
    ask(0x00200121, 7);
    lone_step(&lone, TIMEOUT_CYCLES + 500);
    TEST_ASSERT_EQUAL_HEX8(0x60, answer()->data[0]);
    ask(0x33323101, 0x37363534);
    lone_step(&lone, TIMEOUT_CYCLES + 499);
    TEST_ASSERT_NULL(answer());
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_HEX8(0x20, answer()->data[0]);
}

static void test_a_stopped_node_forgets_the_transfer_without_a_word(void)
{
    begin_block_download();
    lone_nmt(&lone, NMT_STOP);
    lone_step(&lone, 2 * TIMEOUT_CYCLES);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_nmt(&lone, NMT_ENTER_PREOPERATIONAL);
    assert_serves();
}

static void note(void *context, const struct drive_event *event)
{
    (void)context;
    if (event->kind != DRIVE_EVENT_SDO_ABORT)
        return;
    told++;
    TEST_ASSERT_EQUAL_HEX32(SDO_OBJECT(0x2001, 0), event->first);
    TEST_ASSERT_EQUAL_HEX32(0x05040000, event->second);
}

static void test_the_log_tells_what_was_given_up(void)
{
    takt_servo_observe(&lone.drive.servo, &(struct drive_observer){note, NULL});
    begin_block_download();
    lone_step(&lone, TIMEOUT_CYCLES);
    TEST_ASSERT_EQUAL_UINT(1, told);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_block_download_that_its_client_has_left_ends_after_the_timeout);
    RUN_TEST(test_requests_that_a_left_block_download_swallows_do_not_keep_it);
    RUN_TEST(test_a_left_upload_ends_after_the_timeout_and_for_a_new_request_at_once);
    RUN_TEST(test_a_slow_client_that_goes_on_is_served);
    RUN_TEST(test_a_client_whose_request_waits_is_not_silent);
    RUN_TEST(test_a_stopped_node_forgets_the_transfer_without_a_word);
    RUN_TEST(test_the_log_tells_what_was_given_up);
    return UNITY_END();
}
