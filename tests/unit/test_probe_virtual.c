/*
 * What a virtual machine touches and is told.
 */
#include "probe/virtual_probe.h"

#include "base/maths.h"

#include "unity.h"

#include <stdio.h>
#include <string.h>

static struct virtual_probe probe;
static struct virtual_probe_error error;

void setUp(void)
{
}

void tearDown(void)
{
}

static void read_text(const char *text)
{
    const bool good = virtual_probe_read(&probe, text, strlen(text), &error);

    TEST_ASSERT_TRUE_MESSAGE(good, error.text);
}

static void expect_error(const char *text, uint32_t line, uint32_t column, const char *message)
{
    TEST_ASSERT_FALSE_MESSAGE(virtual_probe_read(&probe, text, strlen(text), &error), text);
    TEST_ASSERT_EQUAL_STRING(message, error.text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(line, error.line, text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(column, error.column, text);
}

static bool touches(double x, double y, double z, double c_deg)
{
    const struct point p = {{x, y, z, 0.0, 0.0, c_deg * MATHS_PI / 180.0}};

    return virtual_probe_touches(&probe, &p);
}

static void test_a_box_is_touched_inside_and_on_its_sides(void)
{
    read_text("box X -10 10 Y 0 5 Z -20 -15\n");
    TEST_ASSERT_TRUE(touches(0.0, 1.0, -16.0, 0.0));
    TEST_ASSERT_TRUE(touches(10.0, 5.0, -15.0, 0.0));
    TEST_ASSERT_FALSE(touches(10.001, 1.0, -16.0, 0.0));
    TEST_ASSERT_FALSE(touches(0.0, -0.001, -16.0, 0.0));
    TEST_ASSERT_FALSE(touches(0.0, 1.0, -14.999, 0.0));
}

static void test_a_box_of_one_open_side_is_a_half_space(void)
{
    read_text("  box Z * -5   # the table\n");
    TEST_ASSERT_TRUE(touches(1e5, -1e5, -1e5, 0.0));
    TEST_ASSERT_FALSE(touches(0.0, 0.0, -4.999, 0.0));
}

static void test_rotary_axes_count_in_degrees(void)
{
    read_text("box C 90 *\n");
    TEST_ASSERT_TRUE(touches(0.0, 0.0, 0.0, 90.001));
    TEST_ASSERT_FALSE(touches(0.0, 0.0, 0.0, 89.999));
}

static void test_a_ball_is_touched_at_its_radius(void)
{
    read_text("# a reference ball\n\nball X 3 Y 0 Z -4 R 5\r\n");
    TEST_ASSERT_TRUE(touches(0.001, 0.0, 0.0, 0.0));
    TEST_ASSERT_FALSE(touches(-0.001, 0.0, 0.0, 0.0));
}

static void test_any_of_the_solids_is_touched(void)
{
    read_text("box X 10 *\nbox Y 10 *\nball X 0 Y 0 Z 0 R 1");
    TEST_ASSERT_TRUE(touches(11.0, 0.0, 5.0, 0.0));
    TEST_ASSERT_TRUE(touches(0.0, 11.0, 5.0, 0.0));
    TEST_ASSERT_TRUE(touches(0.0, 0.0, 0.5, 0.0));
    TEST_ASSERT_FALSE(touches(9.0, 9.0, 5.0, 0.0));
}

static void test_nothing_is_touched_where_there_is_nothing(void)
{
    read_text("");
    TEST_ASSERT_FALSE(touches(0.0, 0.0, 0.0, 0.0));
    read_text("box X 0 1\n");
    read_text("# nothing\n");
    TEST_ASSERT_FALSE(touches(0.5, 0.0, 0.0, 0.0));
}

static void test_inputs_change_at_their_times(void)
{
    const struct point at = {{0}};
    struct inputs inputs = inputs_idle();

    read_text("input P2 1 at 1e0\ninput P31 1 at 0\ninput E3 7 at 0.5\n"
              "input E3 -2.5 at 0.5\ninput P31 0 at 0.5\n");
    virtual_probe_set_inputs(&probe, 0.0, &at, &inputs);
    TEST_ASSERT_EQUAL_HEX32(0x80000000U, inputs.digital);
    TEST_ASSERT_TRUE(inputs.analogue[3] == 0.0);
    virtual_probe_set_inputs(&probe, 0.5, &at, &inputs);
    TEST_ASSERT_EQUAL_HEX32(0U, inputs.digital);
    TEST_ASSERT_TRUE(inputs.analogue[3] == -2.5);
    virtual_probe_set_inputs(&probe, 1.0, &at, &inputs);
    TEST_ASSERT_EQUAL_HEX32(4U, inputs.digital);
}

static void test_contact_is_told_as_long_as_it_lasts(void)
{
    struct inputs inputs = inputs_idle();

    read_text("box X 1 2\n");
    virtual_probe_set_inputs(&probe, 0.0, &(struct point){{1.5}}, &inputs);
    TEST_ASSERT_TRUE(inputs.probe_contact);
    virtual_probe_set_inputs(&probe, 0.0, &(struct point){{2.5}}, &inputs);
    TEST_ASSERT_FALSE(inputs.probe_contact);
}

static void test_mistakes_are_named_with_their_place(void)
{
    expect_error("box X 0 1\ncube X 1\n", 2, 1,
                 "box, ball, hole, part or input is expected, not 'cube'");
    expect_error("box\n", 1, 4, "an axis, X Y Z A B or C, is missing");
    expect_error("box U 1 2\n", 1, 5, "an axis, X Y Z A B or C, is expected, not 'U'");
    expect_error("box X 1\n", 1, 8, "a number is missing");
    expect_error("box X 1 2,5\n", 1, 9, "a number is expected, not '2,5'");
    expect_error("box X 1 nan\n", 1, 9, "a number is expected, not 'nan'");
    expect_error("box X 1 1e999\n", 1, 9, "a number is expected, not '1e999'");
    expect_error("box X 2 1\n", 1, 5, "the lower end of X is above the upper one");
    expect_error("box X 1 2 X 3 4\n", 1, 11, "the axis X is given twice");
    expect_error("ball X 1 Y 2 R 3\n", 1, 14, "'Z' is expected, not 'R'");
    expect_error("ball X 1 Y 2 Z 3 R 0\n", 1, 20, "a radius above 0 is expected");
    expect_error("ball X 1 Y 2 Z 3 R 1 A 5\n", 1, 22, "'A' is too much here");
}

static void test_mistakes_in_inputs_are_named_too(void)
{
    expect_error("input P32 1 at 0\n", 1, 7,
                 "an input, P0 to P31 or E0 to E3, is expected, not 'P32'");
    expect_error("input E4 1 at 0\n", 1, 7,
                 "an input, P0 to P31 or E0 to E3, is expected, not 'E4'");
    expect_error("input P1.5 1 at 0\n", 1, 7,
                 "an input, P0 to P31 or E0 to E3, is expected, not 'P1.5'");
    expect_error("input P1 2 at 0\n", 1, 10, "a digital input is 0 or 1");
    expect_error("input P1 1 0\n", 1, 12, "'at' is expected, not '0'");
    expect_error("input P1 1 at -1\n", 1, 15, "a time is 0 or more");
}

static void test_more_than_there_is_room_for_is_refused(void)
{
    static char text[(VIRTUAL_PROBE_CHANGES_MAX + 1) * 20];
    size_t length = 0;

    for (unsigned i = 0; i <= VIRTUAL_PROBE_SOLIDS_MAX; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "box X %u 999\n", i);
    expect_error(text, VIRTUAL_PROBE_SOLIDS_MAX + 1, 1, "more than 64 solids");
    length = 0;
    for (unsigned i = 0; i <= VIRTUAL_PROBE_CHANGES_MAX; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "input P1 1 at %u\n", i);
    expect_error(text, VIRTUAL_PROBE_CHANGES_MAX + 1, 1, "more than 256 changes of inputs");
    expect_error("box 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25\n", 1, 65,
                 "the line has more than 24 words");
}

static void test_a_hole_is_touched_from_inside(void)
{
    read_text("hole X 10 Y 5 Z -3 R 4\n");
    TEST_ASSERT_FALSE(touches(10.0, 8.9, -5.0, 0.0));
    TEST_ASSERT_TRUE(touches(10.0, 9.0, -5.0, 0.0));
    TEST_ASSERT_TRUE(touches(-100.0, 0.0, -3.0, 0.0));
    TEST_ASSERT_FALSE(touches(10.0, 9.0, -2.999, 0.0));
}

/*
 * A corner at 20, 0, turned by 90 degrees about 10, 0 and displaced by 1, 2: it is at 11, 12 then.
 */
static void test_a_part_stands_displaced_and_turned(void)
{
    read_text("part by 1 2 0  turned 0 0 90  about 10 0 0\nbox X 20 * Y 0 *\n");
    TEST_ASSERT_TRUE(touches(10.999, 12.001, 0.0, 0.0));
    TEST_ASSERT_FALSE(touches(11.001, 12.001, 0.0, 0.0));
    TEST_ASSERT_FALSE(touches(10.999, 11.999, 0.0, 0.0));
}

/* And with the table, which turns about 10, 0: by 90 degrees more at -2, 1 from there. */
static void test_a_part_turns_with_its_table(void)
{
    read_text("box X 20 * Y 0 *\npart by 1 2 0  turned 0 0 90  about 10 0 0  on C\n");
    TEST_ASSERT_TRUE(touches(10.999, 12.001, 0.0, 0.0));
    TEST_ASSERT_TRUE(touches(-2.001, 0.999, 0.0, 90.0));
    TEST_ASSERT_FALSE(touches(-1.999, 0.999, 0.0, 90.0));
    TEST_ASSERT_FALSE(touches(-2.001, 1.001, 0.0, 90.0));
    expect_error("part by 1 2\n", 1, 12, "a number is missing");
    expect_error("part by 1 2 0 turned 0 0 0 about 0 0 0 on X\n", 1, 43,
                 "a table, A, B or C, is expected, not 'X'");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_box_is_touched_inside_and_on_its_sides);
    RUN_TEST(test_a_box_of_one_open_side_is_a_half_space);
    RUN_TEST(test_rotary_axes_count_in_degrees);
    RUN_TEST(test_a_ball_is_touched_at_its_radius);
    RUN_TEST(test_any_of_the_solids_is_touched);
    RUN_TEST(test_nothing_is_touched_where_there_is_nothing);
    RUN_TEST(test_a_hole_is_touched_from_inside);
    RUN_TEST(test_a_part_stands_displaced_and_turned);
    RUN_TEST(test_a_part_turns_with_its_table);
    RUN_TEST(test_inputs_change_at_their_times);
    RUN_TEST(test_contact_is_told_as_long_as_it_lasts);
    RUN_TEST(test_mistakes_are_named_with_their_place);
    RUN_TEST(test_mistakes_in_inputs_are_named_too);
    RUN_TEST(test_more_than_there_is_room_for_is_refused);
    return UNITY_END();
}
