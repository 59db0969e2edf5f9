#include "correction/grid.h"

#include "base/assert.h"
#include "correction/grid_stencil.h"

/* Where a point is in a grid: where its stencil begins, and the weights along each input. */
struct place {
    size_t first;
    float weight[TABLE_INPUTS_MAX][STENCIL];
};

/* Beyond an end, or in the last cell: the same with all that holds there. */
static __attribute__((noinline)) size_t find_edge_cell(const struct grid_input *input,
                                                       double position, float *t, unsigned *outside)
{
    unsigned beyond = 0;
    const double held = takt_edge_hold(position, input->last, &beyond);
    const uint32_t cell = held < 1.0 ? 0 : input->last_cell;

    *t = (float)(held - (double)cell);
    *outside |= beyond << input->axis;
    return cell * input->stride;
}

size_t takt_grid_find_cell(const struct grid_input *input, const struct point *at, float *t,
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

/* As c0 + t (c1 + t (c2 + t c3)). */
void takt_grid_set_weights(float t, float weight[STENCIL])
{
    weight[0] = 1.0F / 6.0F + t * (-0.5F + t * (0.5F - t * (1.0F / 6.0F)));
    weight[1] = 4.0F / 6.0F + t * t * (-1.0F + t * 0.5F);
    weight[2] = 1.0F / 6.0F + t * (0.5F + t * (0.5F - t * 0.5F));
    weight[3] = t * t * t * (1.0F / 6.0F);
}

/*
 * ---- the sum over the stencil: first over all inputs but the first, side by side along that one
 * ----
 */

/* One column of a plane, over its rows. */
static GRID_INLINE void add_column(const float *at, size_t row, const float *y, float z, lanes *sum)
{
    lanes column = y[0] * load(at);

    column += y[1] * load(at + row);
    column += y[2] * load(at + 2 * row);
    column += y[3] * load(at + 3 * row);
    *sum += z * column;
}

/* All columns, which stand at constant places. */
static GRID_INLINE void add_plane(const float *at, size_t row, const float *y, float z,
                                  lanes sum[STENCIL / GRID_LANES])
{
    add_column(at, row, y, z, &sum[0]);
    if (GRID_LANES == 1) {
        add_column(at + 1, row, y, z, &sum[1 / GRID_LANES]);
        add_column(at + 2, row, y, z, &sum[2 / GRID_LANES]);
        add_column(at + 3, row, y, z, &sum[3 / GRID_LANES]);
    }
}

/* One component. */
static GRID_INLINE float add_planes(const struct grid *grid, const float *at,
                                    const struct place *place)
{
    lanes sum[STENCIL / GRID_LANES];
    float total[STENCIL];

    memset(sum, 0, sizeof(sum));
    for (unsigned i = 0; i < STENCIL; i++) {
        add_plane(at, grid->input[1].stride, place->weight[1], place->weight[2][i], sum);
        at += grid->input[2].stride;
    }
    memcpy(total, sum, sizeof(total));
    return finish(total, place->weight[0]);
}

/* The common case: X, Y, Z over X, Y, Z. */
static unsigned add_three(const struct grid *grid, const struct point *at, float weight,
                          float k[AXIS_COUNT])
{
    struct place place;
    unsigned outside = 0;
    float t;

    place.first = 0;
    for (unsigned i = 0; i < 3; i++) {
        place.first += takt_grid_find_cell(&grid->input[i], at, &t, &outside);
        takt_grid_set_weights(t, place.weight[i]);
    }
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        k[i] += weight * add_planes(grid, grid->coefficient + place.first + i * grid->size, &place);
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

    TAKT_ASSERT(grid->inputs >= 2 && grid->inputs <= TABLE_INPUTS_MAX);
    for (unsigned i = 0; i < grid->inputs; i++) {
        place.first += takt_grid_find_cell(&grid->input[i], at, &t, &outside);
        takt_grid_set_weights(t, place.weight[i]);
    }
    sum_any(grid, &place, components, sum);
    for (unsigned i = 0; i < components; i++) {
        k[i < AXIS_LINEAR_COUNT ? i : grid->turn_axis] += weight * finish(sum[i], place.weight[0]);
    }
    return outside;
}

unsigned takt_grid_add(const struct grid *grid, const struct point *at, float weight,
                       float k[AXIS_COUNT])
{
    if (grid->inputs == 3 && grid->turn_axis == AXIS_COUNT) {
        return add_three(grid, at, weight, k);
    }
    return add_any(grid, at, weight, k);
}
