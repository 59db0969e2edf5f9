/*
 * Bounds of a spline's derivatives: those of its coefficients' differences, because a derivative of a B-spline is the
 * B-spline of the differences, and a B-spline lies between its least and its largest coefficient.
 */
#include "correction/grid_bound.h"

#include "base/maths.h"

/* (-1)^(n-i) over i of n, of differences of up to third order. */
static const float binomial[4][4] = {{1}, {-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}};

/* The difference along the first two inputs of the coefficients that begin at an offset. */
static float difference_in_plane(const struct grid *grid, const struct grid_order *order,
                                 size_t offset, unsigned component)
{
    float sum = 0.0F;

    for (unsigned j = 0; j <= order->along[1]; j++) {
        for (unsigned i = 0; i <= order->along[0]; i++) {
            sum +=
                binomial[order->along[1]][j] * binomial[order->along[0]][i] *
                grid->coefficient[component * grid->size + offset + j * grid->input[1].stride + i];
        }
    }
    return sum;
}

/* Along all of them; inputs that are not there have order 0. */
static float difference(const struct grid *grid, const struct grid_order *order, size_t offset,
                        unsigned component)
{
    float sum = 0.0F;

    for (unsigned j = 0; j <= order->along[3]; j++) {
        for (unsigned i = 0; i <= order->along[2]; i++) {
            const size_t plane = offset + j * grid->input[3].stride + i * grid->input[2].stride;

            sum += binomial[order->along[3]][j] * binomial[order->along[2]][i] *
                   difference_in_plane(grid, order, plane, component);
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

double grid_bound(const struct grid *grid, const struct grid_order *order, unsigned component)
{
    unsigned index[TABLE_INPUTS_MAX] = {0};
    size_t offset = 0;
    double most = 0.0;

    do {
        most = maths_max(most, maths_abs((double)difference(grid, order, offset, component)));
    } while (next_place(grid, order, index, &offset));
    return most;
}

double grid_bound_third(const struct grid *grid, unsigned component)
{
    double most = 0.0;

    for (unsigned i = 0; i < grid->inputs; i++) {
        for (unsigned j = 0; j < grid->inputs; j++) {
            for (unsigned k = 0; k < grid->inputs; k++) {
                struct grid_order order = {{0}};

                order.along[i]++;
                order.along[j]++;
                order.along[k]++;
                most = maths_max(most, grid_bound(grid, &order, component));
            }
        }
    }
    return most;
}
