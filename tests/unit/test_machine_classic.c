/* A machine on an image that has classical CAN alone (CAN_DATA_MAX 8, set by CMakeLists.txt). */
#include "machine/machine_check.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_can_fd_is_refused_where_the_image_has_none(void)
{
    struct machine machine;
    struct diagnostic wrong;
    char said[DIAGNOSTIC_TEXT_MAX];

    takt_machine_set_default(&machine);
    TEST_ASSERT_TRUE(takt_machine_check(&machine, &wrong));
    machine.can_data_bitrate = 5000000;
    TEST_ASSERT_FALSE(takt_machine_check(&machine, &wrong));
    TEST_ASSERT_EQUAL(TAKT_ERROR_MACHINE_FD, wrong.code);
    (void)takt_diagnostic_text(&wrong, said);
    TEST_ASSERT_EQUAL_STRING(
        "data_bitrate 5000000: this image has classical CAN alone, so it must be 0", said);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_can_fd_is_refused_where_the_image_has_none);
    return UNITY_END();
}
