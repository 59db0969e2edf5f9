/*
 * With r how far a patch is good (grid->reach) and w the way of a cycle, in steps, all inputs together:
 *
 *     |<------- r ------->|<------- r ------->|           a patch, and its anchor
 *     . . . . . . . . . . A . . . . . . . . x . | . . .   at x, MAKING w before its end, the next one is begun
 *                                               |<-- 3/4 r -->B
 *
 * Its anchor B lies ahead, so that it holds from when it is ready, and for nearly 2 r. A patch that would not last long
 * enough to make the next one is not made: then the spline itself is evaluated in every cycle.
 */
#include "correction/grid_patch.h"

#include "base/maths.h"
#include "correction/grid_bound.h"
#include "correction/grid_stencil.h"

/* Steps in which a component is made: half of its stencil, the other half, its terms. */
enum { STEP_FIRST, STEP_SECOND, STEP_TERMS, STEPS };

/*
 * Cycles that making a patch takes: its anchor, its cell and weights, then a step in each, then whether it is near an end.
 */
#define MAKING (3.0F + (float)(STEPS * GRID_COMPONENTS))

/* The first of these stages is that with cell and weights, the second that with the first step. */
#define FIRST_STEP 2U

/* A patch that would last fewer cycles than this is not worth making. */
#define LASTING_MIN 8.0F

/* The part of its reach at which a patch begins to hold when it is ready. */
#define AHEAD_RATIO 0.75F

/* What is left out at the distance r: |third derivative| r^3 / 6, all of them together. */
float grid_patch_reach(const struct grid *grid)
{
    double third = 0.0;

    for (unsigned i = 0; i < GRID_COMPONENTS; i++) {
        if ((grid->components & 1U << i) == 0) {
            continue;
        }
        third = maths_max(third, (double)grid_bound_third(grid, i));
    }
    return third > 0.0 ? (float)maths_min(0.5, maths_cbrt(6.0 * GRID_PATCH_ERROR_MM / third))
                       : 0.5F;
}

/* ---- making a patch ---- */

/* Sums over the second and third input, for derivatives (second, third): (0 0) (1 0) (0 1) (2 0) (1 1) (0 2). */
enum { SUM, SUM_Y, SUM_Z, SUM_YY, SUM_YZ, SUM_ZZ };

/* Each term of a patch: a sum, the derivative by the first input, and the factor of Taylor's series. */
static const struct {
    uint8_t sum, x;
    float factor;
} terms[GRID_PATCH_TERMS] = {
    {SUM, 0, 1.0F},    {SUM, 1, 1.0F},    {SUM_Y, 0, 1.0F}, {SUM_Z, 0, 1.0F}, {SUM, 2, 0.5F},
    {SUM_YY, 0, 0.5F}, {SUM_ZZ, 0, 0.5F}, {SUM_Y, 1, 1.0F}, {SUM_Z, 1, 1.0F}, {SUM_YZ, 0, 1.0F},
};

/* One column of a plane, weighted. */
static GRID_INLINE lanes weigh(const lanes column[STENCIL], const float *weight)
{
    lanes sum = weight[0] * column[0];

    sum += weight[1] * column[1];
    sum += weight[2] * column[2];
    sum += weight[3] * column[3];
    return sum;
}

static GRID_INLINE void add_to(float *sum, lanes values)
{
    store(sum, load(sum) + values);
}

/* Adds a column with its weights for the orders 0, 1, 2 along the second input and the third to the sums at x. */
static GRID_INLINE void add_column(const float *at, size_t row, const float *y, const float *z,
                                   float sum[GRID_PATCH_SUMS][STENCIL], unsigned x)
{
    const lanes column[STENCIL] = {load(at), load(at + row), load(at + 2 * row),
                                   load(at + 3 * row)};
    const lanes value = weigh(column, y);
    const lanes first = weigh(column, y + FIRST_ORDER);
    const lanes second = weigh(column, y + SECOND_ORDER);

    add_to(&sum[SUM][x], z[0] * value);
    add_to(&sum[SUM_Y][x], z[0] * first);
    add_to(&sum[SUM_Z][x], z[FIRST_ORDER] * value);
    add_to(&sum[SUM_YY][x], z[0] * second);
    add_to(&sum[SUM_YZ][x], z[FIRST_ORDER] * first);
    add_to(&sum[SUM_ZZ][x], z[SECOND_ORDER] * value);
}

/* Adds half of the stencil of a component: two of its planes. */
static void sum_half(const struct grid *grid, struct grid_patches *p, unsigned k, unsigned plane)
{
    const size_t row = grid->input[1].stride;
    const float *at = grid->coefficient + p->first + k * grid->size + plane * grid->input[2].stride;

    for (unsigned i = plane; i < plane + STENCIL / 2; i++) {
        for (unsigned x = 0; x < STENCIL; x += GRID_LANES) {
            add_column(at + x, row, p->weight[1], &p->weight[2][i], p->sum, x);
        }
        at += grid->input[2].stride;
    }
}

/* From the sums of a component; the next one begins with none. */
static void set_terms(struct grid_patches *p, unsigned k)
{
    for (unsigned n = 0; n < GRID_PATCH_TERMS; n++) {
        p->next.term[n][k] = terms[n].factor * finish(p->sum[terms[n].sum],
                                                      p->weight[0] + (size_t)terms[n].x * STENCIL);
    }
    memset(p->sum, 0, sizeof(p->sum));
}

static unsigned components_of(const struct grid *grid)
{
    return grid->turn_axis < AXIS_COUNT ? GRID_COMPONENTS : AXIS_LINEAR_COUNT;
}

/* Patches know nothing of what holds beyond the ends of the table. */
static bool is_inside(const struct grid *grid, const double at_mm[GRID_PATCH_INPUTS], double margin)
{
    bool inside = true;

    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const struct grid_input *input = &grid->input[i];
        const double position = (at_mm[i] - input->first_mm) * input->per_mm;

        inside = inside && position >= margin && position <= input->last - margin;
    }
    return inside;
}

/* Cell and weights at the anchor. */
static void begin_patch(const struct grid *grid, struct grid_patches *p)
{
    struct point anchor;
    unsigned outside = 0;

    p->first = 0;
    memset(p->sum, 0, sizeof(p->sum));
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        float t;

        anchor.at[grid->input[i].axis] = p->next.anchor_mm[i];
        p->first += find_cell(&grid->input[i], &anchor, &t, &outside);
        set_weights(t, p->weight[i]);
        set_weights_first(t, &p->weight[i][FIRST_ORDER]);
        set_weights_second(t, &p->weight[i][SECOND_ORDER]);
    }
    p->stage = outside == 0 ? FIRST_STEP : 0;
}

/* ---- using it ---- */

static inline float length(const float way[GRID_PATCH_INPUTS])
{
    return __builtin_fabsf(way[0]) + __builtin_fabsf(way[1]) + __builtin_fabsf(way[2]);
}

/* From the anchor, in steps of each input. */
static inline void way_from(const struct grid *grid, const struct grid_patch *patch,
                            const struct point *at, float way[GRID_PATCH_INPUTS])
{
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const struct grid_input *input = &grid->input[i];

        way[i] = (float)(at->at[input->axis] - patch->anchor_mm[i]) * input->steps_per_mm;
    }
}

/*
 * Taylor's series to the second order, in Horner's form. The value at the anchor comes last, so that what changes from
 * cycle to cycle is added up before it is rounded to the size of the whole.
 */
static inline float value_of(const struct grid_patch *p, const float way[GRID_PATCH_INPUTS],
                             unsigned k)
{
    const float of_x =
        p->term[1][k] + way[0] * p->term[4][k] + way[1] * p->term[7][k] + way[2] * p->term[8][k];
    const float of_y = p->term[2][k] + way[1] * p->term[5][k] + way[2] * p->term[9][k];
    const float of_z = p->term[3][k] + way[2] * p->term[6][k];

    return p->term[0][k] + (way[0] * of_x + (way[1] * of_y + way[2] * of_z));
}

static void add_value(const struct grid *grid, const struct grid_patches *p, float weight,
                      float k[AXIS_COUNT])
{
    k[0] += weight * value_of(&p->used, p->way, 0);
    k[1] += weight * value_of(&p->used, p->way, 1);
    k[2] += weight * value_of(&p->used, p->way, 2);
    if (grid->turn_axis < AXIS_COUNT) {
        k[grid->turn_axis] += weight * value_of(&p->used, p->way, AXIS_LINEAR_COUNT);
    }
}

static void get_inputs(const struct grid *grid, const struct point *at,
                       double at_mm[GRID_PATCH_INPUTS])
{
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        at_mm[i] = at->at[grid->input[i].axis];
    }
}

static bool holds(const struct grid *grid, const struct grid_patch *patch, float distance,
                  const struct point *at)
{
    double at_mm[GRID_PATCH_INPUTS];

    if (!patch->valid || distance > grid->reach || !patch->near_end) {
        return patch->valid && distance <= grid->reach;
    }
    get_inputs(grid, at, at_mm);
    return is_inside(grid, at_mm, 0.0);
}

/* Where the axes will be when the next patch is ready, and most of its reach further on; or here, close to an end. */
static void set_anchor(const struct grid *grid, struct grid_patches *p, const struct point *at,
                       const float step[GRID_PATCH_INPUTS], float speed)
{
    const float cycles = speed > 0.0F ? MAKING + AHEAD_RATIO * grid->reach / speed : 0.0F;

    get_inputs(grid, at, p->next.anchor_mm);
    if (!(cycles < 1e6F)) {
        return;
    }
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        p->next.anchor_mm[i] += (double)(cycles * step[i] * grid->input[i].mm_per_step);
    }
    if (!is_inside(grid, p->next.anchor_mm, 0.0)) {
        get_inputs(grid, at, p->next.anchor_mm);
    }
}

/* A step of a component. */
static void make_step(const struct grid *grid, struct grid_patches *p, unsigned k, unsigned step)
{
    switch (step) {
    case STEP_FIRST:
        sum_half(grid, p, k, 0);
        break;
    case STEP_SECOND:
        sum_half(grid, p, k, STENCIL / 2);
        break;
    default:
        set_terms(p, k);
        break;
    }
    p->stage++;
}

/* One cycle of making the next patch. When it is ready it takes over. */
static void make(const struct grid *grid, struct grid_patches *p, const struct point *at)
{
    if (p->stage < FIRST_STEP) {
        begin_patch(grid, p);
        return;
    }
    const unsigned k = (p->stage - FIRST_STEP) / STEPS;

    if (k < components_of(grid)) {
        make_step(grid, p, k, (p->stage - FIRST_STEP) % STEPS);
        return;
    }
    p->next.near_end = !is_inside(grid, p->next.anchor_mm, (double)grid->reach);
    p->next.valid = true;
    p->used = p->next;
    p->stage = 0;
    way_from(grid, &p->used, at, p->way);
}

/* Begins the next patch when this one will soon be left, and if that will last. before: the way a cycle ago. */
static void look_ahead(const struct grid *grid, struct grid_patches *p, const struct point *at,
                       const float before[GRID_PATCH_INPUTS], float distance)
{
    float step[GRID_PATCH_INPUTS];

    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        step[i] = p->way[i] - before[i];
    }
    const float speed = length(step);
    const bool leaves = distance > length(before) && distance + MAKING * speed > grid->reach;

    if ((leaves || !p->used.valid) && LASTING_MIN * speed <= grid->reach) {
        set_anchor(grid, p, at, step, speed);
        p->stage = 1;
    }
}

/* Without a patch its anchor is where the axes are, so that the way from it is that of a cycle. */
static unsigned add_spline(const struct grid *grid, struct grid_patches *p, const struct point *at,
                           float weight, float k[AXIS_COUNT])
{
    p->used.valid = false;
    get_inputs(grid, at, p->used.anchor_mm);
    return grid_add(grid, at, weight, k);
}

unsigned grid_patch_add(const struct grid *grid, struct grid_patches *p, const struct point *at,
                        float weight, float k[AXIS_COUNT])
{
    float before[GRID_PATCH_INPUTS];
    unsigned outside = 0;

    memcpy(before, p->way, sizeof(before));
    way_from(grid, &p->used, at, p->way);
    const float distance = length(p->way);

    if (holds(grid, &p->used, distance, at)) {
        add_value(grid, p, weight, k);
    } else {
        outside = add_spline(grid, p, at, weight, k);
    }
    if (p->stage != 0) {
        make(grid, p, at);
    } else if (outside == 0) {
        look_ahead(grid, p, at, before, distance);
    }
    if (!p->used.valid) {
        memset(p->way, 0, sizeof(p->way));
    }
    return outside;
}
