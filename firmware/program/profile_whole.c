/*
 * The offset of a profile as a whole.
 *
 * The profile falls in u alone, so what is nearer to it than d reaches up to a function of u: the
 * highest of the offset segments and of the circles of radius d round all corners. That is walked
 * along, towards falling u:
 *
 *           ___                     a circle round each corner, an offset line or arc for each segment;
 *       ___/   \  <-- from here     walls are the jumps from one to the next
 *      |  o     o-----
 *      |
 */
#include "base/assert.h"
#include "base/maths.h"
#include "program/profile_parts.h"

/* A curve over u from low to high. */
struct over {
    struct profile_segment s;
    unsigned number;
    bool corner; /* a circle round a corner */
};

/*
 * Segments have odd numbers, corners, beginning and end among them, even ones. Made when they are
 * asked for.
 */
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
    return o->s.start.u - o->s.end.u > PROFILE_SAME_MM && takt_profile_offset_segment(&o->s, d);
}

static double height(const struct profile_segment *s, double u)
{
    if (s->kind == PROFILE_ARC) {
        const double r = takt_profile_radius(s);
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

    for (unsigned i = 0; i < 2; i++) {
        at[i] = takt_profile_meet(a, b, far[i]);
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
 * Arcs round corners that hardly open are left out, their neighbours lengthened. That leads outside
 * where they touch both neighbours, and would cut where another curve ends them.
 */
static bool is_gap(const struct profile *p, double d, const struct over *o)
{
    const unsigned i = o->number / 2;

    if (!o->corner || i == 0 || i + 1 == p->count || o->s.start.u - o->s.end.u >= GAP_MM) {
        return false;
    }
    struct profile_segment before = p->segment[i];
    struct profile_segment behind = p->segment[i + 1];

    return takt_profile_offset_segment(&before, d) && takt_profile_offset_segment(&behind, d) &&
           takt_profile_distance(&before.end, &o->s.start) < PROFILE_SHORT_MM &&
           takt_profile_distance(&behind.start, &o->s.end) < PROFILE_SHORT_MM;
}

/* The last piece has been added: it begins where the one before it ends. */
static void close_gap(struct profile_path *path, bool gap)
{
    if (gap && path->count > 2) {
        takt_profile_join(&path->segment[path->count - 2], &path->segment[path->count - 1]);
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

bool takt_profile_offset_up(const struct profile *p, double d, struct profile_path *path)
{
    struct profile_segment first = p->segment[1];
    struct profile_segment last = p->segment[p->count - 1];

    TAKT_ASSERT(p->count >= 2);
    path->count = 1;
    if (!takt_profile_offset_segment(&first, d) || !takt_profile_offset_segment(&last, d) ||
        last.end.u > first.start.u) {
        return false;
    }
    lift(p, d, &first.start);
    lift(p, d, &last.end);
    walk(p, d, first.start, &last.end, path);
    return path->count > 1 && path->count < PROFILE_PATH_MAX - 1;
}
