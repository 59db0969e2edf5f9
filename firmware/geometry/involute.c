/*
 * A string unrolled from a base circle (centre C, radius r) by the angle phi >= 0 ends at
 *
 *     P = C + r [(cos t, sin t) + h phi (sin t, -cos t)],      t = heading + h phi,   h = 1 or -1 (hand)
 *
 * (seed 001, eq. 2, 6). The curve's direction there is t, its radius of curvature r phi, its
 * distance from C r sqrt(1 + phi^2), and the vector from C has turned by inv phi = phi - atan phi
 * since the base circle. Its length is (r / 2) (phi^2 - phi0^2), so phi^2 is linear in the length:
 * the place at s is a closed form,
 *
 *     phi(s) = sqrt(phi0^2 +- 2 s / r)
 *
 * and equal steps of s are equal lengths, exactly. Other axes move in proportion to the length.
 *
 * Ends off the curve. Programs have rounded ends. The distances of both ends from C and the angle T
 * between them overdetermine phi at both ends: with u = 1 / r as unknown,
 *
 *     f(u) = inv phi_outer - inv phi_inner - T = 0,       phi = sqrt((d u)^2 - 1)
 *
 * f' = (phi_outer - phi_inner) / u > 0 and f'' = (1 / phi_outer - 1 / phi_inner) / u^2 < 0, so
 * Newton's steps from the left stay left of the root and go up to it. The involute found is off the
 * programmed one by a distance that grows steadily from 0 at the start to what the end is off. When
 * f(1 / d_inner) > 0, the inner end is in the base circle that the outer one asks for, and no
 * circle about C will do. Then the programmed involute is turned and scaled until its cusp is the
 * inner end and its other end the outer one; since the distance from the cusp grows along the
 * curve, no point moves farther than both ends do.
 *
 * Rejected: keeping r and adding a drift in proportion to the length (steps are not equal any
 * more); moving C alone (does not help after whole turns).
 */
#include "geometry/involute.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Newton's steps: 4 to 6 are used; the limit is for ends far off the curve. */
#define NEWTON_MAX 60

/*
 * Nearer to the base circle than this a curve begins or ends on it; then the piece there turns by
 * this much.
 */
#define CUSP_NEAR_RAD  0.1
#define CUSP_PIECE_RAD 1.0
/* A rest shorter than that is no piece of its own. */
#define CUSP_PIECE_MAX_RAD 1.25

/* Largest ratio of curvatures within other pieces: its logarithm. */
#define PIECE_LN_RATIO 0.22314355131420976 /* ln 1.25 */

/*
 * Curvature is that of this angle on the base circle itself: finite, and so large that nobody
 * passes.
 */
#define UNROLLED_MIN_RAD 1e-8

/* Both ends as seen from the centre: the inner one first. */
struct ends {
    double inner_mm, outer_mm;
    double turned_rad; /* T */
};

double takt_involute_turned(double distance_mm, double radius_mm)
{
    const double ratio = distance_mm / radius_mm;

    TAKT_ASSERT(radius_mm > 0.0);
    if (ratio <= 1.0) {
        return 0.0;
    }
    const double phi = maths_sqrt((ratio - 1.0) * (ratio + 1.0));

    return phi - takt_maths_atan2(phi, 1.0);
}

/* phi at the distance d when 1 / r = u. */
static double unrolled(double d, double u)
{
    return maths_sqrt(maths_max(0.0, (d * u - 1.0) * (d * u + 1.0)));
}

/* f(u) of the top, and its slope. */
static double excess(const struct ends *e, double u, double *slope)
{
    const double inner = unrolled(e->inner_mm, u);
    const double outer = unrolled(e->outer_mm, u);

    *slope = (outer - inner) / u;
    return (outer - takt_maths_atan2(outer, 1.0)) - (inner - takt_maths_atan2(inner, 1.0)) -
           e->turned_rad;
}

/*
 * The radius of the base circle about C that suits both ends; that of the inner end if none does.
 */
static double fit_radius(const struct ends *e, double radius_mm)
{
    const double least = 1.0 / e->inner_mm;
    double u = maths_max(least, 1.0 / radius_mm);
    double slope;
    double f = excess(e, u, &slope);

    TAKT_ASSERT(radius_mm > 0.0 && e->inner_mm > 0.0);
    if (f > 0.0 && slope > 0.0) { /* one step leads from the right of the root to its left */
        u = maths_max(least, u - f / slope);
    }
    for (int i = 0; i < NEWTON_MAX; i++) {
        f = excess(e, u, &slope);
        const double next = u - f / slope;

        if (!(f < 0.0 && next > u && maths_is_finite(next))) {
            break;
        }
        u = next;
    }
    return 1.0 / u;
}

static double angle_of(const struct point *p, const struct curve_involute *i)
{
    return takt_maths_atan2(p->at[i->second] - i->centre_mm[1], p->at[i->first] - i->centre_mm[0]);
}

static double distance_of(const struct point *p, const struct curve_involute *i)
{
    const double x = p->at[i->first] - i->centre_mm[0];
    const double y = p->at[i->second] - i->centre_mm[1];

    return maths_sqrt(x * x + y * y);
}

/*
 * T: the turn in the sense of the motion that is nearest to what the programmed base circle asks
 * for.
 */
static double turned_between(const struct curve *c, double radius_mm, bool clockwise,
                             const struct ends *e)
{
    const double angle = angle_of(&c->end, &c->involute) - angle_of(&c->start, &c->involute);
    const double wanted =
        takt_involute_turned(e->outer_mm, radius_mm) - takt_involute_turned(e->inner_mm, radius_mm);
    const double off = (clockwise ? -angle : angle) - wanted;

    return wanted + (off - MATHS_TWO_PI * takt_maths_round(off / MATHS_TWO_PI));
}

/* Where the string ends when phi is unrolled, from the centre. */
static void string_end(const struct curve_involute *i, double phi, double at[2])
{
    double sine;
    double cosine;

    takt_maths_sincos(i->heading_rad + i->hand * phi, &sine, &cosine);
    at[0] = i->radius_mm * (cosine + i->hand * phi * sine);
    at[1] = i->radius_mm * (sine - i->hand * phi * cosine);
}

/*
 * Turns and scales the curve so that its cusp is the inner end and the angle outer_rad is the outer
 * one.
 */
static void move_cusp(struct curve_involute *i, const struct point *inner,
                      const struct point *outer, double outer_rad)
{
    const double to[2] = {outer->at[i->first] - inner->at[i->first],
                          outer->at[i->second] - inner->at[i->second]};
    double cusp[2];
    double end[2];

    string_end(i, 0.0, cusp);
    string_end(i, outer_rad, end);
    const double way[2] = {end[0] - cusp[0], end[1] - cusp[1]};
    const double square = way[0] * way[0] + way[1] * way[1];
    const double re = (to[0] * way[0] + to[1] * way[1]) / square;
    const double im = (to[1] * way[0] - to[0] * way[1]) / square;

    i->centre_mm[0] = inner->at[i->first] - cusp[0] * re + cusp[1] * im;
    i->centre_mm[1] = inner->at[i->second] - cusp[0] * im - cusp[1] * re;
    i->radius_mm *= maths_sqrt(re * re + im * im);
    i->heading_rad += takt_maths_atan2(im, re);
}

/* Base circle and heading. Returns phi of the inner and of the outer end. */
static void fit(struct curve *c, double radius_mm, bool clockwise, double unrolled_rad[2])
{
    struct curve_involute *i = &c->involute;
    const struct point *inner = i->outward ? &c->start : &c->end;
    const struct point *outer = i->outward ? &c->end : &c->start;
    struct ends e = {distance_of(inner, i), distance_of(outer, i), 0.0};
    double slope;

    e.turned_rad = turned_between(c, radius_mm, clockwise, &e);
    if (excess(&e, 1.0 / e.inner_mm, &slope) > 0.0) {
        i->radius_mm = radius_mm;
        i->heading_rad = angle_of(inner, i);
        unrolled_rad[0] = 0.0;
        unrolled_rad[1] = unrolled(e.outer_mm, 1.0 / i->radius_mm);
        move_cusp(i, inner, outer, unrolled_rad[1]);
        return;
    }
    i->radius_mm = fit_radius(&e, radius_mm);
    unrolled_rad[0] = unrolled(e.inner_mm, 1.0 / i->radius_mm);
    unrolled_rad[1] = unrolled(e.outer_mm, 1.0 / i->radius_mm);
    i->heading_rad =
        angle_of(inner, i) - i->hand * (unrolled_rad[0] - takt_maths_atan2(unrolled_rad[0], 1.0));
}

/* Length, and all that goes with it; unrolled_rad at the inner and at the outer end. */
static void set_length(struct curve *c, const double unrolled_rad[2])
{
    struct curve_involute *i = &c->involute;
    const double plane_mm = 0.5 * i->radius_mm * (unrolled_rad[1] - unrolled_rad[0]) *
                            (unrolled_rad[1] + unrolled_rad[0]);
    double square = plane_mm * plane_mm;

    for (int axis = 0; axis < AXIS_LINEAR_COUNT; axis++) {
        if (axis != i->first && axis != i->second) {
            const double delta = c->end.at[axis] - c->start.at[axis];

            square += delta * delta;
        }
    }
    c->length_mm = maths_sqrt(square);
    i->plane_ratio = plane_mm / c->length_mm;
    const double start_rad = unrolled_rad[i->outward ? 0 : 1];

    i->square_start_rad2 = start_rad * start_rad;
    i->square_rate_rad2_mm = (i->outward ? 2.0 : -2.0) * i->plane_ratio / i->radius_mm;
    i->cusp_start = i->outward && unrolled_rad[0] < CUSP_NEAR_RAD;
    i->cusp_end = !i->outward && unrolled_rad[0] < CUSP_NEAR_RAD;
}

static void set_slope(struct curve *c)
{
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        if (axis != c->involute.first && axis != c->involute.second) {
            c->slope.at[axis] = (c->end.at[axis] - c->start.at[axis]) / c->length_mm;
        }
    }
}

bool takt_curve_set_involute(struct curve *c, const struct point *start, const struct point *end,
                             enum plane plane, const double centre_mm[2], double base_radius_mm,
                             bool clockwise)
{
    struct curve_involute *i = &c->involute;
    double unrolled_rad[2];
    enum axis first;
    enum axis second;

    TAKT_ASSERT(base_radius_mm > 0.0);
    takt_plane_axes(plane, &first, &second);
    memset(c, 0, sizeof(*c));
    c->kind = CURVE_INVOLUTE;
    c->start = *start;
    c->end = *end;
    i->first = (unsigned char)first;
    i->second = (unsigned char)second;
    i->centre_mm[0] = centre_mm[0];
    i->centre_mm[1] = centre_mm[1];
    const double start_mm = distance_of(start, i);
    const double end_mm = distance_of(end, i);

    i->outward = end_mm > start_mm;
    i->hand = i->outward == clockwise ? -1.0 : 1.0;
    if (maths_min(start_mm, end_mm) <= 0.0 || start_mm == end_mm ||
        maths_max(start_mm, end_mm) <= base_radius_mm ||
        maths_max(start_mm, end_mm) > CURVE_UNROLLED_MAX_RAD * base_radius_mm) {
        return false;
    }
    fit(c, base_radius_mm, clockwise, unrolled_rad);
    set_length(c, unrolled_rad);
    set_slope(c);
    return c->length_mm >= CURVE_LENGTH_MIN_MM && unrolled_rad[1] <= 2.0 * CURVE_UNROLLED_MAX_RAD;
}

double takt_involute_unrolled(const struct curve *c, double s_mm)
{
    const struct curve_involute *i = &c->involute;

    return maths_sqrt(maths_max(0.0, i->square_start_rad2 + i->square_rate_rad2_mm * s_mm));
}

double takt_involute_place(const struct curve *c, double unrolled_rad)
{
    const struct curve_involute *i = &c->involute;

    TAKT_ASSERT(i->square_rate_rad2_mm != 0.0);
    return (unrolled_rad * unrolled_rad - i->square_start_rad2) / i->square_rate_rad2_mm;
}

/* Sine and cosine of the heading t away from the base circle. */
static void heading(const struct curve_involute *i, double phi, double *sine, double *cosine)
{
    takt_maths_sincos(i->heading_rad + i->hand * phi, sine, cosine);
}

void takt_involute_point(const struct curve *c, double s_mm, struct point *p)
{
    const struct curve_involute *i = &c->involute;
    double at[2];

    string_end(i, takt_involute_unrolled(c, s_mm), at);
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        p->at[axis] = c->start.at[axis] + c->slope.at[axis] * s_mm;
    }
    p->at[i->first] = i->centre_mm[0] + at[0];
    p->at[i->second] = i->centre_mm[1] + at[1];
}

void takt_involute_tangent(const struct curve *c, double s_mm, struct point *t)
{
    const struct curve_involute *i = &c->involute;
    const double along = i->outward ? i->plane_ratio : -i->plane_ratio;
    double sine;
    double cosine;

    heading(i, takt_involute_unrolled(c, s_mm), &sine, &cosine);
    *t = c->slope;
    t->at[i->first] = along * cosine;
    t->at[i->second] = along * sine;
}

/* Curvature q^2 / (r phi), q the plane's share of the length; it changes by q^3 / (r^2 phi^3). */
struct involute_curvature takt_involute_curvature_change(const struct curve *c, double s_mm)
{
    const struct curve_involute *i = &c->involute;
    const double phi = maths_max(takt_involute_unrolled(c, s_mm), UNROLLED_MIN_RAD);
    const double per_mm = i->plane_ratio / (i->radius_mm * phi);

    return (struct involute_curvature){
        .curvature_1_mm = i->plane_ratio * per_mm,
        .change_1_mm2 = i->plane_ratio * per_mm * per_mm / phi,
    };
}

/*
 * d2P/ds2 lies across the curve: to the left of its heading away from the base circle when that
 * turns left.
 */
void takt_involute_curvature(const struct curve *c, double s_mm, struct point *k)
{
    const struct curve_involute *i = &c->involute;
    const double curvature = takt_involute_curvature_change(c, s_mm).curvature_1_mm;
    double sine;
    double cosine;

    heading(i, takt_involute_unrolled(c, s_mm), &sine, &cosine);
    memset(k, 0, sizeof(*k));
    k->at[i->first] = -i->hand * curvature * sine;
    k->at[i->second] = i->hand * curvature * cosine;
}

/*
 * What is sharpest is sharpest at the inner end. With curvature k in the plane: q k, q^2 k, q^3 k^2
 * and q^3 k'.
 */
static void bound_plane(const struct curve *c, struct curve_bounds *b, int axis)
{
    const struct curve_involute *i = &c->involute;
    const struct involute_curvature at_end =
        takt_involute_curvature_change(c, i->outward ? 0.0 : c->length_mm);

    b->first[axis] = i->plane_ratio;
    if (i->cusp_start || i->cusp_end) {
        b->second[axis] = b->third[axis] = MATHS_INFINITY;
        return;
    }
    b->second[axis] = at_end.curvature_1_mm;
    b->third[axis] = at_end.curvature_1_mm * at_end.curvature_1_mm / i->plane_ratio;
    b->radius_min_mm = 1.0 / at_end.curvature_1_mm;
    b->third_across = at_end.change_1_mm2;
}

void takt_involute_bound(const struct curve *c, struct curve_bounds *b)
{
    const struct curve_involute *i = &c->involute;

    memset(b, 0, sizeof(*b));
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        b->first[axis] = maths_abs(c->slope.at[axis]);
    }
    bound_plane(c, b, i->first);
    bound_plane(c, b, i->second);
    if (i->cusp_start || i->cusp_end) {
        b->cusp_rad = takt_involute_unrolled(c, i->outward ? c->length_mm : 0.0);
    }
}

double takt_involute_cusp_acceleration(double cusp_rad)
{
    TAKT_ASSERT(cusp_rad >= 0.0);
    return maths_sqrt(1.0 + cusp_rad * cusp_rad);
}

double takt_involute_cusp_jerk(double cusp_rad)
{
    const double along = 1.0 + 1.125 * cusp_rad * cusp_rad;
    const double across = 5.625 * cusp_rad;

    TAKT_ASSERT(cusp_rad >= 0.0);
    return maths_sqrt(along * along + across * across);
}

double takt_involute_step_max(const struct curve *c, double error_mm)
{
    const struct curve_involute *i = &c->involute;
    const double root = takt_maths_cbrt(6.75 * error_mm * maths_sqrt(1.125 * i->radius_mm));

    TAKT_ASSERT(error_mm > 0.0);
    return root * root / i->plane_ratio;
}

/*
 * From phi to the next of the fewest equal ratios, none above PIECE_LN_RATIO, that lead to the
 * other one.
 */
static double next_unrolled(double from_rad, double to_rad)
{
    const double ln = takt_maths_ln(to_rad / from_rad);
    const double pieces = takt_maths_ceil(maths_abs(ln) / PIECE_LN_RATIO);

    TAKT_ASSERT(from_rad > 0.0 && to_rad > 0.0);
    return pieces > 1.0 ? from_rad * takt_maths_exp(ln / pieces) : to_rad;
}

double takt_involute_piece_end(const struct curve *c, double from_mm)
{
    const struct curve_involute *i = &c->involute;
    const double from = takt_involute_unrolled(c, from_mm);
    const double last = takt_involute_unrolled(c, c->length_mm);
    double to = last;

    if (i->cusp_start && from_mm == 0.0) {
        to = last > CUSP_PIECE_MAX_RAD ? CUSP_PIECE_RAD : last;
    } else if (!i->cusp_end) {
        to = next_unrolled(from, last);
    } else if (from > CUSP_PIECE_MAX_RAD) {
        to = next_unrolled(from, CUSP_PIECE_RAD);
    }
    return to == last ? c->length_mm
                      : maths_clamp(takt_involute_place(c, to), from_mm, c->length_mm);
}

void takt_involute_cut(const struct curve *c, double from_mm, double to_mm, struct curve *piece)
{
    struct curve_involute *i = &piece->involute;

    TAKT_ASSERT(c->kind == CURVE_INVOLUTE);
    *piece = *c;
    piece->length_mm = to_mm - from_mm;
    i->square_start_rad2 += i->square_rate_rad2_mm * from_mm;
    if (from_mm > 0.0) {
        takt_involute_point(c, from_mm, &piece->start);
        i->cusp_start = false;
    }
    if (to_mm < c->length_mm) {
        takt_involute_point(c, to_mm, &piece->end);
        i->cusp_end = false;
    }
}

bool takt_involute_extreme(const struct curve *c, unsigned quarter, double *s_mm)
{
    const struct curve_involute *i = &c->involute;
    const double from = takt_involute_unrolled(c, i->outward ? 0.0 : c->length_mm);
    const double to = takt_involute_unrolled(c, i->outward ? c->length_mm : 0.0);
    double phi = i->hand * (quarter * MATHS_HALF_PI - i->heading_rad);

    TAKT_ASSERT(quarter < 4 && c->kind == CURVE_INVOLUTE);
    phi += MATHS_TWO_PI * takt_maths_floor((to - phi) / MATHS_TWO_PI);
    *s_mm = maths_clamp(takt_involute_place(c, phi), 0.0, c->length_mm);
    return phi >= from;
}
