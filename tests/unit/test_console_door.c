/* 0x84 on the console: the axes are held, and the spindle stands when they rest. */
#include "console_bench.h"

void setUp(void)
{
    console_bench_set_up(0);
}

void tearDown(void)
{
}

static double place(unsigned axis)
{
    return service.controller.record.set.at[axis];
}

static double spindle_rpm(void)
{
    return takt_service_get_outputs(&service).spindle_speed_rpm;
}

static void test_a_door_holds_the_axes_with_the_spindle_off(void)
{
    give("M3 S1000\nG1 X50 F3000\n");
    steps(600);
    give("\x84");
    steps(300);
    TEST_ASSERT_TRUE(spindle_rpm() == 0.0);
    expect_status("<Door:0|");
    give("~");
    steps(50);
    TEST_ASSERT_TRUE(spindle_rpm() == 1000.0);
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(50.0, place(AXIS_X));
}

/* The spindle turns until they do. */
static void test_a_door_waits_where_the_program_forbids_the_hold(void)
{
    give("M3 S1000\nM53 P0\nG1 X30 F3000\nM53 P1\nG1 X50\n");
    steps(400);
    give("\x84");
    steps(50);
    TEST_ASSERT_TRUE(spindle_rpm() == 1000.0);
    expect_status("<Run|");
    steps(600);
    TEST_ASSERT_TRUE(spindle_rpm() == 0.0);
    expect_status("<Door:0|");
    TEST_ASSERT_TRUE(place(AXIS_X) > 30.0 && place(AXIS_X) < 40.0);
    give("~");
    settle();
    TEST_ASSERT_EQUAL_DOUBLE(50.0, place(AXIS_X));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_door_holds_the_axes_with_the_spindle_off);
    RUN_TEST(test_a_door_waits_where_the_program_forbids_the_hold);
    return UNITY_END();
}
