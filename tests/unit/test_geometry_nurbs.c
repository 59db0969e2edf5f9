/*
 * Pieces of NURBS against closed forms: the circle, Bernstein's cubic, the basis functions of
 * B-splines by their recursion; and against differences of their own points.
 */
#include "base/maths.h"
#include "geometry/nurbs.h"
#include "geometry/quintic.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define PIECES_MAX 4000
#define POINTS_MAX 40
#define LOOKS      16

/* 1e-9 mm on the exact path; a thousandth more is rounding of coordinates. */
#define NEAR_MM (2.002 * error_mm)

static uint64_t seed;
static double error_mm; /* asked for */
static struct curve piece[PIECES_MAX];
static unsigned pieces;

void setUp(void)
{
    seed = 1;
    error_mm = NURBS_ERROR_MM;
    pieces = 0;
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

/* A whole curve: points with weights, and knots. */
struct whole {
    unsigned order, count;
    double point[POINTS_MAX][3], knot[POINTS_MAX + NURBS_ORDER_MAX];
};

static void set_open_knots(struct whole *w)
{
    const unsigned last = w->count - 1;

    for (unsigned i = 0; i < w->count + w->order; i++) {
        w->knot[i] = i < w->order ? 0.0 : i <= last ? i - w->order + 1.0 : last - w->order + 2.0;
    }
}

static enum nurbs_result take_pieces(struct nurbs *n, struct point *at)
{
    struct nurbs_piece p;
    enum nurbs_result result;

    while ((result = takt_nurbs_next(n, error_mm, &p)) == NURBS_PIECE) {
        struct point end = *at;

        end.at[AXIS_X] = p.end_mm[0];
        end.at[AXIS_Y] = p.end_mm[1];
        TEST_ASSERT_TRUE(pieces < PIECES_MAX);
        TEST_ASSERT_TRUE(takt_curve_set_quintic(&piece[pieces++], at, &end, PLANE_XY, &p.course));
        *at = end;
    }
    return result;
}

static void divide(const struct whole *w)
{
    struct point at = {{w->point[0][0], w->point[0][1]}};
    struct nurbs n;

    pieces = 0;
    takt_nurbs_open(&n, w->order);
    for (unsigned i = 0; i < w->count + w->order; i++) {
        if (i < w->count) {
            takt_nurbs_add_point(&n, w->point[i], w->point[i][2]);
        }
        takt_nurbs_add_knot(&n, w->knot[i]);
        TEST_ASSERT_EQUAL_INT(NURBS_NONE, take_pieces(&n, &at));
    }
    TEST_ASSERT_DOUBLE_WITHIN(NEAR_MM, w->point[w->count - 1][0], at.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR_MM, w->point[w->count - 1][1], at.at[AXIS_Y]);
}

/* N_i,k(u) by the recursion of Cox and de Boor. */
static double basis(const struct whole *w, unsigned i, unsigned k, double u)
{
    const double *t = w->knot;
    double sum = 0.0;

    if (k == 1) {
        return t[i] <= u && u < t[i + 1] ? 1.0 : 0.0;
    }
    if (t[i + k - 1] > t[i]) {
        sum += (u - t[i]) / (t[i + k - 1] - t[i]) * basis(w, i, k - 1, u);
    }
    if (t[i + k] > t[i + 1]) {
        sum += (t[i + k] - u) / (t[i + k] - t[i + 1]) * basis(w, i + 1, k - 1, u);
    }
    return sum;
}

static void closed_form(const struct whole *w, double u, double at[2])
{
    double sum[3] = {0.0, 0.0, 0.0};

    for (unsigned i = 0; i < w->count; i++) {
        const double part = basis(w, i, w->order, u) * w->point[i][2];

        sum[0] += part * w->point[i][0];
        sum[1] += part * w->point[i][1];
        sum[2] += part;
    }
    at[0] = sum[0] / sum[2];
    at[1] = sum[1] / sum[2];
}

/*
 * Distance of a point from the pieces: the nearest of them by ternary search, from where the last
 * was on.
 */
static double distance_from(const struct curve *c, const double at[2])
{
    double low = 0.0;
    double high = c->length_mm;
    double square = MATHS_INFINITY;

    for (unsigned i = 0; i < 120; i++) {
        double d[2];

        for (unsigned k = 0; k < 2; k++) {
            struct point p;

            takt_curve_point(c, low + (high - low) * (1.0 + (double)k) / 3.0, &p);
            d[k] = (p.at[0] - at[0]) * (p.at[0] - at[0]) + (p.at[1] - at[1]) * (p.at[1] - at[1]);
        }
        square = maths_min(square, maths_min(d[0], d[1]));
        if (d[0] < d[1]) {
            high = low + (high - low) * 2.0 / 3.0;
        } else {
            low += (high - low) / 3.0;
        }
    }
    return maths_sqrt(square);
}

static double off_closed_form(const struct whole *w)
{
    const double end = w->knot[w->count];
    double largest = 0.0;
    unsigned last = 0;

    for (unsigned i = 0; i < 1000; i++) {
        double at[2];
        double nearest = MATHS_INFINITY;

        closed_form(w, end * i / 1000.0, at);
        for (unsigned k = last; k < pieces && nearest > NEAR_MM; k++) {
            const double d = distance_from(&piece[k], at);

            last = d < nearest && d < NEAR_MM ? k : last;
            nearest = maths_min(nearest, d);
        }
        largest = maths_max(largest, nearest);
    }
    return largest;
}

static double length_of_all(void)
{
    double sum = 0.0;

    for (unsigned i = 0; i < pieces; i++) {
        sum += piece[i].length_mm;
    }
    return sum;
}

/* A quarter circle is a rational quadratic with the weight sqrt(1/2) in the middle. */
static void set_circle(struct whole *w, double radius_mm)
{
    static const double corner[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                        {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    static const double knot[12] = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};

    *w = (struct whole){.order = 3, .count = 9};
    for (unsigned i = 0; i < 9; i++) {
        w->point[i][0] = radius_mm * corner[i][0];
        w->point[i][1] = radius_mm * corner[i][1];
        w->point[i][2] = i % 2 == 0 ? 1.0 : maths_sqrt(0.5);
    }
    memcpy(w->knot, knot, sizeof(knot));
}

static void test_a_circle_is_one(void)
{
    static const double radius[] = {0.01, 1.0, 25.0, 3000.0};
    struct whole w;

    for (unsigned k = 0; k < 4; k++) {
        const double r = radius[k];

        set_circle(&w, r);
        divide(&w);
        for (unsigned i = 0; i < pieces; i++) {
            for (unsigned n = 0; n <= LOOKS; n++) {
                struct point p;
                struct point bend;

                takt_curve_point(&piece[i], piece[i].length_mm * n / LOOKS, &p);
                TEST_ASSERT_DOUBLE_WITHIN(NEAR_MM, r,
                                          maths_sqrt(p.at[0] * p.at[0] + p.at[1] * p.at[1]));
                takt_curve_curvature(&piece[i], piece[i].length_mm * n / LOOKS, &bend);
                TEST_ASSERT_DOUBLE_WITHIN(
                    0.001, 1.0, r * maths_sqrt(bend.at[0] * bend.at[0] + bend.at[1] * bend.at[1]));
            }
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 * r, MATHS_TWO_PI * r, length_of_all());
    }
}

static void set_random(struct whole *w, unsigned order, unsigned count, double size_mm,
                       bool rational)
{
    *w = (struct whole){.order = order, .count = count};
    for (unsigned i = 0; i < count; i++) {
        w->point[i][0] = random_between(-size_mm, size_mm);
        w->point[i][1] = random_between(-size_mm, size_mm);
        w->point[i][2] = rational ? takt_maths_exp(random_between(-1.5, 1.5)) : 1.0;
    }
    set_open_knots(w);
}

/* Every order, sizes from 0.1 mm to a metre, with weights and without. */
static void test_random_splines_are_within_a_millionth_of_a_micrometre_of_closed_form(void)
{
    struct whole w;

    for (unsigned i = 0; i < 30; i++) {
        const double size_mm = takt_maths_exp(random_between(-2.3, 6.9));

        set_random(&w, NURBS_ORDER_MIN + i % 5, 6 + i % 4, size_mm, i % 2 == 0);
        divide(&w);
        TEST_ASSERT_TRUE(off_closed_form(&w) <= NEAR_MM);
    }
}

/* From that of the exact path to some 0.05 mm: never more pieces for a larger one. */
static void test_an_error_that_may_be_larger_makes_fewer_pieces_within_it(void)
{
    struct whole w;

    for (unsigned i = 0; i < 30; i++) {
        const double size_mm = takt_maths_exp(random_between(-2.3, 6.9));
        unsigned before = PIECES_MAX;

        error_mm = NURBS_ERROR_MM;
        set_random(&w, 4 + i % 3, 8, size_mm, i % 2 == 0);
        for (unsigned k = 0; k < 6; k++) {
            divide(&w);
            TEST_ASSERT_TRUE(pieces <= before && off_closed_form(&w) <= NEAR_MM);
            before = pieces;
            error_mm *= 40.0;
        }
    }
}

/* The curve of G5: both ends and the tangents' points. x(1/2) = (p0 + 3 p1 + 3 p2 + p3) / 8. */
static void test_four_points_are_a_bezier_curve(void)
{
    struct whole w = {
        .order = 4, .count = 4, .point = {{0, 0, 1}, {0, 3, 1}, {1, 4, 1}, {1, 1, 1}}};

    set_open_knots(&w);
    divide(&w);
    struct point t;

    takt_curve_tangent(&piece[0], 0.0, &t);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0, t.at[AXIS_Y]);
    TEST_ASSERT_TRUE(off_closed_form(&w) <= NEAR_MM);
    double nearest = MATHS_INFINITY;

    for (unsigned i = 0; i < pieces; i++) {
        nearest = maths_min(nearest, distance_from(&piece[i], (double[2]){0.5, 2.75}));
    }
    TEST_ASSERT_TRUE(nearest <= NEAR_MM);
}

/* Cubic and higher splines have continuous curvature: so do their pieces. */
static void test_tangent_and_curvature_go_on_from_piece_to_piece(void)
{
    struct whole w;

    for (unsigned i = 0; i < 20; i++) {
        set_random(&w, 4 + i % 3, 9, 50.0, true);
        divide(&w);
        for (unsigned k = 0; k + 1 < pieces; k++) {
            struct point t[2];
            struct point bend[2];

            takt_curve_tangent(&piece[k], piece[k].length_mm, &t[0]);
            takt_curve_tangent(&piece[k + 1], 0.0, &t[1]);
            takt_curve_curvature(&piece[k], piece[k].length_mm, &bend[0]);
            takt_curve_curvature(&piece[k + 1], 0.0, &bend[1]);
            for (unsigned axis = 0; axis < 2; axis++) {
                const double size =
                    maths_max(1e-3, maths_abs(bend[0].at[0]) + maths_abs(bend[0].at[1]));

                TEST_ASSERT_DOUBLE_WITHIN(1e-9, t[0].at[axis], t[1].at[axis]);
                TEST_ASSERT_DOUBLE_WITHIN(1e-6 * size, bend[0].at[axis], bend[1].at[axis]);
            }
        }
    }
}

/* Third derivative by differences of the second. */
static void check_bounds(const struct curve *c)
{
    struct curve_bounds b;

    takt_curve_bound(c, &b);
    for (unsigned n = 0; n < LOOKS; n++) {
        const double s = c->length_mm * (n + 0.5) / LOOKS;
        const double h = 0.01 * c->length_mm;
        struct point t;
        struct point bend[3];
        double third[2];

        takt_curve_tangent(c, s, &t);
        takt_curve_curvature(c, s, &bend[0]);
        takt_curve_curvature(c, s - h, &bend[1]);
        takt_curve_curvature(c, s + h, &bend[2]);
        for (unsigned axis = 0; axis < 2; axis++) {
            third[axis] = (bend[2].at[axis] - bend[1].at[axis]) / (2.0 * h);
            TEST_ASSERT_TRUE(maths_abs(t.at[axis]) <= b.first[axis] * (1.0 + 1e-12));
            TEST_ASSERT_TRUE(maths_abs(bend[0].at[axis]) <= b.second[axis] * (1.0 + 1e-9));
            TEST_ASSERT_TRUE(maths_abs(third[axis]) <= b.third[axis] * (1.0 + 1e-9) + 1e-9);
        }
        const double along = maths_abs(t.at[0] * bend[0].at[0] + t.at[1] * bend[0].at[1]);
        const double across = maths_abs(t.at[0] * third[1] - t.at[1] * third[0]);

        TEST_ASSERT_TRUE(along <= b.second_along * (1.0 + 1e-9) + 1e-12);
        TEST_ASSERT_TRUE(across <= b.third_across * (1.0 + 1e-4) + 1e-9);
        TEST_ASSERT_TRUE(b.radius_min_mm <= (1.0 + 1e-9) / b.second[0]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 1.0, b.first[0]);
}

static void test_bounds_hold_everywhere_and_are_no_wider_than_they_need_be(void)
{
    struct whole w;

    for (unsigned i = 0; i < 20; i++) {
        set_random(&w, 3 + i % 4, 8, 20.0, i % 2 == 0);
        divide(&w);
        for (unsigned k = 0; k < pieces; k++) {
            check_bounds(&piece[k]);
        }
    }
    struct curve_bounds b;

    pieces = 0;
    set_circle(&w, 10.0);
    divide(&w);
    for (unsigned k = 0; k < pieces; k++) {
        takt_curve_bound(&piece[k], &b);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.1, b.second[0]);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.01, b.third[0]);
        TEST_ASSERT_DOUBLE_WITHIN(0.005, 0.0, b.third_across);
    }
}

/* Equal points, equal places: corners and standing parameters are straight pieces or none. */
static void test_repeated_control_points_are_passed(void)
{
    struct whole w = {.order = 3,
                      .count = 8,
                      .point = {{0, 0, 1},
                                {10, 0, 1},
                                {10, 0, 1},
                                {10, 10, 1},
                                {10, 10, 1},
                                {10, 10, 1},
                                {0, 10, 1},
                                {0, 0, 1}}};

    set_open_knots(&w);
    divide(&w);
    TEST_ASSERT_TRUE(off_closed_form(&w) <= NEAR_MM);
}

/* A cubic with a cusp at (0.5, 0.75): the pieces lead into it and out again. */
static void test_a_cusp_is_passed(void)
{
    struct whole w = {
        .order = 4, .count = 4, .point = {{0, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 0, 1}}};

    set_open_knots(&w);
    divide(&w);
    TEST_ASSERT_TRUE(off_closed_form(&w) <= NEAR_MM);
    TEST_ASSERT_TRUE(pieces < 400);
}

/*
 * Knots that differ by decades make parts shorter than a piece may be; what is passed over must not
 * stretch the next.
 */
static void test_pieces_are_even_beside_parts_too_short_for_a_piece(void)
{
    struct whole w;

    for (unsigned i = 0; i < 40; i++) {
        double knot = 0.0;

        set_random(&w, 3 + i % 4, 16, 3.0, true);
        for (unsigned k = w.order; k < w.count + w.order; k++) {
            knot += k <= w.count ? takt_maths_exp(random_between(-7.0, 7.0)) : 0.0;
            w.knot[k] = knot;
        }
        divide(&w);
        for (unsigned k = 0; k < pieces; k++) {
            struct point t;

            takt_curve_tangent(&piece[k], 0.5 * piece[k].length_mm, &t);
            TEST_ASSERT_DOUBLE_WITHIN(2e-6, 1.0, maths_sqrt(t.at[0] * t.at[0] + t.at[1] * t.at[1]));
        }
    }
}

/*
 * Even knots from the first on: the curve of order 3 begins and ends in the middle between two
 * control points.
 */
static void test_a_straight_piece_leads_to_a_curve_that_does_not_begin_at_its_first_point(void)
{
    struct point at = {{4, 0}};
    struct nurbs n;

    takt_nurbs_open(&n, 3);
    for (unsigned i = 0; i < 6; i++) {
        static const double point[3][2] = {{4, 0}, {8, 0}, {8, 6}};

        if (i < 3) {
            takt_nurbs_add_point(&n, point[i], 1.0);
        }
        takt_nurbs_add_knot(&n, i);
        TEST_ASSERT_EQUAL_INT(NURBS_NONE, take_pieces(&n, &at));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 6.0, piece[0].end.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0, piece[0].length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 8.0, at.at[AXIS_X]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3.0, at.at[AXIS_Y]);
    for (unsigned i = 0; i < pieces; i++) {
        struct curve_bounds b;

        takt_curve_bound(&piece[i], &b);
        TEST_ASSERT_TRUE(b.first[AXIS_X] < 1.1);
    }
}

static void test_the_place_where_a_piece_turns_back_is_its_farthest(void)
{
    const struct curve_course course = {
        .heading_rad = {-0.2, 0.3}, .curvature_1_mm = {0.5, 0.5}, .length_mm = 1.0};
    const struct point start = {{0}};
    const struct point end = {{0.986, 0.05}};
    struct curve c;
    struct point t;
    double s;

    TEST_ASSERT_TRUE(takt_curve_set_quintic(&c, &start, &end, PLANE_XY, &course));
    TEST_ASSERT_FALSE(takt_quintic_extreme(&c, 0, &s));
    TEST_ASSERT_TRUE(takt_quintic_extreme(&c, 1, &s));
    takt_curve_tangent(&c, s, &t);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, t.at[AXIS_Y]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_circle_is_one);
    RUN_TEST(test_random_splines_are_within_a_millionth_of_a_micrometre_of_closed_form);
    RUN_TEST(test_an_error_that_may_be_larger_makes_fewer_pieces_within_it);
    RUN_TEST(test_four_points_are_a_bezier_curve);
    RUN_TEST(test_tangent_and_curvature_go_on_from_piece_to_piece);
    RUN_TEST(test_bounds_hold_everywhere_and_are_no_wider_than_they_need_be);
    RUN_TEST(test_repeated_control_points_are_passed);
    RUN_TEST(test_a_cusp_is_passed);
    RUN_TEST(test_pieces_are_even_beside_parts_too_short_for_a_piece);
    RUN_TEST(test_a_straight_piece_leads_to_a_curve_that_does_not_begin_at_its_first_point);
    RUN_TEST(test_the_place_where_a_piece_turns_back_is_its_farthest);
    return UNITY_END();
}
