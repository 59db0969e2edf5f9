/*
 * Distances between ways. The nearest points of two ways are a crossing, an end of one of them, or,
 * when an arc is one of them, on the line through its centre at right angles to the other way.
 * Involutes: planar_involute.c.
 */
#include "base/maths.h"
#include "cutter_compensation/planar_involute.h"

#include <string.h>

/* Places may be beyond the ends by this. */
#define PLACE_SLACK_MM 1e-9

static bool is_on(const struct planar *c, const double point[2])
{
    const double place = takt_planar_place(c, point);

    return place >= -PLACE_SLACK_MM && place <= takt_planar_length(c) + PLACE_SLACK_MM;
}

/* The point of an arc in that direction from its centre; false: the arc does not reach there. */
static bool point_towards(const struct planar *arc, const double direction[2], double point[2])
{
    const double length = maths_sqrt(planar_dot(direction, direction));

    if (length < PLACE_SLACK_MM) {
        return false;
    }
    for (unsigned i = 0; i < 2; i++) {
        point[i] = arc->centre[i] + direction[i] * arc->radius_to / length;
    }
    return is_on(arc, point);
}

static double distance_from_line(const struct planar *line, const double point[2])
{
    const double length = takt_planar_length(line);
    const double place = maths_clamp(takt_planar_place(line, point), 0.0, length);
    double foot[2];

    for (unsigned i = 0; i < 2; i++) {
        foot[i] = line->from[i] + (line->to[i] - line->from[i]) * place / length;
    }
    return takt_planar_between(point, foot);
}

double takt_planar_distance_point(const struct planar *c, const double point[2])
{
    const double direction[2] = {point[0] - c->centre[0], point[1] - c->centre[1]};
    double nearest[2];

    if (c->involute) {
        return takt_planar_involute_distance_point(c, point);
    }
    if (!c->arc) {
        return distance_from_line(c, point);
    }
    if (point_towards(c, direction, nearest)) {
        return takt_planar_between(point, nearest);
    }
    return maths_min(takt_planar_between(point, c->from), takt_planar_between(point, c->to));
}

static bool do_cross(const struct planar *a, const struct planar *b)
{
    double points[2][2];
    const unsigned count = takt_planar_cross(a, b, points);

    for (unsigned i = 0; i < count; i++) {
        if (is_on(a, points[i]) && is_on(b, points[i])) {
            return true;
        }
    }
    return false;
}

/*
 * Smallest distance of both points of an arc that lie on a line through its centre from another
 * way.
 */
static double distance_along(const struct planar *arc, const double direction[2],
                             const struct planar *other)
{
    double smallest = MATHS_INFINITY;

    for (int sign = -1; sign <= 1; sign += 2) {
        const double towards[2] = {sign * direction[0], sign * direction[1]};
        double point[2];

        if (point_towards(arc, towards, point)) {
            smallest = maths_min(smallest, takt_planar_distance_point(other, point));
        }
    }
    return smallest;
}

/* Across a line, or towards the centre of another arc. */
static double distance_inside(const struct planar *arc, const struct planar *other)
{
    double direction[2] = {other->centre[0] - arc->centre[0], other->centre[1] - arc->centre[1]};

    if (!other->arc) {
        double t[2];

        takt_planar_tangent_from(other, t);
        direction[0] = -t[1];
        direction[1] = t[0];
    }
    return distance_along(arc, direction, other);
}

/* Where both have a common normal. */
static double distance_across(const struct planar *a, const struct planar *b)
{
    if (a->involute) {
        return takt_planar_involute_distance(a, b);
    }
    if (b->involute) {
        return takt_planar_involute_distance(b, a);
    }
    const double smallest = a->arc ? distance_inside(a, b) : MATHS_INFINITY;

    return b->arc ? maths_min(smallest, distance_inside(b, a)) : smallest;
}

double takt_planar_distance(const struct planar *a, const struct planar *b)
{
    if (do_cross(a, b)) {
        return 0.0;
    }
    double smallest =
        maths_min(takt_planar_distance_point(a, b->from), takt_planar_distance_point(a, b->to));

    smallest = maths_min(smallest, takt_planar_distance_point(b, a->from));
    smallest = maths_min(smallest, takt_planar_distance_point(b, a->to));
    return maths_min(smallest, distance_across(a, b));
}
