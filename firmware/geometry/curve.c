/*
 * Chooses the kind of curve: the one place that knows them all. A new kind is one file and one line
 * in each switch.
 */
#include "geometry/curve.h"

#include "base/assert.h"
#include "geometry/arc.h"
#include "geometry/involute.h"
#include "geometry/line.h"
#include "geometry/quintic.h"
#include "geometry/spline.h"

#include <string.h>

bool takt_curve_is_rotary(const struct curve *c)
{
    return c->rotary;
}

void takt_curve_point(const struct curve *c, double s_mm, struct point *p)
{
    switch (c->kind) {
    case CURVE_LINE:
        takt_line_point(c, s_mm, p);
        break;
    case CURVE_ARC:
        takt_arc_point(c, s_mm, p);
        break;
    case CURVE_INVOLUTE:
        takt_involute_point(c, s_mm, p);
        break;
    case CURVE_QUINTIC:
        takt_quintic_point(c, s_mm, p);
        break;
    case CURVE_SPLINE:
        takt_spline_point(c, s_mm, p);
        break;
    }
}

void takt_curve_tangent(const struct curve *c, double s_mm, struct point *t)
{
    switch (c->kind) {
    case CURVE_LINE:
        *t = c->slope;
        break;
    case CURVE_ARC:
        takt_arc_tangent(c, s_mm, t);
        break;
    case CURVE_INVOLUTE:
        takt_involute_tangent(c, s_mm, t);
        break;
    case CURVE_QUINTIC:
        takt_quintic_tangent(c, s_mm, t);
        break;
    case CURVE_SPLINE:
        takt_spline_tangent(c, s_mm, t);
        break;
    }
}

void takt_curve_point_and_tangent(const struct curve *c, double s_mm, struct point *p,
                                  struct point *t)
{
    if (c->kind == CURVE_ARC) {
        takt_arc_point_and_tangent(c, s_mm, p, t);
        return;
    }
    takt_curve_point(c, s_mm, p);
    takt_curve_tangent(c, s_mm, t);
}

void takt_curve_curvature(const struct curve *c, double s_mm, struct point *k)
{
    switch (c->kind) {
    case CURVE_LINE:
        memset(k, 0, sizeof(*k));
        break;
    case CURVE_ARC:
        takt_arc_curvature(c, s_mm, k);
        break;
    case CURVE_INVOLUTE:
        takt_involute_curvature(c, s_mm, k);
        break;
    case CURVE_QUINTIC:
        takt_quintic_curvature(c, s_mm, k);
        break;
    case CURVE_SPLINE:
        takt_spline_curvature(c, s_mm, k);
        break;
    }
}

void takt_curve_bound(const struct curve *c, struct curve_bounds *b)
{
    TAKT_ASSERT(c->length_mm > 0.0);
    switch (c->kind) {
    case CURVE_LINE:
        takt_line_bound(c, b);
        break;
    case CURVE_ARC:
        takt_arc_bound(c, b);
        break;
    case CURVE_INVOLUTE:
        takt_involute_bound(c, b);
        break;
    case CURVE_QUINTIC:
        takt_quintic_bound(c, b);
        break;
    case CURVE_SPLINE:
        takt_spline_bound(c, b);
        break;
    }
}

double takt_curve_piece_end(const struct curve *c, double from_mm)
{
    TAKT_ASSERT(from_mm >= 0.0 && from_mm < c->length_mm);
    return c->kind == CURVE_INVOLUTE ? takt_involute_piece_end(c, from_mm) : c->length_mm;
}

void takt_curve_cut(const struct curve *c, double from_mm, double to_mm, struct curve *piece)
{
    TAKT_ASSERT(from_mm >= 0.0 && from_mm < to_mm && to_mm <= c->length_mm);
    if (c->kind == CURVE_INVOLUTE) {
        takt_involute_cut(c, from_mm, to_mm, piece);
    } else {
        *piece = *c;
    }
}

bool takt_curve_starts_at_cusp(const struct curve *c)
{
    return c->kind == CURVE_INVOLUTE && c->involute.cusp_start;
}

bool takt_curve_ends_at_cusp(const struct curve *c)
{
    return c->kind == CURVE_INVOLUTE && c->involute.cusp_end;
}

bool takt_curve_plane(const struct curve *c, enum axis *first, enum axis *second)
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
