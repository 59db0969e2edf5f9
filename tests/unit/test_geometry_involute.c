/*
 * Involutes against their definition (seed 001, eq. 2, 6, 11) and against differences of their own
 * points.
 */
#include "base/maths.h"
#include "geometry/involute.h"

#include <string.h>
#include <unity.h>

/* The numbers of the page: roughing a hole of 200 mm with a cutter of 40, n = 20. */
#define ROUGH_R    79.0
#define ROUGH_N    20.0
#define ROUGH_PHI  (MATHS_TWO_PI * ROUGH_N)
#define ROUGH_BASE (ROUGH_R / ROUGH_PHI)

static uint64_t seed;

void setUp(void)
{
    seed = 1;
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/* The page's curve: unrolled counter-clockwise from the origin, turned by psi. */
static void page_point(double r, double phi, double psi, double *x, double *y)
{
    *x = r * (takt_maths_cos(phi + psi) + phi * takt_maths_sin(phi + psi) - takt_maths_cos(psi));
    *y = r * (takt_maths_sin(phi + psi) - phi * takt_maths_cos(phi + psi) - takt_maths_sin(psi));
}

/*
 * The same as a curve of this room, from one angle to another. way -1: its mirror image in the X
 * axis.
 */
static struct curve page_curve(double r, double from, double to, double psi, double way)
{
    const double centre[2] = {-r * takt_maths_cos(psi), -way * r * takt_maths_sin(psi)};
    struct point start;
    struct point end;
    struct curve c;

    memset(&start, 0, sizeof(start));
    memset(&end, 0, sizeof(end));
    page_point(r, from, psi, &start.at[AXIS_X], &start.at[AXIS_Y]);
    page_point(r, to, psi, &end.at[AXIS_X], &end.at[AXIS_Y]);
    start.at[AXIS_Y] *= way;
    end.at[AXIS_Y] *= way;
    TEST_ASSERT_TRUE(
        takt_curve_set_involute(&c, &start, &end, PLANE_XY, centre, r, (to > from) == (way < 0.0)));
    return c;
}

static double distance(const struct point *a, const struct point *b)
{
    double sum = 0.0;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        sum += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    }
    return maths_sqrt(sum);
}

/* At the share u of its length the curve has the page's phi^2 between both ends. */
static void check_against_page(double r, double from, double to, double psi, double way)
{
    const struct curve c = page_curve(r, from, to, psi, way);

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5 * r * maths_abs(to * to - from * from), c.length_mm);
    for (int i = 0; i <= 50; i++) {
        const double u = i / 50.0;
        const double phi = maths_sqrt(from * from + u * (to * to - from * from));
        struct point p;
        double x;
        double y;

        page_point(r, phi, psi, &x, &y);
        takt_curve_point(&c, u * c.length_mm, &p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, x, p.at[AXIS_X]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-10, way * y, p.at[AXIS_Y]);
    }
}

static void test_points_are_those_of_the_formula(void)
{
    check_against_page(ROUGH_BASE, 0.0, ROUGH_PHI, 0.0, 1.0);
    check_against_page(ROUGH_BASE, 0.0, ROUGH_PHI, 2.0, -1.0);
    check_against_page(6.366197724, 9.04482, 2.0 * MATHS_TWO_PI, 0.94657, 1.0);
    check_against_page(5.0, 1.0, 2.0, -3.0, 1.0);
}

static void test_winding_inward_is_the_same_curve_backwards(void)
{
    check_against_page(ROUGH_BASE, ROUGH_PHI, 0.0, 0.0, 1.0);
    check_against_page(ROUGH_BASE, ROUGH_PHI, 0.0, 1.0, -1.0);
    check_against_page(5.0, 2.0, 1.0, -3.0, -1.0);
}

static void test_the_roughing_spiral_is_as_long_as_the_page_says(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(5e-6, 4963.71639,
                              page_curve(ROUGH_BASE, 0.0, ROUGH_PHI, 0.0, 1.0).length_mm);
}

/* Tangent and curvature against differences of points and tangents. */
static void test_derivatives_are_those_of_the_points(void)
{
    const struct curve c = page_curve(3.0, 8.0, 0.5, 1.0, -1.0);
    const double h = 1e-4;

    for (int i = 1; i < 50; i++) {
        const double s = c.length_mm * i / 50.0;
        struct point before, behind, t, t0, t1, k;

        takt_curve_point(&c, s - h, &before);
        takt_curve_point(&c, s + h, &behind);
        takt_curve_tangent(&c, s, &t);
        takt_curve_tangent(&c, s - h, &t0);
        takt_curve_tangent(&c, s + h, &t1);
        takt_curve_curvature(&c, s, &k);
        for (int a = 0; a < AXIS_LINEAR_COUNT; a++) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-8, (behind.at[a] - before.at[a]) / (2 * h), t.at[a]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-7, (t1.at[a] - t0.at[a]) / (2 * h), k.at[a]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, maths_sqrt(t.at[0] * t.at[0] + t.at[1] * t.at[1]));
        const double change = (takt_involute_curvature_change(&c, s + h).curvature_1_mm -
                               takt_involute_curvature_change(&c, s - h).curvature_1_mm) /
                              (2 * h);

        TEST_ASSERT_DOUBLE_WITHIN(1e-6, change, takt_involute_curvature_change(&c, s).change_1_mm2);
    }
}

/* G2 and no more: curvature goes on, its derivative steps by 1 / (phi R^2). */
static void test_the_junction_with_the_circle_keeps_curvature_and_not_its_derivative(void)
{
    const struct curve c = page_curve(ROUGH_BASE, 0.0, ROUGH_PHI, 0.0, 1.0);
    const struct involute_curvature bend = takt_involute_curvature_change(&c, c.length_mm);
    struct curve circle;
    struct point t0, t1, k0, k1;

    TEST_ASSERT_TRUE(
        takt_curve_set_arc(&circle, &c.end, &c.end, PLANE_XY, (double[2]){0.0, 0.0}, false, 1));
    takt_curve_tangent(&c, c.length_mm, &t0);
    takt_curve_tangent(&circle, 0.0, &t1);
    takt_curve_curvature(&c, c.length_mm, &k0);
    takt_curve_curvature(&circle, 0.0, &k1);
    TEST_ASSERT_TRUE(distance(&t0, &t1) < 1e-9);
    TEST_ASSERT_TRUE(distance(&k0, &k1) < 1e-9);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1.0 / ROUGH_R, bend.curvature_1_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.0 / (ROUGH_PHI * ROUGH_R * ROUGH_R), bend.change_1_mm2);
}

/*
 * The page: at constant feed the jerk is sqrt(1 + 1/phi^2) times the circle's, 5.1 times at
 * phi = 0.2.
 */
static void test_the_third_derivative_is_larger_than_a_circles_by_the_pages_factor(void)
{
    const struct curve c = page_curve(2.0, 0.2, 9.0, 0.0, 1.0);
    const double h = 1e-4;
    struct curve_bounds b;

    takt_curve_bound(&c, &b);
    const double factor =
        maths_sqrt(b.third[AXIS_X] * b.third[AXIS_X] + b.third_across * b.third_across) /
        (b.second[AXIS_X] * b.second[AXIS_X]);

    TEST_ASSERT_DOUBLE_WITHIN(0.005, 5.1, factor);
    for (int i = 1; i < 20; i++) {
        const double s = c.length_mm * i / 20.0;
        const double phi = takt_involute_unrolled(&c, s);
        const double circle = 1.0 / (4.0 * phi * phi);
        struct point k0, k1;

        takt_curve_curvature(&c, s - h, &k0);
        takt_curve_curvature(&c, s + h, &k1);
        const double third = distance(&k0, &k1) / (2.0 * h);

        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * third, circle * maths_sqrt(1.0 + 1.0 / (phi * phi)),
                                  third);
        TEST_ASSERT_TRUE(third <= factor * b.second[AXIS_X] * b.second[AXIS_X]);
    }
}

static void test_another_axis_moves_in_proportion_to_the_length(void)
{
    const double r = 2.0;
    struct point start = {{0}};
    struct point end = {{0}};
    struct curve c;

    start.at[AXIS_Z] = r; /* G18: the first axis is Z */
    page_point(r, 7.0, 0.0, &end.at[AXIS_Z], &end.at[AXIS_X]);
    end.at[AXIS_Z] += r;
    end.at[AXIS_Y] = 12.0;
    end.at[AXIS_A] = 0.5;
    TEST_ASSERT_TRUE(
        takt_curve_set_involute(&c, &start, &end, PLANE_ZX, (double[2]){0.0, 0.0}, r, false));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, maths_sqrt(49.0 * 49.0 + 144.0), c.length_mm);
    struct point last = start;
    double length = 0.0;

    for (int i = 1; i <= 20000; i++) {
        struct point p;

        takt_curve_point(&c, c.length_mm * i / 20000, &p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 12.0 * i / 20000, p.at[AXIS_Y]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5 * i / 20000, p.at[AXIS_A]);
        length += distance(&p, &last);
        last = p;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, c.length_mm, length);
    TEST_ASSERT_TRUE(distance(&last, &end) < 1e-12);
}

static void test_ends_that_no_involute_joins_are_refused(void)
{
    const struct point start = {{10.0, 0.0}};
    const struct point end = {{0.0, 10.0}};
    const struct point centre = {{0.0, 0.0}};
    const struct point inside = {{8.0, 0.0}};
    struct curve c;

    TEST_ASSERT_FALSE(
        takt_curve_set_involute(&c, &start, &end, PLANE_XY, (double[2]){0.0, 0.0}, 5.0, false));
    TEST_ASSERT_FALSE(
        takt_curve_set_involute(&c, &centre, &end, PLANE_XY, (double[2]){0.0, 0.0}, 5.0, false));
    TEST_ASSERT_FALSE(
        takt_curve_set_involute(&c, &inside, &end, PLANE_XY, (double[2]){0.0, 0.0}, 10.0, false));
}

/*
 * Distance of p from the involute wanted, along its normal: the string from p touches the base
 * circle.
 */
static double off_page(const struct point *p, double r, double psi)
{
    const double x = p->at[AXIS_X] + r * takt_maths_cos(psi);
    const double y = p->at[AXIS_Y] + r * takt_maths_sin(psi);
    const double d = maths_sqrt(x * x + y * y);
    const double phi = d > r ? maths_sqrt((d / r - 1.0) * (d / r + 1.0)) : 0.0;
    const double turned = takt_maths_atan2(y, x) - psi - (phi - takt_maths_atan2(phi, 1.0));

    return r * maths_abs(turned - MATHS_TWO_PI * takt_maths_round(turned / MATHS_TWO_PI)) +
           maths_max(0.0, r - d);
}

/* Ends moved by up to off_mm: the curve hits them and is nowhere farther from the wanted one. */
static void check_rounded(double r, double from, double to, double off_mm)
{
    const double centre[2] = {-r, 0.0};
    struct point end[2] = {{{0}}, {{0}}};
    struct curve c;
    struct point p;

    page_point(r, from, 0.0, &end[0].at[AXIS_X], &end[0].at[AXIS_Y]);
    page_point(r, to, 0.0, &end[1].at[AXIS_X], &end[1].at[AXIS_Y]);
    for (int i = 0; i < 4; i++) {
        end[i / 2].at[i % 2] += random_between(-off_mm, off_mm);
    }
    TEST_ASSERT_TRUE(takt_curve_set_involute(&c, &end[0], &end[1], PLANE_XY, centre, r, to < from));
    takt_curve_point(&c, 0.0, &p);
    TEST_ASSERT_TRUE(distance(&p, &end[0]) < 1e-9);
    takt_curve_point(&c, c.length_mm, &p);
    TEST_ASSERT_TRUE(distance(&p, &end[1]) < 1e-9);
    for (int i = 0; i <= 40; i++) {
        takt_curve_point(&c, c.length_mm * i / 40, &p);
        TEST_ASSERT_TRUE(off_page(&p, r, 0.0) < 4.5 * off_mm);
    }
}

static void test_rounded_ends_are_hit_and_the_curve_stays_beside_the_wanted_one(void)
{
    for (int i = 0; i < 2000; i++) {
        const double r = takt_maths_power(10.0, random_between(-1.0, 2.0));
        const double inner = i % 3 == 0 ? 0.0 : random_between(0.0, 20.0);
        const double outer = inner + random_between(1.0, 30.0);
        const double off_mm = takt_maths_power(10.0, random_between(-9.0, -2.5));

        check_rounded(r, i % 2 == 0 ? inner : outer, i % 2 == 0 ? outer : inner, off_mm);
    }
}

static void test_a_million_random_involutes_end_where_they_should(void)
{
    static const double specks[4] = {0.0, 1e-15, 1e-12, 1e-9};
    double worst = 0.0;

    for (int i = 0; i < 1000000; i++) {
        const double r = takt_maths_power(10.0, random_between(-2.0, 2.0));
        const double outer = random_between(0.01, 200.0);
        const double inner = i % 8 < 4 ? specks[i % 4] / r : outer * random_between(0.0, 0.999);
        const double start = i % 2 == 0 ? inner : outer;
        const double end = i % 2 == 0 ? outer : inner;
        struct point a = {{0}};
        struct point b = {{0}};
        struct point p;
        struct curve c;

        page_point(r, start, 0.0, &a.at[AXIS_X], &a.at[AXIS_Y]);
        page_point(r, end, 0.0, &b.at[AXIS_X], &b.at[AXIS_Y]);
        TEST_ASSERT_TRUE(
            takt_curve_set_involute(&c, &a, &b, PLANE_XY, (double[2]){-r, 0.0}, r, end < start));
        takt_curve_point(&c, 0.0, &p);
        worst = maths_max(worst, distance(&p, &a) / maths_max(1.0, r * outer));
        takt_curve_point(&c, c.length_mm, &p);
        worst = maths_max(worst, distance(&p, &b) / maths_max(1.0, r * outer));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, worst);
}

/*
 * Pieces go on where the one before ended, and within each curvature changes by a quarter at most.
 */
static void check_pieces(const struct curve *c, unsigned pieces_max)
{
    struct point at = c->start;
    double from = 0.0;
    unsigned count = 0;

    while (from < c->length_mm) {
        const double to = takt_curve_piece_end(c, from);
        struct curve piece;
        struct point p;

        TEST_ASSERT_TRUE(to > from);
        takt_curve_cut(c, from, to, &piece);
        TEST_ASSERT_TRUE(distance(&piece.start, &at) < 1e-12);
        takt_curve_point(&piece, 0.0, &p);
        TEST_ASSERT_TRUE(distance(&p, &at) < 1e-10);
        takt_curve_point(&piece, piece.length_mm, &p);
        TEST_ASSERT_TRUE(distance(&p, &piece.end) < 1e-10);
        const double k0 = takt_involute_curvature_change(&piece, 0.0).curvature_1_mm;
        const double k1 = takt_involute_curvature_change(&piece, piece.length_mm).curvature_1_mm;
        const bool cusp = takt_curve_starts_at_cusp(&piece) || takt_curve_ends_at_cusp(&piece);

        TEST_ASSERT_TRUE(cusp || maths_max(k0, k1) <= maths_min(k0, k1) * 1.2500001);
        at = piece.end;
        from = to;
        count++;
    }
    TEST_ASSERT_TRUE(distance(&at, &c->end) == 0.0);
    TEST_ASSERT_TRUE(count >= 1 && count <= pieces_max);
}

static void test_pieces_follow_each_other_with_bounded_curvature(void)
{
    struct curve c = page_curve(ROUGH_BASE, 0.0, ROUGH_PHI, 0.0, 1.0);

    check_pieces(&c, 23); /* ln(phi) / ln(1.25), and the cusp */
    c = page_curve(ROUGH_BASE, ROUGH_PHI, 0.0, 0.0, 1.0);
    check_pieces(&c, 23);
    c = page_curve(5.0, 0.0, 1.2, 0.0, 1.0);
    check_pieces(&c, 1);
    c = page_curve(5.0, 1.2, 0.05, 0.0, 1.0);
    check_pieces(&c, 1);
    c = page_curve(5.0, 0.3, 40.0, 0.0, -1.0);
    check_pieces(&c, 22);
}

static void test_only_an_end_on_the_base_circle_is_a_cusp(void)
{
    struct curve c = page_curve(5.0, 0.0, 9.0, 0.0, 1.0);

    TEST_ASSERT_TRUE(takt_curve_starts_at_cusp(&c) && !takt_curve_ends_at_cusp(&c));
    c = page_curve(5.0, 9.0, 0.0, 0.0, 1.0);
    TEST_ASSERT_TRUE(!takt_curve_starts_at_cusp(&c) && takt_curve_ends_at_cusp(&c));
    c = page_curve(5.0, 9.0, 0.5, 0.0, 1.0);
    TEST_ASSERT_TRUE(!takt_curve_starts_at_cusp(&c) && !takt_curve_ends_at_cusp(&c));
}

static void test_the_farthest_point_is_an_end_or_an_extreme(void)
{
    const struct curve c = page_curve(2.0, 40.0, 1.0, 0.7, -1.0);

    double extreme[2][2]; /* axis; least, most */
    struct point p;

    for (unsigned axis = 0; axis < 2; axis++) {
        extreme[axis][0] = maths_min(c.start.at[axis], c.end.at[axis]);
        extreme[axis][1] = maths_max(c.start.at[axis], c.end.at[axis]);
    }
    for (unsigned quarter = 0; quarter < 4; quarter++) {
        const unsigned axis = quarter % 2 == 0 ? AXIS_Y : AXIS_X;
        double s;

        TEST_ASSERT_TRUE(takt_involute_extreme(&c, quarter, &s));
        takt_curve_point(&c, s, &p);
        extreme[axis][0] = maths_min(extreme[axis][0], p.at[axis]);
        extreme[axis][1] = maths_max(extreme[axis][1], p.at[axis]);
    }
    for (int i = 0; i <= 100000; i++) {
        takt_curve_point(&c, c.length_mm * i / 100000, &p);
        for (unsigned axis = 0; axis < 2; axis++) {
            TEST_ASSERT_TRUE(p.at[axis] >= extreme[axis][0] - 1e-12);
            TEST_ASSERT_TRUE(p.at[axis] <= extreme[axis][1] + 1e-12);
        }
    }
}

/*
 * The page: a first step of 0.05 mm at r 0.63 is 2 um off. No step of the length allowed is farther
 * off.
 */
static void test_no_chord_of_the_longest_step_leaves_the_curve_farther(void)
{
    const struct curve c = page_curve(0.63, 0.0, 20.0, 0.0, 1.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.05, takt_involute_step_max(&c, 0.00197));
    const double step = takt_involute_step_max(&c, 1e-3);
    double worst = 0.0;

    for (int i = 0; i < 200; i++) {
        const double from = i * step / 20.0;
        struct point a;
        struct point b;

        takt_curve_point(&c, from, &a);
        takt_curve_point(&c, from + step, &b);
        for (int k = 1; k < 50; k++) {
            struct point p;

            takt_curve_point(&c, from + step * k / 50.0, &p);
            worst = maths_max(worst, maths_abs((p.at[0] - a.at[0]) * (b.at[1] - a.at[1]) -
                                               (p.at[1] - a.at[1]) * (b.at[0] - a.at[0])) /
                                         distance(&a, &b));
        }
    }
    TEST_ASSERT_TRUE(worst <= 1e-3);
    TEST_ASSERT_TRUE(worst >= 0.97e-3);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_points_are_those_of_the_formula);
    RUN_TEST(test_winding_inward_is_the_same_curve_backwards);
    RUN_TEST(test_the_roughing_spiral_is_as_long_as_the_page_says);
    RUN_TEST(test_derivatives_are_those_of_the_points);
    RUN_TEST(test_the_junction_with_the_circle_keeps_curvature_and_not_its_derivative);
    RUN_TEST(test_the_third_derivative_is_larger_than_a_circles_by_the_pages_factor);
    RUN_TEST(test_another_axis_moves_in_proportion_to_the_length);
    RUN_TEST(test_ends_that_no_involute_joins_are_refused);
    RUN_TEST(test_rounded_ends_are_hit_and_the_curve_stays_beside_the_wanted_one);
    RUN_TEST(test_a_million_random_involutes_end_where_they_should);
    RUN_TEST(test_pieces_follow_each_other_with_bounded_curvature);
    RUN_TEST(test_only_an_end_on_the_base_circle_is_a_cusp);
    RUN_TEST(test_the_farthest_point_is_an_end_or_an_extreme);
    RUN_TEST(test_no_chord_of_the_longest_step_leaves_the_curve_farther);
    return UNITY_END();
}
