#include "base/maths.h"
#include "geometry/curve.h"
#include "unity.h"

#define LENGTH_MM 0.4

static struct curve piece;
static struct curve next;

void setUp(void)
{
    struct point control[5];

    for (int k = 0; k < 5; k++) {
        for (int i = 0; i < AXIS_COUNT; i++) {
            control[k].at[i] = (k * k * k - 3.0 * k * i) * 0.01 + i;
        }
    }
    takt_curve_set_spline(&piece, control, LENGTH_MM);
    takt_curve_set_spline(&next, control + 1, LENGTH_MM);
}

void tearDown(void)
{
}

static void check_same(const struct point *a, const struct point *b, double within)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(within, a->at[i], b->at[i]);
    }
}

static void test_a_piece_goes_from_its_start_to_its_end(void)
{
    struct point p;

    takt_curve_point(&piece, 0.0, &p);
    check_same(&piece.start, &p, 0.0);
    takt_curve_point(&piece, LENGTH_MM, &p);
    check_same(&piece.end, &p, 1e-14);
}

static void test_pieces_join_with_position_tangent_and_curvature(void)
{
    struct point a;
    struct point b;

    check_same(&piece.end, &next.start, 1e-15);
    takt_curve_tangent(&piece, LENGTH_MM, &a);
    takt_curve_tangent(&next, 0.0, &b);
    check_same(&a, &b, 1e-13);
    takt_curve_curvature(&piece, LENGTH_MM, &a);
    takt_curve_curvature(&next, 0.0, &b);
    check_same(&a, &b, 1e-12);
}

/* Differences over a short way stand beside each derivative. */
static void test_tangent_and_curvature_are_the_derivatives_of_the_point(void)
{
    const double s = 0.3 * LENGTH_MM;
    const double h = 1e-5;
    struct point before;
    struct point after;
    struct point derivative;

    takt_curve_point(&piece, s - h, &before);
    takt_curve_point(&piece, s + h, &after);
    takt_curve_tangent(&piece, s, &derivative);
    for (int i = 0; i < AXIS_COUNT; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, (after.at[i] - before.at[i]) / (2 * h), derivative.at[i]);
    }
    takt_curve_tangent(&piece, s - h, &before);
    takt_curve_tangent(&piece, s + h, &after);
    takt_curve_curvature(&piece, s, &derivative);
    for (int i = 0; i < AXIS_COUNT; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, (after.at[i] - before.at[i]) / (2 * h), derivative.at[i]);
    }
}

static void test_bounds_hold_everywhere_on_the_piece(void)
{
    struct curve_bounds bounds;

    takt_curve_bound(&piece, &bounds);
    for (int k = 0; k <= 100; k++) {
        struct point t;
        struct point c;

        takt_curve_tangent(&piece, LENGTH_MM * k / 100.0, &t);
        takt_curve_curvature(&piece, LENGTH_MM * k / 100.0, &c);
        for (int i = 0; i < AXIS_COUNT; i++) {
            TEST_ASSERT_TRUE(maths_abs(t.at[i]) <= bounds.first[i] + 1e-12);
            TEST_ASSERT_TRUE(maths_abs(c.at[i]) <= bounds.second[i] + 1e-12);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_piece_goes_from_its_start_to_its_end);
    RUN_TEST(test_pieces_join_with_position_tangent_and_curvature);
    RUN_TEST(test_tangent_and_curvature_are_the_derivatives_of_the_point);
    RUN_TEST(test_bounds_hold_everywhere_on_the_piece);
    return UNITY_END();
}
