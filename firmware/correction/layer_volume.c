/* Volume table: corrections over a grid of X, Y, Z and the turning axis. */
#include "correction/layer.h"

static bool volume_begin(const struct correction *c, struct layer_notes *notes)
{
    (void)notes;
    return c->tables != NULL && c->tables->volume.inputs > 0;
}

static bool volume_prepare(struct correction *c)
{
    const struct grid *grid = &c->tables->volume;

    return grid->inputs != GRID_PATCH_INPUTS || takt_grid_patch_prepare(grid, &c->patches, c->at);
}

static void volume_add(struct correction *c, struct layer_notes *notes, double weight,
                       struct correction_sum *sum)
{
    (void)notes;
    const struct grid *grid = &c->tables->volume;

    sum->outside |= grid->inputs == GRID_PATCH_INPUTS
                        ? takt_grid_patch_add(grid, &c->patches, c->at, (float)weight, sum->fine)
                        : takt_grid_add(grid, c->at, (float)weight, sum->fine);
}

static void volume_need(const struct correction *c, const struct layer_notes *notes,
                        const struct motion_bound *most, struct need *need)
{
    (void)notes;
    takt_grid_need(&c->tables->volume, most, c->cycle_s, need);
}

const struct correction_layer takt_layer_volume = {
    .name = "volume",
    .begin = volume_begin,
    .prepare = volume_prepare,
    .add = volume_add,
    .need = volume_need,
};
