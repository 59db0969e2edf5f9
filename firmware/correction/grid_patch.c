/*
 * With M the cycles that making a patch takes, B those of going over to it, and w the way of a
 * cycle in steps, all inputs together:
 *
 *     make ---- M ----> go over - B -> use ---- M ----> go over - B ->
 *                       |<------------ a patch holds ------------->|
 *                                        A                              its anchor, (M / 2 + B) w from both ends
 *
 * when the axes go so fast that the next patch is needed as soon as it can be made; slower ones use
 * a patch for as long as it is good to GRID_PATCH_NEAR_MM. Axes too fast even for that, beyond
 * GRID_PATCH_FAR, are corrected by the spline itself.
 */
#include "correction/grid_patch.h"

#include "base/assert.h"
#include "base/maths.h"
#include "correction/grid_bound.h"
#include "correction/grid_stencil.h"

/*
 * Stages of making a patch after its anchor: its cell, its weights, then of each component the four
 * lines of its stencil and its terms.
 */
enum { STAGE_NONE, STAGE_CELL, STAGE_WEIGHTS, STAGE_LINES };

/*
 * Going over from one patch to the other in B = 8 cycles: what moves from 0 to 1 with the least
 * third derivative,
 *
 *     w = 16/3 t^3 for t <= 1/4,  1/2 + 2 u - 16/3 u^3 with u = t - 1/2 up to 3/4,  the first part backwards to 1
 *
 * and of its derivatives by the cycle |w'| <= 2 / B, |w''| <= 8 / B^2, |w'''| <= 32 / B^3.
 */
#define GOING 8U
static const float share[GOING] = {0.0F,          1.0F / 96.0F,  8.0F / 96.0F,  25.0F / 96.0F,
                                   48.0F / 96.0F, 71.0F / 96.0F, 88.0F / 96.0F, 95.0F / 96.0F};

/*
 * Axes never come this many times as far as GRID_PATCH_FAR by moving: their place has been set
 * anew.
 */
#define LOST_RATIO 2.0F

#define W1 (2.0F / (float)GOING)
#define W2 (8.0F / (float)(GOING * GOING))
#define W3 (32.0F / (float)(GOING * GOING * GOING))

/* The part of its reach at which a patch begins to hold when it is ready, at slow speeds. */
#define AHEAD_RATIO 0.75F

/*
 * From the spline itself back to patches, the axes are slower than what patches can follow by this.
 */
#define CALM_RATIO 0.75F

/* Third derivatives, all of them together, of all components. */
static double third_of(const struct grid *grid)
{
    double third = 0.0;

    for (unsigned i = 0; i < GRID_COMPONENTS; i++) {
        if ((grid->components & 1U << i) != 0) {
            third = maths_max(third, (double)takt_grid_bound_third(grid, i));
        }
    }
    return third;
}

/* From the anchor to either end of where a patch holds, in cycles. */
static inline float holding(const struct grid *grid)
{
    return 0.5F * (float)grid->ready + (float)GOING;
}

/* What is left out at the distance r: |third derivative| r^3 / 6. */
void takt_grid_patch_set_pace(struct grid *grid)
{
    const unsigned components = grid->turn_axis < AXIS_COUNT ? GRID_COMPONENTS : AXIS_LINEAR_COUNT;
    const double third = third_of(grid);

    grid->reach = 0.5F;
    if (third > 0.0) {
        grid->reach = (float)maths_min(0.5, takt_maths_cbrt(6.0 * GRID_PATCH_NEAR_MM / third));
    }
    grid->ready = (uint8_t)(STAGE_LINES + (STENCIL + 1U) * components);
    grid->fastest = (float)GRID_PATCH_FAR * grid->reach / holding(grid);
}

/* ---- making a patch ---- */

/*
 * Sums over the second and third input, for derivatives (second, third): (0 0) (1 0) (0 1) (2 0) (1
 * 1) (0 2).
 */
enum { SUM, SUM_Y, SUM_Z, SUM_YY, SUM_YZ, SUM_ZZ };

#define SUMS GRID_PATCH_SUMS

static GRID_INLINE float weigh(const float at[STENCIL], const float weight[STENCIL])
{
    return at[0] * weight[0] + at[1] * weight[1] + at[2] * weight[2] + at[3] * weight[3];
}

/* The sums of the coefficients that stand at a place x along the first input, from a pointer on. */
static void sum_line(const struct grid *grid, struct grid_patches *p, const float *at, unsigned x)
{
    const size_t row = grid->input[1].stride;
    const float *y = p->weight[1];
    const float *z = p->weight[2];
    float sum[SUMS] = {0.0F};

    for (unsigned i = 0; i < STENCIL; i++) {
        const float column[STENCIL] = {at[0], at[row], at[2 * row], at[3 * row]};
        const float value = weigh(column, y);
        const float first = weigh(column, y + FIRST_ORDER);

        sum[SUM] += z[i] * value;
        sum[SUM_Y] += z[i] * first;
        sum[SUM_Z] += z[FIRST_ORDER + i] * value;
        sum[SUM_YY] += z[i] * weigh(column, y + SECOND_ORDER);
        sum[SUM_YZ] += z[FIRST_ORDER + i] * first;
        sum[SUM_ZZ] += z[SECOND_ORDER + i] * value;
        at += grid->input[2].stride;
    }
    p->sum[SUM][x] = sum[SUM];
    p->sum[SUM_Y][x] = sum[SUM_Y];
    p->sum[SUM_Z][x] = sum[SUM_Z];
    p->sum[SUM_YY][x] = sum[SUM_YY];
    p->sum[SUM_YZ][x] = sum[SUM_YZ];
    p->sum[SUM_ZZ][x] = sum[SUM_ZZ];
}

/*
 * A component's terms, from its sums at all places along the first input: of the orders 0, 1 and 2
 * by that.
 */
static void set_terms(float sum[SUMS][STENCIL], const float *x, float *term)
{
    for (unsigned sums = SUMS; sums != 0; sums /= 2U, x += STENCIL) {
        const float weight[STENCIL] = {x[0], x[1], x[2], x[3]};

        for (unsigned i = 0; i < sums; i++) {
            *term++ = weigh(sum[i], weight);
        }
    }
}

static void get_inputs(const struct grid *grid, const struct point *at,
                       double at_mm[GRID_PATCH_INPUTS])
{
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        at_mm[i] = at->at[grid->input[i].axis];
    }
}

/* Its anchor: this many cycles ahead, but within the table. */
static void begin_patch(const struct grid *grid, struct grid_patches *p, const struct point *at,
                        const float step[GRID_PATCH_INPUTS], float cycles)
{
    const float margin = (float)GRID_PATCH_FAR * grid->reach;
    struct grid_patch *next = &p->patch[1U - p->used];

    next->valid = true;
    next->near_end = false;
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const struct grid_input *input = &grid->input[i];
        const double here_mm = at->at[input->axis];
        const float here = (float)(here_mm - input->first_mm) * input->steps_per_mm;
        const float last = (float)(input->last_cell + 1U);
        float way = cycles * step[i];

        if (here + way < margin || here + way > last - margin) {
            way = here + way < 0.0F ? -here : here + way > last ? last - here : way;
            next->near_end = true;
        }
        next->anchor_mm[i] = here_mm + (double)(way * input->mm_per_step);
    }
    p->stage = STAGE_CELL;
}

/* The cell its anchor is in, and where in it: that goes where the weights will be. */
static void find_patch(const struct grid *grid, struct grid_patches *p)
{
    struct point anchor;
    unsigned outside = 0;

    p->first = 0;
    p->line = p->component = 0;
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        anchor.at[grid->input[i].axis] = p->patch[1U - p->used].anchor_mm[i];
        p->first += takt_grid_find_cell(&grid->input[i], &anchor, &p->weight[i][0], &outside);
    }
}

static void set_all_weights(struct grid_patches *p)
{
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const float t = p->weight[i][0];

        takt_grid_set_weights(t, p->weight[i]);
        set_weights_first(t, &p->weight[i][FIRST_ORDER]);
        set_weights_second(t, &p->weight[i][SECOND_ORDER]);
    }
}

/* One cycle of making the next patch. */
static void make(const struct grid *grid, struct grid_patches *p)
{
    if (p->stage == STAGE_CELL) {
        find_patch(grid, p);
    } else if (p->stage == STAGE_WEIGHTS) {
        set_all_weights(p);
    } else if (p->line < STENCIL) {
        sum_line(grid, p, grid->coefficient + p->first + p->line, p->line);
        p->line++;
    } else {
        set_terms(p->sum, p->weight[0], p->patch[1U - p->used].term[p->component]);
        p->component++;
        p->first += grid->size;
        p->line = 0;
    }
    p->stage++;
}

/* ---- where the axes are ---- */

static GRID_INLINE float length(const float way[GRID_PATCH_INPUTS])
{
    return __builtin_fabsf(way[0]) + __builtin_fabsf(way[1]) + __builtin_fabsf(way[2]);
}

/* Beyond an end of the table the way stops as positions do. */
static __attribute__((noinline)) unsigned hold_way(const struct grid *grid,
                                                   struct grid_patch *patch, const struct point *at,
                                                   float step[GRID_PATCH_INPUTS])
{
    unsigned outside = 0;

    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const struct grid_input *input = &grid->input[i];
        const double position = (at->at[input->axis] - input->first_mm) * input->per_mm;
        unsigned beyond = 0;
        const float held = (float)(takt_edge_hold(position, input->last, &beyond) - position);

        patch->way[i] += held;
        step[i] += held;
        outside |= beyond << input->axis;
    }
    return outside;
}

/*
 * step: by how much the way differs from that of the last cycle. Returns inputs that are outside.
 */
static unsigned find_way(const struct grid *grid, struct grid_patch *patch, const struct point *at,
                         float step[GRID_PATCH_INPUTS])
{
    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        const struct grid_input *input = &grid->input[i];
        const float way = (float)(at->at[input->axis] - patch->anchor_mm[i]) * input->steps_per_mm;

        step[i] = way - patch->way[i];
        patch->way[i] = way;
    }
    return patch->near_end ? hold_way(grid, patch, at, step) : 0U;
}

/*
 * The anchor of the spline itself is where the axes are: the way from it is that of a cycle. It is
 * asked whether they are outside.
 */
static void stand_for_spline(const struct grid *grid, struct grid_patch *patch,
                             const struct point *at)
{
    patch->valid = false;
    patch->near_end = true;
    get_inputs(grid, at, patch->anchor_mm);
    memset(patch->way, 0, sizeof(patch->way));
}

/*
 * Begins the next patch if the one in use will have got worse than it may at slow speeds when that
 * can be ready.
 */
static void look_ahead(const struct grid *grid, struct grid_patches *p, const struct point *at,
                       const float step[GRID_PATCH_INPUTS], float speed)
{
    const struct grid_patch *used = &p->patch[p->used];
    const float making = (float)grid->ready;
    float then[GRID_PATCH_INPUTS];

    for (unsigned i = 0; i < GRID_PATCH_INPUTS; i++) {
        then[i] = used->way[i] + (making + (float)GOING) * step[i];
    }
    const float calm = p->is_ready ? CALM_RATIO : 1.0F;

    if (used->valid ? length(then) > grid->reach : speed <= calm * grid->fastest) {
        const float ahead = AHEAD_RATIO * grid->reach;
        const float half = holding(grid);

        begin_patch(grid, p, at, step,
                    making + (ahead > half * speed && speed > 0.0F ? ahead / speed : half));
    }
}

/* The axes are too fast for patches: on to the spline itself. */
static void give_up(const struct grid *grid, struct grid_patches *p, struct grid_patch *used,
                    const struct point *at)
{
    p->is_ready = true;
    if (length(used->way) > LOST_RATIO * (float)GRID_PATCH_FAR * grid->reach) {
        used->valid = false;
    }
    if (!used->valid) {
        p->stage = STAGE_NONE;
    } else if (p->stage < grid->ready) {
        stand_for_spline(grid, &p->patch[1U - p->used], at);
        p->stage = grid->ready;
    }
}

/* A cycle of going over to the next patch; the first one is taken at once. */
static void go_over(const struct grid *grid, struct grid_patches *p, const struct point *at)
{
    float step[GRID_PATCH_INPUTS];

    p->outside |= find_way(grid, &p->patch[1U - p->used], at, step);
    p->stage++;
    if (!p->is_ready || p->stage == grid->ready + GOING) {
        p->used = 1U - p->used;
        p->stage = STAGE_NONE;
        p->is_ready = true;
    }
}

static void follow(const struct grid *grid, struct grid_patches *p, const struct point *at)
{
    struct grid_patch *used = &p->patch[p->used];
    float step[GRID_PATCH_INPUTS];

    if (!p->is_known) {
        stand_for_spline(grid, used, at);
        p->stage = STAGE_NONE;
        p->speed = grid->fastest;
        p->is_known = true;
        return;
    }
    p->outside = find_way(grid, used, at, step);
    const float speed = length(step);

    if (p->outside != 0 || speed + (float)GOING * (speed - p->speed) > grid->fastest) {
        give_up(grid, p, used, at);
    }
    p->speed = speed;
    if (p->stage >= grid->ready) {
        go_over(grid, p, at);
    } else if (p->stage != STAGE_NONE) {
        make(grid, p);
    } else {
        look_ahead(grid, p, at, step, speed);
    }
    used = &p->patch[p->used];
    if (!used->valid) {
        stand_for_spline(grid, used, at);
    }
}

/* ---- evaluating ---- */

/*
 * Taylor's series to the second order, in Horner's form. The value at the anchor comes last, so
 * that what changes from cycle to cycle is added up before it is rounded to the size of the whole.
 */
static GRID_INLINE float value_of(const float term[GRID_PATCH_TERMS], float x, float y, float z)
{
    const float of_x = term[6] + x * term[9] + y * term[7] + z * term[8];
    const float of_y = term[1] + y * term[3] + z * term[4];
    const float of_z = term[2] + z * term[5];

    return term[0] + (x * of_x + (y * of_y + z * of_z));
}

static __attribute__((noinline)) void
add_turn(const struct grid *grid, const struct grid_patch *patch, float weight, float k[AXIS_COUNT])
{
    const float *way = patch->way;

    k[grid->turn_axis] += weight * value_of(patch->term[AXIS_LINEAR_COUNT], way[0], way[1], way[2]);
}

static GRID_INLINE void add_values(const struct grid *grid, const struct grid_patch *patch,
                                   float weight, float k[AXIS_COUNT])
{
    const float x = patch->way[0];
    const float y = patch->way[1];
    const float z = patch->way[2];

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        k[i] += weight * value_of(patch->term[i], x, y, z);
    }
    if (grid->turn_axis < AXIS_COUNT) {
        add_turn(grid, patch, weight, k);
    }
}

unsigned takt_grid_patch_add(const struct grid *grid, struct grid_patches *p,
                             const struct point *at, float weight, float k[AXIS_COUNT])
{
    follow(grid, p, at);
    const struct grid_patch *patch = &p->patch[p->used];
    const struct grid_patch *next = &p->patch[1U - p->used];
    const unsigned going = p->stage > grid->ready ? p->stage - (unsigned)grid->ready : 0U;
    unsigned outside = p->outside;

    for (float part = weight * (1.0F - share[going]);; part = weight * share[going]) {
        if (patch->valid) {
            add_values(grid, patch, part, k);
        } else {
            outside |= takt_grid_add(grid, at, part, k);
        }
        if (going == 0 || patch == next) {
            return outside;
        }
        patch = next;
    }
}

bool takt_grid_patch_prepare(const struct grid *grid, struct grid_patches *p,
                             const struct point *at)
{
    if (!p->is_ready) {
        follow(grid, p, at);
        return false;
    }
    return true;
}

/* ---- what it takes of the axes ---- */

float takt_grid_patch_jerk(const struct grid *grid, float third, float speed_per_s, float cycle_s)
{
    const float half = holding(grid);
    const float back = half - (float)GOING;
    const float fastest_per_s = grid->fastest / cycle_s;
    const float speed = speed_per_s < fastest_per_s ? speed_per_s : fastest_per_s;
    /*
     * For the difference of two patches, and of its derivatives by the cycle where w' and w'' are
     * not small.
     */
    const float size = (back * back * back + half * half * half) * (1.0F / 6.0F);
    const float first = (back + half) * ((float)GOING / 4.0F);
    const float second = back + half;

    TAKT_ASSERT(third >= 0.0F && cycle_s > 0.0F);
    return (W3 * size + 3.0F * W2 * first + 3.0F * W1 * second) * third * speed * speed * speed;
}
