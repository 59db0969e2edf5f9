/*
 * Crossings of lines and circles.
 *
 * Line p + s t (|t| = 1) and line q + r u:     s = ((q - p) x u) / (t x u) Line and circle (c, R):
 * foot f = p + ((c - p) . t) t,  points f +- sqrt(R^2 - |c - f|^2) t Circles (c, R) and (d, S),
 * D = |d - c|:      along = (D^2 + R^2 - S^2) / (2 D) from c towards d,
 *                                              across = +- sqrt(R^2 - along^2)
 */
#include "base/assert.h"
#include "base/maths.h"
#include "cutter_compensation/planar_involute.h"

#include <string.h>

/* Below this sine of their angle two lines do not cross. */
#define PARALLEL_SINE 1e-12
/* Circles and lines that miss each other by less than this touch. */
#define TOUCH_MM 1e-9

/* Both points from a middle, at distance h in both directions of a unit vector. */
static unsigned two_points(const double middle[2], const double direction[2], double h,
                           double points[2][2])
{
    TAKT_ASSERT(h >= 0.0);
    for (unsigned i = 0; i < 2; i++) {
        points[0][i] = middle[i] - h * direction[i];
        points[1][i] = middle[i] + h * direction[i];
    }
    return h == 0.0 ? 1 : 2;
}

/* sqrt(r^2 - d^2); 0 when d is hardly larger than r, negative when it is clearly. */
static double half_chord(double r, double d)
{
    TAKT_ASSERT(r >= 0.0 && d >= 0.0);
    if (d >= r) {
        return d - r <= TOUCH_MM ? 0.0 : -1.0;
    }
    return maths_sqrt((r - d) * (r + d));
}

static unsigned cross_lines(const struct planar *a, const struct planar *b, double points[2][2])
{
    const double between[2] = {b->from[0] - a->from[0], b->from[1] - a->from[1]};
    double t[2];
    double u[2];

    takt_planar_tangent_from(a, t);
    takt_planar_tangent_from(b, u);
    const double sine = planar_turn(t, u);

    if (maths_abs(sine) < PARALLEL_SINE) {
        return 0;
    }
    const double s = planar_turn(between, u) / sine;

    points[0][0] = a->from[0] + s * t[0];
    points[0][1] = a->from[1] + s * t[1];
    return 1;
}

static unsigned cross_line_circle(const struct planar *line, const double centre[2], double radius,
                                  double points[2][2])
{
    const double to_centre[2] = {centre[0] - line->from[0], centre[1] - line->from[1]};
    double t[2];

    takt_planar_tangent_from(line, t);
    const double s = planar_dot(to_centre, t);
    const double foot[2] = {line->from[0] + s * t[0], line->from[1] + s * t[1]};
    const double h = half_chord(radius, maths_abs(planar_turn(t, to_centre)));

    return h < 0.0 ? 0 : two_points(foot, t, h, points);
}

static unsigned cross_circles(const double c[2], double r, const double d[2], double s,
                              double points[2][2])
{
    const double distance = takt_planar_between(c, d);

    if (distance < TOUCH_MM) {
        return 0;
    }
    const double along = 0.5 * (distance + (r - s) * (r + s) / distance);
    const double h = half_chord(r, maths_abs(along));
    const double towards[2] = {(d[0] - c[0]) / distance, (d[1] - c[1]) / distance};
    const double across[2] = {-towards[1], towards[0]};
    const double reach = h == 0.0 && along < 0.0 ? -r : maths_min(along, r);
    const double middle[2] = {c[0] + reach * towards[0], c[1] + reach * towards[1]};

    return h < 0.0 ? 0 : two_points(middle, across, h, points);
}

unsigned takt_planar_cross(const struct planar *a, const struct planar *b, double points[2][2])
{
    if (a->involute) {
        return takt_planar_involute_cross(a, b, b->radius_from, true, points);
    }
    if (b->involute) {
        return takt_planar_involute_cross(b, a, a->radius_to, false, points);
    }
    if (!a->arc && !b->arc) {
        return cross_lines(a, b, points);
    }
    if (a->arc && b->arc) {
        return cross_circles(a->centre, a->radius_to, b->centre, b->radius_from, points);
    }
    if (a->arc) {
        return cross_line_circle(b, a->centre, a->radius_to, points);
    }
    return cross_line_circle(a, b->centre, b->radius_from, points);
}
