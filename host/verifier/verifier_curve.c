#include "verifier/verifier_curve.h"

#include "base/maths.h"
#include "geometry/involute.h"

double verifier_distance(const struct point *a, const struct point *b)
{
    double sum = 0;

    for (int i = 0; i < AXIS_COUNT; i++)
        sum += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    return maths_sqrt(sum);
}

/*
 * Nearest point of the line from a to b: a + f (b - a), f = (p - a)(b - a) / |b - a|^2, kept within
 * 0 ... 1.
 */
static double line_distance(const struct curve *c, const struct point *p, double *fraction)
{
    double dot = 0, square = 0, sum = 0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        double way = c->end.at[i] - c->start.at[i];

        dot += (p->at[i] - c->start.at[i]) * way;
        square += way * way;
    }
    *fraction = maths_clamp(dot / square, 0, 1);
    for (int i = 0; i < AXIS_COUNT; i++) {
        double off = p->at[i] - c->start.at[i] - *fraction * (c->end.at[i] - c->start.at[i]);

        sum += off * off;
    }
    return maths_sqrt(sum);
}

/* Fraction of the arc at which its radius vector has the angle, near the fraction given. */
static double arc_fraction(const struct curve_arc *arc, double angle_rad, double near)
{
    double turn = MATHS_TWO_PI / maths_abs(arc->sweep_rad);
    double fraction = (angle_rad - arc->angle_start_rad) / arc->sweep_rad;

    fraction += turn * takt_maths_round((near - fraction) / turn);
    return maths_clamp(fraction, 0, 1);
}

static double arc_distance(const struct curve *c, const struct point *p, double *fraction)
{
    const struct curve_arc *arc = &c->arc;
    double x = p->at[arc->first] - arc->centre_mm[0];
    double y = p->at[arc->second] - arc->centre_mm[1];
    double angle = takt_maths_atan2(y, x);
    double f = arc_fraction(arc, angle, *fraction);
    double on = arc->angle_start_rad + f * arc->sweep_rad;
    double radius = arc->radius_start_mm + f * arc->radius_change_mm;
    double sine, cosine, sum;

    *fraction = f;
    takt_maths_sincos(on, &sine, &cosine);
    sum = (x - radius * cosine) * (x - radius * cosine) + (y - radius * sine) * (y - radius * sine);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double off = p->at[i] - c->start.at[i] - f * (c->end.at[i] - c->start.at[i]);

        if (i != arc->first && i != arc->second)
            sum += off * off;
    }
    return maths_sqrt(sum);
}

/*
 * The normals of an involute touch its base circle. So seen from p, unrolled by
 * phi = sqrt((d / r)^2 - 1) with the string at the angle t = angle of p + h atan phi, the nearest
 * point has the same t, and lies r |phi - h (t - heading)| away.
 */
static double involute_nearest(const struct curve *c, double x, double y)
{
    const struct curve_involute *i = &c->involute;
    double ratio = maths_sqrt(x * x + y * y) / i->radius_mm;
    double phi = ratio > 1 ? maths_sqrt((ratio - 1) * (ratio + 1)) : 0;
    double string = takt_maths_atan2(y, x) + i->hand * takt_maths_atan2(phi, 1);
    double on = i->hand * (string - i->heading_rad);

    on += MATHS_TWO_PI * takt_maths_round((phi - on) / MATHS_TWO_PI);
    return maths_clamp(takt_involute_place(c, maths_max(on, 0)), 0, c->length_mm);
}

static double involute_distance(const struct curve *c, const struct point *p, double *fraction)
{
    const struct curve_involute *i = &c->involute;
    double s =
        involute_nearest(c, p->at[i->first] - i->centre_mm[0], p->at[i->second] - i->centre_mm[1]);
    struct point on;

    *fraction = s / c->length_mm;
    takt_curve_point(c, s, &on);
    return verifier_distance(p, &on);
}

/*
 * Of any curve the nearest place by Newton's steps s += (p - x) t / t^2 from the fraction's place:
 * between two setpoints it hardly bends.
 */
#define NEAREST_STEPS 8

static double near_distance(const struct curve *c, const struct point *p, double *fraction)
{
    double s = maths_clamp(*fraction, 0, 1) * c->length_mm;
    struct point on, tangent;

    for (unsigned k = 0; k < NEAREST_STEPS; k++) {
        double dot = 0, square = 0;

        takt_curve_point(c, s, &on);
        takt_curve_tangent(c, s, &tangent);
        for (int i = 0; i < AXIS_COUNT; i++) {
            dot += (p->at[i] - on.at[i]) * tangent.at[i];
            square += tangent.at[i] * tangent.at[i];
        }
        s = maths_clamp(s + dot / square, 0, c->length_mm);
    }
    *fraction = s / c->length_mm;
    takt_curve_point(c, s, &on);
    return verifier_distance(p, &on);
}

double verifier_curve_distance(const struct curve *c, const struct point *p, double *fraction)
{
    if (c->kind == CURVE_LINE)
        return line_distance(c, p, fraction);
    if (c->kind == CURVE_ARC)
        return arc_distance(c, p, fraction);
    if (c->kind == CURVE_INVOLUTE)
        return involute_distance(c, p, fraction);
    return near_distance(c, p, fraction);
}

/*
 * Sagitta of the chord in the plane of the arc: h = R - sqrt(R^2 - l^2 / 4), written without
 * cancellation as h = (l^2 / 4) / (R + sqrt(R^2 - l^2 / 4)). Where the radius changes, R is its
 * mean over the step: the chord's middle then lies h off the curve, up to terms of third order.
 */
static double arc_chord_error(const struct curve_arc *arc, const struct point *from,
                              const struct point *to)
{
    double x0 = from->at[arc->first] - arc->centre_mm[0];
    double y0 = from->at[arc->second] - arc->centre_mm[1];
    double x1 = to->at[arc->first] - arc->centre_mm[0];
    double y1 = to->at[arc->second] - arc->centre_mm[1];
    double quarter = ((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)) / 4;
    double radius = (maths_sqrt(x0 * x0 + y0 * y0) + maths_sqrt(x1 * x1 + y1 * y1)) / 2;

    return quarter / (radius + maths_sqrt(maths_max(radius * radius - quarter, 0)));
}

/*
 * An involute is farthest from a chord where it is parallel to it: at the headings of the chord and
 * half a turn on. Of a step of more than a turn the last turn counts, the widest.
 */
static double involute_chord_error(const struct curve *c, const struct point *from,
                                   const struct point *to)
{
    const struct curve_involute *i = &c->involute;
    double off[2] = {to->at[i->first] - from->at[i->first],
                     to->at[i->second] - from->at[i->second]};
    double length = maths_sqrt(off[0] * off[0] + off[1] * off[1]);
    double fraction = 0, begin, end, largest = 0;

    (void)involute_distance(c, from, &fraction);
    begin = takt_involute_unrolled(c, fraction * c->length_mm);
    (void)involute_distance(c, to, &fraction);
    end = takt_involute_unrolled(c, fraction * c->length_mm);
    for (unsigned half = 0; half < 2; half++) {
        double phi =
            i->hand * (takt_maths_atan2(off[1], off[0]) - i->heading_rad) + half * MATHS_PI;
        struct point p;

        phi += MATHS_TWO_PI * takt_maths_floor((maths_max(begin, end) - phi) / MATHS_TWO_PI);
        if (length == 0 || phi <= maths_min(begin, end))
            continue;
        takt_curve_point(c, takt_involute_place(c, phi), &p);
        largest = maths_max(largest, maths_abs((p.at[i->first] - from->at[i->first]) * off[1] -
                                               (p.at[i->second] - from->at[i->second]) * off[0]) /
                                         length);
    }
    return largest;
}

/* Places between both, of which the largest counts. */
#define CHORD_PLACES 16

static double near_chord_error(const struct curve *c, const struct point *from,
                               const struct point *to)
{
    struct curve chord;
    double begin = 0, end = 1, largest = 0;

    if (!takt_curve_set_line(&chord, from, to))
        return 0;
    (void)near_distance(c, from, &begin);
    (void)near_distance(c, to, &end);
    for (unsigned k = 1; k < CHORD_PLACES; k++) {
        double fraction = 0;
        struct point p;

        takt_curve_point(c, (begin + (end - begin) * k / CHORD_PLACES) * c->length_mm, &p);
        largest = maths_max(largest, line_distance(&chord, &p, &fraction));
    }
    return largest;
}

double verifier_curve_chord_error(const struct curve *c, const struct point *from,
                                  const struct point *to)
{
    if (c->kind == CURVE_LINE)
        return 0;
    if (c->kind == CURVE_ARC)
        return arc_chord_error(&c->arc, from, to);
    if (c->kind == CURVE_INVOLUTE)
        return involute_chord_error(c, from, to);
    return near_chord_error(c, from, to);
}
