/*
 * How deep a cut is: between the points of the grid, at its edges and beyond them.
 */
#include "spindle/stock.h"
#include "unity.h"

static double x[] = {0, 10, 30}, y[] = {-5, 5};
static double top[] = {1, 2, 4, 3, 6, 0};
static const struct stock stock = {3, 2, x, y, top};

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_the_points_of_the_grid_have_their_tops(void)
{
    for (unsigned i = 0; i < 2; i++) {
        for (unsigned k = 0; k < 3; k++)
            TEST_ASSERT_EQUAL_DOUBLE(top[3 * i + k] + 7, stock_depth_mm(&stock, x[k], y[i], -7));
    }
}

/*
 * At (20, 0): the mean of 2, 4, 6 and 0. At (5, -2.5): 0.75 of the mean of 1 and 2, 0.25 of that of
 * 3 and 6.
 */
static void test_between_them_the_top_is_linear_in_x_and_in_y(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3, stock_depth_mm(&stock, 20, 0, 0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.75 * 1.5 + 0.25 * 4.5, stock_depth_mm(&stock, 5, -2.5, 0));
}

static void test_above_the_top_and_beside_the_grid_nothing_is_cut(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(0, stock_depth_mm(&stock, 20, 0, 3.5));
    TEST_ASSERT_EQUAL_DOUBLE(0, stock_depth_mm(&stock, -0.001, 0, -1));
    TEST_ASSERT_EQUAL_DOUBLE(0, stock_depth_mm(&stock, 30.001, 0, -1));
    TEST_ASSERT_EQUAL_DOUBLE(0, stock_depth_mm(&stock, 20, 5.001, -1));
    TEST_ASSERT_EQUAL_DOUBLE(0, stock_depth_mm(&stock, 20, -5.001, -1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_points_of_the_grid_have_their_tops);
    RUN_TEST(test_between_them_the_top_is_linear_in_x_and_in_y);
    RUN_TEST(test_above_the_top_and_beside_the_grid_nothing_is_cut);
    return UNITY_END();
}
