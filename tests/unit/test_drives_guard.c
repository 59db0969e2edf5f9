/*
 * Node guarding, the drive's end (CiA 301, 7.2.8.3.2.1).
 */
#include "lone_drive.h"

#include "canopen/emcy.h"

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
}

static void guard(void)
{
    lone_take(&lone, CAN_REMOTE | 0x705, 1, 0, 0);
}

static void test_a_guarded_node_tells_its_state_with_a_bit_that_toggles(void)
{
    static const uint8_t expected[] = {0x7F, 0xFF, 0x7F};
    for (unsigned i = 0; i < 3; i++) {
        guard();
        TEST_ASSERT_EQUAL_UINT(1, lone.sent_count);
        TEST_ASSERT_EQUAL_HEX8(expected[i], lone.sent[0].data[0]);
    }
    lone_nmt(&lone, NMT_RESET_COMMUNICATION);
    lone_nmt(&lone, NMT_START);
    guard();
    TEST_ASSERT_EQUAL_HEX8(0x05, lone.sent[0].data[0]);
}

static void test_a_node_with_a_heartbeat_is_not_guarded(void)
{
    (void)lone_write(&lone, 0x1017, 0, 2, 100);
    guard();
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
}

static void test_guarding_that_stays_out_for_the_life_time_is_8130(void)
{
    struct emcy emcy;
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x100C, 0, 2, 20));
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x100D, 0, 1, 3));
    lone_enable(&lone, 8);
    lone_step(&lone, 200);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
    guard();
    lone_step(&lone, 59);
    TEST_ASSERT_NULL(lone_find(&lone, 0x085));
    lone_step(&lone, 1);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x085));
    TEST_ASSERT_TRUE(takt_emcy_read(lone_find(&lone, 0x085), &emcy));
    TEST_ASSERT_EQUAL_HEX16(0x8130, emcy.code);
    TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, virtual_drive_get_state(&lone.drive));
    guard();
    TEST_ASSERT_TRUE(takt_emcy_read(lone_find(&lone, 0x085), &emcy));
    TEST_ASSERT_EQUAL_HEX16(0x0000, emcy.code);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_guarded_node_tells_its_state_with_a_bit_that_toggles);
    RUN_TEST(test_a_node_with_a_heartbeat_is_not_guarded);
    RUN_TEST(test_guarding_that_stays_out_for_the_life_time_is_8130);
    return UNITY_END();
}
