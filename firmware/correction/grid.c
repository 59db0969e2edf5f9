#include "correction/grid.h"

#include "correction/grid_stencil.h"

/* Where a point is in a grid: where its stencil begins, and the weights along each input. */
struct place {
    size_t first;
    four weight[TABLE_INPUTS_MAX];
};

static inline unsigned find_place(const struct grid *grid, unsigned inputs, const struct point *at,
                                  struct place *place)
{
    unsigned outside = 0;
    float t;

    place->first = 0;
    for (unsigned i = 0; i < inputs; i++) {
        place->first += find_cell(&grid->input[i], at, &t, &outside);
        place->weight[i] = weights(t);
    }
    return outside;
}

/* ---- the sum over the stencil: first over all inputs but the first, four numbers at a time ---- */

static inline void add_plane(const struct grid *grid, const float *at, four weight,
                             unsigned components, four *sum)
{
    for (unsigned j = 0; j < STENCIL; j++) {
        const four w = all(weight[j]);

        for (unsigned k = 0; k < components; k++) {
            sum[k] += w * load(at + k * grid->size);
        }
        at += grid->input[1].stride;
    }
}

static inline void add_volume(const struct grid *grid, const float *at, const struct place *place,
                              four weight, unsigned components, four *sum)
{
    for (unsigned i = 0; i < STENCIL; i++) {
        add_plane(grid, at, all(place->weight[2][i]) * weight, components, sum);
        at += grid->input[2].stride;
    }
}

static inline void add_xyz(const four sum[3], four weight, float k[AXIS_COUNT])
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        k[i] += finish(sum[i], weight);
    }
}

/* The common case: X, Y, Z over X, Y, Z. */
static unsigned add_three(const struct grid *grid, const struct point *at, float weight,
                          float k[AXIS_COUNT])
{
    struct place place;
    four sum[AXIS_LINEAR_COUNT] = {{0.0F}};
    const unsigned outside = find_place(grid, 3, at, &place);

    add_volume(grid, grid->coefficient + place.first, &place, place.weight[1], AXIS_LINEAR_COUNT,
               sum);
    add_xyz(sum, all(weight) * place.weight[0], k);
    return outside;
}

/* Any number of inputs, and the turning axis. */
static void sum_any(const struct grid *grid, const struct place *place, four *sum)
{
    const float *at = grid->coefficient + place->first;
    const unsigned components = grid->turn_axis < AXIS_COUNT ? GRID_COMPONENTS : AXIS_LINEAR_COUNT;

    if (grid->inputs == 2) {
        add_plane(grid, at, place->weight[1], components, sum);
    } else if (grid->inputs == 3) {
        add_volume(grid, at, place, place->weight[1], components, sum);
    } else {
        for (unsigned i = 0; i < STENCIL; i++) {
            add_volume(grid, at + i * grid->input[3].stride, place,
                       all(place->weight[3][i]) * place->weight[1], components, sum);
        }
    }
}

static unsigned add_any(const struct grid *grid, const struct point *at, float weight,
                        float k[AXIS_COUNT])
{
    struct place place = {0};
    four sum[GRID_COMPONENTS] = {{0.0F}};
    const unsigned outside = find_place(grid, grid->inputs, at, &place);
    const four last = all(weight) * place.weight[0];

    sum_any(grid, &place, sum);
    add_xyz(sum, last, k);
    if (grid->turn_axis < AXIS_COUNT) {
        k[grid->turn_axis] += finish(sum[GRID_COMPONENTS - 1], last);
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
