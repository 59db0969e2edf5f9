#include "canopen/emcy.h"
#include "canopen/sync.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_an_emergency_is_the_frame_of_the_standard(void)
{
    static const uint8_t bytes[] = {0x11, 0x86, 0x21, 1, 2, 3, 4, 5};
    struct emcy emcy = {
        .node = 3, .code = 0x8611, .error_register = 0x21, .vendor = {1, 2, 3, 4, 5}};
    struct can_frame frame;
    takt_emcy_write(&frame, &emcy);
    TEST_ASSERT_EQUAL_HEX16(0x083, frame.id);
    TEST_ASSERT_EQUAL_INT(8, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes, frame.data, 8);
}

static void test_an_emergency_reads_back(void)
{
    struct emcy emcy = {
        .node = 127, .code = 0x8210, .error_register = 0x11, .vendor = {9, 8, 7, 6, 5}};
    struct emcy read = {0};
    struct can_frame frame;
    takt_emcy_write(&frame, &emcy);
    TEST_ASSERT_TRUE(takt_emcy_read(&frame, &read));
    TEST_ASSERT_EQUAL_INT(127, read.node);
    TEST_ASSERT_EQUAL_HEX16(0x8210, read.code);
    TEST_ASSERT_EQUAL_HEX8(0x11, read.error_register);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(emcy.vendor, read.vendor, 5);
}

static void test_every_code_of_the_class_of_no_error_is_none(void)
{
    const struct can_frame frame = {.id = 0x081, .length = 8, .data = {0x01, 0x00}};
    struct emcy emcy;
    TEST_ASSERT_TRUE(takt_emcy_read(&frame, &emcy));
    TEST_ASSERT_EQUAL_HEX16(EMCY_NONE, emcy.code);
}

static void test_sync_and_short_frames_are_no_emergency(void)
{
    struct can_frame frame = {.id = 0x080, .length = 8};
    struct emcy emcy;
    TEST_ASSERT_FALSE(takt_emcy_read(&frame, &emcy));
    frame.id = 0x081;
    frame.length = 7;
    TEST_ASSERT_FALSE(takt_emcy_read(&frame, &emcy));
    frame.id = 0x181;
    frame.length = 8;
    TEST_ASSERT_FALSE(takt_emcy_read(&frame, &emcy));
}

static void test_codes_have_a_meaning_and_unknown_ones_that_of_their_class(void)
{
    TEST_ASSERT_EQUAL_STRING("following error", takt_emcy_text(0x8611));
    TEST_ASSERT_EQUAL_STRING("positioning controller", takt_emcy_text(0x8600));
    TEST_ASSERT_EQUAL_STRING("DC bus voltage", takt_emcy_text(0x32FE));
    TEST_ASSERT_EQUAL_STRING("voltage", takt_emcy_text(0x3FFF));
    TEST_ASSERT_EQUAL_STRING("made up by the manufacturer", takt_emcy_text(0x0E01));
}

static void test_sync_has_identifier_80_and_no_data(void)
{
    struct can_frame frame = {.id = 0x7FF, .length = 8};
    takt_sync_write(&frame);
    TEST_ASSERT_EQUAL_HEX16(0x080, frame.id);
    TEST_ASSERT_EQUAL_INT(0, frame.length);
    TEST_ASSERT_TRUE(takt_sync_is(&frame));
}

static void test_sync_with_a_counter_is_sync_and_an_emergency_is_not(void)
{
    struct can_frame frame = {.id = 0x080, .length = 1};
    TEST_ASSERT_TRUE(takt_sync_is(&frame));
    frame.length = 2;
    TEST_ASSERT_FALSE(takt_sync_is(&frame));
    frame.id = 0x081;
    frame.length = 0;
    TEST_ASSERT_FALSE(takt_sync_is(&frame));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_emergency_is_the_frame_of_the_standard);
    RUN_TEST(test_an_emergency_reads_back);
    RUN_TEST(test_every_code_of_the_class_of_no_error_is_none);
    RUN_TEST(test_sync_and_short_frames_are_no_emergency);
    RUN_TEST(test_codes_have_a_meaning_and_unknown_ones_that_of_their_class);
    RUN_TEST(test_sync_has_identifier_80_and_no_data);
    RUN_TEST(test_sync_with_a_counter_is_sync_and_an_emergency_is_not);
    return UNITY_END();
}
