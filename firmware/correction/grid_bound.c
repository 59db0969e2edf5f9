/*
 * Bounds of a spline's derivatives: those of its coefficients' differences, because a derivative of
 * a B-spline is the B-spline of the differences, and a B-spline lies between its least and its
 * largest coefficient.
 */
#include "correction/grid_bound.h"

#include "base/assert.h"

/* How often to differentiate along each input; at most three times. */
struct grid_order {
    unsigned along[TABLE_INPUTS_MAX];
};

/* (-1)^(n-i) over i of n, of differences of up to third order. */
static const float binomial[4][4] = {{1}, {-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}};

/*
 * What is summed along an input: count coefficients, from one that stands a little before or at the
 * place.
 */
struct taps {
    unsigned count;
    unsigned before;
    const float *weight;
};

/*
 * At the ends of an input the outer coefficient stands for a place outside of the table, and is
 * large where values are noisy. The spline is read to t = -0.2 there and no further (edge.h), and
 * all of it from there on lies between its value there,
 *
 *     0.288 c_0 + 0.62267 c_1 + 0.09067 c_2 - 0.00133 c_3     (1 - t)^3/6, (3 t^3 - 6 t^2 + 4)/6, ..., t^3/6
 *
 * and the next coefficients (de Boor's points of that piece are means of these with positive
 * weights; C. de Boor, 1978, chapter IX). The first derivative has the factor u' beyond the end:
 * together they are at most 1.02 of the derivative at the end, (c_2 - c_0)/2, and 0.18 of the
 * differences behind it. So 1.25 of it, beside those, bounds both.
 */
#define END_TAPS 4U
static const float value_at_start[END_TAPS] = {0.288F, 0.622666667F, 0.0906666667F,
                                               -0.00133333333F};
static const float value_at_end[END_TAPS] = {-0.00133333333F, 0.0906666667F, 0.622666667F, 0.288F};
static const float slope_at_end[] = {-0.625F, 0.0F, 0.625F};

static struct taps taps_of(const struct grid *grid, const struct grid_order *order,
                           const unsigned index[TABLE_INPUTS_MAX], unsigned i)
{
    const unsigned n = order->along[i];
    const unsigned last = grid->input[i].points + 1U - n;

    if (i >= grid->inputs || n > 1 || (index[i] != 0 && index[i] != last)) {
        return (struct taps){n + 1U, 0, binomial[n]};
    }
    if (n == 1) {
        return (struct taps){3, index[i] == 0 ? 0 : 1, slope_at_end};
    }
    return index[i] == 0 ? (struct taps){END_TAPS, 0, value_at_start}
                         : (struct taps){END_TAPS, END_TAPS - 1U, value_at_end};
}

/* Along the first two inputs, of the coefficients from a place on. */
static float difference_in_plane(const struct grid *grid, const struct taps taps[], const float *at)
{
    const size_t row = grid->input[1].stride;
    float sum = 0.0F;

    at -= taps[1].before * row + taps[0].before;
    for (unsigned j = 0; j < taps[1].count; j++, at += row) {
        for (unsigned i = 0; i < taps[0].count; i++) {
            sum += taps[1].weight[j] * taps[0].weight[i] * at[i];
        }
    }
    return sum;
}

/* Along all of them; of inputs that are not there, one. */
static float difference(const struct grid *grid, const struct taps taps[], const float *at)
{
    float sum = 0.0F;

    at -= taps[3].before * grid->input[3].stride + taps[2].before * grid->input[2].stride;
    for (unsigned j = 0; j < taps[3].count; j++) {
        for (unsigned i = 0; i < taps[2].count; i++) {
            sum += taps[3].weight[j] * taps[2].weight[i] *
                   difference_in_plane(grid, taps,
                                       at + j * grid->input[3].stride + i * grid->input[2].stride);
        }
    }
    return sum;
}

/* Goes to the next place where a difference of this order has room. False: that was the last. */
static bool next_place(const struct grid *grid, const struct grid_order *order,
                       unsigned index[TABLE_INPUTS_MAX], size_t *offset)
{
    for (unsigned i = 0; i < grid->inputs; i++) {
        const struct grid_input *input = &grid->input[i];

        if (++index[i] + order->along[i] < input->points + 2U) {
            *offset += input->stride;
            return true;
        }
        *offset -= (index[i] - 1) * input->stride;
        index[i] = 0;
    }
    return false;
}

static float largest(const struct grid *grid, const struct grid_order *order, unsigned component)
{
    unsigned index[TABLE_INPUTS_MAX] = {0};
    size_t offset = 0;
    const float *from = grid->coefficient + component * grid->size;
    float most = 0.0F;

    TAKT_ASSERT(component < GRID_COMPONENTS);
    do {
        struct taps taps[TABLE_INPUTS_MAX];

        for (unsigned i = 0; i < TABLE_INPUTS_MAX; i++) {
            taps[i] = taps_of(grid, order, index, i);
        }
        const float size = __builtin_fabsf(difference(grid, taps, from + offset));

        most = size > most ? size : most;
    } while (next_place(grid, order, index, &offset));
    return most;
}

/* ---- all of them ---- */

static void sort(unsigned *a, unsigned *b)
{
    const unsigned least = *a < *b ? *a : *b;

    *b = *a < *b ? *b : *a;
    *a = least;
}

/*
 * Index of a <= b <= c, inputs or GRID_NO_INPUT, each number once: a + b (b + 1) / 2 + c (c + 1)
 * (c + 2) / 6.
 */
static unsigned index_of(unsigned a, unsigned b, unsigned c)
{
    sort(&a, &b);
    sort(&b, &c);
    sort(&a, &b);
    TAKT_ASSERT(a <= b && b <= c);
    return a + b * (b + 1U) / 2U + c * (c + 1U) * (c + 2U) / 6U;
}

static bool is_input(const struct grid *grid, unsigned i)
{
    return i < grid->inputs || i == GRID_NO_INPUT;
}

static float bound_of(const struct grid *grid, unsigned component, unsigned a, unsigned b,
                      unsigned c)
{
    const unsigned by[] = {a, b, c};
    struct grid_order order = {{0}};

    TAKT_ASSERT(component < GRID_COMPONENTS && is_input(grid, a) && is_input(grid, b) &&
                is_input(grid, c));
    for (unsigned i = 0; i < 3; i++) {
        if (by[i] != GRID_NO_INPUT) {
            order.along[by[i]]++;
        }
    }
    return largest(grid, &order, component);
}

static void bound_component(struct grid *grid, unsigned component)
{
    for (unsigned c = 0; c <= GRID_NO_INPUT; c++) {
        for (unsigned b = 0; b <= c; b++) {
            for (unsigned a = 0; a <= b; a++) {
                if (is_input(grid, a) && is_input(grid, b) && is_input(grid, c)) {
                    grid->bound[component][index_of(a, b, c)] = bound_of(grid, component, a, b, c);
                }
            }
        }
    }
}

void takt_grid_bound_all(struct grid *grid)
{
    for (unsigned i = 0; i < GRID_COMPONENTS; i++) {
        if (((unsigned)grid->components >> i & 1U) != 0) {
            bound_component(grid, i);
        }
    }
}

float takt_grid_bound(const struct grid *grid, unsigned component, unsigned a, unsigned b,
                      unsigned c)
{
    TAKT_ASSERT(component < GRID_COMPONENTS);
    return grid->bound[component][index_of(a, b, c)];
}

float takt_grid_bound_third(const struct grid *grid, unsigned component)
{
    float most = 0.0F;

    for (unsigned c = 0; c < grid->inputs; c++) {
        for (unsigned b = 0; b <= c; b++) {
            for (unsigned a = 0; a <= b; a++) {
                const float third = takt_grid_bound(grid, component, a, b, c);

                most = third > most ? third : most;
            }
        }
    }
    return most;
}
