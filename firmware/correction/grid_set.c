/* From a table's values to the coefficients of its spline. */
#include "base/assert.h"
#include "correction/grid.h"
#include "correction/grid_bound.h"
#include "correction/grid_patch.h"
#include "correction/spline.h"

#include <string.h>

_Static_assert(TABLE_KNOTS_MAX <= SPLINE_KNOTS_MAX, "every line of a table is a spline");

/* A table has one coefficient more than points at both ends of each line. */
#define MARGIN 2U

static bool refuse(struct diagnostic *wrong, enum takt_error code, const char *word, size_t length,
                   double value)
{
    takt_diagnostic_set(wrong, code, 0, 0, word, length, value);
    return false;
}

/* Index along each input, counted with the margin. */
struct index {
    unsigned at[TABLE_INPUTS_MAX];
};

static size_t offset_of(const struct grid *grid, const struct index *index)
{
    size_t offset = 0;

    for (unsigned i = 0; i < grid->inputs; i++) {
        offset += index->at[i] * grid->input[i].stride;
    }
    return offset;
}

/* ---- one line: points 1 ... n of it hold values, and become coefficients 0 ... n + 1 ---- */

/*
 * The spline has the value (c_{k-1} + 4 c_k + c_{k+1}) / 6 and the second derivative c_{k-1} - 2
 * c_k + c_{k+1} = M_k at point k, so
 *
 *     c_k = f_k - M_k / 6,  c_{-1} = 2 c_0 - c_1 + M_0,  and the same at the other end
 */
static void transform_line(float *line, size_t stride, unsigned points)
{
    double knot[TABLE_KNOTS_MAX] = {0.0};
    double value[TABLE_KNOTS_MAX] = {0.0};
    double second[TABLE_KNOTS_MAX];
    const unsigned last = points - 1;

    TAKT_ASSERT(points >= 2 && points <= TABLE_KNOTS_MAX);
    for (unsigned k = 0; k < points; k++) {
        knot[k] = k;
        value[k] = (double)line[(k + 1) * stride];
    }
    takt_spline_second_derivatives(points, knot, value, second);
    for (unsigned k = 0; k < points; k++) {
        value[k] -= second[k] / 6.0;
        line[(k + 1) * stride] = (float)value[k];
    }
    line[0] = (float)(2.0 * value[0] - value[1] + second[0]);
    line[(points + 1) * stride] = (float)(2.0 * value[last] - value[last - 1] + second[last]);
}

/*
 * Goes to the next line along an input: other inputs before it are complete with margins, those
 * behind it still without. False: that was the last.
 */
static bool next_line(const struct grid *grid, unsigned along, struct index *index)
{
    for (unsigned i = 0; i < grid->inputs; i++) {
        const unsigned margin = i < along ? 0 : 1;

        if (i == along) {
            continue;
        }
        if (++index->at[i] < grid->input[i].points + MARGIN - margin) {
            return true;
        }
        index->at[i] = margin;
    }
    return false;
}

/* The turning axis has room when it is corrected. */
static unsigned components_of(const struct grid *grid)
{
    return grid->turn_axis < AXIS_COUNT ? GRID_COMPONENTS : GRID_COMPONENTS - 1U;
}

static void transform_along(struct grid *grid, unsigned along)
{
    const struct grid_input *input = &grid->input[along];
    struct index index = {{0}};

    TAKT_ASSERT(along < grid->inputs);
    for (unsigned i = along + 1; i < grid->inputs; i++) {
        index.at[i] = 1;
    }
    do {
        for (unsigned i = 0; i < components_of(grid); i++) {
            transform_line(grid->own + i * grid->size + offset_of(grid, &index), input->stride,
                           input->points);
        }
    } while (next_line(grid, along, &index));
}

/* ---- the whole ---- */

static bool set_inputs(struct grid *grid, const struct table *table)
{
    size_t stride = 1;

    for (unsigned i = 0; i < table->inputs; i++) {
        const double *knot = table->knot_mm[i];
        const unsigned last = table->knots[i] - 1U;

        const double per_mm = last / (knot[last] - knot[0]);

        grid->input[i] = (struct grid_input){
            .axis = table->input[i],
            .points = table->knots[i],
            .last_cell = last - 1U,
            .stride = stride,
            .first_mm = knot[0],
            .per_mm = per_mm,
            .last = last,
            .steps_per_mm = (float)per_mm,
            .mm_per_step = (float)(1.0 / per_mm),
        };
        stride *= (size_t)table->knots[i] + MARGIN;
        if (stride > GRID_COEFFICIENTS_MAX) {
            return false;
        }
    }
    grid->size = stride;
    return stride * components_of(grid) <= GRID_COEFFICIENTS_MAX;
}

static unsigned component_of(uint8_t axis)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    return axis < AXIS_LINEAR_COUNT ? axis : AXIS_LINEAR_COUNT;
}

static void set_values(struct grid *grid, const struct table *table)
{
    const uint32_t rows = takt_table_rows(table);

    TAKT_ASSERT(grid->inputs == table->inputs);
    for (uint32_t row = 0; row < rows; row++) {
        struct index index;
        uint32_t rest = row;

        for (unsigned i = 0; i < table->inputs; i++) {
            index.at[i] = 1 + rest % table->knots[i];
            rest /= table->knots[i];
        }
        float *to = grid->own + offset_of(grid, &index);

        for (unsigned i = 0; i < table->outputs; i++) {
            to[component_of(table->output[i].axis) * grid->size] =
                table->value_mm[row * table->outputs + i];
        }
    }
}

bool takt_grid_set(struct grid *grid, const struct table *table, struct diagnostic *wrong)
{
    memset(grid, 0, sizeof(*grid));
    grid->coefficient = grid->own;
    if (table->inputs < 2) {
        return refuse(wrong, TAKT_ERROR_TABLE_KIND, "", 0, table->inputs);
    }
    grid->turn_axis = AXIS_COUNT;
    for (unsigned i = 0; i < table->outputs; i++) {
        const uint8_t axis = table->output[i].axis;

        grid->components |= (uint8_t)(1U << component_of(axis));
        if (axis >= AXIS_LINEAR_COUNT) {
            grid->turn_axis = axis;
        }
    }
    if (!set_inputs(grid, table)) {
        return refuse(wrong, TAKT_ERROR_TABLE_FULL, "", 0, GRID_COEFFICIENTS_MAX);
    }
    grid->inputs = table->inputs;
    set_values(grid, table);
    for (unsigned i = 0; i < grid->inputs; i++) {
        transform_along(grid, i);
    }
    takt_grid_bound_all(grid);
    takt_grid_patch_set_pace(grid);
    return true;
}
