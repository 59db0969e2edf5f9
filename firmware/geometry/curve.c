/* Chooses the kind of curve: the one place that knows them all. A new kind is one file and one line in each switch. */
#include "geometry/curve.h"

#include "geometry/arc.h"
#include "geometry/involute.h"
#include "geometry/line.h"
#include "geometry/quintic.h"
#include "geometry/spline.h"

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
    case CURVE_INVOLUTE:
        involute_point(c, s_mm, p);
        break;
    case CURVE_QUINTIC:
        quintic_point(c, s_mm, p);
        break;
    case CURVE_SPLINE:
        spline_point(c, s_mm, p);
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
    case CURVE_INVOLUTE:
        involute_tangent(c, s_mm, t);
        break;
    case CURVE_QUINTIC:
        quintic_tangent(c, s_mm, t);
        break;
    case CURVE_SPLINE:
        spline_tangent(c, s_mm, t);
        break;
    }
}

void curve_point_and_tangent(const struct curve *c, double s_mm, struct point *p, struct point *t)
{
    if (c->kind == CURVE_ARC) {
        arc_point_and_tangent(c, s_mm, p, t);
        return;
    }
    curve_point(c, s_mm, p);
    curve_tangent(c, s_mm, t);
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
    case CURVE_INVOLUTE:
        involute_curvature(c, s_mm, k);
        break;
    case CURVE_QUINTIC:
        quintic_curvature(c, s_mm, k);
        break;
    case CURVE_SPLINE:
        spline_curvature(c, s_mm, k);
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
    case CURVE_INVOLUTE:
        involute_bound(c, b);
        break;
    case CURVE_QUINTIC:
        quintic_bound(c, b);
        break;
    case CURVE_SPLINE:
        spline_bound(c, b);
        break;
    }
}

double curve_piece_end(const struct curve *c, double from_mm)
{
    return c->kind == CURVE_INVOLUTE ? involute_piece_end(c, from_mm) : c->length_mm;
}

void curve_cut(const struct curve *c, double from_mm, double to_mm, struct curve *piece)
{
    if (c->kind == CURVE_INVOLUTE) {
        involute_cut(c, from_mm, to_mm, piece);
    } else {
        *piece = *c;
    }
}

bool curve_starts_at_cusp(const struct curve *c)
{
    return c->kind == CURVE_INVOLUTE && c->involute.cusp_start;
}

bool curve_ends_at_cusp(const struct curve *c)
{
    return c->kind == CURVE_INVOLUTE && c->involute.cusp_end;
}

bool curve_plane(const struct curve *c, enum axis *first, enum axis *second)
{
    switch (c->kind) {
    case CURVE_LINE:
    case CURVE_SPLINE:
        return false;
    case CURVE_ARC:
        *first = (enum axis)c->arc.first;
        *second = (enum axis)c->arc.second;
        return true;
    case CURVE_INVOLUTE:
        *first = (enum axis)c->involute.first;
        *second = (enum axis)c->involute.second;
        return true;
    case CURVE_QUINTIC:
        *first = (enum axis)c->quintic.first;
        *second = (enum axis)c->quintic.second;
        return true;
    }
    return false;
}
