/*
 * An arc in fractions. With f from 0 to 1,
 *
 *     angle  = angle_start + sweep f
 *     radius = radius_start + radius_change f
 *     other  = start + (end - start) f            (every axis outside the plane)
 *
 * so a circle, a helix and an arc whose two radii differ are one form; the last is how an arc is
 * run whose end is, within the tolerance, not on the circle of its start. The length element is
 *
 *     ds/df = g(f) = sqrt((radius sweep)^2 + radius_change^2 + sum of other linear axes^2)
 *
 * which is constant for a circle or helix: f = s / L. Else f(s) is the cubic with the right value
 * and slope (1/g) at both ends; it moves the point along the curve, never off it, and its error in
 * length is below L (radius_change / radius)^3 / 400.
 */
#include "geometry/arc.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Start and end closer than this in the plane are the same point: a full circle. */
#define ARC_CLOSED_MM 1e-7

/* Where an arc is: fraction, its first three derivatives by s, and the radius vector there. */
struct arc_state {
    double f, f1, f2;
    double radius_mm;
    double cosine, sine;
};

void takt_plane_axes(enum plane plane, enum axis *first, enum axis *second)
{
    static const unsigned char axes[3][2] = {{AXIS_X, AXIS_Y}, {AXIS_Z, AXIS_X}, {AXIS_Y, AXIS_Z}};

    TAKT_ASSERT(plane <= PLANE_YZ);
    *first = (enum axis)axes[plane][0];
    *second = (enum axis)axes[plane][1];
}

/*
 * g(f)^2 without the part that changes with the radius: radius_change^2 + sum of other linear
 * axes^2
 */
static double constant_speed_squared(const struct curve *c)
{
    double sum = c->arc.radius_change_mm * c->arc.radius_change_mm;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (i != c->arc.first && i != c->arc.second) {
            const double delta = c->end.at[i] - c->start.at[i];

            sum += delta * delta;
        }
    }
    return sum;
}

/* g(f) = ds/df */
static double speed(const struct curve *c, double constant_squared, double f)
{
    const double radius = c->arc.radius_start_mm + c->arc.radius_change_mm * f;
    const double across = radius * c->arc.sweep_rad;

    return maths_sqrt(across * across + constant_squared);
}

/* L = integral of g over 0 ... 1 by Gauss-Legendre with five points; exact for constant radius. */
static double arc_length(const struct curve *c, double constant_squared)
{
    static const double node[3] = {0.0, 0.53846931010568309104, 0.90617984593866399280};
    static const double weight[3] = {0.56888888888888888889, 0.47862867049936646804,
                                     0.23692688505618908751};
    double sum = weight[0] * speed(c, constant_squared, 0.5);

    for (int i = 1; i < 3; i++) {
        sum += weight[i] * speed(c, constant_squared, 0.5 - 0.5 * node[i]);
        sum += weight[i] * speed(c, constant_squared, 0.5 + 0.5 * node[i]);
    }
    return 0.5 * sum;
}

/*
 * Angle from start to end in the sense of turning. When they coincide it is a whole turn and the
 * little that the end's angle differs from the start's, of either sign: the end is hit, however
 * small the radius.
 */
static double arc_sweep(double from_rad, double to_rad, bool clockwise, bool closed, unsigned turns)
{
    double sweep = clockwise ? from_rad - to_rad : to_rad - from_rad;

    TAKT_ASSERT(turns >= 1);
    if (sweep <= 0.0) {
        sweep += MATHS_TWO_PI;
    }
    if (closed && sweep < MATHS_PI) {
        sweep += MATHS_TWO_PI;
    }
    sweep += MATHS_TWO_PI * (double)(turns - 1U);
    return clockwise ? -sweep : sweep;
}

/*
 * f' L - 1 at an end of the arc. f' L <= 3 at both ends keeps the cubic monotone (Fritsch and
 * Carlson 1980).
 */
static double skew(const struct curve *c, double constant_squared, double f)
{
    return maths_min(2.0, c->length_mm / speed(c, constant_squared, f) - 1.0);
}

static void set_length(struct curve *c)
{
    const double constant_squared = constant_speed_squared(c);

    if (c->arc.radius_change_mm == 0.0) {
        c->length_mm = speed(c, constant_squared, 0.0);
    } else {
        c->length_mm = arc_length(c, constant_squared);
        c->arc.skew_start = skew(c, constant_squared, 0.0);
        c->arc.skew_end = skew(c, constant_squared, 1.0);
    }
}

static void set_slope(struct curve *c)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (i != c->arc.first && i != c->arc.second) {
            c->slope.at[i] = (c->end.at[i] - c->start.at[i]) / c->length_mm;
        }
    }
}

/* From the centre to a point, in the plane. */
struct spoke {
    double x, y;
};

static struct spoke spoke_to(const struct curve *c, const struct point *p)
{
    return (struct spoke){p->at[c->arc.first] - c->arc.centre_mm[0],
                          p->at[c->arc.second] - c->arc.centre_mm[1]};
}

static double spoke_length(struct spoke s)
{
    return maths_sqrt(s.x * s.x + s.y * s.y);
}

void takt_curve_begin_arc(struct curve *c, const struct point *start, const struct point *end,
                          enum plane plane, const double centre_mm[2])
{
    enum axis first;
    enum axis second;

    takt_plane_axes(plane, &first, &second);
    memset(c, 0, sizeof(*c));
    c->kind = CURVE_ARC;
    c->start = *start;
    c->end = *end;
    c->arc.first = (unsigned char)first;
    c->arc.second = (unsigned char)second;
    c->arc.centre_mm[0] = centre_mm[0];
    c->arc.centre_mm[1] = centre_mm[1];
    const struct spoke from = spoke_to(c, start);

    c->arc.radius_start_mm = spoke_length(from);
    c->arc.angle_start_rad = takt_maths_atan2(from.y, from.x);
}

bool takt_curve_end_arc(struct curve *c, bool clockwise, unsigned turns)
{
    const struct spoke from = spoke_to(c, &c->start);
    const struct spoke to = spoke_to(c, &c->end);
    const bool closed =
        maths_abs(to.x - from.x) <= ARC_CLOSED_MM && maths_abs(to.y - from.y) <= ARC_CLOSED_MM;
    const double radius_end = spoke_length(to);

    TAKT_ASSERT(c->kind == CURVE_ARC && turns >= 1);
    c->arc.radius_change_mm = radius_end - c->arc.radius_start_mm;
    c->arc.sweep_rad =
        arc_sweep(c->arc.angle_start_rad, takt_maths_atan2(to.y, to.x), clockwise, closed, turns);
    if (c->arc.radius_start_mm == 0.0 || radius_end == 0.0) {
        return false;
    }
    set_length(c);
    set_slope(c);
    return c->length_mm >= CURVE_LENGTH_MIN_MM;
}

bool takt_curve_set_arc(struct curve *c, const struct point *start, const struct point *end,
                        enum plane plane, const double centre_mm[2], bool clockwise, unsigned turns)
{
    takt_curve_begin_arc(c, start, end, plane, centre_mm);
    return takt_curve_end_arc(c, clockwise, turns);
}

static bool is_curved(const struct curve *c)
{
    return c->arc.skew_start != 0.0 || c->arc.skew_end != 0.0;
}

/* f, u = s / L */
static double fraction(const struct curve *c, double u)
{
    if (!is_curved(c)) {
        return u;
    }
    return u + u * (1.0 - u) * (c->arc.skew_start * (1.0 - u) - c->arc.skew_end * u);
}

/* All but the derivatives of f. */
static void locate_point(const struct curve *c, double s_mm, struct arc_state *a)
{
    a->f = fraction(c, s_mm / c->length_mm);
    a->radius_mm = c->arc.radius_start_mm + c->arc.radius_change_mm * a->f;
    takt_maths_sincos(c->arc.angle_start_rad + c->arc.sweep_rad * a->f, &a->sine, &a->cosine);
}

static void arc_locate(const struct curve *c, double s_mm, struct arc_state *a)
{
    const double u = s_mm / c->length_mm;
    const double p = c->arc.skew_start;
    const double q = c->arc.skew_end;

    locate_point(c, s_mm, a);
    a->f1 = (1.0 + p * (1.0 - 4.0 * u + 3.0 * u * u) - q * (2.0 * u - 3.0 * u * u)) / c->length_mm;
    a->f2 = (p * (6.0 * u - 4.0) - q * (2.0 - 6.0 * u)) / (c->length_mm * c->length_mm);
}

static void point_of(const struct curve *c, const struct arc_state *a, struct point *p)
{
    *p = c->start;
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (c->slope.at[i] != 0.0) {
            p->at[i] += c->slope.at[i] * c->length_mm * a->f;
        }
    }
    p->at[c->arc.first] = c->arc.centre_mm[0] + a->radius_mm * a->cosine;
    p->at[c->arc.second] = c->arc.centre_mm[1] + a->radius_mm * a->sine;
}

/* dx/ds = dx/df f'; in the plane dx/df = radius_change (cos, sin) + radius sweep (-sin, cos) */
static void tangent_of(const struct curve *c, const struct arc_state *a, struct point *t)
{
    const double along = c->arc.radius_change_mm * a->f1;
    const double across = a->radius_mm * c->arc.sweep_rad * a->f1;

    for (int i = 0; i < AXIS_COUNT; i++) {
        t->at[i] = c->slope.at[i] * c->length_mm * a->f1;
    }
    t->at[c->arc.first] = along * a->cosine - across * a->sine;
    t->at[c->arc.second] = along * a->sine + across * a->cosine;
}

void takt_arc_point(const struct curve *c, double s_mm, struct point *p)
{
    struct arc_state a;

    locate_point(c, s_mm, &a);
    point_of(c, &a, p);
}

void takt_arc_tangent(const struct curve *c, double s_mm, struct point *t)
{
    struct arc_state a;

    arc_locate(c, s_mm, &a);
    tangent_of(c, &a, t);
}

void takt_arc_point_and_tangent(const struct curve *c, double s_mm, struct point *p,
                                struct point *t)
{
    struct arc_state a;

    arc_locate(c, s_mm, &a);
    point_of(c, &a, p);
    tangent_of(c, &a, t);
}

/*
 * d2x/ds2 = d2x/df2 f'^2 + dx/df f''; in the plane
 * d2x/df2 = -radius sweep^2 (cos, sin) + 2 radius_change sweep (-sin, cos)
 */
void takt_arc_curvature(const struct curve *c, double s_mm, struct point *k)
{
    struct arc_state a;

    arc_locate(c, s_mm, &a);
    const double sweep = c->arc.sweep_rad;
    const double change = c->arc.radius_change_mm;
    const double along = change * a.f2 - a.radius_mm * sweep * sweep * a.f1 * a.f1;
    const double across = a.radius_mm * sweep * a.f2 + 2.0 * change * sweep * a.f1 * a.f1;

    for (int i = 0; i < AXIS_COUNT; i++) {
        k->at[i] = c->slope.at[i] * c->length_mm * a.f2;
    }
    k->at[c->arc.first] = along * a.cosine - across * a.sine;
    k->at[c->arc.second] = along * a.sine + across * a.cosine;
}

/*
 * Bounds of the derivatives by s. With R the larger radius, d = |radius_change|, w = |sweep|, and
 * bounds F1, F2, F3 of the derivatives of f, in the plane
 *     |x'|   <= (R w + d) F1
 *     |x''|  <= (R w + 2 d) w F1^2 + (R w + d) F2
 *     |x'''| <= (R w + 3 d) w^2 F1^3 + 3 (R w + 2 d) w F1 F2 + (R w + d) F3
 * and outside it the same with (R w + ...) replaced by the axis's travel and w by 0.
 *
 * The part of x'' along the path is d|x'|/ds, and d|dx/df|/df = radius w^2 d / |dx/df| <= w d; of
 * the three terms of x''' the last lies along the path, and d3x/df3 = -3 d w^2 (cos, sin) - radius
 * w^3 (-sin, cos) has at most 4 d w^2 across it:
 *     along  <= w d F1^2 + (R w + d) F2
 *     across <= 4 d w^2 F1^3 + 3 (R w + 2 d) w F1 F2
 */
void takt_arc_bound(const struct curve *c, struct curve_bounds *b)
{
    const double skews = maths_abs(c->arc.skew_start) + maths_abs(c->arc.skew_end);
    const double inverse = 1.0 / c->length_mm;
    const double f1 = (1.0 + skews) * inverse;
    const double f2 = 4.0 * skews * inverse * inverse;
    const double f3 = 6.0 * skews * inverse * inverse * inverse;
    const double w = maths_abs(c->arc.sweep_rad);
    const double d = maths_abs(c->arc.radius_change_mm);
    const double rw =
        w * maths_max(c->arc.radius_start_mm, c->arc.radius_start_mm + c->arc.radius_change_mm);

    TAKT_ASSERT(c->length_mm > 0.0);
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double travel = maths_abs(c->slope.at[i]) * c->length_mm;

        b->first[i] = travel * f1;
        b->second[i] = travel * f2;
        b->third[i] = travel * f3;
    }
    const double first = (rw + d) * f1;
    const double second = (rw + 2.0 * d) * w * f1 * f1 + (rw + d) * f2;
    const double third =
        (rw + 3.0 * d) * w * w * f1 * f1 * f1 + 3.0 * (rw + 2.0 * d) * w * f1 * f2 + (rw + d) * f3;

    b->first[c->arc.first] = b->first[c->arc.second] = first;
    b->second[c->arc.first] = b->second[c->arc.second] = second;
    b->third[c->arc.first] = b->third[c->arc.second] = third;
    b->radius_min_mm = 1.0 / second;
    b->second_along = w * d * f1 * f1 + (rw + d) * f2;
    b->third_across = 4.0 * d * w * w * f1 * f1 * f1 + 3.0 * (rw + 2.0 * d) * w * f1 * f2;
    b->cusp_rad = 0.0;
}
