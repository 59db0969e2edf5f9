#include "base/maths.h"
#include "geometry/curve.h"

#include <string.h>
#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static struct point at(double x, double y, double z)
{
    return (struct point){{x, y, z, 0.0, 0.0, 0.0}};
}

static double distance(const struct point *a, const struct point *b)
{
    double sum = 0.0;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        sum += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    }
    return maths_sqrt(sum);
}

static struct curve arc_of(struct point start, struct point end, double cx, double cy,
                           bool clockwise, unsigned turns)
{
    struct curve c;

    TEST_ASSERT_TRUE(
        takt_curve_set_arc(&c, &start, &end, PLANE_XY, (double[2]){cx, cy}, clockwise, turns));
    return c;
}

/*
 * Length of the polyline through n points at equal steps of s: below the curve's length, and near
 * it.
 */
static double measured_length(const struct curve *c, int n)
{
    struct point last = c->start;
    double sum = 0.0;

    for (int i = 1; i <= n; i++) {
        struct point p;

        takt_curve_point(c, c->length_mm * i / n, &p);
        sum += distance(&p, &last);
        last = p;
    }
    return sum;
}

static void test_a_line_is_as_long_as_its_ends_are_apart(void)
{
    struct curve c;
    const struct point start = at(1.0, 2.0, 3.0);
    const struct point end = at(4.0, 6.0, 15.0);

    TEST_ASSERT_TRUE(takt_curve_set_line(&c, &start, &end));
    TEST_ASSERT_EQUAL_DOUBLE(13.0, c.length_mm);
    TEST_ASSERT_FALSE(takt_curve_is_rotary(&c));
}

static void test_a_line_without_length_is_refused(void)
{
    struct curve c;
    const struct point p = at(1.0, 2.0, 3.0);

    TEST_ASSERT_FALSE(takt_curve_set_line(&c, &p, &p));
}

static void test_a_line_of_rotary_axes_alone_is_measured_in_radians(void)
{
    struct curve c;
    struct point start = at(0.0, 0.0, 0.0);
    struct point end = start;

    end.at[AXIS_B] = 3.0;
    end.at[AXIS_C] = -4.0;
    TEST_ASSERT_TRUE(takt_curve_set_line(&c, &start, &end));
    TEST_ASSERT_EQUAL_DOUBLE(5.0, c.length_mm);
    TEST_ASSERT_TRUE(takt_curve_is_rotary(&c));
}

static void test_rotary_axes_follow_the_length_of_the_linear_ones(void)
{
    struct curve c;
    struct point start = at(0.0, 0.0, 0.0);
    struct point end = at(10.0, 0.0, 0.0);
    struct point p;

    end.at[AXIS_A] = 1.0;
    TEST_ASSERT_TRUE(takt_curve_set_line(&c, &start, &end));
    takt_curve_point(&c, 2.5, &p);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.25, p.at[AXIS_A]);
}

static void test_rounding_of_linear_axes_does_not_hide_a_turn(void)
{
    const struct point start = at(0.0, 0.0, 0.0);
    struct point end = at(1e-13, 0.0, 0.0);
    struct curve c;

    end.at[AXIS_A] = 1.5;
    TEST_ASSERT_TRUE(takt_curve_set_line(&c, &start, &end));
    TEST_ASSERT_TRUE(takt_curve_is_rotary(&c));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.5, c.length_mm);
}

static void test_a_quarter_circle_has_a_quarter_of_the_circumference(void)
{
    const struct curve c = arc_of(at(10.0, 0.0, 0.0), at(0.0, 10.0, 0.0), 0.0, 0.0, false, 1);

    TEST_ASSERT_DOUBLE_WITHIN(1e-13, 10.0 * MATHS_HALF_PI, c.length_mm);
}

static void test_the_other_direction_takes_the_rest_of_the_circle(void)
{
    const struct curve c = arc_of(at(10.0, 0.0, 0.0), at(0.0, 10.0, 0.0), 0.0, 0.0, true, 1);

    TEST_ASSERT_DOUBLE_WITHIN(1e-13, 30.0 * MATHS_HALF_PI, c.length_mm);
}

static void test_equal_ends_make_a_full_circle_and_turns_add_to_it(void)
{
    const struct curve one = arc_of(at(3.0, 4.0, 0.0), at(3.0, 4.0, 0.0), 0.0, 0.0, true, 1);
    const struct curve three = arc_of(at(3.0, 4.0, 0.0), at(3.0, 4.0, 0.0), 0.0, 0.0, true, 3);

    TEST_ASSERT_DOUBLE_WITHIN(1e-13, 5.0 * MATHS_TWO_PI, one.length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-13, 15.0 * MATHS_TWO_PI, three.length_mm);
}

static void test_a_helix_is_as_long_as_its_unrolled_line(void)
{
    const struct curve c = arc_of(at(10.0, 0.0, 0.0), at(10.0, 0.0, 7.0), 0.0, 0.0, false, 1);
    const double round = 10.0 * MATHS_TWO_PI;

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, maths_sqrt(round * round + 49.0), c.length_mm);
}

static void test_every_plane_turns_from_its_first_axis_to_its_second(void)
{
    static const enum plane planes[] = {PLANE_XY, PLANE_ZX, PLANE_YZ};

    for (int i = 0; i < 3; i++) {
        enum axis first, second;
        struct point start = at(0.0, 0.0, 0.0);
        struct point end = start;
        struct point middle;
        struct curve c;

        takt_plane_axes(planes[i], &first, &second);
        start.at[first] = 2.0;
        end.at[second] = 2.0;
        TEST_ASSERT_TRUE(
            takt_curve_set_arc(&c, &start, &end, planes[i], (double[2]){0.0, 0.0}, false, 1));
        takt_curve_point(&c, 0.5 * c.length_mm, &middle);
        TEST_ASSERT_DOUBLE_WITHIN(1e-14, maths_sqrt(2.0), middle.at[first]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-14, maths_sqrt(2.0), middle.at[second]);
    }
}

static void test_an_arc_of_radius_zero_is_refused(void)
{
    const struct point p = at(1.0, 1.0, 0.0);
    struct curve c;

    TEST_ASSERT_FALSE(takt_curve_set_arc(&c, &p, &p, PLANE_XY, (double[2]){1.0, 1.0}, false, 1));
}

/* Arcs of many kinds, the last two with radii that differ. */
static const struct {
    struct point start, end;
    double cx, cy;
    bool clockwise;
    unsigned turns;
} arcs[] = {
    {{{10, 0, 0, 0, 0, 0}}, {{0, 10, 0, 0, 0, 0}}, 0, 0, false, 1},
    {{{10, 0, 0, 0, 0, 0}}, {{0, 10, 5, 0, 0, 0}}, 0, 0, true, 2},
    {{{-3, 4, 1, 0, 0, 0}}, {{-3, 4, -2, 0, 0.5, 0}}, 0, 0, true, 1},
    {{{10, 0, 0, 0, 0, 0}}, {{0, 10.01, 2, 0, 0, 0}}, 0, 0, false, 1},
    {{{0.05, 0, 0, 0, 0, 0}}, {{0, 0.06, 0, 0, 0, 0}}, 0, 0, true, 1},
};

#define ARCS (sizeof(arcs) / sizeof(arcs[0]))

static struct curve arc_number(unsigned i)
{
    return arc_of(arcs[i].start, arcs[i].end, arcs[i].cx, arcs[i].cy, arcs[i].clockwise,
                  arcs[i].turns);
}

static void test_an_arc_starts_and_ends_where_it_was_told(void)
{
    for (unsigned i = 0; i < ARCS; i++) {
        const struct curve c = arc_number(i);
        struct point p;

        takt_curve_point(&c, 0.0, &p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, 0.0, distance(&p, &c.start));
        takt_curve_point(&c, c.length_mm, &p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, 0.0, distance(&p, &c.end));
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, c.end.at[AXIS_B], p.at[AXIS_B]);
    }
}

static void test_an_arc_that_closes_but_for_rounding_ends_where_it_was_told(void)
{
    static const double off_mm[] = {-9e-8, -1e-12, 1e-12, 9e-8};

    for (int i = 0; i < 8; i++) {
        const double radius = 0.002;
        const double y = off_mm[i / 2];
        const double x = maths_sqrt(radius * radius - y * y);
        const struct curve c = arc_of(at(radius, 0.0, 0.0), at(x, y, 0.0), 0.0, 0.0, i % 2 != 0, 1);
        struct point p;

        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 1.0, c.length_mm / (radius * MATHS_TWO_PI));
        takt_curve_point(&c, c.length_mm, &p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-17, 0.0, distance(&p, &c.end));
    }
}

static void test_steps_of_equal_length_are_equally_far_apart(void)
{
    for (unsigned i = 0; i < ARCS; i++) {
        const struct curve c = arc_number(i);
        const double tolerance = c.arc.radius_change_mm == 0.0 ? 1e-9 : 2e-3;

        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * c.length_mm, c.length_mm, measured_length(&c, 20000));
        for (int k = 0; k < 1000; k++) {
            struct point a, b;

            takt_curve_point(&c, c.length_mm * k * 1e-3, &a);
            takt_curve_point(&c, c.length_mm * (k + 0.001) * 1e-3, &b);
            TEST_ASSERT_DOUBLE_WITHIN(tolerance, 1.0, distance(&a, &b) / (c.length_mm * 1e-6));
        }
    }
}

static void test_tangent_and_curvature_are_the_derivatives_of_the_point(void)
{
    for (unsigned i = 0; i < ARCS; i++) {
        const struct curve c = arc_number(i);
        const double h = c.length_mm * 1e-4;

        for (int k = 1; k < 100; k++) {
            const double s = c.length_mm * k * 0.01;
            struct point before, here, after, t, kappa;

            takt_curve_point(&c, s - h, &before);
            takt_curve_point(&c, s, &here);
            takt_curve_point(&c, s + h, &after);
            takt_curve_tangent(&c, s, &t);
            takt_curve_curvature(&c, s, &kappa);
            for (int axis = 0; axis < AXIS_COUNT; axis++) {
                const double first = (after.at[axis] - before.at[axis]) / (2.0 * h);
                const double second =
                    (after.at[axis] - 2.0 * here.at[axis] + before.at[axis]) / (h * h);

                TEST_ASSERT_DOUBLE_WITHIN(1e-6, first, t.at[axis]);
                TEST_ASSERT_DOUBLE_WITHIN(1e-5 / c.length_mm, second, kappa.at[axis]);
            }
        }
    }
}

static void test_bounds_hold_everywhere_on_the_curve(void)
{
    for (unsigned i = 0; i < ARCS; i++) {
        const struct curve c = arc_number(i);
        struct curve_bounds b;

        takt_curve_bound(&c, &b);
        for (int k = 0; k <= 100; k++) {
            struct point t, kappa;

            takt_curve_tangent(&c, c.length_mm * k * 0.01, &t);
            takt_curve_curvature(&c, c.length_mm * k * 0.01, &kappa);
            for (int axis = 0; axis < AXIS_COUNT; axis++) {
                TEST_ASSERT_TRUE(maths_abs(t.at[axis]) <= b.first[axis] * (1.0 + 1e-12));
                TEST_ASSERT_TRUE(maths_abs(kappa.at[axis]) <= b.second[axis] * (1.0 + 1e-12));
            }
        }
    }
}

/* Small radii may differ much and still be within an interpreter's tolerance. */
static void test_an_arc_of_two_very_different_radii_never_turns_back(void)
{
    static const double ratios[] = {0.02, 0.1, 10.0, 50.0};

    for (int i = 0; i < 4; i++) {
        const struct curve c =
            arc_of(at(0.002, 0.0, 0.0), at(0.0, 0.002 * ratios[i], 0.001), 0.0, 0.0, false, 1);
        double last = 0.0;

        for (int k = 1; k <= 1000; k++) {
            struct point p;

            takt_curve_point(&c, c.length_mm * k * 1e-3, &p);
            TEST_ASSERT_TRUE(p.at[AXIS_Z] > last);
            last = p.at[AXIS_Z];
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-16, 0.001, last);
    }
}

static double along(const struct point *a, const struct point *b)
{
    return a->at[AXIS_X] * b->at[AXIS_X] + a->at[AXIS_Y] * b->at[AXIS_Y];
}

/* Third derivatives by differences of second ones. */
static void test_bounds_of_an_arc_of_two_radii_tell_how_far_it_is_from_a_circle(void)
{
    static const double ratios[] = {0.5, 0.999, 1.001, 2.0};

    for (int i = 0; i < 4; i++) {
        const struct curve c =
            arc_of(at(2.0, 0.0, 0.0), at(0.0, 2.0 * ratios[i], 0.0), 0.0, 0.0, false, 1);
        const double h = c.length_mm * 1e-5;
        struct curve_bounds b;

        takt_curve_bound(&c, &b);
        TEST_ASSERT_TRUE(b.second_along <= 10.0 * maths_abs(ratios[i] - 1.0) * b.second[AXIS_X]);
        for (int k = 1; k < 100; k++) {
            const double s = c.length_mm * k * 0.01;
            struct point t, k0, k1, third, normal;

            takt_curve_tangent(&c, s, &t);
            takt_curve_curvature(&c, s - h, &k0);
            takt_curve_curvature(&c, s + h, &k1);
            for (int axis = 0; axis < AXIS_COUNT; axis++) {
                third.at[axis] = (k1.at[axis] - k0.at[axis]) / (2.0 * h);
            }
            takt_curve_curvature(&c, s, &k0);
            normal = at(-t.at[AXIS_Y], t.at[AXIS_X], 0.0);
            const double size = maths_sqrt(along(&t, &t));

            TEST_ASSERT_TRUE(maths_abs(along(&k0, &t)) <= b.second_along * size * (1.0 + 1e-9));
            TEST_ASSERT_TRUE(maths_abs(along(&third, &normal)) <=
                             b.third_across * size + 1e-7 * b.third[AXIS_X]);
        }
    }
}

static void test_an_arc_of_two_radii_changes_its_radius_linearly_with_the_angle(void)
{
    const struct curve c = arc_number(4);

    for (int k = 0; k <= 100; k++) {
        struct point p;
        double radius, fraction;

        takt_curve_point(&c, c.length_mm * k * 0.01, &p);
        radius = maths_sqrt(p.at[0] * p.at[0] + p.at[1] * p.at[1]);
        fraction = -takt_maths_atan2(p.at[1], p.at[0]) / (1.5 * MATHS_PI);
        fraction = fraction < -1e-12 ? fraction + 2.0 / 1.5 : fraction;
        TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.05 + 0.01 * fraction, radius);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_line_is_as_long_as_its_ends_are_apart);
    RUN_TEST(test_a_line_without_length_is_refused);
    RUN_TEST(test_a_line_of_rotary_axes_alone_is_measured_in_radians);
    RUN_TEST(test_rotary_axes_follow_the_length_of_the_linear_ones);
    RUN_TEST(test_rounding_of_linear_axes_does_not_hide_a_turn);
    RUN_TEST(test_a_quarter_circle_has_a_quarter_of_the_circumference);
    RUN_TEST(test_the_other_direction_takes_the_rest_of_the_circle);
    RUN_TEST(test_equal_ends_make_a_full_circle_and_turns_add_to_it);
    RUN_TEST(test_a_helix_is_as_long_as_its_unrolled_line);
    RUN_TEST(test_every_plane_turns_from_its_first_axis_to_its_second);
    RUN_TEST(test_an_arc_of_radius_zero_is_refused);
    RUN_TEST(test_an_arc_starts_and_ends_where_it_was_told);
    RUN_TEST(test_an_arc_that_closes_but_for_rounding_ends_where_it_was_told);
    RUN_TEST(test_steps_of_equal_length_are_equally_far_apart);
    RUN_TEST(test_tangent_and_curvature_are_the_derivatives_of_the_point);
    RUN_TEST(test_bounds_hold_everywhere_on_the_curve);
    RUN_TEST(test_an_arc_of_two_very_different_radii_never_turns_back);
    RUN_TEST(test_bounds_of_an_arc_of_two_radii_tell_how_far_it_is_from_a_circle);
    RUN_TEST(test_an_arc_of_two_radii_changes_its_radius_linearly_with_the_angle);
    return UNITY_END();
}
