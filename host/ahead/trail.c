#include "ahead/trail.h"

#include <stdlib.h>

bool trail_allocate(struct trail *t, size_t intervals)
{
    t->intervals = intervals;
    t->control = calloc(intervals + TRAIL_ENDS, sizeof *t->control);
    t->place_mm = calloc(2 * intervals + 1, sizeof *t->place_mm);
    t->beyond = calloc(intervals, sizeof *t->beyond);
    if (t->control != NULL && t->place_mm != NULL && t->beyond != NULL)
        return true;
    trail_free(t);
    return false;
}

void trail_free(struct trail *t)
{
    free(t->control);
    free(t->place_mm);
    free(t->beyond);
    *t = (struct trail){0};
}

/* Uniform cubic B-spline: ((1-f)^3, 3f^3 - 6f^2 + 4, -3f^3 + 3f^2 + 3f + 1, f^3) / 6 */
void trail_weights(double f, double weight[4])
{
    const double g = 1 - f;

    weight[0] = g * g * g / 6;
    weight[1] = (4 + f * f * (3 * f - 6)) / 6;
    weight[2] = (4 + g * g * (3 * g - 6)) / 6;
    weight[3] = f * f * f / 6;
}

/* Their derivatives. */
void trail_slopes(double f, double weight[4])
{
    const double g = 1 - f;

    weight[0] = -g * g / 2;
    weight[1] = f * (1.5 * f - 2);
    weight[2] = g * (2 - 1.5 * g);
    weight[3] = f * f / 2;
}

void trail_sum(double (*control)[3], const double weight[4], double sum[3])
{
    for (int i = 0; i < 3; i++)
        sum[i] = weight[0] * control[0][i] + weight[1] * control[1][i] + weight[2] * control[2][i] +
                 weight[3] * control[3][i];
}

void trail_at(const struct trail *t, double u, double point[3])
{
    size_t k = (size_t)u;
    double weight[4];

    if (k >= t->intervals)
        k = t->intervals - 1;
    trail_weights(u - (double)k, weight);
    trail_sum(t->control + k, weight, point);
}
