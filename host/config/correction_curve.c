#include "config/correction_curve.h"

#include "cli/axis_unit.h"
#include "cli/message.h"
#include "correction/axis_tables.h"

#include <math.h>
#include <stdlib.h>

/* What noise may leave by, mm and rad. */
#define NOISE_MM  1e-3
#define NOISE_RAD 1e-6

/* Places of a piece that are looked at. */
#define PLACES 64

/* One column: the values of its points, and the curve through them. */
struct column {
    const struct table *table;
    const struct axis_tables *tables;
    const struct axis_pair *pair;
    int approach; /* 1: up, -1: down, where they differ */
    double least, most;
};

static double value_at(const float c[4], double t)
{
    return (double)c[0] + t * ((double)c[1] + t * ((double)c[2] + t * (double)c[3]));
}

static double piece_at(const struct column *column, unsigned piece, double t)
{
    const struct axis_piece *p = column->tables->piece + column->pair->first + piece;

    return value_at(p->mean, t) +
           (column->pair->directed ? column->approach * value_at(p->half, t) : 0);
}

static double width_of(const struct column *column, unsigned piece)
{
    const double *knot = column->tables->knot_mm + column->pair->first + piece;

    return knot[1] - knot[0];
}

static void take_points(struct column *column)
{
    const unsigned last = column->pair->points - 1U;

    column->least = column->most = piece_at(column, last - 1, width_of(column, last - 1));
    for (unsigned k = 0; k < last; k++) {
        column->least = fmin(column->least, piece_at(column, k, 0));
        column->most = fmax(column->most, piece_at(column, k, 0));
    }
}

/* How far a piece goes beyond the points at t. */
static double beyond(const struct column *column, unsigned piece, double t)
{
    const double value = piece_at(column, piece, t);

    return fmax(value - column->most, column->least - value);
}

/* The place of a piece where it is farthest out, as a distance from its first point. */
static double farthest(const struct column *column, unsigned piece)
{
    double worst = 0;

    for (unsigned i = 1; i < PLACES; i++) {
        const double t = width_of(column, piece) * i / PLACES;

        if (beyond(column, piece, t) > beyond(column, piece, worst))
            worst = t;
    }
    return worst;
}

static void refuse(const struct column *column, const char *path, unsigned piece, double t)
{
    static const char *const direction[] = {"_down", "", "_up"};
    const unsigned input = column->pair->input, output = column->pair->corrected;
    const double *knot = column->tables->knot_mm + column->pair->first + piece;
    const double position = axis_unit_ratio(input), value = axis_unit_is_rotary(output) ? 1e6 : 1e3;

    message_error(
        path, 0, 0,
        "%c%c%s: between %c %.9g and %.9g %s the curve through the points goes to %.2f %s, "
        "and no point is beyond %.2f to %.2f: it needs more points there, in steps more "
        "like the others",
        column->table->errors ? 'E' : 'K', AXIS_LETTERS[output],
        direction[column->pair->directed ? 1 + column->approach : 1], AXIS_LETTERS[input],
        knot[0] * position, knot[1] * position, axis_unit_name(input),
        value * piece_at(column, piece, t), axis_unit_is_rotary(output) ? "urad" : "um",
        value * column->least, value * column->most);
}

static bool check_column(struct column *column, const char *path)
{
    take_points(column);
    const double noise = axis_unit_is_rotary(column->pair->corrected) ? NOISE_RAD : NOISE_MM;
    const double allowed = fmax(column->most - column->least, noise);

    for (unsigned piece = 0; piece + 1U < column->pair->points; piece++) {
        const double t = farthest(column, piece);

        if (!(beyond(column, piece, t) <= allowed)) {
            refuse(column, path, piece, t);
            return false;
        }
    }
    return true;
}

static bool check_pairs(struct column *column, const char *path)
{
    for (unsigned i = 0; i < column->tables->count; i++) {
        column->pair = &column->tables->pair[i];
        for (column->approach = column->pair->directed ? -1 : 1; column->approach <= 1;
             column->approach += 2) {
            if (!check_column(column, path))
                return false;
        }
    }
    return true;
}

bool correction_curve_check(const struct table *table, const char *path)
{
    struct axis_tables *tables;
    struct diagnostic wrong;
    bool good;

    if (table->inputs != 1)
        return true;
    tables = calloc(1, sizeof *tables);
    if (tables == NULL) {
        message_command_error("out of memory");
        return false;
    }
    /* What does not fit is refused where the table is taken. */
    good = !takt_axis_tables_add(tables, table, &wrong) ||
           check_pairs(&(struct column){.table = table, .tables = tables}, path);
    free(tables);
    return good;
}
