#include "correction/grid_patch.h"

#include "base/maths.h"
#include "correction/grid_bound.h"
#include "correction/grid_stencil.h"

/* A patch that would last fewer cycles than this is not worth making. */
#define PATCH_CYCLES_MIN 3.0F

/* What is left out at the distance r: |third derivative| r^3 / 6, all of them together. */
float grid_patch_reach(const struct grid *grid)
{
    double third = 0.0;

    for (unsigned i = 0; i < GRID_COMPONENTS; i++) {
        if ((grid->components & 1U << i) == 0) {
            continue;
        }
        third = maths_max(third, grid_bound_third(grid, i));
    }
    return third > 0.0 ? (float)maths_min(0.5, maths_cbrt(6.0 * GRID_PATCH_ERROR_MM / third))
                       : 0.5F;
}

/* ---- making a patch ---- */

/* B-splines along one input, and their derivatives. */
struct jet {
    four weight[3];
};

/* Sums over the second and third input, for derivatives (second, third): (0 0) (1 0) (0 1) (2 0) (1 1) (0 2). */
enum { SUM, SUM_Y, SUM_Z, SUM_YY, SUM_YZ, SUM_ZZ, SUMS };

static const struct {
    uint8_t y, z;
} sum_orders[SUMS] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};

/* Each term of a patch: a sum, the derivative by the first input, and the factor of Taylor's series. */
static const struct {
    uint8_t sum, x;
    float factor;
} terms[GRID_PATCH_TERMS] = {
    {SUM, 0, 1.0F},    {SUM, 1, 1.0F},    {SUM_Y, 0, 1.0F}, {SUM_Z, 0, 1.0F}, {SUM, 2, 0.5F},
    {SUM_YY, 0, 0.5F}, {SUM_ZZ, 0, 0.5F}, {SUM_Y, 1, 1.0F}, {SUM_Z, 1, 1.0F}, {SUM_YZ, 0, 1.0F},
};

/* One plane of the stencil, for the derivatives of order 0, 1, 2 along the second input. */
static inline void sum_plane(const struct grid *grid, const float *at, const struct jet *y,
                             four plane[3])
{
    plane[0] = plane[1] = plane[2] = all(0.0F);
    for (unsigned j = 0; j < STENCIL; j++) {
        const four row = load(at);

        for (unsigned n = 0; n < 3; n++) {
            plane[n] += all(y->weight[n][j]) * row;
        }
        at += grid->input[1].stride;
    }
}

static void sum_stencil(const struct grid *grid, const float *at, const struct jet jet[],
                        four sum[SUMS])
{
    four plane[3];

    for (unsigned n = 0; n < SUMS; n++) {
        sum[n] = all(0.0F);
    }
    for (unsigned i = 0; i < STENCIL; i++) {
        sum_plane(grid, at, &jet[1], plane);
        for (unsigned n = 0; n < SUMS; n++) {
            sum[n] += all(jet[2].weight[sum_orders[n].z][i]) * plane[sum_orders[n].y];
        }
        at += grid->input[2].stride;
    }
}

static void set_jet(float t, struct jet *jet)
{
    jet->weight[0] = weights(t);
    jet->weight[1] = weights_first(t);
    jet->weight[2] = weights_second(t);
}

/* False: the point is outside. */
static bool make_patch(const struct grid *grid, const struct point *at, struct grid_patch *patch)
{
    struct jet jet[GRID_PATCH_INPUTS];
    unsigned outside = 0;
    size_t first = 0;
    four sum[SUMS];

    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        float t;

        first += find_cell(&grid->input[i], at, &t, &outside);
        set_jet(t, &jet[i]);
        patch->anchor_mm[i] = at->at[grid->input[i].axis];
    }
    const unsigned components = grid->turn_axis < AXIS_COUNT ? GRID_COMPONENTS : AXIS_LINEAR_COUNT;

    for (unsigned k = 0; k < components && outside == 0; k++) {
        sum_stencil(grid, grid->coefficient + first + k * grid->size, jet, sum);
        for (unsigned n = 0; n < GRID_PATCH_TERMS; n++) {
            patch->term[n][k] =
                terms[n].factor * finish(sum[terms[n].sum], jet[0].weight[terms[n].x]);
        }
    }
    return outside == 0;
}

/* ---- using it ---- */

static inline float length(float x, float y, float z)
{
    return __builtin_fabsf(x) + __builtin_fabsf(y) + __builtin_fabsf(z);
}

/* Way from a place, in steps of each input. */
static inline void way_from(const struct grid *grid, const double from_mm[GRID_PATCH_INPUTS],
                            const struct point *at, float way[GRID_PATCH_INPUTS])
{
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const struct grid_input *input = &grid->input[i];

        way[i] = (float)((at->at[input->axis] - from_mm[i]) * input->per_mm);
    }
}

/*
 * Taylor's series to the second order, in Horner's form. The value at the anchor comes last, so that what changes from
 * cycle to cycle is added up before it is rounded to the size of the whole.
 */
static inline four patch_value(const struct grid_patch *p, const float way[GRID_PATCH_INPUTS])
{
    const four x = all(way[0]);
    const four y = all(way[1]);
    const four z = all(way[2]);
    const four of_x =
        load(p->term[1]) + x * load(p->term[4]) + y * load(p->term[7]) + z * load(p->term[8]);
    const four of_y = load(p->term[2]) + y * load(p->term[5]) + z * load(p->term[9]);
    const four of_z = load(p->term[3]) + z * load(p->term[6]);

    return load(p->term[0]) + (x * of_x + (y * of_y + z * of_z));
}

static void add_value(const struct grid *grid, four value, float weight, float k[AXIS_COUNT])
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        k[i] += weight * value[i];
    }
    if (grid->turn_axis < AXIS_COUNT) {
        k[grid->turn_axis] += weight * value[AXIS_LINEAR_COUNT];
    }
}

/* Patches know nothing of what holds beyond the ends of the table. */
static bool is_inside(const struct grid *grid, const struct point *at, double margin)
{
    bool inside = true;

    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const struct grid_input *input = &grid->input[i];
        const double position = (at->at[input->axis] - input->first_mm) * input->per_mm;

        inside = inside && position >= margin && position <= input->last - margin;
    }
    return inside;
}

/* The patch is left, or there is none: makes one if it will last, else evaluates the spline itself. */
static unsigned renew(const struct grid *grid, struct grid_patch *patch, const struct point *at,
                      float weight, float k[AXIS_COUNT])
{
    float step[GRID_PATCH_INPUTS];

    way_from(grid, patch->before_mm, at, step);
    patch->valid = PATCH_CYCLES_MIN * length(step[0], step[1], step[2]) <= grid->reach &&
                   make_patch(grid, at, patch);
    if (!patch->valid) {
        return grid_add(grid, at, weight, k);
    }
    patch->near_end = !is_inside(grid, at, (double)grid->reach);
    add_value(grid, load(patch->term[0]), weight, k);
    return 0;
}

unsigned grid_patch_add(const struct grid *grid, struct grid_patch *patch, const struct point *at,
                        float weight, float k[AXIS_COUNT])
{
    float way[GRID_PATCH_INPUTS];
    unsigned outside = 0;

    way_from(grid, patch->anchor_mm, at, way);
    if (patch->valid && length(way[0], way[1], way[2]) <= grid->reach &&
        (!patch->near_end || is_inside(grid, at, 0.0))) {
        add_value(grid, patch_value(patch, way), weight, k);
    } else {
        outside = renew(grid, patch, at, weight, k);
    }
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        patch->before_mm[i] = at->at[grid->input[i].axis];
    }
    return outside;
}
