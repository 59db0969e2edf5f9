/*
 * What evaluating a grid and its derivatives have in common. Private to this room.
 */
#ifndef TAKT_CORRECTION_GRID_STENCIL_H
#define TAKT_CORRECTION_GRID_STENCIL_H

#include "correction/edge.h"
#include "correction/grid.h"

#include <string.h>

#define STENCIL 4

/* What a sum over the stencil consists of: inline where sources are built for size, too. */
#define GRID_INLINE inline __attribute__((always_inline))

/* Where the weights of derivatives stand behind those of the value. */
#define FIRST_ORDER  STENCIL
#define SECOND_ORDER (STENCIL + STENCIL)

/*
 * Numbers side by side along the first input that are worked on at once, 1 or 4: as many as suit
 * the processor. The bits are the same. A build for a processor that has no vectors says 1.
 */
#ifndef GRID_LANES
#define GRID_LANES STENCIL
#endif

/* Coefficients that stand side by side: load and store. */
#if GRID_LANES == 1
typedef float lanes;

static GRID_INLINE lanes load(const float *at)
{
    return *at;
}

static GRID_INLINE void store(float *to, lanes values)
{
    *to = values;
}
#else
typedef float lanes __attribute__((vector_size(sizeof(float) * GRID_LANES)));

static GRID_INLINE lanes load(const float *at)
{
    lanes values;

    memcpy(&values, at, sizeof(values));
    return values;
}

static GRID_INLINE void store(float *to, lanes values)
{
    memcpy(to, &values, sizeof(values));
}
#endif

static GRID_INLINE void set_weights_first(float t, float weight[STENCIL])
{
    weight[0] = -0.5F + t * (1.0F - t * 0.5F);
    weight[1] = t * (-2.0F + t * 1.5F);
    weight[2] = 0.5F + t * (1.0F - t * 1.5F);
    weight[3] = t * t * 0.5F;
}

/* Half of it, as Taylor's series has it. */
static GRID_INLINE void set_weights_second(float t, float weight[STENCIL])
{
    weight[0] = 0.5F - t * 0.5F;
    weight[1] = -1.0F + t * 1.5F;
    weight[2] = 0.5F - t * 1.5F;
    weight[3] = t * 0.5F;
}

/*
 * The cell a point is in along one input: where it begins, and how far in it the point is, in
 * steps.
 */
size_t takt_grid_find_cell(const struct grid_input *input, const struct point *at, float *t,
                           unsigned *outside);

/*
 * The four B-splines that are not 0 in a cell, at t = 0 ... 1 in it, and their first and half their
 * second derivatives by t (C. de Boor, 1978, chapter IX):
 *
 *     w0 = (1 - t)^3 / 6   w1 = (4 - 6 t^2 + 3 t^3) / 6   w2 = (1 + 3 t + 3 t^2 - 3 t^3) / 6   w3 = t^3 / 6
 *
 * as c0 + t (c1 + t (c2 + t c3)).
 */
void takt_grid_set_weights(float t, float weight[STENCIL]);

static GRID_INLINE float finish(const float sum[STENCIL], const float weight[STENCIL])
{
    return (sum[0] * weight[0] + sum[1] * weight[1]) + (sum[2] * weight[2] + sum[3] * weight[3]);
}

#endif
