/*
 * The closest point of the route: on a line, on a curved element, and over the junctions between
 * them.
 */
#include "smooth/route_curved.h"

#include "base/assert.h"
#include "smooth/single.h"

#define NEWTON_STEPS 3

/* Part of the tolerance by which the neighbour of an element must be nearer. */
#define NEARER 0.2f

/*
 * A turn up to which the angle can be told by it, and how much more than that times the distance is
 * looked at.
 */
#define SLIGHT       0.5f
#define SLIGHT_REACH 1.25f

/* x + (start - x) + s/length (end - start), s from the nearest place of the whole line. */
static void closest_on_line(const struct route *r, uint32_t index, const double x[], float low,
                            float high, struct route_closest *f)
{
    const double *start = route_start(r, index);
    const double *end = route_end_point(r, index);
    const float length = (float)(route_end_of(r, index) - route_element(r, index)->start_mm);
    float line[AXIS_COUNT];
    float dot = 0.0f;
    float square = 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        line[i] = r->slots.weight[i] * (float)(end[i] - start[i]);
        f->off[i] = r->slots.weight[i] * (float)(start[i] - x[i]);
        dot -= line[i] * f->off[i];
        square += line[i] * line[i];
    }
    const float s = single_clamp(dot / square * length, low, high);
    const float part = s / length;

    for (unsigned i = 0; i < r->slots.count; i++) {
        f->off[i] += part * line[i];
    }
    f->at_mm = s < length ? route_element(r, index)->start_mm + (double)s : route_end_of(r, index);
}

/* By Newton's method: s += (x - p) t / (t t), weighted. */
static void closest_on_curved(const struct route *r, uint32_t index, const double x[], double low,
                              double high, double s, struct route_closest *f)
{
    const double per_mm = (double)takt_route_per_mm(r, index);
    struct curve c;
    struct point p;

    takt_route_curve(r, index, &c);
    low /= per_mm;
    high /= per_mm;
    s = maths_clamp(s / per_mm, low, high);
    for (unsigned k = 0; k < NEWTON_STEPS; k++) {
        struct point t;
        float dot = 0.0f;
        float square = 0.0f;

        takt_curve_point_and_tangent(&c, s, &p, &t);
        for (unsigned i = 0; i < r->slots.count; i++) {
            const unsigned axis = r->slots.axis[i];
            const float w = r->slots.weight[i] * (float)t.at[axis];

            dot += r->slots.weight[i] * (float)(x[i] - p.at[axis]) * w;
            square += w * w;
        }
        s = maths_clamp(s + (double)(dot / square), low, high);
    }
    takt_curve_point(&c, s, &p);
    for (unsigned i = 0; i < r->slots.count; i++) {
        f->off[i] = r->slots.weight[i] * (float)(p.at[r->slots.axis[i]] - x[i]);
    }
    f->at_mm =
        s < c.length_mm ? route_element(r, index)->start_mm + s * per_mm : route_end_of(r, index);
}

/* The nearest point of one element between two places of the route, looked for from at_mm on. */
static void closest_on(const struct route *r, uint32_t index, const double x[], double from_mm,
                       double to_mm, double at_mm, struct route_closest *f)
{
    const struct route_element *e = route_element(r, index);
    const double length = route_end_of(r, index) - e->start_mm;
    const double low = maths_clamp(from_mm - e->start_mm, 0.0, length);
    const double high = maths_clamp(to_mm - e->start_mm, 0.0, length);

    TAKT_ASSERT(from_mm <= to_mm);
    f->element = index;
    if (e->curved) {
        closest_on_curved(r, index, x, low, high, at_mm - e->start_mm, f);
    } else {
        closest_on_line(r, index, x, (float)low, (float)high, f);
    }
    f->distance_mm = route_length(r, f->off);
}

/*
 * Can the element on the other side of a junction be nearer than the closest point? From a closest
 * point before the junction, a line that goes on at an angle t cannot, unless the junction is
 * within distance tan t; and tan t < 1.2 |turn| of slight turns.
 */
static bool is_near_junction(const struct route *r, uint32_t next, double junction, float turn,
                             const struct route_closest *f)
{
    const float away = single_abs((float)(junction - f->at_mm));

    return f->at_mm == junction || turn > SLIGHT || away < SLIGHT_REACH * turn * f->distance_mm ||
           route_element(r, next)->curved || route_element(r, f->element)->curved;
}

/*
 * Goes to the neighbour while that is nearer: by more than rounding of a corner can make it, unless
 * the closest point is at the junction already. Near a reversal both sides are near, and the curve
 * is on the first until it has turned.
 */
static void walk(const struct route *r, const double x[], double from_mm, double to_mm, bool onward,
                 struct route_closest *f)
{
    for (;;) {
        const uint32_t next = onward ? f->element + 1 : f->element - 1;
        const double junction =
            onward ? route_end_of(r, f->element) : route_element(r, f->element)->start_mm;
        struct route_closest other;

        if (onward ? next >= r->count || junction > to_mm
                   : f->element == r->first || junction < from_mm) {
            return;
        }
        if (!is_near_junction(r, next, junction, route_turn(r, onward ? next : f->element), f)) {
            return;
        }
        closest_on(r, next, x, from_mm, to_mm, junction, &other);
        const float more = f->at_mm == junction ? 0.0f : NEARER * (float)r->tolerance_mm;

        if (!(other.distance_mm + more < f->distance_mm)) {
            return;
        }
        *f = other;
    }
}

void takt_route_closest(const struct route *r, const double x[], double from_mm, double to_mm,
                        struct route_closest *f)
{
    const double at = maths_clamp(f->at_mm, from_mm, to_mm);
    const uint32_t index = takt_route_find(r, at, f->element);

    closest_on(r, index, x, from_mm, to_mm, at, f);
    walk(r, x, from_mm, to_mm, true, f);
    if (f->element == index) {
        walk(r, x, from_mm, to_mm, false, f);
    }
}
