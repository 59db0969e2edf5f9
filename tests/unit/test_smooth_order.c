/*
 * Does a curve follow the route in order? What can be known by hand: strokes, corners and loops of
 * a few tolerances.
 */
#include "smooth/order.h"

#include "base/maths.h"

#include <string.h>
#include <unity.h>

#define TOLERANCE_MM 0.1

static struct route route;
static struct order order;
static struct point at;    /* end of the route */
static double place_mm[2]; /* of the curve */
static double feed_mm_s;   /* of motions that are pushed */

/* Three equal axes, a route that begins at 0. */
void setUp(void)
{
    struct smooth_limits limits;

    memset(&limits, 0, sizeof limits);
    limits.axes = 7;
    limits.cycle_s = 1e-3;
    for (int i = 0; i < 3; i++) {
        limits.velocity_mm_s[i] = 100.0;
        limits.acceleration_mm_s2[i] = 1000.0;
        limits.jerk_mm_s3[i] = 50000.0;
    }
    takt_route_init(&route, &limits, TOLERANCE_MM);
    memset(&at, 0, sizeof at);
    place_mm[0] = 0.0;
    place_mm[1] = 0.0;
    feed_mm_s = 100.0;
    takt_order_start(&order, 0.0, 0);
}

void tearDown(void)
{
}

static void push(const struct curve *curve)
{
    const struct move move = {
        .kind = MOVE_FEED, .feed_mm_s = feed_mm_s, .tolerance_mm = TOLERANCE_MM};

    takt_route_push(&route, &move, 0, curve);
}

static void line_to(double x, double y)
{
    struct point end = {{x, y}};
    struct curve line;

    TEST_ASSERT_TRUE(takt_curve_set_line(&line, &at, &end));
    push(&line);
    at = end;
}

static void full_circle(double radius_mm)
{
    const double centre[2] = {at.at[0], at.at[1] + radius_mm};
    struct curve arc;

    TEST_ASSERT_TRUE(takt_curve_set_arc(&arc, &at, &at, PLANE_XY, centre, false, 1));
    push(&arc);
}

/* The curve, in chords of some length. */
static void go_to(double x, double y, double chord_mm)
{
    const double dx = x - place_mm[0];
    const double dy = y - place_mm[1];
    const unsigned chords = (unsigned)(maths_sqrt(dx * dx + dy * dy) / chord_mm) + 1;

    for (unsigned i = 0; i < chords; i++) {
        struct order_chord chord = {.within_mm = (float)TOLERANCE_MM,
                                    .corner_mm = (float)TOLERANCE_MM};

        chord.from[0] = place_mm[0] + dx * i / chords;
        chord.from[1] = place_mm[1] + dy * i / chords;
        chord.way[0] = (float)(dx / chords);
        chord.way[1] = (float)(dy / chords);
        takt_order_go(&order, &route, &chord);
    }
    place_mm[0] = x;
    place_mm[1] = y;
}

/* Whatever the chords, down to one for each stroke. */
static const double chords_mm[] = {0.001, 0.03, 0.3, 100.0};
#define CHORDS (sizeof chords_mm / sizeof chords_mm[0])

static void test_the_route_itself_is_in_order(void)
{
    for (unsigned i = 0; i < CHORDS; i++) {
        setUp();
        line_to(10.0, 0.0);
        line_to(10.0, 5.0);
        line_to(2.0, 5.0);
        go_to(10.0, 0.0, chords_mm[i]);
        go_to(10.0, 5.0, chords_mm[i]);
        go_to(2.0, 5.0, chords_mm[i]);
        TEST_ASSERT_TRUE(order_reaches(&order, 23.0));
    }
}

/* There and back: the tip may be cut short by the tolerance. */
static bool passes_tip(double short_mm, double chord_mm)
{
    setUp();
    line_to(3.0, 0.0);
    line_to(0.0, 0.0);
    go_to(3.0 - short_mm, 0.0, chord_mm);
    go_to(0.0, 0.0, chord_mm);
    return order_reaches(&order, 6.0);
}

static void test_a_stroke_is_cut_short_by_the_tolerance_at_most(void)
{
    for (unsigned i = 0; i < CHORDS; i++) {
        TEST_ASSERT_TRUE(passes_tip(0.099, chords_mm[i]));
        TEST_ASSERT_FALSE(passes_tip(0.101, chords_mm[i]));
    }
}

/*
 * To 1, back by a stroke, and on to 3, with a curve that goes straight through: it stands for half
 * of the stroke.
 */
static bool leaves_out_stroke(double stroke_mm, double chord_mm)
{
    setUp();
    line_to(1.0, 0.0);
    line_to(1.0 - stroke_mm, 0.0);
    line_to(3.0, 0.0);
    go_to(3.0, 0.0, chord_mm);
    return order_reaches(&order, takt_route_end(&route));
}

/* Every place and every corner is near in all of these. */
static void test_a_stroke_back_is_left_out_up_to_two_tolerances(void)
{
    for (unsigned i = 0; i < CHORDS; i++) {
        TEST_ASSERT_TRUE(leaves_out_stroke(0.199, chords_mm[i]));
        TEST_ASSERT_FALSE(leaves_out_stroke(0.201, chords_mm[i]));
    }
}

/* A circle on a line, and a curve that goes straight through: from the tangent it is 2 r high. */
static bool leaves_out_circle(double radius_mm, double chord_mm)
{
    setUp();
    line_to(1.0, 0.0);
    full_circle(radius_mm);
    line_to(3.0, 0.0);
    go_to(3.0, 0.0, chord_mm);
    return order_reaches(&order, takt_route_end(&route));
}

static void test_a_full_circle_is_left_out_up_to_a_diameter_of_the_tolerance(void)
{
    for (unsigned i = 0; i < CHORDS; i++) {
        TEST_ASSERT_TRUE(leaves_out_circle(0.049, chords_mm[i]));
        TEST_ASSERT_FALSE(leaves_out_circle(0.0505, chords_mm[i]));
        TEST_ASSERT_FALSE(leaves_out_circle(1.0, chords_mm[i]));
    }
}

static void test_a_corner_is_passed_nearer_where_chords_leave_the_curve(void)
{
    struct order_chord chord = {.within_mm = 0.1f, .corner_mm = 0.05f, .way = {0.93f}};

    line_to(1.0, 0.0);
    line_to(1.0, 1.0);
    takt_order_go(&order, &route, &chord);
    TEST_ASSERT_FALSE(order_reaches(&order, 1.01));
    chord.way[0] = 0.96f;
    takt_order_start(&order, 0.0, 0);
    takt_order_go(&order, &route, &chord);
    TEST_ASSERT_TRUE(order_reaches(&order, 1.01));
}

/*
 * The end of a line is within the tolerance of a chord that does not come near enough to the corner
 * there.
 */
static void test_a_corner_is_not_passed_by_what_only_comes_to_its_place(void)
{
    struct order_chord chord = {.within_mm = 0.1f, .corner_mm = 0.05f, .way = {0.93f}};

    line_to(1.0, 0.0);
    line_to(1.0, 1.0);
    takt_order_go(&order, &route, &chord);
    TEST_ASSERT_TRUE(order_reaches(&order, 1.0));
    chord.from[0] = 0.93;
    chord.way[0] = 0.0f;
    chord.way[1] = 0.09f;
    takt_order_go(&order, &route, &chord);
    TEST_ASSERT_FALSE(order_reaches(&order, 1.01));
}

/*
 * Two fast lines with a slow one between, and one chord from before it to behind it, on them: is
 * there a way on fast ones alone?
 */
static bool hurries_past(double slow_mm)
{
    struct order_chord chord = {
        .from = {0.95}, .within_mm = 0.1f, .corner_mm = 0.1f, .least_mm_s = {50.0f, 50.0f}};

    setUp();
    chord.way[0] = (float)(slow_mm + 0.1);
    line_to(1.0, 0.0);
    feed_mm_s = 10.0;
    line_to(1.0 + slow_mm, 0.0);
    feed_mm_s = 100.0;
    line_to(3.0, 0.0);
    takt_order_start(&order, 0.95, 0);
    takt_order_go(&order, &route, &chord);
    return order_reaches(&order, 1.0 + slow_mm + 0.05);
}

static void test_a_slow_motion_longer_than_two_tolerances_is_not_passed_in_an_instant(void)
{
    TEST_ASSERT_TRUE(hurries_past(0.199));
    TEST_ASSERT_FALSE(hurries_past(0.201));
}

/*
 * A raster finer than the tolerance has more stretches than are kept: one of those that are kept
 * leads on.
 */
static void test_of_many_stretches_enough_are_kept(void)
{
    for (unsigned i = 0; i < 8; i++) {
        line_to(i % 2 == 0 ? 3.0 : 0.0, 0.01 * i);
        line_to(i % 2 == 0 ? 3.0 : 0.0, 0.01 * (i + 1));
    }
    for (unsigned i = 0; i < 8; i++) {
        go_to(i % 2 == 0 ? 3.0 : 0.0, 0.01 * i, 0.05);
        go_to(i % 2 == 0 ? 3.0 : 0.0, 0.01 * (i + 1), 0.05);
        TEST_ASSERT_TRUE(order.count > 0 && order.count <= ORDER_SPANS);
    }
    TEST_ASSERT_TRUE(order_reaches(&order, takt_route_end(&route)));
}

static void test_the_place_to_rest_at_is_one_that_can_have_been_come_to(void)
{
    line_to(3.0, 0.0);
    go_to(1.0, 0.0, 0.01);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0, takt_order_place(&order, 1.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.1, takt_order_place(&order, 2.0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.9, takt_order_place(&order, 0.5));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_route_itself_is_in_order);
    RUN_TEST(test_a_stroke_is_cut_short_by_the_tolerance_at_most);
    RUN_TEST(test_a_stroke_back_is_left_out_up_to_two_tolerances);
    RUN_TEST(test_a_full_circle_is_left_out_up_to_a_diameter_of_the_tolerance);
    RUN_TEST(test_a_corner_is_passed_nearer_where_chords_leave_the_curve);
    RUN_TEST(test_a_corner_is_not_passed_by_what_only_comes_to_its_place);
    RUN_TEST(test_a_slow_motion_longer_than_two_tolerances_is_not_passed_in_an_instant);
    RUN_TEST(test_of_many_stretches_enough_are_kept);
    RUN_TEST(test_the_place_to_rest_at_is_one_that_can_have_been_come_to);
    return UNITY_END();
}
