#include "spindle/stock.h"

#include "base/maths.h"

#include <stdbool.h>

/*
 * Where a coordinate lies: between the grid's values number at and at + 1, at this part of the way.
 */
struct place {
    size_t at;
    double part;
};

static bool find(const double *grid, size_t count, double value, struct place *place)
{
    if (!(value >= grid[0] && value <= grid[count - 1]))
        return false;
    place->at = 0;
    while (place->at + 2 < count && value > grid[place->at + 1])
        place->at++;
    place->part = (value - grid[place->at]) / (grid[place->at + 1] - grid[place->at]);
    return true;
}

/* f = f0 + (f1 - f0) u */
static double between(double first, double second, double part)
{
    return first + (second - first) * part;
}

double stock_depth_mm(const struct stock *stock, double x_mm, double y_mm, double z_mm)
{
    struct place x, y;
    const double *near, *far;

    if (!find(stock->x_mm, stock->columns, x_mm, &x) || !find(stock->y_mm, stock->rows, y_mm, &y))
        return 0.0;
    near = stock->top_mm + y.at * stock->columns + x.at;
    far = near + stock->columns;
    return maths_max(
        0.0,
        between(between(near[0], near[1], x.part), between(far[0], far[1], x.part), y.part) - z_mm);
}
