/*
 * The linear system of the relaxation: symmetric, a diagonal and three bands on each side of it,
 * for each group of lanes.
 */
#include "smooth/relax_parts.h"

#include "base/assert.h"

#include <string.h>

/* Units that a sample moves in one step at most. */
#define STEP_MAX 1048576.0f

/*
 * Products of the rows (1 4 1)/6, (1 -2 1), (-1 3 -3 1) with themselves, shifted by 0 to 3 samples.
 */
static const float near_products[4] = {18.0f / 36.0f, 8.0f / 36.0f, 1.0f / 36.0f, 0.0f};
static const float second_products[4] = {6.0f, -4.0f, 1.0f, 0.0f};
static const float third_products[4] = {20.0f, -15.0f, 6.0f, -1.0f};

/* Between samples that are not fixed every row is there. */
static void fill(struct relax *x, const struct window *w, unsigned group, float weight)
{
    const unsigned first = group * w->capacity;
    const float second = x->scale.second_per_near[group];
    const float third = x->scale.third_per_near[group];

    for (unsigned k = 0; k < 4; k++) {
        const float value = weight * near_products[k] + second * second * second_products[k] +
                            third * third * third_products[k];

        for (unsigned i = 0; i < w->count; i++) {
            x->band[k][first + i] = value;
        }
    }
}

static void add_corner(struct relax *x, const struct window *w, unsigned group, unsigned corner,
                       float weight)
{
    const unsigned first = group * w->capacity + x->corners.piece[corner];
    float row[4];

    TAKT_ASSERT(x->corners.piece[corner] + 3U < w->count);
    takt_window_weights(x->corners.fraction[corner], row);
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned k = i; k < 4; k++) {
            x->band[k - i][first + i] += weight * row[i] * row[k];
        }
    }
}

/*
 * L D L': the multipliers take the bands' places, 1/D that of the diagonal. What this does to fixed
 * samples behind is not looked at.
 */
static void factor(struct relax *x, const struct window *w, unsigned group)
{
    const unsigned first = group * w->capacity;
    float *restrict d0 = x->band[0] + first;
    float *restrict d1 = x->band[1] + first;
    float *restrict d2 = x->band[2] + first;
    float *restrict d3 = x->band[3] + first;

    TAKT_ASSERT(w->count <= w->capacity);
    for (unsigned i = SMOOTH_FIXED; i + SMOOTH_FIXED < w->count; i++) {
        const float per_d = 1.0f / d0[i];
        const float l1 = d1[i] * per_d;
        const float l2 = d2[i] * per_d;
        const float l3 = d3[i] * per_d;

        d0[i + 1] -= l1 * d1[i];
        d1[i + 1] -= l1 * d2[i];
        d2[i + 1] -= l1 * d3[i];
        d0[i + 2] -= l2 * d2[i];
        d1[i + 2] -= l2 * d3[i];
        d0[i + 3] -= l3 * d3[i];
        d0[i] = per_d;
        d1[i] = l1;
        d2[i] = l2;
        d3[i] = l3;
    }
}

void takt_bands_build(struct relax *x, const struct window *w, const struct route *r, float weight)
{
    for (unsigned g = 0; g < r->slots.groups; g++) {
        fill(x, w, g, weight);
        for (unsigned k = 0; k < x->corners.count; k++) {
            add_corner(x, w, g, k, weight);
        }
        factor(x, w, g);
    }
}

/* L, from the front, and 1/D. */
static void solve_front(struct relax *x, const struct window *w, unsigned group)
{
    const unsigned first = group * w->capacity;
    lanes *restrict v = x->step + first;
    const float *restrict d0 = x->band[0] + first;
    const float *restrict d1 = x->band[1] + first;
    const float *restrict d2 = x->band[2] + first;
    const float *restrict d3 = x->band[3] + first;
    lanes near = {0.0f};
    lanes far = near;
    lanes farthest = near;

    for (unsigned i = SMOOTH_FIXED; i + SMOOTH_FIXED < w->count; i++) {
        const lanes rest = v[i] - d3[i - 3] * farthest - d2[i - 2] * far;

        farthest = far;
        far = near;
        near = rest - d1[i - 1] * near;
        v[i] = d0[i] * near;
    }
}

void takt_bands_step(struct relax *x, struct window *w, unsigned group)
{
    const unsigned first = group * w->capacity;
    const lanes *restrict v = x->step + first;
    const float *restrict d1 = x->band[1] + first;
    const float *restrict d2 = x->band[2] + first;
    const float *restrict d3 = x->band[3] + first;
    const lanes per_near = x->scale.unit_per_near[group];
    const lanes most = {STEP_MAX, STEP_MAX, STEP_MAX, STEP_MAX};
    lanes_int *restrict c = w->x + first;
    lanes near = {0.0f};
    lanes far = near;
    lanes farthest = near;

    solve_front(x, w, group);
    for (unsigned i = w->count - SMOOTH_FIXED - 1; i >= SMOOTH_FIXED; i--) {
        const lanes rest = v[i] - d3[i] * farthest - d2[i] * far;

        farthest = far;
        far = near;
        near = rest - d1[i] * near;
        c[i] += lanes_int_of(lanes_clamp(near * per_near, most));
    }
}
