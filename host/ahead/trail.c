#include "ahead/trail.h"

#include "convex/vector.h"

#include <stdlib.h>
#include <string.h>

static bool allocate_sides(struct trail *t)
{
    if (t->modes == 0) {
        t->motor = t->control;
        t->tool = t->control;
        return true;
    }
    t->motor = calloc(t->intervals + TRAIL_ENDS, sizeof *t->motor);
    t->tool = calloc(t->intervals + TRAIL_ENDS, sizeof *t->tool);
    for (size_t s = 0; s < MODES_STRAYS; s++)
        t->stray[s] = calloc(t->intervals + TRAIL_ENDS, sizeof *t->stray[s]);
    return t->motor != NULL && t->tool != NULL && t->stray[0] != NULL && t->stray[1] != NULL;
}

bool trail_allocate(struct trail *t, size_t intervals, unsigned modes)
{
    *t = (struct trail){.intervals = intervals, .modes = modes};
    t->control = calloc(intervals + trail_ends(modes), sizeof *t->control);
    t->place_mm = calloc(2 * intervals + 1, sizeof *t->place_mm);
    t->beyond = calloc(intervals, sizeof *t->beyond);
    if (allocate_sides(t) && t->control != NULL && t->place_mm != NULL && t->beyond != NULL)
        return true;
    trail_free(t);
    return false;
}

void trail_free(struct trail *t)
{
    if (t->modes > 0) {
        free(t->motor);
        free(t->tool);
        for (size_t s = 0; s < MODES_STRAYS; s++)
            free(t->stray[s]);
    }
    free(t->control);
    free(t->place_mm);
    free(t->beyond);
    *t = (struct trail){0};
}

/* The recursion of modes.h. */
static void swing(struct trail *t, const struct modes_stray *as, size_t s, int axis)
{
    double before = t->swing[s][0][axis];
    double here = t->swing[s][1][axis];

    t->stray[s][0][axis] = t->motor[0][axis] + before;
    t->stray[s][1][axis] = t->motor[1][axis] + here;
    for (size_t k = 2; k < t->intervals + TRAIL_ENDS; k++) {
        const double bend = t->motor[k][axis] - 2 * t->motor[k - 1][axis] + t->motor[k - 2][axis];
        const double next = as->trace * here - as->determinant * before - as->pull * bend;

        t->stray[s][k][axis] = t->motor[k][axis] + next;
        before = here;
        here = next;
    }
}

void trail_continue(struct trail *to, const struct trail *from, size_t first, size_t intervals)
{
    to->rest = first + intervals == from->intervals ? from->rest : 0;
    for (size_t s = 0; s < MODES_STRAYS && from->modes > 0; s++) {
        for (size_t k = 0; k < 2; k++)
            vector_from_to(from->motor[first + k], from->stray[s][first + k], to->swing[s][k]);
    }
}

void trail_follow(struct trail *t, const struct ahead_modes *modes)
{
    for (size_t k = 0; k < t->intervals + TRAIL_ENDS && t->modes > 0; k++) {
        for (int i = 0; i < 3; i++) {
            struct modes_point motor;
            struct modes_point tool;

            modes_at(modes, i, t->control + k, &motor, &tool);
            t->motor[k][i] = motor.at_mm;
            t->tool[k][i] = tool.at_mm;
        }
    }
    for (size_t s = 0; s < modes->strays && t->modes > 0; s++) {
        for (int i = 0; i < 3; i++)
            swing(t, &modes->stray[s][i], s, i);
    }
}

bool trail_soften(struct trail *t, const struct ahead_modes *modes)
{
    const size_t more = 2 * (size_t)modes->count; /* control points at each end */
    const size_t last = t->intervals + TRAIL_ENDS - 1;
    /* So that they show it in points that may change. */
    const size_t rest = modes->strays > 0 ? modes->rest + trail_ends(modes->count) : 0;
    struct trail soft;

    if (!trail_allocate(&soft, t->intervals + more + rest, modes->count))
        return false;
    soft.rest = rest;
    for (size_t k = 0; k <= last + 2 * more + soft.rest; k++) {
        const size_t from = k < more ? 0 : k - more < last ? k - more : last;

        memcpy(soft.control[k], t->control[from], sizeof t->control[from]);
    }
    for (size_t site = 0; site <= 2 * soft.intervals; site++) {
        const size_t from = site < more ? 0 : site - more;

        soft.place_mm[site] = t->place_mm[from < 2 * t->intervals ? from : 2 * t->intervals];
    }
    trail_follow(&soft, modes);
    trail_free(t);
    *t = soft;
    return true;
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

/*
 * The same of any degree d, from 3 on (Cox, de Boor): weight_d,i = ((d - i + f)
 * weight_d-1,i-1 + (i + 1 - f) weight_d-1,i) / d
 */
void trail_curve_weights(unsigned modes, double f, double *weight)
{
    trail_weights(f, weight);
    for (size_t d = 4; d <= TRAIL_ENDS + 2 * (size_t)modes; d++) {
        weight[d] = 0;
        for (size_t i = d; i > 0; i--)
            weight[i] = (((double)(d - i) + f) * weight[i - 1] + ((double)i + 1 - f) * weight[i]) /
                        (double)d;
        weight[0] *= (1 - f) / (double)d;
    }
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

void trail_at(const struct trail *t, double (*control)[3], double u, double point[3])
{
    size_t k = (size_t)u;
    double weight[4];

    if (k >= t->intervals)
        k = t->intervals - 1;
    trail_weights(u - (double)k, weight);
    trail_sum(control + k, weight, point);
}
