/*
 * The optimiser: a small path from a first guess to a legal trajectory, the same on any number of
 * cores.
 */
#include "ahead/guess.h"
#include "ahead/solver.h"
#include "convex/vector.h"

#include <string.h>
#include <unity.h>

static const struct ahead_limits limits = {.velocity_mm_s = {100, 100, 100},
                                           .acceleration_mm_s2 = {1000, 1000, 1000},
                                           .jerk_mm_s3 = {50000, 50000, 50000},
                                           .step_s = 0.002,
                                           .cycle_s = 0.001};

void setUp(void)
{
}

void tearDown(void)
{
}

/* A square, closed. */
static void make_square(struct ahead_path *path, double side_mm)
{
    static const double corner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};

    ahead_path_init(path);
    for (int i = 0; i < 4; i++) {
        struct ahead_element e = {.feed_mm_s = 100, .tolerance_mm = 0.01, .block = 1};
        struct point from = {{side_mm * corner[i][0], side_mm * corner[i][1]}};
        struct point to = {{side_mm * corner[i + 1][0], side_mm * corner[i + 1][1]}};

        TEST_ASSERT_TRUE(takt_curve_set_line(&e.curve, &from, &to));
        TEST_ASSERT_TRUE(ahead_path_add(path, &e));
    }
}

static struct trail solve(const struct ahead_path *path, unsigned workers)
{
    struct solver *s = solver_new(workers, &limits.modes);
    struct trail t;

    TEST_ASSERT_NOT_NULL(s);
    TEST_ASSERT_TRUE(guess_trail(path, &limits, &t));
    TEST_ASSERT_EQUAL(SOLVER_DONE, solver_run(s, path, &limits, &t, SIZE_MAX, NULL, NULL));
    solver_free(s);
    return t;
}

static void test_differences_of_control_points_keep_the_limits(void)
{
    const double h = limits.step_s;
    struct ahead_path path;
    struct trail t;

    make_square(&path, 5);
    t = solve(&path, 1);
    for (size_t k = 0; k < t.intervals; k++) {
        for (int i = 0; i < 3; i++) {
            double(*c)[3] = t.control + k;
            const double a = c[2][i] - 2 * c[1][i] + c[0][i];
            const double j = c[3][i] - 3 * c[2][i] + 3 * c[1][i] - c[0][i];

            TEST_ASSERT_DOUBLE_WITHIN(100.1 * h, 0, c[1][i] - c[0][i]);
            TEST_ASSERT_DOUBLE_WITHIN(1000.5 * h * h, 0, a);
            TEST_ASSERT_DOUBLE_WITHIN(50025 * h * h * h, 0, j);
        }
    }
    trail_free(&t);
    ahead_path_free(&path);
}

static void test_every_corner_is_passed_within_the_tolerance(void)
{
    struct ahead_path path;
    struct trail t;

    make_square(&path, 5);
    t = solve(&path, 1);
    for (size_t k = 0; k < path.count; k++) {
        double nearest = 1;

        for (size_t i = 0; i <= 20 * t.intervals; i++) {
            double x[3];
            double way[3];

            trail_at(&t, t.tool, 0.05 * (double)i, x);
            vector_from_to(path.element[k].curve.end.at, x, way);
            nearest = maths_min(nearest, vector_length(way));
        }
        TEST_ASSERT_TRUE(nearest < 0.01);
    }
    trail_free(&t);
    ahead_path_free(&path);
}

static void test_two_cores_find_the_same_bits_as_one(void)
{
    struct ahead_path path;
    struct trail one;
    struct trail two;

    make_square(&path, 5);
    one = solve(&path, 1);
    two = solve(&path, 2);
    TEST_ASSERT_TRUE(one.intervals == two.intervals);
    TEST_ASSERT_EQUAL_MEMORY(one.control, two.control, (one.intervals + 3) * sizeof *one.control);
    trail_free(&one);
    trail_free(&two);
    ahead_path_free(&path);
}

/*
 * A tolerance below what the curve's own bend takes: nothing fits, and each repair has slowed it
 * down. On a small square: the time goes with the repaired intervals, of which each repair makes
 * more.
 */
static void test_the_place_where_it_is_stuck_is_on_the_path(void)
{
    struct solver *s = solver_new(1, &limits.modes);
    struct ahead_path path;
    struct trail t;
    size_t guessed;

    TEST_ASSERT_NOT_NULL(s);
    make_square(&path, 0.5);
    path.element[2].tolerance_mm = 3e-7;
    TEST_ASSERT_TRUE(guess_trail(&path, &limits, &t));
    guessed = t.intervals;
    TEST_ASSERT_EQUAL(SOLVER_STUCK, solver_run(s, &path, &limits, &t, SIZE_MAX, NULL, NULL));
    TEST_ASSERT_TRUE(t.intervals > guessed);
    TEST_ASSERT_DOUBLE_WITHIN(0.26, 1.25, solver_stuck_mm(s));
    solver_free(s);
    trail_free(&t);
    ahead_path_free(&path);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_differences_of_control_points_keep_the_limits);
    RUN_TEST(test_every_corner_is_passed_within_the_tolerance);
    RUN_TEST(test_the_place_where_it_is_stuck_is_on_the_path);
    RUN_TEST(test_two_cores_find_the_same_bits_as_one);
    return UNITY_END();
}
