#include "smooth/nominal.h"

#include "base/maths.h"

/* Part of the axes' acceleration for the nominal feed along the path; smoothing needs the rest to round its ramps. */
#define ALONG 0.95

/* Part of the axes' limits for the curvature of arcs. */
#define BENT 0.9

/* A corner may use the tolerance on both sides: the curve swings out before it and cuts in at it. */
#define SIDES 2.0

/* How many elements a corner is looked at together with, and when: so many elements after it have come. */
#define NEIGHBOURS 8
#define BEHIND     4

static struct route_element *at(struct route *r, uint32_t index)
{
    return &r->element[index % SMOOTH_ELEMENTS_MAX];
}

/* v <= V/|x_s|, sqrt(A/|x_ss|), cbrt(J/|x_sss|) on every axis. */
static double feed_of(const struct curve_bounds *b, const struct smooth_limits *limits)
{
    double feed = MATHS_INFINITY;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if (b->first[i] > 0.0) {
            feed = maths_min(feed, limits->velocity_mm_s[i] / b->first[i]);
        }
        if (b->second[i] > 0.0) {
            feed = maths_min(feed, maths_sqrt(BENT * limits->acceleration_mm_s2[i] / b->second[i]));
        }
        if (b->third[i] > 0.0) {
            feed = maths_min(feed, maths_cbrt(BENT * limits->jerk_mm_s3[i] / b->third[i]));
        }
    }
    return feed;
}

/* a = sqrt(A^2 - (x_ss v^2)^2) / |x_s| */
static double along_of(const struct curve_bounds *b, const struct smooth_limits *limits,
                       double feed)
{
    double along = MATHS_INFINITY;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double a = limits->acceleration_mm_s2[i];
        const double normal = b->second[i] * feed * feed;

        if (b->first[i] > 0.0) {
            along = maths_min(along, maths_sqrt(a * a - normal * normal) / b->first[i]);
        }
    }
    return ALONG * along;
}

void nominal_set(struct route_element *e, const struct smooth_limits *limits)
{
    struct curve_bounds b;
    const double programmed = e->move.kind == MOVE_RAPID ? MATHS_INFINITY : e->move.feed_mm_s;

    curve_bound(&e->curve, &b);
    e->feed_mm_s = maths_min(programmed, feed_of(&b, limits));
    e->along_mm_s2 = along_of(&b, limits, e->feed_mm_s);
}

/*
 * A change of direction d, rounded over w mm to both sides with curvature that rises and falls evenly, bends the path by
 * d/w at most and leaves the corner by |d| w / 6: v <= sqrt(A w/|d_i|), cbrt(J w^2/|d_i|) on every axis.
 */
static double feed_over(const struct smooth_limits *limits, const struct point *d, double w_mm)
{
    double feed = MATHS_INFINITY;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double turn = maths_abs(d->at[i]) / smooth_weight(i);

        if (turn > 0.0) {
            feed = maths_min(feed, maths_sqrt(limits->acceleration_mm_s2[i] * w_mm / turn));
            feed = maths_min(feed, maths_cbrt(limits->jerk_mm_s3[i] * w_mm * w_mm / turn));
        }
    }
    return feed;
}

/* Both sides of a corner while it is looked at from farther and farther away. */
struct surroundings {
    uint32_t left, right; /* elements reached */
    double left_mm, right_mm;
    struct point before, after; /* directions there */
};

static double turn_of(const struct surroundings *s, struct point *d)
{
    double square = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        d->at[i] = s->after.at[i] - s->before.at[i];
        square += d->at[i] * d->at[i];
    }
    return maths_sqrt(square);
}

/* The shorter side grows by an element. False when there is none. */
static bool widen(const struct route *r, struct surroundings *s)
{
    struct point ignored;

    if (s->left_mm < s->right_mm) {
        if (s->left <= r->first + 1) {
            return false;
        }
        route_corner(r, s->left, &s->before, &ignored);
        s->left--;
        s->left_mm += route_element(r, s->left)->curve.length_mm;
        return true;
    }
    if (s->right + 1 >= r->count) {
        return false;
    }
    s->right++;
    route_corner(r, s->right, &ignored, &s->after);
    s->right_mm += route_element(r, s->right)->curve.length_mm;
    return true;
}

/*
 * The highest feed at the start of an element: the best of all widths over which the corner may be rounded. Many small
 * corners in a row are one bend, and some that go to and fro nearly none: so the directions are also compared farther off.
 */
static double corner_feed(struct route *r, uint32_t index)
{
    struct surroundings s = {.left = index - 1, .right = index};
    const double enough =
        maths_min(route_element(r, index - 1)->feed_mm_s, route_element(r, index)->feed_mm_s);
    double best = 0.0;
    struct point d;

    route_corner(r, index, &s.before, &s.after);
    s.left_mm = route_element(r, index - 1)->curve.length_mm;
    s.right_mm = route_element(r, index)->curve.length_mm;
    at(r, index)->turn = turn_of(&s, &d);
    for (unsigned i = 0; i < NEIGHBOURS && best < enough; i++) {
        const double turn = turn_of(&s, &d);
        const double allowed = 6.0 * SIDES * r->tolerance_mm / maths_max(turn, 1e-12);
        const double width = maths_min(s.left_mm, s.right_mm);

        best = maths_max(best, feed_over(&r->limits, &d, maths_min(allowed, width)));
        if (allowed < width || !widen(r, &s)) {
            break;
        }
    }
    return maths_min(best, enough);
}

static void set_corner(struct route *r, uint32_t index)
{
    const double feed = corner_feed(r, index);

    at(r, index)->energy_cap = feed * feed;
}

/* u = min(cap, u_next + 2 a L), backwards until nothing changes any more. */
static void pass_back(struct route *r, uint32_t changed)
{
    double next = 0.0;

    for (uint32_t i = r->count; i > r->first; i--) {
        struct route_element *e = at(r, i - 1);
        const double energy =
            maths_min(e->energy_cap, next + 2.0 * e->along_mm_s2 * e->curve.length_mm);

        if (energy == e->energy && i - 1 < changed) {
            return;
        }
        e->energy = energy;
        next = energy;
    }
}

void nominal_update(struct route *r)
{
    const uint32_t newest = r->count - 1;
    uint32_t changed = newest;

    if (newest > r->first) {
        set_corner(r, newest);
    }
    if (newest > r->first + BEHIND) {
        changed = newest - BEHIND;
        set_corner(r, changed);
    }
    pass_back(r, changed);
}
