#include "convex/band.h"

/* Takes a column's part from the columns behind it; within: how many of them there are. */
static void eliminate(double *column, size_t width, size_t within)
{
    const double inverse = 1 / column[0];

    for (size_t i = 1; i <= within; i++) {
        const double l = column[i] * inverse;
        double *next = column + i * width;

        for (size_t k = i; k < width; k++)
            next[k - i] -= l * column[k];
    }
    for (size_t i = 1; i < width; i++)
        column[i] *= inverse;
    column[0] = inverse;
}

static size_t behind(size_t j, size_t width, size_t size)
{
    return size - 1 - j < width - 1 ? size - 1 - j : width - 1;
}

void band_factor(double *a, size_t width, size_t size)
{
    for (size_t j = 0; j < size; j++)
        eliminate(a + j * width, width, behind(j, width, size));
}

void band_back(const double *a, size_t width, size_t size, double *b)
{
    for (size_t j = 0; j < size; j++)
        b[j] *= a[j * width];
    for (size_t j = size; j-- > 0;) {
        const size_t within = behind(j, width, size);
        double sum = b[j];

        for (size_t i = 1; i <= within; i++)
            sum -= a[j * width + i] * b[j + i];
        b[j] = sum;
    }
}

void band_solve(const double *a, size_t width, size_t size, double *b)
{
    for (size_t j = 0; j < size; j++) {
        const size_t within = behind(j, width, size);

        for (size_t i = 1; i <= within; i++)
            b[j + i] -= a[j * width + i] * b[j];
    }
    band_back(a, width, size, b);
}
