/*
 * The profile of a turning cycle: its segments, their offsets and corners, and what is asked of it.
 */
#include "program/profile.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/profile_parts.h"

static struct profile_point minus(struct profile_point a, struct profile_point b)
{
    return (struct profile_point){a.u - b.u, a.v - b.v};
}

/* a + f b */
static struct profile_point along(struct profile_point a, double f, struct profile_point b)
{
    return (struct profile_point){a.u + f * b.u, a.v + f * b.v};
}

static double dot(struct profile_point a, struct profile_point b)
{
    return a.u * b.u + a.v * b.v;
}

/* The area of a and b: above 0 when b points to the left of a. */
static double cross(struct profile_point a, struct profile_point b)
{
    return a.u * b.v - a.v * b.u;
}

double takt_profile_distance(const struct profile_point *a, const struct profile_point *b)
{
    const struct profile_point d = minus(*a, *b);

    return maths_sqrt(dot(d, d));
}

double takt_profile_radius(const struct profile_segment *s)
{
    TAKT_ASSERT(s->kind == PROFILE_ARC);
    return takt_profile_distance(&s->start, &s->centre);
}

/* -- offsets -- */

/*
 * The centre of an arc as its decimals have it, moved along the chord w until both ends are as far
 * from it:
 *
 *     c + w (|e - c|^2 - |s - c|^2) / 2 |w|^2
 *
 * Else a gap would open at the end of its offset.
 */
static void centre(struct profile_segment *s)
{
    const struct profile_point way = minus(s->end, s->start);
    const struct profile_point from = minus(s->start, s->centre);
    const struct profile_point to = minus(s->end, s->centre);

    s->centre = along(s->centre, (dot(to, to) - dot(from, from)) / (2.0 * dot(way, way)), way);
}

/*
 * To the right by d: a line by d times its normal, an arc of radius r to
 *
 *     (r + d) / r  if it turns left, so that its centre is to the left,  (r - d) / r  if right
 *
 * of its distance from the centre. False: nothing of the arc remains.
 */
bool takt_profile_offset_segment(struct profile_segment *s, double d)
{
    if (s->kind == PROFILE_ARC) {
        centre(s);
        const double r = takt_profile_radius(s);
        const double f = 1.0 + (s->left ? d : -d) / r;

        s->start = along(s->centre, f, minus(s->start, s->centre));
        s->end = along(s->centre, f, minus(s->end, s->centre));
        return f * r > PROFILE_SAME_MM;
    }
    const struct profile_point way = minus(s->end, s->start);
    const struct profile_point right = {way.v, -way.u};
    const double length = takt_profile_distance(&s->start, &s->end);

    s->start = along(s->start, d / length, right);
    s->end = along(s->end, d / length, right);
    return true;
}

/* Of two points the one nearer to near. */
static struct profile_point nearer(struct profile_point near, struct profile_point a,
                                   struct profile_point b)
{
    return takt_profile_distance(&near, &a) <= takt_profile_distance(&near, &b) ? a : b;
}

/*
 * The line through s, and the circle of c: from the foot of its centre on the line, h along it,
 * h^2 = r^2 - distance^2.
 */
static struct profile_point meet_circle(const struct profile_segment *s,
                                        const struct profile_segment *c, struct profile_point near)
{
    const struct profile_point way = minus(s->end, s->start);
    const double length = takt_profile_distance(&s->start, &s->end);
    const struct profile_point unit = {way.u / length, way.v / length};
    const struct profile_point to = minus(c->centre, s->start);
    const double aside = cross(unit, to);
    const double r = takt_profile_radius(c);
    const double h = maths_sqrt(maths_max(r * r - aside * aside, 0.0));
    const struct profile_point foot = along(s->start, dot(unit, to), unit);

    return nearer(near, along(foot, h, unit), along(foot, -h, unit));
}

/*
 * Two circles at the distance c: x = (c^2 + a^2 - b^2) / 2 c from the first centre towards the
 * second, h aside.
 */
static struct profile_point meet_circles(const struct profile_segment *first,
                                         const struct profile_segment *second,
                                         struct profile_point near)
{
    const double a = takt_profile_radius(first);
    const double b = takt_profile_radius(second);
    const double c = takt_profile_distance(&first->centre, &second->centre);

    if (c < PROFILE_SAME_MM) {
        return near;
    }
    const double x = (c * c + a * a - b * b) / (2.0 * c);
    const double h = maths_sqrt(maths_max(a * a - x * x, 0.0));
    const struct profile_point way = minus(second->centre, first->centre);
    const struct profile_point unit = {way.u / c, way.v / c};
    const struct profile_point left = {-unit.v, unit.u};
    const struct profile_point foot = along(first->centre, x, unit);

    return nearer(near, along(foot, h, left), along(foot, -h, left));
}

/*
 * a + f way with cross(way of b, a + f way - start of b) = 0; parallel lines meet where they are.
 */
static struct profile_point meet_lines(const struct profile_segment *a,
                                       const struct profile_segment *b)
{
    const struct profile_point way = minus(a->end, a->start);
    const struct profile_point other = minus(b->end, b->start);
    const double area = cross(other, way);

    if (area == 0.0) {
        return b->start;
    }
    return along(a->start, cross(other, minus(b->start, a->start)) / area, way);
}

struct profile_point takt_profile_meet(const struct profile_segment *a,
                                       const struct profile_segment *b, struct profile_point near)
{
    const bool arcs[2] = {a->kind == PROFILE_ARC, b->kind == PROFILE_ARC};

    if (arcs[0] && arcs[1]) {
        return meet_circles(a, b, near);
    }
    if (arcs[0]) {
        return meet_circle(b, a, near);
    }
    return arcs[1] ? meet_circle(a, b, near) : meet_lines(a, b);
}

void takt_profile_join(struct profile_segment *a, struct profile_segment *b)
{
    if (takt_profile_distance(&a->end, &b->start) < PROFILE_SAME_MM) {
        a->end = b->start;
        return;
    }
    b->start = takt_profile_meet(a, b, b->start);
    a->end = b->start;
}

/* -- corners -- */

/*
 * The centre of a fillet is where the neighbours meet, each offset to its side by the radius; it
 * touches them at their feet. A chamfer has the same ends.
 */
static bool round_corner(struct profile_segment *before, struct profile_segment *s,
                         struct profile_segment *behind)
{
    double d = s->centre.u;
    struct profile_segment a = *before;
    struct profile_segment b = *behind;

    if (!takt_profile_offset_segment(&a, d) || !takt_profile_offset_segment(&b, d) ||
        a.end.u - b.start.u > GAP_MM) {
        d = -d;
        a = *before;
        b = *behind;
        if (!takt_profile_offset_segment(&a, d) || !takt_profile_offset_segment(&b, d) ||
            a.end.u - b.start.u > GAP_MM) {
            return false;
        }
    }
    takt_profile_join(&a, &b);
    s->centre = a.end;
    if (!takt_profile_offset_segment(&a, -d) || !takt_profile_offset_segment(&b, -d)) {
        return false;
    }
    before->end = s->start = a.end;
    behind->start = s->end = b.start;
    s->left = s->start.v > s->centre.v || s->end.v > s->centre.v;
    s->kind = s->kind == PROFILE_FILLET ? PROFILE_ARC : PROFILE_LINE;
    return true;
}

static bool is_corner(const struct profile_segment *s)
{
    return s->kind == PROFILE_FILLET || s->kind == PROFILE_CHAMFER;
}

bool takt_profile_round(struct profile *p)
{
    unsigned kept = 0;

    for (unsigned i = 1; i + 1 < p->count; i++) {
        if (is_corner(&p->segment[i]) &&
            !round_corner(&p->segment[i - 1], &p->segment[i], &p->segment[i + 1])) {
            return false;
        }
    }
    for (unsigned i = 0; i < p->count; i++) {
        const struct profile_segment *s = &p->segment[i];

        if (!is_corner(s) &&
            (i == 0 || takt_profile_distance(&s->start, &s->end) > PROFILE_SAME_MM)) {
            p->segment[kept++] = *s;
        }
    }
    p->count = kept;
    return kept > 1;
}

/*
 * The stock is to the right of the profile where it goes on from the way to it, seen from there, to
 * its end.
 */
static double signed_distance(const struct profile *p, double distance_mm)
{
    const struct profile_segment *way = &p->segment[0];
    const struct profile_point to_end = minus(p->segment[p->count - 1].end, way->start);

    return cross(to_end, minus(way->end, way->start)) < 0.0 ? -distance_mm : distance_mm;
}

static void copy(const struct profile *p, struct profile_path *path)
{
    TAKT_ASSERT(p->count <= PROFILE_PATH_MAX);
    path->count = p->count;
    for (unsigned i = 0; i < p->count; i++) {
        path->segment[i] = p->segment[i];
    }
}

/* Upwards, of the mirror image. */
static bool offset_down(const struct profile *p, double d, struct profile_path *path)
{
    struct profile image = *p;

    takt_profile_mirror(&image, false, true);
    const bool good = takt_profile_offset_up(&image, d, path);

    for (unsigned i = 1; i < path->count; i++) {
        takt_profile_mirror_segment(&path->segment[i], false, true);
    }
    return good;
}

bool takt_profile_offset(const struct profile *p, double distance_mm, struct profile_path *path)
{
    const double d = signed_distance(p, distance_mm);
    bool good = true;

    TAKT_ASSERT(p->count >= 2);
    if (maths_abs(d) < PROFILE_SAME_MM) {
        copy(p, path);
    } else if (d > 0.0) {
        good = takt_profile_offset_up(p, d, path);
    } else {
        good = offset_down(p, -d, path);
    }
    path->segment[0] = p->segment[0];
    path->segment[0].end = path->segment[1].start;
    return good;
}

bool takt_profile_cross(const struct profile_segment *s, double v, double *u)
{
    const double low = maths_min(s->start.v, s->end.v);
    const double high = maths_max(s->start.v, s->end.v);

    if (v < low - PROFILE_SAME_MM || v > high + PROFILE_SAME_MM) {
        return false;
    }
    if (high - low < PROFILE_SAME_MM) {
        *u = s->start.u;
    } else if (s->kind == PROFILE_ARC) {
        const double r = takt_profile_radius(s);
        const double up = v - s->centre.v;
        const double h = maths_sqrt(maths_max(r * r - up * up, 0.0));

        *u = s->centre.u + (s->start.u + s->end.u > 2.0 * s->centre.u ? h : -h);
    } else {
        *u = s->start.u + (v - s->start.v) / (s->end.v - s->start.v) * (s->end.u - s->start.u);
    }
    return true;
}
