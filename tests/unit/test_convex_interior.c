/*
 * The interior-point method on a straight line that is passed evenly: what its time has to become
 * is known.
 */
#include "base/maths.h"
#include "convex/interior.h"

#include <string.h>
#include <unity.h>

#define CELLS 60

static struct problem_cell cell[CELLS];
static struct problem problem;
static struct interior *interior;

void setUp(void)
{
    interior = interior_new(CELLS, 0, 0);
    TEST_ASSERT_NOT_NULL(interior);
}

void tearDown(void)
{
    interior_free(interior);
}

/* Along X, at so many times the highest velocity; of acceleration and jerk there is plenty. */
static void make_line(double velocity)
{
    static const double value[4] = {0.5, 0.5, 0, 0};

    memset(cell, 0, sizeof cell);
    problem = (struct problem){.cells = CELLS, .cell = cell, .timed = true};
    for (int i = 0; i < 3; i++)
        problem.scale[i][FORM_VELOCITY] = 1;
    for (size_t k = 0; k < CELLS; k++) {
        cell[k].now[0][FORM_VELOCITY] = velocity;
        for (int j = 0; j < 4; j++)
            cell[k].time[0][FORM_VELOCITY][j] = velocity * 0.5 * value[j];
        cell[k].ball[0] = (struct problem_ball){
            .weight = {1.0 / 6, 4.0 / 6, 1.0 / 6, 0}, .along = {1, 0, 0}, .radius_mm = 0.01};
    }
}

/* The square of the rate, less 1, in the middle of the line. */
static double middle_of(double (*change)[4])
{
    return change[CELLS / 2 - problem_ends(&problem)][3];
}

static void test_what_is_slower_than_its_limit_becomes_faster(void)
{
    make_line(0.9);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 2 * (1 / 0.9 - 1),
                              middle_of(interior_solve(interior, &problem)));
}

static void test_what_is_beyond_its_limit_becomes_slower(void)
{
    make_line(1.2);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 2 * (1 / 1.2 - 1),
                              middle_of(interior_solve(interior, &problem)));
}

static void test_an_untimed_problem_leaves_the_time(void)
{
    make_line(0.9);
    problem.timed = false;
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, middle_of(interior_solve(interior, &problem)));
}

static void test_the_change_stays_within_the_tube(void)
{
    double(*change)[4];

    make_line(1);
    for (size_t k = 0; k < CELLS; k++)
        cell[k].ball[0].offset[1] = 0.02; /* twice the radius */
    change = interior_solve(interior, &problem);
    TEST_ASSERT_DOUBLE_WITHIN(0.0101, -0.02, change[CELLS / 2 - problem_ends(&problem)][1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_slower_than_its_limit_becomes_faster);
    RUN_TEST(test_what_is_beyond_its_limit_becomes_slower);
    RUN_TEST(test_an_untimed_problem_leaves_the_time);
    RUN_TEST(test_the_change_stays_within_the_tube);
    return UNITY_END();
}
