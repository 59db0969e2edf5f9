#include "ahead/band.h"

/* Takes column j's part from the columns behind it; within: how many of them there are. */
static void eliminate(double (*a)[BAND_WIDTH], size_t j, size_t within)
{
    double *column = a[j];
    const double inverse = 1 / column[0];

    for (size_t i = 1; i <= within; i++) {
        const double l = column[i] * inverse;
        double *next = a[j + i];

        for (size_t k = i; k < BAND_WIDTH; k++)
            next[k - i] -= l * column[k];
    }
    for (size_t i = 1; i < BAND_WIDTH; i++)
        column[i] *= inverse;
    column[0] = inverse;
}

static size_t behind(size_t j, size_t size)
{
    return size - 1 - j < BAND_WIDTH - 1 ? size - 1 - j : BAND_WIDTH - 1;
}

void band_factor(double (*a)[BAND_WIDTH], size_t size)
{
    for (size_t j = 0; j < size; j++)
        eliminate(a, j, behind(j, size));
}

void band_solve(double (*a)[BAND_WIDTH], size_t size, double *b)
{
    for (size_t j = 0; j < size; j++) {
        const size_t within = behind(j, size);

        for (size_t i = 1; i <= within; i++)
            b[j + i] -= a[j][i] * b[j];
    }
    for (size_t j = 0; j < size; j++)
        b[j] *= a[j][0];
    for (size_t j = size; j-- > 0;) {
        const size_t within = behind(j, size);
        double sum = b[j];

        for (size_t i = 1; i <= within; i++)
            sum -= a[j][i] * b[j + i];
        b[j] = sum;
    }
}
