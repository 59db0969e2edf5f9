#include "program/profile.h"

#include "base/assert.h"
#include "base/maths.h"

/* Ends of offset segments that are this far from each other in u need an arc between them; nearer ones are lengthened. */
#define GAP_MM 1e-2

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

static double radius(const struct profile_segment *s)
{
    TAKT_ASSERT(s->kind == PROFILE_ARC);
    return takt_profile_distance(&s->start, &s->centre);
}

/* -- offsets -- */

/*
 * The centre of an arc as its decimals have it, moved along the chord w until both ends are as far from it:
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
static bool offset(struct profile_segment *s, double d)
{
    if (s->kind == PROFILE_ARC) {
        centre(s);
        const double r = radius(s);
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

/* The line through s, and the circle of c: from the foot of its centre on the line, h along it, h^2 = r^2 - distance^2. */
static struct profile_point meet_circle(const struct profile_segment *s,
                                        const struct profile_segment *c, struct profile_point near)
{
    const struct profile_point way = minus(s->end, s->start);
    const double length = takt_profile_distance(&s->start, &s->end);
    const struct profile_point unit = {way.u / length, way.v / length};
    const struct profile_point to = minus(c->centre, s->start);
    const double aside = cross(unit, to);
    const double r = radius(c);
    const double h = maths_sqrt(maths_max(r * r - aside * aside, 0.0));
    const struct profile_point foot = along(s->start, dot(unit, to), unit);

    return nearer(near, along(foot, h, unit), along(foot, -h, unit));
}

/* Two circles at the distance c: x = (c^2 + a^2 - b^2) / 2 c from the first centre towards the second, h aside. */
static struct profile_point meet_circles(const struct profile_segment *first,
                                         const struct profile_segment *second,
                                         struct profile_point near)
{
    const double a = radius(first);
    const double b = radius(second);
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

/* a + f way with cross(way of b, a + f way - start of b) = 0; parallel lines meet where they are. */
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

/* Lengthens or shortens two segments so that the second begins where the first ends. */
static void join(struct profile_segment *a, struct profile_segment *b)
{
    const struct profile_point near = b->start;
    const bool arcs[2] = {a->kind == PROFILE_ARC, b->kind == PROFILE_ARC};

    if (takt_profile_distance(&a->end, &b->start) < PROFILE_SAME_MM) {
        a->end = b->start;
        return;
    }
    if (arcs[0] && arcs[1]) {
        b->start = meet_circles(a, b, near);
    } else if (arcs[0]) {
        b->start = meet_circle(b, a, near);
    } else if (arcs[1]) {
        b->start = meet_circle(a, b, near);
    } else {
        b->start = meet_lines(a, b);
    }
    a->end = b->start;
}

/* -- corners -- */

/*
 * The centre of a fillet is where the neighbours meet, each offset to its side by the radius; it touches them at their feet.
 * A chamfer has the same ends.
 */
static bool round_corner(struct profile_segment *before, struct profile_segment *s,
                         struct profile_segment *behind)
{
    double d = s->centre.u;
    struct profile_segment a = *before;
    struct profile_segment b = *behind;

    if (!offset(&a, d) || !offset(&b, d) || a.end.u - b.start.u > GAP_MM) {
        d = -d;
        a = *before;
        b = *behind;
        if (!offset(&a, d) || !offset(&b, d) || a.end.u - b.start.u > GAP_MM) {
            return false;
        }
    }
    join(&a, &b);
    s->centre = a.end;
    if (!offset(&a, -d) || !offset(&b, -d)) {
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

/* -- the whole --
 *
 * The profile falls in u alone, so what is nearer to it than d reaches up to a function of u: the highest of the offset segments
 * and of the circles of radius d round all corners. That is walked along, towards falling u:
 *
 *           ___                     a circle round each corner, an offset line or arc for each segment;
 *       ___/   \  <-- from here     walls are the jumps from one to the next
 *      |  o     o-----
 *      |
 */

/* A curve over u from low to high. */
struct over {
    struct profile_segment s;
    unsigned number;
    bool corner; /* a circle round a corner */
};

/* Segments have odd numbers, corners, beginning and end among them, even ones. Made when they are asked for. */
static unsigned overs(const struct profile *p)
{
    TAKT_ASSERT(p->count > 0 && p->count <= PROFILE_PATH_MAX);
    return 2 * p->count - 1;
}

/* False: there is none of this number, a wall or an arc that the distance swallows. */
static bool get_over(const struct profile *p, unsigned number, double d, struct over *o)
{
    const unsigned i = number / 2;

    TAKT_ASSERT(number < overs(p));
    o->number = number;
    o->corner = number % 2 == 0;
    if (o->corner) {
        const struct profile_point c = p->segment[i].end;

        o->s = (struct profile_segment){{c.u + d, c.v}, {c.u - d, c.v}, c, PROFILE_ARC, true};
        return true;
    }
    o->s = p->segment[i + 1];
    return o->s.start.u - o->s.end.u > PROFILE_SAME_MM && offset(&o->s, d);
}

static double height(const struct profile_segment *s, double u)
{
    if (s->kind == PROFILE_ARC) {
        const double r = radius(s);
        const double aside = u - s->centre.u;
        const double h = maths_sqrt(maths_max(r * r - aside * aside, 0.0));

        return s->centre.v + (s->left ? h : -h);
    }
    return s->start.v + (u - s->start.u) / (s->end.u - s->start.u) * (s->end.v - s->start.v);
}

static bool reaches(const struct profile_segment *s, double u)
{
    return u <= s->start.u && u >= s->end.u;
}

/* The highest over a place just behind u; false: there is none. */
static bool find_highest(const struct profile *p, double d, double u, struct over *highest)
{
    const double behind = u - PROFILE_SAME_MM;
    double best = 0.0;
    bool found = false;

    for (unsigned i = 0; i < overs(p); i++) {
        struct over o;

        if (get_over(p, i, d, &o) && reaches(&o.s, behind) &&
            (!found || height(&o.s, behind) > best)) {
            best = height(&o.s, behind);
            *highest = o;
            found = true;
        }
    }
    return found;
}

/* Where two curves may meet: one or two points of their lines and circles. */
static void meet(const struct profile_segment *a, const struct profile_segment *b,
                 struct profile_point at[2])
{
    const struct profile_point far[2] = {{1e9, 0.0}, {-1e9, 0.0}};
    const bool arcs[2] = {a->kind == PROFILE_ARC, b->kind == PROFILE_ARC};

    for (unsigned i = 0; i < 2; i++) {
        if (arcs[0] && arcs[1]) {
            at[i] = meet_circles(a, b, far[i]);
        } else if (arcs[0]) {
            at[i] = meet_circle(b, a, far[i]);
        } else if (arcs[1]) {
            at[i] = meet_circle(a, b, far[i]);
        } else {
            at[i] = meet_lines(a, b);
        }
    }
}

/* The first place behind u where o may come out above s; low: there is none before. */
static double rises_at(const struct profile_segment *s, const struct profile_segment *o, double u,
                       double low)
{
    struct profile_point at[2];
    const double begin = o->start.u;

    if (begin < u && begin > low && height(o, begin) > height(s, begin) - PROFILE_SAME_MM) {
        return begin;
    }
    meet(s, o, at);
    for (unsigned i = 0; i < 2; i++) {
        const double w = at[i].u;

        if (w < u - 2.0 * PROFILE_SAME_MM && w > low && reaches(o, w) &&
            maths_abs(height(s, w) - at[i].v) < PROFILE_SAME_MM &&
            maths_abs(height(o, w) - at[i].v) < PROFILE_SAME_MM) {
            low = w;
        }
    }
    return low;
}

static double find_end(const struct profile *p, double d, double u, const struct profile_segment *s)
{
    double end = s->end.u;

    for (unsigned i = 0; i < overs(p); i++) {
        struct over o;

        if (get_over(p, i, d, &o)) {
            end = rises_at(s, &o.s, u, end);
        }
    }
    return end;
}

static void add(struct profile_path *path, const struct profile_segment *s)
{
    TAKT_ASSERT(path->count <= PROFILE_PATH_MAX);
    if (takt_profile_distance(&s->start, &s->end) > PROFILE_SAME_MM &&
        path->count < PROFILE_PATH_MAX) {
        path->segment[path->count++] = *s;
    }
}

/* Straight up or down, from one curve to the next. */
static void add_wall(struct profile_path *path, const struct profile_point *from, double to_v)
{
    const struct profile_segment wall = {.start = *from, .end = {from->u, to_v}};

    add(path, &wall);
}

/*
 * Arcs round corners that hardly open are left out, their neighbours lengthened. That leads outside where they touch both
 * neighbours, and would cut where another curve ends them.
 */
static bool is_gap(const struct profile *p, double d, const struct over *o)
{
    const unsigned i = o->number / 2;

    if (!o->corner || i == 0 || i + 1 == p->count || o->s.start.u - o->s.end.u >= GAP_MM) {
        return false;
    }
    struct profile_segment before = p->segment[i];
    struct profile_segment behind = p->segment[i + 1];

    return offset(&before, d) && offset(&behind, d) &&
           takt_profile_distance(&before.end, &o->s.start) < PROFILE_SHORT_MM &&
           takt_profile_distance(&behind.start, &o->s.end) < PROFILE_SHORT_MM;
}

/* The last piece has been added: it begins where the one before it ends. */
static void close_gap(struct profile_path *path, bool gap)
{
    if (gap && path->count > 2) {
        join(&path->segment[path->count - 2], &path->segment[path->count - 1]);
    }
}

/* From a to b, as the whole goes between. */
static void walk(const struct profile *p, double d, struct profile_point a,
                 const struct profile_point *b, struct profile_path *path)
{
    bool gap = false;
    unsigned last = overs(p);
    struct over o;

    while (a.u > b->u + PROFILE_SAME_MM && find_highest(p, d, a.u, &o)) {
        const double v = height(&o.s, a.u);
        const double end = maths_max(find_end(p, d, a.u, &o.s), b->u);

        if (maths_abs(v - a.v) > PROFILE_SHORT_MM) {
            add_wall(path, &a, v);
            close_gap(path, gap);
            gap = false;
        } else {
            gap = gap || maths_abs(v - a.v) > PROFILE_SAME_MM;
        }
        o.s.start = (struct profile_point){a.u, v};
        o.s.end = (struct profile_point){end, height(&o.s, end)};
        a = o.s.end;
        if (takt_profile_distance(&o.s.start, &o.s.end) <= PROFILE_SAME_MM) {
            continue;
        }
        if (o.number == last && !gap && path->count > 1) {
            path->segment[path->count - 1].end = a;
            continue;
        }
        last = o.number;
        if (is_gap(p, d, &o)) {
            gap = true;
            continue;
        }
        add(path, &o.s);
        close_gap(path, gap);
        gap = false;
    }
    add_wall(path, &a, b->v);
    close_gap(path, gap);
}

/* An end that is below the whole on both sides is lifted onto it. */
static void lift(const struct profile *p, double d, struct profile_point *end)
{
    struct over before;
    struct over behind;

    if (find_highest(p, d, end->u + 2.0 * PROFILE_SAME_MM, &before) &&
        find_highest(p, d, end->u, &behind)) {
        end->v = maths_max(end->v, maths_min(height(&before.s, end->u), height(&behind.s, end->u)));
    }
}

/* The stock is to the right of the profile where it goes on from the way to it, seen from there, to its end. */
static double signed_distance(const struct profile *p, double distance_mm)
{
    const struct profile_segment *way = &p->segment[0];
    const struct profile_point to_end = minus(p->segment[p->count - 1].end, way->start);

    return cross(to_end, minus(way->end, way->start)) < 0.0 ? -distance_mm : distance_mm;
}

static bool offset_up(const struct profile *p, double d, struct profile_path *path)
{
    struct profile_segment first = p->segment[1];
    struct profile_segment last = p->segment[p->count - 1];

    TAKT_ASSERT(p->count >= 2);
    path->count = 1;
    if (!offset(&first, d) || !offset(&last, d) || last.end.u > first.start.u) {
        return false;
    }
    lift(p, d, &first.start);
    lift(p, d, &last.end);
    walk(p, d, first.start, &last.end, path);
    return path->count > 1 && path->count < PROFILE_PATH_MAX - 1;
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
    const bool good = offset_up(&image, d, path);

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
        good = offset_up(p, d, path);
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
        const double r = radius(s);
        const double up = v - s->centre.v;
        const double h = maths_sqrt(maths_max(r * r - up * up, 0.0));

        *u = s->centre.u + (s->start.u + s->end.u > 2.0 * s->centre.u ? h : -h);
    } else {
        *u = s->start.u + (v - s->start.v) / (s->end.v - s->start.v) * (s->end.u - s->start.u);
    }
    return true;
}
