#include "correction/grid.h"

#include "correction/grid_stencil.h"

/* Where a point is in a grid: where its stencil begins, and the weights along each input. */
struct place {
    size_t first;
    float weight[TABLE_INPUTS_MAX][STENCIL];
};

/* ---- the sum over the stencil: first over all inputs but the first, side by side along that one ---- */

/* One row of it, for X, Y and Z. */
static inline void add_row(const struct grid *grid, const float *at, float weight, lanes plane[3])
{
    plane[0] += weight * load(at);
    plane[1] += weight * load(at + grid->size);
    plane[2] += weight * load(at + 2 * grid->size);
}

static inline void add_plane(const struct grid *grid, const float *at, const float *y, float z,
                             lanes sum[3])
{
    const size_t row = grid->input[1].stride;
    lanes plane[AXIS_LINEAR_COUNT];

    memset(plane, 0, sizeof(plane));
    add_row(grid, at, y[0], plane);
    add_row(grid, at + row, y[1], plane);
    add_row(grid, at + 2 * row, y[2], plane);
    add_row(grid, at + 3 * row, y[3], plane);
    sum[0] += z * plane[0];
    sum[1] += z * plane[1];
    sum[2] += z * plane[2];
}

/* The common case: X, Y, Z over X, Y, Z. */
static unsigned add_three(const struct grid *grid, const struct point *at, float weight,
                          float k[AXIS_COUNT])
{
    struct place place;
    float total[AXIS_LINEAR_COUNT][STENCIL];
    unsigned outside = 0;
    float t;

    place.first = 0;
    for (unsigned i = 0; i < 3; i++) {
        place.first += find_cell(&grid->input[i], at, &t, &outside);
        set_weights(t, place.weight[i]);
    }
    for (unsigned x = 0; x < STENCIL; x += GRID_LANES) {
        const float *plane = grid->coefficient + place.first + x;
        lanes sum[AXIS_LINEAR_COUNT];

        memset(sum, 0, sizeof(sum));
        for (unsigned i = 0; i < STENCIL; i++) {
            add_plane(grid, plane, place.weight[1], place.weight[2][i], sum);
            plane += grid->input[2].stride;
        }
        store(&total[0][x], sum[0]);
        store(&total[1][x], sum[1]);
        store(&total[2][x], sum[2]);
    }
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        k[i] += weight * finish(total[i], place.weight[0]);
    }
    return outside;
}

/* ---- any number of inputs, and the turning axis ---- */

/* A plane of one component: the rows along the second input. */
static void add_any_plane(const float *at, size_t stride, const float *y, float weight,
                          float sum[STENCIL])
{
    for (unsigned x = 0; x < STENCIL; x++) {
        float plane = 0.0F;

        for (unsigned j = 0; j < STENCIL; j++) {
            plane += y[j] * at[j * stride + x];
        }
        sum[x] += weight * plane;
    }
}

/* Over the planes that the third and fourth input make, where there are such. */
static void sum_any(const struct grid *grid, const struct place *place, unsigned components,
                    float sum[][STENCIL])
{
    unsigned planes = 1;

    for (unsigned i = 2; i < grid->inputs; i++) {
        planes *= STENCIL;
    }
    for (unsigned n = 0; n < planes; n++) {
        const float *at = grid->coefficient + place->first;
        float weight = 1.0F;

        for (unsigned i = 2; i < grid->inputs; i++) {
            const unsigned j = n >> (2U * (i - 2U)) & 3U;

            weight *= place->weight[i][j];
            at += j * grid->input[i].stride;
        }
        for (unsigned k = 0; k < components; k++) {
            add_any_plane(at + k * grid->size, grid->input[1].stride, place->weight[1], weight,
                          sum[k]);
        }
    }
}

static unsigned add_any(const struct grid *grid, const struct point *at, float weight,
                        float k[AXIS_COUNT])
{
    const unsigned components = grid->turn_axis < AXIS_COUNT ? GRID_COMPONENTS : AXIS_LINEAR_COUNT;
    float sum[GRID_COMPONENTS][STENCIL] = {{0.0F}};
    struct place place = {0};
    unsigned outside = 0;
    float t;

    for (unsigned i = 0; i < grid->inputs; i++) {
        place.first += find_cell(&grid->input[i], at, &t, &outside);
        set_weights(t, place.weight[i]);
    }
    sum_any(grid, &place, components, sum);
    for (unsigned i = 0; i < components; i++) {
        k[i < AXIS_LINEAR_COUNT ? i : grid->turn_axis] += weight * finish(sum[i], place.weight[0]);
    }
    return outside;
}

unsigned grid_add(const struct grid *grid, const struct point *at, float weight,
                  float k[AXIS_COUNT])
{
    if (grid->inputs == 3 && grid->turn_axis == AXIS_COUNT) {
        return add_three(grid, at, weight, k);
    }
    return add_any(grid, at, weight, k);
}
