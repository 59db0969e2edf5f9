/*
 * What evaluating a grid and its derivatives have in common. Private to this room.
 */
#ifndef TAKT_CORRECTION_GRID_STENCIL_H
#define TAKT_CORRECTION_GRID_STENCIL_H

#include "correction/edge.h"
#include "correction/grid.h"

#include <string.h>

#define STENCIL 4

/*
 * Four numbers side by side: processors that can work on four at once do so, others one after the other, with the same
 * bits.
 */
typedef float four __attribute__((vector_size(sizeof(float) * STENCIL)));

static inline four all(float value)
{
    return (four){value, value, value, value};
}

/* Four coefficients that stand side by side along the first input. */
static inline four load(const float *at)
{
    four values;

    memcpy(&values, at, sizeof(values));
    return values;
}

static const four weights_c0 = {1.0F / 6.0F, 4.0F / 6.0F, 1.0F / 6.0F, 0.0F};
static const four weights_c1 = {-0.5F, 0.0F, 0.5F, 0.0F};
static const four weights_c2 = {0.5F, -1.0F, 0.5F, 0.0F};
static const four weights_c3 = {-1.0F / 6.0F, 0.5F, -0.5F, 1.0F / 6.0F};

/*
 * The four B-splines that are not 0 in a cell, at t = 0 ... 1 in it (C. de Boor, 1978, chapter IX):
 *
 *     w0 = (1 - t)^3 / 6   w1 = (4 - 6 t^2 + 3 t^3) / 6   w2 = (1 + 3 t + 3 t^2 - 3 t^3) / 6   w3 = t^3 / 6
 */
static inline four weights(float t)
{
    return weights_c0 + all(t) * (weights_c1 + all(t) * (weights_c2 + all(t) * weights_c3));
}

/* Their derivatives by t. */
static inline four weights_first(float t)
{
    return weights_c1 + all(t) * (2.0F * weights_c2 + all(t) * (3.0F * weights_c3));
}

static inline four weights_second(float t)
{
    return 2.0F * weights_c2 + all(t) * (6.0F * weights_c3);
}

/* Beyond an end, or in the last cell: the same with all that holds there. */
static __attribute__((noinline)) size_t find_edge_cell(const struct grid_input *input,
                                                       double position, float *t, unsigned *outside)
{
    unsigned beyond = 0;
    const double held = edge_hold(position, input->last, &beyond);
    const uint32_t cell = held < 1.0 ? 0 : input->last_cell;

    *t = (float)(held - (double)cell);
    *outside |= beyond << input->axis;
    return cell * input->stride;
}

/* The cell a point is in along one input: where it begins, and how far in it the point is, in steps. */
static inline size_t find_cell(const struct grid_input *input, const struct point *at, float *t,
                               unsigned *outside)
{
    const double position = (at->at[input->axis] - input->first_mm) * input->per_mm;

    if (!(position >= 0.0 && position < input->last)) {
        return find_edge_cell(input, position, t, outside);
    }
    const int32_t cell = (int32_t)position;

    *t = (float)(position - (double)cell);
    return (size_t)(uint32_t)cell * input->stride;
}

static inline float finish(four sum, four weight)
{
    const four product = sum * weight;

    return (product[0] + product[1]) + (product[2] + product[3]);
}

#endif
