#include "cutter_compensation/planar.h"

#include "base/assert.h"
#include "base/maths.h"
#include "cutter_compensation/planar_involute.h"
#include "geometry/involute.h"

#include <string.h>

/*
 * Start and end of an arc closer than this are one point: a full circle (as in the room geometry).
 */
#define CLOSED_MM 1e-7

/* Ways shorter than this are none. */
#define LENGTH_MIN_MM 1e-9

double takt_planar_between(const double a[2], const double b[2])
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]};

    return maths_sqrt(planar_dot(d, d));
}

bool takt_planar_set_line(struct planar *c, const double from[2], const double to[2])
{
    memset(c, 0, sizeof(*c));
    memcpy(c->from, from, sizeof(c->from));
    memcpy(c->to, to, sizeof(c->to));
    return takt_planar_between(from, to) >= LENGTH_MIN_MM;
}

/* Angle from a to b as seen from centre, in the sense of turning: 0 <= angle < 2 pi. */
static double angle_between(const double centre[2], const double a[2], const double b[2],
                            double sense)
{
    const double u[2] = {a[0] - centre[0], a[1] - centre[1]};
    const double v[2] = {b[0] - centre[0], b[1] - centre[1]};
    const double angle = sense * takt_maths_atan2(planar_turn(u, v), planar_dot(u, v));

    TAKT_ASSERT(sense == 1.0 || sense == -1.0);
    return angle < 0.0 ? angle + MATHS_TWO_PI : angle;
}

/* The end of a full circle may lie a rounding before or behind its start. */
void takt_planar_set_arc(struct planar *c, const double from[2], const double to[2],
                         const double centre[2], double sense, unsigned turns)
{
    TAKT_ASSERT(turns >= 1);
    (void)takt_planar_set_line(c, from, to);
    c->arc = true;
    memcpy(c->centre, centre, sizeof(c->centre));
    c->sense = sense > 0.0 ? 1 : -1;
    c->radius_from = takt_planar_between(from, centre);
    c->radius_to = takt_planar_between(to, centre);
    c->sweep_rad = angle_between(centre, from, to, sense);
    const bool closed =
        maths_abs(to[0] - from[0]) <= CLOSED_MM && maths_abs(to[1] - from[1]) <= CLOSED_MM;

    if (closed && c->sweep_rad < MATHS_PI) {
        c->sweep_rad += MATHS_TWO_PI;
    }
    c->sweep_rad += MATHS_TWO_PI * ((double)turns - 1.0);
}

bool takt_planar_set_involute(struct planar *c, const double from[2], const double to[2],
                              const double centre[2], double base_mm, bool clockwise)
{
    const struct point start = {{from[0], from[1]}};
    const struct point end = {{to[0], to[1]}};
    struct curve curve;

    (void)takt_planar_set_line(c, from, to);
    if (!takt_curve_set_involute(&curve, &start, &end, PLANE_XY, centre, base_mm, clockwise)) {
        return false;
    }
    c->involute = true;
    memcpy(c->centre, curve.involute.centre_mm, sizeof(c->centre));
    c->base_mm = curve.involute.radius_mm;
    c->hand = curve.involute.hand > 0.0 ? 1 : -1;
    c->heading_rad = curve.involute.heading_rad;
    c->unrolled_from = takt_involute_unrolled(&curve, 0.0);
    c->unrolled_to = takt_involute_unrolled(&curve, curve.length_mm);
    return true;
}

/* A line's direction, or across the radius of an arc's point, in the sense of turning. */
static void tangent(const struct planar *c, const double point[2], double result[2])
{
    double d[2] = {c->to[0] - c->from[0], c->to[1] - c->from[1]};

    if (c->arc) {
        d[0] = -c->sense * (point[1] - c->centre[1]);
        d[1] = c->sense * (point[0] - c->centre[0]);
    }
    const double length = maths_sqrt(planar_dot(d, d));

    result[0] = d[0] / length;
    result[1] = d[1] / length;
}

void takt_planar_tangent_from(const struct planar *c, double result[2])
{
    if (c->involute) {
        takt_planar_involute_tangent(c, c->unrolled_from, result);
    } else {
        tangent(c, c->from, result);
    }
}

void takt_planar_tangent_to(const struct planar *c, double result[2])
{
    if (c->involute) {
        takt_planar_involute_tangent(c, c->unrolled_to, result);
    } else {
        tangent(c, c->to, result);
    }
}

double takt_planar_curvature_from(const struct planar *c)
{
    if (c->involute) {
        return takt_planar_involute_curvature(c, c->unrolled_from);
    }
    return c->arc ? c->sense / c->radius_from : 0.0;
}

double takt_planar_curvature_to(const struct planar *c)
{
    if (c->involute) {
        return takt_planar_involute_curvature(c, c->unrolled_to);
    }
    return c->arc ? c->sense / c->radius_to : 0.0;
}

static void move_left(double point[2], const double direction[2], double left_mm)
{
    point[0] -= direction[1] * left_mm;
    point[1] += direction[0] * left_mm;
}

/* The centre of a counter-clockwise arc is on its left: its radius shrinks by left_mm. */
bool takt_planar_offset(const struct planar *c, double left_mm, struct planar *result,
                        double *lack_mm)
{
    double direction[2];

    *result = *c;
    takt_planar_tangent_from(c, direction);
    move_left(result->from, direction, left_mm);
    takt_planar_tangent_to(c, direction);
    move_left(result->to, direction, left_mm);
    if (c->involute) {
        *lack_mm = -takt_planar_involute_offset(result, left_mm);
        return *lack_mm < -CLOSED_MM;
    }
    if (!c->arc) {
        return true;
    }
    result->radius_from -= c->sense * left_mm;
    result->radius_to -= c->sense * left_mm;
    *lack_mm = -maths_min(result->radius_from, result->radius_to);
    return *lack_mm < -CLOSED_MM;
}

double takt_planar_length(const struct planar *c)
{
    if (c->involute) {
        return takt_planar_involute_length(c);
    }
    return c->arc ? c->sweep_rad * 0.5 * (c->radius_from + c->radius_to)
                  : takt_planar_between(c->from, c->to);
}

/* Radians that turn an angle into that place of the circle which is nearest to another one. */
static double nearest_turn(double angle_rad, double to_rad)
{
    return angle_rad + MATHS_TWO_PI * takt_maths_round((to_rad - angle_rad) / MATHS_TWO_PI);
}

static double place_near(const struct planar *c, const double point[2], double near_rad)
{
    if (c->involute) {
        return takt_planar_involute_place(c, point);
    }
    if (!c->arc) {
        const double d[2] = {point[0] - c->from[0], point[1] - c->from[1]};
        double direction[2];

        takt_planar_tangent_from(c, direction);
        return planar_dot(d, direction);
    }
    const double angle = angle_between(c->centre, c->from, point, c->sense);

    return nearest_turn(angle, near_rad) * 0.5 * (c->radius_from + c->radius_to);
}

double takt_planar_place(const struct planar *c, const double point[2])
{
    return place_near(c, point, 0.5 * c->sweep_rad);
}

/* From three quarters of a turn before the end to one quarter behind it; likewise at the start. */
double takt_planar_place_near_to(const struct planar *c, const double point[2])
{
    return place_near(c, point, maths_max(0.5 * c->sweep_rad, c->sweep_rad - MATHS_HALF_PI));
}

double takt_planar_place_near_from(const struct planar *c, const double point[2])
{
    return place_near(c, point, maths_min(0.5 * c->sweep_rad, MATHS_HALF_PI));
}

void takt_planar_end_at(struct planar *c, double place_mm, const double point[2])
{
    if (c->arc) {
        c->sweep_rad = place_mm / (0.5 * (c->radius_from + c->radius_to));
        c->radius_to = takt_planar_between(c->centre, point);
    }
    if (c->involute) {
        c->unrolled_to = takt_planar_involute_unrolled(c, place_mm);
    }
    memcpy(c->to, point, sizeof(c->to));
}

void takt_planar_begin_at(struct planar *c, double place_mm, const double point[2])
{
    if (c->arc) {
        c->sweep_rad -= place_mm / (0.5 * (c->radius_from + c->radius_to));
        c->radius_from = takt_planar_between(c->centre, point);
    }
    if (c->involute) {
        c->unrolled_from = takt_planar_involute_unrolled(c, place_mm);
    }
    memcpy(c->from, point, sizeof(c->from));
}
