/* Chooses the kind of curve: the one place that knows them all. A new kind is one file and one line in each switch. */
#include "geometry/curve.h"

#include "geometry/arc.h"
#include "geometry/line.h"

#include <string.h>

bool curve_is_rotary(const struct curve *c)
{
    return c->rotary;
}

void curve_point(const struct curve *c, double s_mm, struct point *p)
{
    switch (c->kind) {
    case CURVE_LINE:
        line_point(c, s_mm, p);
        break;
    case CURVE_ARC:
        arc_point(c, s_mm, p);
        break;
    }
}

void curve_tangent(const struct curve *c, double s_mm, struct point *t)
{
    switch (c->kind) {
    case CURVE_LINE:
        *t = c->slope;
        break;
    case CURVE_ARC:
        arc_tangent(c, s_mm, t);
        break;
    }
}

void curve_curvature(const struct curve *c, double s_mm, struct point *k)
{
    switch (c->kind) {
    case CURVE_LINE:
        memset(k, 0, sizeof(*k));
        break;
    case CURVE_ARC:
        arc_curvature(c, s_mm, k);
        break;
    }
}

void curve_bound(const struct curve *c, struct curve_bounds *b)
{
    switch (c->kind) {
    case CURVE_LINE:
        line_bound(c, b);
        break;
    case CURVE_ARC:
        arc_bound(c, b);
        break;
    }
}
