/* host/session/canon.h: moves as text. */
#include "base/maths.h"
#include "session/canon.h"

#include "unity.h"

#include <string.h>

#define AXES_XYZ  0x7u
#define AXES_XYZA 0xfu

void setUp(void)
{
}

void tearDown(void)
{
}

static void check(const struct move *move, unsigned axes, const char *expected)
{
    const struct point at = {{1.0, 2.0, 3.0, 0.0, 0.0, 0.0}};
    char text[CANON_TEXT_MAX];
    const size_t length = canon_format(move, axes, &at, text);

    TEST_ASSERT_EQUAL_STRING(expected, text);
    TEST_ASSERT_EQUAL_UINT(strlen(expected), length);
}

static void test_a_rapid_names_every_axis_and_no_feed(void)
{
    const struct move move = {
        .kind = MOVE_RAPID, .line = 7, .end = {{1.0, 2.5, -3.0, 0.0, 0.0, 0.0}}};

    check(&move, AXES_XYZ, "7 rapid X1.000000 Y2.500000 Z-3.000000");
}

static void test_rotary_axes_are_degrees(void)
{
    const struct move move = {.kind = MOVE_FEED,
                              .line = 7,
                              .end = {{1.0, 2.0, 4.0, MATHS_HALF_PI, 0.0, 0.0}},
                              .feed_mm_s = 10.0};

    check(&move, AXES_XYZA, "7 feed X1.000000 Y2.000000 Z4.000000 A90.000000 F600.000000");
}

static void test_feed_of_a_rotary_axis_alone_is_degrees_a_minute(void)
{
    const struct move move = {.kind = MOVE_FEED,
                              .line = 7,
                              .end = {{1.0, 2.0, 3.0, MATHS_HALF_PI, 0.0, 0.0}},
                              .feed_mm_s = MATHS_PI};

    check(&move, AXES_XYZA, "7 feed X1.000000 Y2.000000 Z3.000000 A90.000000 F10800.000000");
}

static void test_the_centre_outside_the_plane_is_the_start_s(void)
{
    struct move move = {.kind = MOVE_ARC_CW,
                        .line = 12,
                        .end = {{5.0, 6.0, 7.0, 0.0, 0.0, 0.0}},
                        .feed_mm_s = 1.0,
                        .plane = PLANE_XY,
                        .centre_mm = {8.0, 9.0},
                        .turns = 2};

    check(
        &move, AXES_XYZ,
        "12 arc_cw X5.000000 Y6.000000 Z7.000000 I8.000000 J9.000000 K3.000000 P2 G17 F60.000000");
    move.kind = MOVE_ARC_CCW;
    move.plane = PLANE_ZX;
    check(
        &move, AXES_XYZ,
        "12 arc_ccw X5.000000 Y6.000000 Z7.000000 I9.000000 J2.000000 K8.000000 P2 G18 F60.000000");
    move.plane = PLANE_YZ;
    check(
        &move, AXES_XYZ,
        "12 arc_ccw X5.000000 Y6.000000 Z7.000000 I1.000000 J8.000000 K9.000000 P2 G19 F60.000000");
}

static void test_spindle_and_coolant(void)
{
    struct move move = {
        .kind = MOVE_SPINDLE, .line = 5, .direction = SPINDLE_CW, .speed_rpm = 1600.0};

    check(&move, AXES_XYZ, "5 spindle_cw S1600.000000");
    move.direction = SPINDLE_CCW;
    check(&move, AXES_XYZ, "5 spindle_ccw S1600.000000");
    move.direction = SPINDLE_OFF;
    check(&move, AXES_XYZ, "5 spindle_off");
    move = (struct move){.kind = MOVE_COOLANT, .line = 6};
    check(&move, AXES_XYZ, "6 coolant_off");
    move.mist = true;
    check(&move, AXES_XYZ, "6 coolant_mist_on");
    move.flood = true;
    check(&move, AXES_XYZ, "6 coolant_mist_flood_on");
    move.mist = false;
    check(&move, AXES_XYZ, "6 coolant_flood_on");
}

static void test_tools_waits_and_stops(void)
{
    struct move move = {.kind = MOVE_TOOL, .line = 1, .tool = 12};

    check(&move, AXES_XYZ, "1 tool_prepare T12");
    move.tool_change = true;
    check(&move, AXES_XYZ, "1 tool_change T12");
    move = (struct move){.kind = MOVE_DWELL, .line = 2, .dwell_s = 0.5};
    check(&move, AXES_XYZ, "2 dwell P0.500000");
    move = (struct move){.kind = MOVE_STOP, .line = 3};
    check(&move, AXES_XYZ, "3 stop");
    move.optional = true;
    check(&move, AXES_XYZ, "3 optional_stop");
    move = (struct move){.kind = MOVE_END, .line = 4294967295U};
    check(&move, AXES_XYZ, "4294967295 end");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_rapid_names_every_axis_and_no_feed);
    RUN_TEST(test_rotary_axes_are_degrees);
    RUN_TEST(test_feed_of_a_rotary_axis_alone_is_degrees_a_minute);
    RUN_TEST(test_the_centre_outside_the_plane_is_the_start_s);
    RUN_TEST(test_spindle_and_coolant);
    RUN_TEST(test_tools_waits_and_stops);
    return UNITY_END();
}
