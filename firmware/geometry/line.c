#include "geometry/line.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Length over some axes: sqrt(sum of squares). */
static double length_over(const struct point *delta, int from, int to)
{
    double sum = 0.0;

    TAKT_ASSERT(from >= 0 && from <= to && to <= AXIS_COUNT);
    for (int i = from; i < to; i++) {
        sum += delta->at[i] * delta->at[i];
    }
    return maths_sqrt(sum);
}

bool takt_curve_set_line(struct curve *c, const struct point *start, const struct point *end)
{
    struct point delta;

    memset(c, 0, sizeof(*c));
    c->kind = CURVE_LINE;
    c->start = *start;
    c->end = *end;
    for (int i = 0; i < AXIS_COUNT; i++) {
        delta.at[i] = end->at[i] - start->at[i];
    }
    c->length_mm = length_over(&delta, 0, AXIS_LINEAR_COUNT);
    if (c->length_mm < CURVE_LENGTH_MIN_MM) {
        c->rotary = true;
        c->length_mm = length_over(&delta, AXIS_LINEAR_COUNT, AXIS_COUNT);
    }
    if (c->length_mm < CURVE_LENGTH_MIN_MM) {
        return false;
    }
    for (int i = 0; i < AXIS_COUNT; i++) {
        c->slope.at[i] = delta.at[i] / c->length_mm;
    }
    return true;
}

/* x(s) = start + slope s */
void takt_line_point(const struct curve *c, double s_mm, struct point *p)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        p->at[i] = c->start.at[i] + c->slope.at[i] * s_mm;
    }
}

void takt_line_bound(const struct curve *c, struct curve_bounds *b)
{
    memset(b, 0, sizeof(*b));
    for (int i = 0; i < AXIS_COUNT; i++) {
        b->first[i] = maths_abs(c->slope.at[i]);
    }
}
