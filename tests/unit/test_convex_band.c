/* The band solver, by a matrix whose solution is known. */
#include "convex/band.h"

#include <unity.h>

#define SIZE  40
#define WIDTH 16

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_the_band_solver_solves(void)
{
    static double a[SIZE][WIDTH];
    static double full[SIZE][SIZE];
    double x[SIZE];

    for (int j = 0; j < SIZE; j++) {
        x[j] = 0;
        for (int k = 0; k < WIDTH && j + k < SIZE; k++) {
            a[j][k] = k == 0 ? 40 + j : 1.0 / (1 + j + 3 * k);
            full[j + k][j] = full[j][j + k] = a[j][k];
        }
    }
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++)
            x[i] += full[i][j] * (j - 7);
    }
    band_factor(a[0], WIDTH, SIZE);
    band_solve(a[0], WIDTH, SIZE, x);
    for (int j = 0; j < SIZE; j++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, j - 7, x[j]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_band_solver_solves);
    return UNITY_END();
}
