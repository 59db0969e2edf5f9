/*
 * The paths: where they lead, that they are smooth, and that arcs and lines stay within their
 * tolerance.
 */
#include "base/maths.h"
#include "bore/job.h"
#include "bore/rival.h"

#include <unity.h>

static struct bore_job job;
static struct bore_path path;

void setUp(void)
{
    job = (struct bore_job){
        .pass = BORE_FINISHING,
        .hole_mm = 60,
        .cutter_mm = 12,
        .step_mm = 3,
        .turns = 2,
        .start_mm = {5, -3},
        .height_mm = 2,
        .feed_mm_min = 1000,
        .plunge_mm_min = 300,
        .tolerance_mm = 0.002,
    };
}

void tearDown(void)
{
    bore_path_free(&path);
}

/* The piece as the controller will have it. */
static struct curve curve_of(size_t i)
{
    const struct bore_piece *piece = &path.piece[i];
    const double *from = bore_path_start(&path, i);
    struct point start = {{from[0], from[1]}};
    struct point end = {{piece->to_mm[0], piece->to_mm[1]}};
    struct curve c;
    bool good = false;

    switch (piece->kind) {
    case BORE_LINE:
        good = takt_curve_set_line(&c, &start, &end);
        break;
    case BORE_ARC:
        good = takt_curve_set_arc(&c, &start, &end, PLANE_XY, piece->centre_mm, false, 1);
        break;
    case BORE_INVOLUTE:
        good = takt_curve_set_involute(&c, &start, &end, PLANE_XY, piece->centre_mm, piece->base_mm,
                                       false);
        break;
    }
    TEST_ASSERT_TRUE(good);
    return c;
}

static double between(const struct point *a, const struct point *b)
{
    const double x = a->at[0] - b->at[0];
    const double y = a->at[1] - b->at[1];

    return maths_sqrt(x * x + y * y);
}

/* Every piece goes on in the direction of the one before. */
static void check_smooth(double sine)
{
    for (size_t i = 1; i < path.count; i++) {
        const struct curve before = curve_of(i - 1);
        const struct curve behind = curve_of(i);
        struct point t0, t1;

        takt_curve_tangent(&before, before.length_mm, &t0);
        takt_curve_tangent(&behind, 0.0, &t1);
        TEST_ASSERT_TRUE(between(&t0, &t1) < sine);
    }
}

static void test_a_finishing_pass_comes_and_goes_in_mirror_images(void)
{
    struct bore_spiral s;
    struct point in, out;

    bore_make_path(&job, BORE_FINISHING, &path);
    bore_set_spiral(&job, BORE_FINISHING, &s);
    TEST_ASSERT_EQUAL_UINT(3, path.count);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, path.from_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -3.0, path.from_mm[1]);
    check_smooth(1e-9);
    const struct curve first = curve_of(0);
    const struct curve last = curve_of(2);

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, first.length_mm, last.length_mm);
    for (int i = 0; i <= 20; i++) {
        const double u[2] = {takt_maths_sin(s.turned_rad), -takt_maths_cos(s.turned_rad)};

        takt_curve_point(&first, first.length_mm * i / 20, &in);
        takt_curve_point(&last, last.length_mm * (20 - i) / 20, &out);
        const double along = 2.0 * (in.at[0] * u[0] + in.at[1] * u[1]);

        TEST_ASSERT_DOUBLE_WITHIN(1e-9, along * u[0] - in.at[0], out.at[0]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, along * u[1] - in.at[1], out.at[1]);
    }
}

/* How far a point is from the spiral: the string from it touches the base circle. */
static double off_spiral(const struct bore_spiral *s, const struct point *p)
{
    double centre[2];

    bore_spiral_base_centre(s, centre);
    const double x = p->at[0] - centre[0];
    const double y = p->at[1] - centre[1];
    const double d = maths_sqrt(x * x + y * y) / s->base_mm;
    const double phi = d > 1.0 ? maths_sqrt((d - 1.0) * (d + 1.0)) : 0.0;
    const double turned =
        takt_maths_atan2(y, x) - s->turned_rad - (phi - takt_maths_atan2(phi, 1.0));

    return s->base_mm * maths_abs(turned - MATHS_TWO_PI * takt_maths_round(turned / MATHS_TWO_PI));
}

static double worst_off(const struct bore_spiral *s, size_t pieces)
{
    double worst = 0.0;

    for (size_t i = 0; i < pieces; i++) {
        const struct curve c = curve_of(i);

        for (int k = 0; k <= 400; k++) {
            struct point p;

            takt_curve_point(&c, c.length_mm * k / 400, &p);
            worst = maths_max(worst, off_spiral(s, &p));
        }
    }
    return worst;
}

static void check_approximation(enum bore_form_kind as, size_t most)
{
    struct bore_spiral s;

    job.as = as;
    bore_make_path(&job, BORE_ROUGHING, &path);
    bore_set_spiral(&job, BORE_ROUGHING, &s);
    TEST_ASSERT_FALSE(path.failed);
    size_t spiral = 0;

    while (between(&(struct point){{path.piece[spiral].to_mm[0], path.piece[spiral].to_mm[1]}},
                   &(struct point){{0.0, -s.radius_mm}}) > 1e-9) {
        spiral++;
    }
    const double worst = worst_off(&s, spiral + 1);

    TEST_ASSERT_TRUE(worst <= job.tolerance_mm);
    TEST_ASSERT_TRUE(worst >= 0.9 * job.tolerance_mm);
    TEST_ASSERT_TRUE(path.count <= most);
}

static void test_arcs_stay_within_the_tolerance_and_are_smooth(void)
{
    check_approximation(BORE_AS_ARCS, 110);
    check_smooth(1e-7);
}

static void test_lines_stay_within_the_tolerance(void)
{
    /* the integral of ds / sqrt(8 radius tolerance) is 1541 */
    check_approximation(BORE_AS_LINES, 1600);
    for (size_t i = 0; i < path.count; i++) {
        TEST_ASSERT_EQUAL(BORE_LINE, path.piece[i].kind);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -24.0, path.piece[path.count - 1].to_mm[1]);
}

static void test_every_spiral_leads_from_the_centre_around_the_circle(void)
{
    for (unsigned rival = 0; rival < BORE_RIVALS; rival++) {
        bore_rival_path((enum bore_rival)rival, 24.0, 8, 1e-3, 0.0, &path);
        const struct curve circle = curve_of(path.count - 1);

        TEST_ASSERT_DOUBLE_WITHIN(1e-9, MATHS_TWO_PI * 24.0, circle.length_mm);
        TEST_ASSERT_TRUE(path.from_mm[0] == 0.0 && path.from_mm[1] == 0.0);
        if (rival != BORE_RIVAL_ARCHIMEDES) {
            check_smooth(1e-7);
        }
        bore_path_free(&path);
    }
}

/* With two poles there are 2 n - 1 half circles whose radii grow by R / (2 n). */
static void test_joined_arcs_grow_evenly(void)
{
    bore_rival_path(BORE_RIVAL_TWO_POLES, 24.0, 8, 1e-3, 0.0, &path);
    TEST_ASSERT_EQUAL_UINT(16, path.count);
    for (size_t i = 0; i + 1 < path.count; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, MATHS_PI * 1.5 * (double)(i + 1), curve_of(i).length_mm);
    }
    bore_path_free(&path);
    bore_rival_path(BORE_RIVAL_FOUR_POLES, 24.0, 8, 1e-3, 0.0, &path);
    TEST_ASSERT_EQUAL_UINT(32, path.count);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, MATHS_HALF_PI * 0.75, curve_of(0).length_mm);
}

/* Radius in proportion to the angle: at whole turns R k / n. */
static void test_the_archimedean_spiral_keeps_its_distance(void)
{
    const double a = 24.0 / (MATHS_TWO_PI * 8.0);
    double turned = 0.0;
    double last = 0.0;

    bore_rival_path(BORE_RIVAL_ARCHIMEDES, 24.0, 8, 1e-3, 0.0, &path);
    for (size_t i = 0; i + 1 < path.count; i++) {
        const struct curve c = curve_of(i);

        for (int k = 1; k <= 100; k++) {
            struct point p;

            takt_curve_point(&c, c.length_mm * k / 100, &p);
            const double radius = maths_sqrt(p.at[0] * p.at[0] + p.at[1] * p.at[1]);
            const double angle = takt_maths_atan2(p.at[1], p.at[0]);

            turned += angle - last < -MATHS_PI ? MATHS_TWO_PI : 0.0;
            last = angle;
            const double theta = turned + angle;
            /* across the spiral, which crosses the radius at an angle whose tangent is theta */
            const double off = (radius - a * theta) * theta / maths_sqrt(1.0 + theta * theta);

            TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0.0, off);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_finishing_pass_comes_and_goes_in_mirror_images);
    RUN_TEST(test_arcs_stay_within_the_tolerance_and_are_smooth);
    RUN_TEST(test_lines_stay_within_the_tolerance);
    RUN_TEST(test_every_spiral_leads_from_the_centre_around_the_circle);
    RUN_TEST(test_joined_arcs_grow_evenly);
    RUN_TEST(test_the_archimedean_spiral_keeps_its_distance);
    return UNITY_END();
}
