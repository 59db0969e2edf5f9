#include "correction/axis_tables.h"

#include "base/assert.h"
#include "base/maths.h"
#include "correction/edge.h"
#include "correction/spline.h"

/* The piece a position is in: the last knot that is not above it, by bisection. */
static unsigned find_piece(const struct axis_tables *tables, const struct axis_pair *pair,
                           double position)
{
    const double *knot = tables->knot_mm + pair->first;
    unsigned low = 0;
    unsigned high = pair->points - 1U;

    while (high - low > 1) {
        const unsigned middle = (low + high) / 2;

        if (position < knot[middle]) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return low;
}

static float evaluate(const float c[4], float t)
{
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

static float pair_value(const struct axis_tables *tables, const struct axis_pair *pair,
                        double position, float approach, unsigned *outside)
{
    const unsigned at = find_piece(tables, pair, position);
    const double *knot = tables->knot_mm + pair->first + at;
    const struct axis_piece *piece = tables->piece + pair->first + at;
    const double width = knot[1] - knot[0];
    double t = position - knot[0];

    if ((t < 0.0 && at == 0) || (t > width && at + 2U == pair->points)) {
        t = width * takt_edge_hold(t / width, 1.0, outside);
    }
    const float mean = evaluate(piece->mean, (float)t);

    return pair->directed ? mean + approach * evaluate(piece->half, (float)t) : mean;
}

unsigned takt_axis_tables_sum(const struct axis_tables *tables, const struct point *at,
                              const float approach[AXIS_COUNT], float weight, float k[AXIS_COUNT])
{
    unsigned outside = 0;

    TAKT_ASSERT(tables->count <= AXIS_TABLES_PAIRS_MAX);
    for (unsigned i = 0; i < tables->count; i++) {
        const struct axis_pair *pair = &tables->pair[i];
        unsigned beyond = 0;

        k[pair->corrected] +=
            weight * pair_value(tables, pair, at->at[pair->input], approach[pair->input], &beyond);
        outside |= beyond << pair->input;
    }
    return outside;
}

/* ---- from a table to pieces ---- */

static bool refuse(struct diagnostic *wrong, enum takt_error code, uint8_t axis, double value)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    takt_diagnostic_set(wrong, code, 0, 0, &AXIS_LETTERS[axis], 1, value);
    return false;
}

/*
 * The cubic between two points from values y, second derivatives M and width h:
 *
 *     y_0 + t ((y_1 - y_0) / h - h (2 M_0 + M_1) / 6) + t^2 M_0 / 2 + t^3 (M_1 - M_0) / (6 h)
 */
static void set_piece(const double *knot, const double *value, const double *second, float c[4])
{
    const double h = knot[1] - knot[0];

    TAKT_ASSERT(h > 0.0);
    c[0] = (float)value[0];
    c[1] = (float)((value[1] - value[0]) / h - h * (2.0 * second[0] + second[1]) / 6.0);
    c[2] = (float)(0.5 * second[0]);
    c[3] = (float)((second[1] - second[0]) / (6.0 * h));
}

/* Column of a correction for a direction. */
static unsigned column_of(const struct table *table, uint8_t axis, enum table_direction direction)
{
    unsigned column = 0;

    for (unsigned i = 0; i < table->outputs; i++) {
        const struct table_output *output = &table->output[i];

        if (output->axis == axis &&
            (output->direction == direction || output->direction == TABLE_BOTH)) {
            column = i;
        }
    }
    return column;
}

static void set_pieces(struct axis_tables *tables, const struct axis_pair *pair,
                       const struct table *table)
{
    const unsigned up = column_of(table, pair->corrected, TABLE_UP);
    const unsigned down = column_of(table, pair->corrected, TABLE_DOWN);
    double mean[TABLE_KNOTS_MAX], half[TABLE_KNOTS_MAX];
    double mean_second[TABLE_KNOTS_MAX], half_second[TABLE_KNOTS_MAX];

    for (unsigned i = 0; i < pair->points; i++) {
        const float *row = table->value_mm + (size_t)i * table->outputs;

        mean[i] = 0.5 * ((double)row[up] + (double)row[down]);
        half[i] = 0.5 * ((double)row[up] - (double)row[down]);
        tables->own_knot_mm[pair->first + i] = table->knot_mm[0][i];
    }
    takt_spline_second_derivatives(pair->points, table->knot_mm[0], mean, mean_second);
    takt_spline_second_derivatives(pair->points, table->knot_mm[0], half, half_second);
    for (unsigned i = 0; i + 1U < pair->points; i++) {
        struct axis_piece *piece = &tables->own_piece[pair->first + i];

        set_piece(table->knot_mm[0] + i, mean + i, mean_second + i, piece->mean);
        set_piece(table->knot_mm[0] + i, half + i, half_second + i, piece->half);
    }
}

static bool has_pair(const struct axis_tables *tables, uint8_t input, uint8_t corrected)
{
    for (unsigned i = 0; i < tables->count; i++) {
        if (tables->pair[i].input == input && tables->pair[i].corrected == corrected) {
            return true;
        }
    }
    return false;
}

/* Columns that begin a pair: the second direction belongs to the first. */
static bool begins_pair(const struct table_output *output)
{
    return output->direction != TABLE_DOWN;
}

static bool check_room(const struct axis_tables *tables, const struct table *table,
                       struct diagnostic *wrong)
{
    unsigned pairs = tables->count;
    uint32_t points = tables->points;

    if (table->inputs != 1) {
        takt_diagnostic_set(wrong, TAKT_ERROR_TABLE_KIND, 0, 0, "", 0, table->inputs);
        return false;
    }
    for (unsigned i = 0; i < table->outputs; i++) {
        if (!begins_pair(&table->output[i])) {
            continue;
        }
        if (has_pair(tables, table->input[0], table->output[i].axis)) {
            return refuse(wrong, TAKT_ERROR_TABLE_PAIR_TWICE, table->output[i].axis, 0.0);
        }
        pairs++;
        points += table->knots[0];
    }
    return (pairs <= AXIS_TABLES_PAIRS_MAX && points <= AXIS_TABLES_POINTS_MAX) ||
           refuse(wrong, TAKT_ERROR_TABLE_PAIRS_MANY, table->input[0], AXIS_TABLES_PAIRS_MAX);
}

bool takt_axis_tables_add(struct axis_tables *tables, const struct table *table,
                          struct diagnostic *wrong)
{
    if (!check_room(tables, table, wrong)) {
        return false;
    }
    tables->knot_mm = tables->own_knot_mm;
    tables->piece = tables->own_piece;
    for (unsigned i = 0; i < table->outputs; i++) {
        const struct table_output *output = &table->output[i];
        struct axis_pair *pair = &tables->pair[tables->count];

        if (!begins_pair(output)) {
            continue;
        }
        *pair = (struct axis_pair){
            .input = table->input[0],
            .corrected = output->axis,
            .directed = output->direction == TABLE_UP,
            .first = (uint16_t)tables->points,
            .points = table->knots[0],
        };
        set_pieces(tables, pair, table);
        tables->points += pair->points;
        tables->count++;
        if (pair->directed) {
            tables->inputs |= 1U << pair->input;
        }
    }
    return true;
}
