/*
 * The point at the unrolled angle phi, the string at the angle t = heading + h phi from the base
 * circle's centre C:
 *
 *     P = C + r [(cos t, sin t) + h phi (sin t, -cos t)]
 *
 * Its normal is the string, which touches the base circle. So
 *
 *   - moved aside by d along it an involute stays one of the same circle: phi' = phi - w h d / r, t the same
 *     (w = 1: outward, -1: inward; d to the left);
 *   - the foot of a point is where its own string has the same angle t;
 *   - the distance from a line, or from a point, can only turn where the string is across the line, or goes through the
 *     point: at one or two angles t, once a turn each. Between two of those places it is monotone, so crossings with
 *     lines and circles are found by bisection and none is missed. A common normal of two involutes touches both base
 *     circles: four angles; there the steps are also kept short, since the distance from an involute is told only up to
 *     its turns.
 */
#include "cutter_compensation/planar_involute.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/*
 * Crossings are looked for so far beyond the ends: more than one point of a blunt corner can need.
 */
#define BEYOND_MM 0.05
/*
 * Base circles nearer than this to concentric have all normals in common: the ends then tell the
 * distance.
 */
#define CONCENTRIC_MM 1e-9
#define BISECTIONS    60
#define ANGLES_MAX    4
#define STEP_MAX_RAD  0.3
/* Radius of curvature below which a curve counts as that. */
#define RADIUS_MIN_MM 1e-9

/* Angles of the string at which a distance may turn. */
struct angles {
    unsigned count;
    double angle_rad[ANGLES_MAX];
};

/* A search for crossings along an involute. */
struct search {
    const struct planar *c, *other;
    double radius_mm;
    bool near_end;
    unsigned count;
    double (*points)[2];
};

static double way_of(const struct planar *c)
{
    return c->unrolled_to > c->unrolled_from ? 1.0 : -1.0;
}

static void point_at(const struct planar *c, double phi, double point[2])
{
    double sine;
    double cosine;

    takt_maths_sincos(c->heading_rad + c->hand * phi, &sine, &cosine);
    point[0] = c->centre[0] + c->base_mm * (cosine + c->hand * phi * sine);
    point[1] = c->centre[1] + c->base_mm * (sine - c->hand * phi * cosine);
}

void takt_planar_involute_tangent(const struct planar *c, double unrolled_rad, double result[2])
{
    takt_maths_sincos(c->heading_rad + c->hand * unrolled_rad, &result[1], &result[0]);
    result[0] *= way_of(c);
    result[1] *= way_of(c);
}

double takt_planar_involute_curvature(const struct planar *c, double unrolled_rad)
{
    TAKT_ASSERT(c->involute && c->base_mm > 0.0);
    return way_of(c) * c->hand / maths_max(c->base_mm * unrolled_rad, RADIUS_MIN_MM);
}

double takt_planar_involute_offset(struct planar *c, double left_mm)
{
    const double by_rad = way_of(c) * c->hand * left_mm / c->base_mm;

    c->unrolled_from -= by_rad;
    c->unrolled_to -= by_rad;
    c->heading_rad += c->hand * by_rad;
    return c->base_mm * maths_min(c->unrolled_from, c->unrolled_to);
}

double takt_planar_involute_length(const struct planar *c)
{
    TAKT_ASSERT(c->involute && c->base_mm > 0.0);
    return 0.5 * c->base_mm * maths_abs(c->unrolled_to - c->unrolled_from) *
           (c->unrolled_to + c->unrolled_from);
}

/* Unrolled angle of a point by its distance from the centre; false: it is in the base circle. */
static bool unrolled_of(const struct planar *c, const double point[2], double *phi)
{
    const double ratio = takt_planar_between(point, c->centre) / c->base_mm;

    TAKT_ASSERT(c->base_mm > 0.0);
    *phi = ratio > 1.0 ? maths_sqrt((ratio - 1.0) * (ratio + 1.0)) : 0.0;
    return ratio > 1.0;
}

/* The unrolled angle of a point's foot, of all turns the one nearest to the point. */
static double foot_of(const struct planar *c, const double point[2], double phi)
{
    const double angle = takt_maths_atan2(point[1] - c->centre[1], point[0] - c->centre[0]);
    const double on = c->hand * (angle - c->heading_rad) + takt_maths_atan2(phi, 1.0);

    return on + MATHS_TWO_PI * takt_maths_round((phi - on) / MATHS_TWO_PI);
}

double takt_planar_involute_place(const struct planar *c, const double point[2])
{
    double phi;

    (void)unrolled_of(c, point, &phi);
    const double on = maths_max(foot_of(c, point, phi), 0.0);

    return way_of(c) * 0.5 * c->base_mm * (on - c->unrolled_from) * (on + c->unrolled_from);
}

double takt_planar_involute_unrolled(const struct planar *c, double place_mm)
{
    return maths_sqrt(maths_max(0.0, c->unrolled_from * c->unrolled_from +
                                         2.0 * way_of(c) * place_mm / c->base_mm));
}

/*
 * The string touches the base circle and is r' from another centre, on either side: cos(t - b) = (r
 * -+ r') / D.
 */
static void add_through(struct angles *a, const struct planar *c, const double centre[2],
                        double distance_mm)
{
    const double to[2] = {centre[0] - c->centre[0], centre[1] - c->centre[1]};
    const double between = maths_sqrt(planar_dot(to, to));

    if (between < CONCENTRIC_MM || maths_abs(c->base_mm - distance_mm) > between) {
        return;
    }
    const double towards = takt_maths_atan2(to[1], to[0]);
    const double off = takt_maths_acos((c->base_mm - distance_mm) / between);

    a->angle_rad[a->count++] = towards + off;
    a->angle_rad[a->count++] = towards - off;
}

static struct angles angles_of(const struct planar *c, const struct planar *other)
{
    struct angles a = {.count = 0};

    if (other->involute) {
        add_through(&a, c, other->centre, other->base_mm);
        add_through(&a, c, other->centre, -other->base_mm);
    } else if (other->arc) {
        add_through(&a, c, other->centre, 0.0);
    } else {
        double t[2];

        takt_planar_tangent_from(other, t);
        a.angle_rad[a.count++] = takt_maths_atan2(t[1], t[0]);
        a.angle_rad[a.count++] = takt_maths_atan2(-t[1], -t[0]);
    }
    return a;
}

/* The first unrolled angle above from_rad at which the string has that angle. */
static double next_at(const struct planar *c, double angle_rad, double from_rad)
{
    const double phi = c->hand * (angle_rad - c->heading_rad);

    return phi + MATHS_TWO_PI * (takt_maths_floor((from_rad - phi) / MATHS_TWO_PI) + 1.0);
}

/* The next place after from_rad where the distance may turn, at most to_rad. */
static double next_turn(const struct planar *c, const struct angles *a, bool short_steps,
                        double from_rad, double to_rad)
{
    double next = short_steps ? maths_min(to_rad, from_rad + STEP_MAX_RAD) : to_rad;

    for (unsigned i = 0; i < a->count; i++) {
        const double phi = next_at(c, a->angle_rad[i], from_rad);

        next = phi > from_rad ? maths_min(next, phi) : next;
    }
    return next;
}

/*
 * How far a point is to one side of the other way, with a sign. False: that cannot be told there.
 */
static bool side_of(const struct search *s, double phi, double *side_mm)
{
    const struct planar *other = s->other;
    double point[2];
    double unrolled;
    double t[2];

    point_at(s->c, phi, point);
    if (other->arc) {
        *side_mm = takt_planar_between(point, other->centre) - s->radius_mm;
        return true;
    }
    if (!other->involute) {
        const double off[2] = {point[0] - other->from[0], point[1] - other->from[1]};

        takt_planar_tangent_from(other, t);
        *side_mm = planar_turn(t, off);
        return true;
    }
    const bool outside = unrolled_of(other, point, &unrolled);

    *side_mm = other->base_mm * (unrolled - foot_of(other, point, unrolled));
    return outside && maths_abs(*side_mm) < other->base_mm * MATHS_HALF_PI;
}

static double bisect(const struct search *s, double low, double high, double low_mm)
{
    TAKT_ASSERT(low <= high);
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (low + high);
        double side_mm = 0.0;

        (void)side_of(s, middle, &side_mm);
        if ((side_mm > 0.0) == (low_mm > 0.0)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

/* Keeps the two nearest to the end asked for; they are found in the order of phi. */
static void keep(struct search *s, const double point[2])
{
    const double place = takt_planar_place(s->other, point);
    const bool last_ones = s->near_end == (way_of(s->c) > 0.0);

    if (place < -BEYOND_MM || place > takt_planar_length(s->other) + BEYOND_MM ||
        (s->count == 2 && !last_ones)) {
        return;
    }
    if (s->count == 2) {
        memcpy(s->points[0], s->points[1], sizeof(s->points[0]));
        s->count = 1;
    }
    memcpy(s->points[s->count++], point, sizeof(s->points[0]));
}

unsigned takt_planar_involute_cross(const struct planar *c, const struct planar *other,
                                    double radius_mm, bool near_end, double points[2][2])
{
    struct search s = {c, other, radius_mm, near_end, 0, points};
    const struct angles angles = angles_of(c, other);
    const double end = takt_planar_involute_unrolled(c, takt_planar_involute_length(c) + BEYOND_MM);
    const double start = takt_planar_involute_unrolled(c, -BEYOND_MM);
    const double last = maths_max(start, end);
    double from = maths_min(start, end);
    double from_mm;
    bool told = side_of(&s, from, &from_mm);

    while (from < last) {
        const double to = next_turn(c, &angles, other->involute, from, last);
        double to_mm;
        const bool also = side_of(&s, to, &to_mm);

        if (told && also && (from_mm > 0.0) != (to_mm > 0.0)) {
            double point[2];

            point_at(c, bisect(&s, from, to, from_mm), point);
            keep(&s, point);
        }
        from = to;
        from_mm = to_mm;
        told = also;
    }
    return s.count;
}

/* The foot next to the point on either side of it, as far as the way goes. */
double takt_planar_involute_distance_point(const struct planar *c, const double point[2])
{
    const double low = maths_min(c->unrolled_from, c->unrolled_to);
    const double high = maths_max(c->unrolled_from, c->unrolled_to);
    double nearest =
        maths_min(takt_planar_between(point, c->from), takt_planar_between(point, c->to));
    double phi;

    if (!unrolled_of(c, point, &phi)) {
        return nearest;
    }
    double on = foot_of(c, point, phi);

    on += MATHS_TWO_PI * takt_maths_ceil(maths_max(0.0, low - on) / MATHS_TWO_PI);
    on -= MATHS_TWO_PI * takt_maths_ceil(maths_max(0.0, on - high) / MATHS_TWO_PI);
    if (on >= low && on <= high) {
        nearest = maths_min(nearest, c->base_mm * maths_abs(phi - on));
    }
    return nearest;
}

double takt_planar_involute_distance(const struct planar *c, const struct planar *other)
{
    const struct angles angles = angles_of(c, other);
    const double last = maths_max(c->unrolled_from, c->unrolled_to);
    double from = maths_min(c->unrolled_from, c->unrolled_to);
    double nearest = MATHS_INFINITY;

    while (from < last) {
        const double to = next_turn(c, &angles, false, from, last);
        double point[2];

        point_at(c, to, point);
        nearest = maths_min(nearest, takt_planar_distance_point(other, point));
        from = to;
    }
    return nearest;
}
