/* What following a grid takes of the axes: K as a function of time, differentiated three times. */
#include "base/assert.h"
#include "base/maths.h"
#include "correction/edge.h"
#include "correction/grid_bound.h"
#include "correction/grid_patch.h"

/*
 * Room for what is not bounded one by one: differences over whole cycles instead of derivatives,
 * and second derivatives of the hold at the edges in mixed terms. Only terms of second and third
 * order have it, which are small.
 */
#define NEED_MARGIN 2.0

struct sums {
    const struct grid *grid;
    const struct motion_bound *most;
    double cycle_s;
    struct need *need;
    unsigned component;
};

static unsigned corrected(const struct sums *s)
{
    TAKT_ASSERT(s->component < GRID_COMPONENTS);
    return s->component < AXIS_LINEAR_COUNT ? s->component : s->grid->turn_axis;
}

/* For the derivative by inputs i, j and k, per mm or rad instead of per step. */
static double largest(const struct sums *s, unsigned i, unsigned j, unsigned k)
{
    const unsigned by[] = {i, j, k};
    double most = (double)takt_grid_bound(s->grid, s->component, i, j, k);

    for (unsigned n = 0; n < 3; n++) {
        most *= by[n] != GRID_NO_INPUT ? s->grid->input[by[n]].per_mm : 1.0;
    }
    return most;
}

/* Beyond an edge, d2u/dx2 and d3u/dx3 of the hold come in. */
static void add_first(const struct sums *s, unsigned i)
{
    const struct grid_input *input = &s->grid->input[i];
    const double v = s->most->velocity_mm_s[input->axis];
    const double slope = largest(s, i, GRID_NO_INPUT, GRID_NO_INPUT) +
                         (double)(grid_patch_slope(s->grid) * input->steps_per_mm);

    takt_need_add_slope(s->need, corrected(s), input->axis, slope, s->most);
    s->need->acceleration_mm_s2[corrected(s)] += slope * EDGE_SECOND_MAX * input->per_mm * v * v;
    s->need->jerk_mm_s3[corrected(s)] +=
        slope * EDGE_THIRD_MAX * input->per_mm * input->per_mm * v * v * v +
        slope * EDGE_SECOND_MAX * input->per_mm * 3.0 * v *
            s->most->acceleration_mm_s2[input->axis];
}

/* acceleration: q_ij v_i v_j, jerk: 3 q_ij v_i a_j, summed over all ordered pairs. */
static void add_second(const struct sums *s, unsigned i, unsigned j)
{
    const unsigned a = s->grid->input[i].axis;
    const unsigned b = s->grid->input[j].axis;
    const double q = NEED_MARGIN * largest(s, i, j, GRID_NO_INPUT);

    s->need->acceleration_mm_s2[corrected(s)] +=
        q * s->most->velocity_mm_s[a] * s->most->velocity_mm_s[b];
    s->need->jerk_mm_s3[corrected(s)] +=
        3.0 * q * s->most->velocity_mm_s[a] * s->most->acceleration_mm_s2[b];
}

static void add_third(const struct sums *s, unsigned i, unsigned j, unsigned k)
{
    s->need->jerk_mm_s3[corrected(s)] += NEED_MARGIN * largest(s, i, j, k) *
                                         s->most->velocity_mm_s[s->grid->input[i].axis] *
                                         s->most->velocity_mm_s[s->grid->input[j].axis] *
                                         s->most->velocity_mm_s[s->grid->input[k].axis];
}

/* Steps of all inputs together. */
static float speed_per_s(const struct sums *s)
{
    float sum = 0.0F;

    for (unsigned i = 0; i < s->grid->inputs; i++) {
        const struct grid_input *input = &s->grid->input[i];

        sum += (float)s->most->velocity_mm_s[input->axis] * input->steps_per_mm;
    }
    return sum;
}

/* Grids over three axes are followed by patches. */
static void add_patches(const struct sums *s)
{
    const double jerk_mm_s3 = (double)takt_grid_patch_jerk(
        s->grid, takt_grid_bound_third(s->grid, s->component), speed_per_s(s), (float)s->cycle_s);
    const double by_cycle = jerk_mm_s3 * s->cycle_s;

    s->need->noise_mm[corrected(s)] += GRID_PATCH_NEAR_MM;
    s->need->jerk_mm_s3[corrected(s)] += jerk_mm_s3;
    s->need->acceleration_mm_s2[corrected(s)] += GRID_PATCH_ACCELERATION * by_cycle;
    s->need->velocity_mm_s[corrected(s)] += GRID_PATCH_VELOCITY * by_cycle * s->cycle_s;
}

static void add_component(const struct sums *s)
{
    const double size = largest(s, GRID_NO_INPUT, GRID_NO_INPUT, GRID_NO_INPUT);

    if (s->grid->inputs == GRID_PATCH_INPUTS) {
        add_patches(s);
    }

    s->need->size_mm[corrected(s)] += size;
    s->need->noise_mm[corrected(s)] += NEED_ROUNDING * size;
    for (unsigned i = 0; i < s->grid->inputs; i++) {
        add_first(s, i);
        for (unsigned j = 0; j < s->grid->inputs; j++) {
            add_second(s, i, j);
            for (unsigned k = 0; k < s->grid->inputs; k++) {
                add_third(s, i, j, k);
            }
        }
    }
}

void takt_grid_need(const struct grid *grid, const struct motion_bound *most, double cycle_s,
                    struct need *need)
{
    struct sums s = {.grid = grid, .most = most, .cycle_s = cycle_s, .need = need};

    TAKT_ASSERT(cycle_s > 0.0);
    for (s.component = 0; s.component < GRID_COMPONENTS; s.component++) {
        if ((grid->components & 1U << s.component) != 0) {
            add_component(&s);
        }
    }
}
