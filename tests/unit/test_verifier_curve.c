/*
 * How far the verifier finds points from involutes, and their chords: against points moved aside by
 * a known distance, and against the largest distance of many points of the curve from the chord.
 */
#include "base/maths.h"
#include "verifier/verifier_curve.h"

#include <unity.h>

/* r 2, four turns from the base circle; 30 mm along Z meanwhile. */
static struct curve curve;

static void takt_involute_point(double phi, double x_y[2])
{
    x_y[0] = 2.0 * (takt_maths_cos(phi) + phi * takt_maths_sin(phi));
    x_y[1] = 2.0 * (takt_maths_sin(phi) - phi * takt_maths_cos(phi));
}

void setUp(void)
{
    struct point start = {{2.0, 0.0, 0.0}};
    struct point end = {{0}};

    takt_involute_point(4.0 * MATHS_TWO_PI, end.at);
    end.at[AXIS_Z] = 30.0;
    TEST_ASSERT_TRUE(
        takt_curve_set_involute(&curve, &start, &end, PLANE_XY, (double[2]){0.0, 0.0}, 2.0, false));
}

void tearDown(void)
{
}

static void test_a_point_of_an_involute_is_on_it(void)
{
    for (int i = 0; i <= 100; i++) {
        const double phi = 4.0 * MATHS_TWO_PI * i / 100;
        struct point p = {{0}};
        double fraction = 0.0;

        takt_involute_point(phi, p.at);
        p.at[AXIS_Z] = 30.0 * (i / 100.0) * (i / 100.0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, verifier_curve_distance(&curve, &p, &fraction));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, (i / 100.0) * (i / 100.0), fraction);
    }
}

/* Aside along the string by 0.3 mm in the plane, or by 0.4 mm along Z; or both, 0.5. */
static void test_a_point_beside_an_involute_is_as_far_as_it_was_moved(void)
{
    for (int i = 1; i <= 100; i++) {
        const double phi = 1.0 + 3.5 * MATHS_TWO_PI * i / 100;
        const double share = phi / (4.0 * MATHS_TWO_PI);
        struct point p = {{0}};
        double fraction = 0.0;

        takt_involute_point(phi, p.at);
        p.at[AXIS_X] += 0.3 * takt_maths_sin(phi);
        p.at[AXIS_Y] -= 0.3 * takt_maths_cos(phi);
        p.at[AXIS_Z] = 30.0 * share * share;
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.3, verifier_curve_distance(&curve, &p, &fraction));
        p.at[AXIS_Z] += 0.4;
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, verifier_curve_distance(&curve, &p, &fraction));
    }
}

/* From the base circle itself, over less and more than a turn, and far out. */
static void test_a_chord_error_is_the_largest_distance_from_the_chord(void)
{
    static const double ends[][2] = {{0.0, 0.1}, {0.0, 2.0},  {0.0, 9.0},
                                     {1.0, 1.2}, {8.0, 20.0}, {20.0, 20.1}};

    for (unsigned i = 0; i < sizeof(ends) / sizeof(ends[0]); i++) {
        struct point a = {{0}};
        struct point b = {{0}};
        double most = 0.0;

        takt_involute_point(ends[i][0], a.at);
        takt_involute_point(ends[i][1], b.at);
        const double x = b.at[0] - a.at[0];
        const double y = b.at[1] - a.at[1];

        for (int k = 0; k <= 20000; k++) {
            double p[2];

            takt_involute_point(ends[i][0] + (ends[i][1] - ends[i][0]) * k / 20000, p);
            most = maths_max(most, maths_abs((p[0] - a.at[0]) * y - (p[1] - a.at[1]) * x) /
                                       maths_sqrt(x * x + y * y));
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * most, most, verifier_curve_chord_error(&curve, &a, &b));
        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * most, most, verifier_curve_chord_error(&curve, &b, &a));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_point_of_an_involute_is_on_it);
    RUN_TEST(test_a_point_beside_an_involute_is_as_far_as_it_was_moved);
    RUN_TEST(test_a_chord_error_is_the_largest_distance_from_the_chord);
    return UNITY_END();
}
