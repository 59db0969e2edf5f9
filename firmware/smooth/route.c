#include "smooth/route.h"

#include "base/maths.h"
#include "smooth/nominal.h"

#include <assert.h>

#define NEWTON_STEPS 3

/* Part of the tolerance by which the neighbour of an element must be nearer. */
#define NEARER 0.2

void route_init(struct route *r, const struct smooth_limits *limits, double tolerance_mm)
{
    r->limits = *limits;
    r->tolerance_mm = tolerance_mm;
    r->first = 0;
    r->count = 0;
}

bool route_has_room(const struct route *r)
{
    return r->count - r->first < SMOOTH_ELEMENTS_MAX;
}

const struct route_element *route_element(const struct route *r, uint32_t index)
{
    return &r->element[index % SMOOTH_ELEMENTS_MAX];
}

static double end_of(const struct route_element *e)
{
    return e->start_mm + e->curve.length_mm;
}

double route_end(const struct route *r)
{
    return r->count == 0 ? 0.0 : end_of(route_element(r, r->count - 1));
}

void route_push(struct route *r, const struct move *move, uint32_t number,
                const struct curve *curve)
{
    struct route_element *e = &r->element[r->count % SMOOTH_ELEMENTS_MAX];

    assert(route_has_room(r));
    e->move = *move;
    e->number = number;
    e->curve = *curve;
    e->start_mm = route_end(r);
    e->energy_cap = 0.0;
    e->energy = 0.0;
    e->turn = 0.0;
    nominal_set(e, &r->limits);
    r->count++;
    nominal_update(r);
}

void route_forget(struct route *r, double at_mm)
{
    while (r->first + 1 < r->count && end_of(route_element(r, r->first)) < at_mm) {
        r->first++;
    }
}

uint32_t route_find(const struct route *r, double at_mm, uint32_t hint)
{
    uint32_t i = hint < r->first ? r->first : hint;

    if (i >= r->count) {
        i = r->count - 1;
    }
    while (i + 1 < r->count && route_element(r, i + 1)->start_mm <= at_mm) {
        i++;
    }
    while (i > r->first && route_element(r, i)->start_mm > at_mm) {
        i--;
    }
    return i;
}

static double on_curve(const struct route_element *e, double at_mm)
{
    return maths_clamp(at_mm - e->start_mm, 0.0, e->curve.length_mm);
}

void route_point(const struct route *r, double at_mm, uint32_t *hint, struct point *p)
{
    *hint = route_find(r, at_mm, *hint);
    const struct route_element *e = route_element(r, *hint);

    curve_point(&e->curve, on_curve(e, at_mm), p);
}

/* Weighted, of unit length. */
static void direction(const struct curve *c, double s_mm, struct point *t)
{
    double square = 0.0;

    curve_tangent(c, s_mm, t);
    for (int i = 0; i < AXIS_COUNT; i++) {
        t->at[i] *= smooth_weight(i);
        square += t->at[i] * t->at[i];
    }
    for (int i = 0; i < AXIS_COUNT; i++) {
        t->at[i] /= maths_sqrt(square);
    }
}

void route_corner(const struct route *r, uint32_t index, struct point *before, struct point *after)
{
    const struct curve *last = &route_element(r, index - 1)->curve;

    direction(last, last->length_mm, before);
    direction(&route_element(r, index)->curve, 0.0, after);
}

static double distance_between(const struct point *a, const struct point *b)
{
    double square = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d = (a->at[i] - b->at[i]) * smooth_weight(i);

        square += d * d;
    }
    return maths_sqrt(square);
}

/* How far along the tangent x lies from p: (x - p) t / (t t), weighted. */
static double step_along(const struct point *x, const struct point *p, const struct point *t)
{
    double dot = 0.0;
    double square = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double w = smooth_weight(i) * t->at[i];

        dot += smooth_weight(i) * (x->at[i] - p->at[i]) * w;
        square += w * w;
    }
    return dot / square;
}

/* The nearest point of one element between two places of the route, by Newton's method from at_mm; exact on a line. */
static void foot_on(const struct route *r, uint32_t index, const struct point *x, double from_mm,
                    double to_mm, double at_mm, struct route_foot *f)
{
    const struct route_element *e = route_element(r, index);
    const double low = on_curve(e, from_mm);
    const double high = on_curve(e, to_mm);
    const unsigned steps = e->curve.kind == CURVE_LINE ? 1 : NEWTON_STEPS;
    double s = maths_clamp(at_mm - e->start_mm, low, high);
    struct point t;

    curve_point(&e->curve, s, &f->point);
    for (unsigned i = 0; i < steps; i++) {
        curve_tangent(&e->curve, s, &t);
        s = maths_clamp(s + step_along(x, &f->point, &t), low, high);
        curve_point(&e->curve, s, &f->point);
    }
    f->element = index;
    f->at_mm = e->start_mm + s;
    f->distance_mm = distance_between(x, &f->point);
}

/*
 * Goes to the neighbour while that is nearer: by more than rounding of a corner can make it, unless the foot is at the
 * joint already. Near a reversal both sides are near, and the curve is on the first until it has turned.
 */
static void walk(const struct route *r, const struct point *x, double from_mm, double to_mm,
                 bool onward, struct route_foot *f)
{
    for (;;) {
        const struct route_element *e = route_element(r, f->element);
        const uint32_t next = onward ? f->element + 1 : f->element - 1;
        const double joint = onward ? end_of(e) : e->start_mm;
        struct route_foot other;

        if (onward ? next >= r->count || joint > to_mm
                   : f->element == r->first || joint < from_mm) {
            return;
        }
        foot_on(r, next, x, from_mm, to_mm, joint, &other);
        const double more = f->at_mm == joint ? 0.0 : NEARER * r->tolerance_mm;

        if (!(other.distance_mm + more < f->distance_mm)) {
            return;
        }
        *f = other;
    }
}

void route_foot(const struct route *r, const struct point *x, double from_mm, double to_mm,
                struct route_foot *f)
{
    const double at = maths_clamp(f->at_mm, from_mm, to_mm);
    const uint32_t index = route_find(r, at, f->element);

    foot_on(r, index, x, from_mm, to_mm, at, f);
    walk(r, x, from_mm, to_mm, true, f);
    if (f->element == index) {
        walk(r, x, from_mm, to_mm, false, f);
    }
}

double route_feed(const struct route *r, double at_mm, uint32_t *hint)
{
    *hint = route_find(r, at_mm, *hint);
    const struct route_element *e = route_element(r, *hint);
    const double end_energy = *hint + 1 < r->count ? route_element(r, *hint + 1)->energy : 0.0;
    const double ahead = maths_max(0.0, end_of(e) - at_mm);

    return maths_min(e->feed_mm_s, maths_sqrt(end_energy + 2.0 * e->along_mm_s2 * ahead));
}

double route_acceleration(const struct route *r, uint32_t index)
{
    return route_element(r, index)->along_mm_s2;
}
