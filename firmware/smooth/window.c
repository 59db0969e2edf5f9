#include "smooth/window.h"

#include "base/assert.h"
#include "smooth/nominal.h"
#include "smooth/single.h"

#include <string.h>

/*
 * Part of the distance between the neighbours of a sample within which it may move along the route;
 * and at least this length, but not many tolerances, lest the curve go back so far along the route.
 */
#define REACH            0.8
#define REACH_MIN_MM     0.01
#define REACH_TOLERANCES 1.5

/*
 * A corner that turns by more than this must be passed by the curve before its samples are beyond
 * it.
 */
#define SHARP 0.2f

/*
 * Up to this many tolerances from a corner is near it: the chord of two samples cannot tell more.
 */
#define NEAR_CORNER 3.0f

/*
 * A window as long as it can be, and the tolerance that it may begin off the route, take this many
 * units; coordinates may be a few times that.
 */
#define UNITS 268435456.0

/* Coordinates are never farther from the origin. */
#define UNITS_MAX 1073741824.0

/*
 * b0 = (1-f)^3/6, b1 = (4 - 6f^2 + 3f^3)/6, b2 = (1 + 3f + 3f^2 - 3f^3)/6, b3 = f^3/6 (uniform
 * cubic B-spline).
 */
void takt_window_weights(float f, float weight[4])
{
    const float g = 1.0f - f;

    TAKT_ASSERT(f >= 0.0f && f <= 1.0f);
    weight[0] = g * g * g * (1.0f / 6.0f);
    weight[1] = 2.0f / 3.0f - f * f * (1.0f - 0.5f * f);
    weight[2] = 2.0f / 3.0f - g * g * (1.0f - 0.5f * g);
    weight[3] = f * f * f * (1.0f / 6.0f);
}

/* From one sample to the next one the feed is at least this part of A d, or of J d^2. */
#define LEAST_PART 0.25f

/* The largest power of two of which UNITS are at least this long. */
static double unit_for(double length_mm)
{
    double unit = 1.0;

    TAKT_ASSERT(length_mm > 0.0);
    while (unit * UNITS > length_mm) {
        unit *= 0.5;
    }
    while (unit * UNITS < length_mm) {
        unit *= 2.0;
    }
    return unit;
}

/*
 * From one sample to the next one, at the highest feed or at the least one: V d, or a part of A d^2
 * or J d^3.
 */
static float step_most(const struct route_slots *slots, unsigned slot, float d)
{
    const float least = single_min(slots->acceleration_mm_s2[slot], slots->jerk_mm_s3[slot] * d);

    return single_max(slots->velocity_mm_s[slot], LEAST_PART * least * d) * d;
}

void takt_window_init(struct window *w, const struct route *r, double interval_s)
{
    TAKT_ASSERT(interval_s > 0.0 && r->slots.groups >= 1 && r->slots.groups <= SMOOTH_GROUPS_MAX);
    w->count = 0;
    w->at_end = false;
    w->capacity = window_capacity(r);
    w->interval_s = interval_s;
    w->reach_min_mm = maths_min(REACH_MIN_MM, REACH_TOLERANCES * r->tolerance_mm);
    memset(w->x, 0, sizeof w->x);
    memset(w->weighted_unit_mm, 0, sizeof w->weighted_unit_mm);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const double step = (double)step_most(&r->slots, i, (float)interval_s);

        w->unit_mm[i] = unit_for(step * w->capacity + r->tolerance_mm / (double)r->slots.weight[i]);
        w->weighted_unit_mm[i] = r->slots.weight[i] * (float)w->unit_mm[i];
    }
}

void takt_window_nearest(const struct window *w, const struct route *r, const double p[],
                         struct window_spot *s)
{
    memset(s, 0, sizeof(*s));
    for (unsigned i = 0; i < r->slots.count; i++) {
        const double u = maths_clamp((p[i] - w->origin[i]) / w->unit_mm[i], -UNITS_MAX, UNITS_MAX);

        s->at[i] = (int32_t)(u < 0.0 ? u - 0.5 : u + 0.5);
    }
}

void takt_window_place(const struct window *w, const struct route *r, const struct window_spot *s,
                       double p[])
{
    for (unsigned i = 0; i < r->slots.count; i++) {
        p[i] = w->origin[i] + w->unit_mm[i] * (double)s->at[i];
    }
}

void takt_window_set(struct window *w, const struct route *r, unsigned i,
                     const struct window_spot *s)
{
    TAKT_ASSERT(i < w->capacity);
    for (unsigned g = 0; g < r->slots.groups; g++) {
        w->x[g * w->capacity + i] = s->group[g];
    }
}

void takt_window_sample(const struct window *w, const struct route *r, unsigned i, double p[])
{
    for (unsigned k = 0; k < r->slots.count; k++) {
        p[k] = w->origin[k] + w->unit_mm[k] * (double)window_x(w, k, i);
    }
}

static void append(struct window *w, const struct route *r, double at_mm)
{
    const unsigned i = w->count;
    struct window_spot spot;
    double p[AXIS_COUNT];

    TAKT_ASSERT(w->count < w->capacity && (i == 0 || at_mm >= w->at_mm[i - 1]));
    w->at_mm[i] = at_mm;
    w->element[i] = i == 0 ? r->first : w->element[i - 1];
    takt_route_point(r, at_mm, &w->element[i], p);
    takt_window_nearest(w, r, p, &spot);
    takt_window_set(w, r, i, &spot);
    w->count++;
}

void takt_window_stand(struct window *w, const struct route *r, const double p[], double at_mm,
                       uint32_t element)
{
    static const struct window_spot nowhere;

    w->at_end = false;
    w->count = SMOOTH_FIXED;
    memcpy(w->origin, p, r->slots.count * sizeof w->origin[0]);
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        w->at_mm[i] = at_mm;
        w->element[i] = element;
        takt_window_set(w, r, i, &nowhere);
    }
}

void takt_window_start(struct window *w, const struct route *r)
{
    takt_window_stand(w, r, route_start(r, r->first), 0.0, r->first);
}

/*
 * The spline at sample 1 is x[1] + (x[0] - 2 x[1] + x[2])/6, exactly x[1] where it rests already:
 * the new origin. Its place is one that it can have come to in order, so that it can go to the
 * route there and on along it; at a corner on the element before.
 */
void takt_window_rest(struct window *w, const struct route *r, const struct order *order)
{
    const double on = w->at_mm[1] + (w->at_mm[0] - 2.0 * w->at_mm[1] + w->at_mm[2]) / 6.0;
    const double at = takt_order_place(order, maths_min(on, route_end_of(r, w->element[1])));
    const uint32_t found = takt_route_find(r, at, w->element[1]);
    const bool elsewhere = found < w->element[1] || at > route_end_of(r, w->element[1]);
    const uint32_t element = elsewhere ? found : w->element[1];
    double p[3][AXIS_COUNT];

    TAKT_ASSERT(w->count >= SMOOTH_FIXED && order->count > 0);
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        takt_window_sample(w, r, i, p[i]);
    }
    for (unsigned k = 0; k < r->slots.count; k++) {
        p[1][k] += (p[0][k] - 2.0 * p[1][k] + p[2][k]) / 6.0;
    }
    takt_window_stand(w, r, p[1], at, element);
}

/* Halvings in search of the next acceleration. */
#define HALVINGS 5

/* Where the route is gone along. */
struct going {
    uint32_t element;
    float feed;
    float acceleration;
};

static float changed(const struct going *g, const struct braking_limits *along, float interval,
                     float part)
{
    return single_clamp(g->acceleration + part * along->jerk * interval, -along->acceleration,
                        along->acceleration);
}

/* With this acceleration for an interval, can all be met that follows? */
static bool can_go(const struct route *r, double here, const struct going *g, float a,
                   float interval)
{
    const float feed = g->feed + a * interval;
    const double there = here + (double)(feed * interval);

    return there < takt_route_end(r) &&
           takt_nominal_allows(r, takt_route_find(r, there, g->element), there,
                               feed + 0.5f * a * interval, a);
}

/* The next place at the nominal feed: no faster than acceleration, jerk and what follows allow. */
static double next_place(const struct window *w, const struct route *r)
{
    const double *at = &w->at_mm[w->count - 1];
    const float d = (float)w->interval_s;
    const float step = (float)(at[0] - at[-1]);
    struct going g = {w->element[w->count - 1], step / d,
                      (step - (float)(at[-1] - at[-2])) / (d * d)};
    const struct braking_limits *along = &route_element(r, g.element)->along;
    const float least = LEAST_PART * single_min(along->acceleration, along->jerk * d) * d;
    float low = -1.0f;
    float high = 1.0f;

    TAKT_ASSERT(w->count >= SMOOTH_FIXED);
    g.acceleration = changed(&g, along, d, 0.0f);
    if (can_go(r, at[0], &g, changed(&g, along, d, high), d)) {
        low = high;
    }
    for (unsigned i = 0; i < HALVINGS && low < high; i++) {
        const float middle = 0.5f * (low + high);

        if (can_go(r, at[0], &g, changed(&g, along, d, middle), d)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return at[0] + (double)(single_max(g.feed + changed(&g, along, d, low) * d, least) * d);
}

void takt_window_extend(struct window *w, const struct route *r)
{
    const double end = takt_route_end(r);

    while (!w->at_end && w->count + SMOOTH_FIXED <= w->capacity) {
        const double at = next_place(w, r);

        if (at < end) {
            append(w, r, at);
            continue;
        }
        for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
            append(w, r, end);
        }
        w->at_end = true;
    }
}

/* The origin goes along, so that coordinates stay small. */
static void move_origin(struct window *w, const struct route *r)
{
    for (unsigned k = 0; k < r->slots.count; k++) {
        const int32_t by = window_x(w, k, 0);
        lanes_int *x = &w->x[(size_t)(k / SMOOTH_LANES) * w->capacity];

        w->origin[k] += w->unit_mm[k] * (double)by;
        for (unsigned i = 0; i < w->count; i++) {
            x[i][k % SMOOTH_LANES] -= by;
        }
    }
}

void takt_window_drop(struct window *w, const struct route *r, unsigned count)
{
    TAKT_ASSERT(count <= w->count);
    if (count == 0) {
        return;
    }
    w->count -= count;
    memmove(w->at_mm, w->at_mm + count, w->count * sizeof w->at_mm[0]);
    memmove(w->element, w->element + count, w->count * sizeof w->element[0]);
    for (unsigned g = 0; g < r->slots.groups; g++) {
        memmove(&w->x[(size_t)g * w->capacity], &w->x[g * w->capacity + count],
                w->count * sizeof w->x[0]);
    }
    if (w->count > 0) {
        move_origin(w, r);
    }
}

/* The nearest integers, halves away from zero; |x| < 2^31. */
static lanes_int nearest(lanes x)
{
    static const lanes half = {0.5f, 0.5f, 0.5f, 0.5f};
    static const lanes_int sign = {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN};

    return lanes_int_of(x + (lanes)(((lanes_int)x & sign) | (lanes_int)half));
}

void takt_window_spot(const struct window *w, const struct route *r, unsigned i,
                      const float weight[4], struct window_spot *s)
{
    memset(s, 0, sizeof(*s));
    for (unsigned g = 0; g < r->slots.groups; g++) {
        const lanes_int *x = &w->x[g * w->capacity + i];
        const lanes off = weight[0] * lanes_of(x[0] - x[1]) + weight[2] * lanes_of(x[2] - x[1]) +
                          weight[3] * lanes_of(x[3] - x[1]);

        s->group[g] = x[1] + nearest(off);
    }
}

void takt_window_beside(const struct window *w, const struct route *r, unsigned i,
                        struct window_spot *s)
{
    static const float weight[4] = {1.0f / 6.0f, 4.0f / 6.0f, 1.0f / 6.0f, 0.0f};

    takt_window_spot(w, r, i - 1, weight, s);
}

double takt_window_at(const struct window *w, unsigned i, const float weight[4])
{
    const double *at = w->at_mm + i;

    return at[1] +
           (double)(weight[0] * (float)(at[0] - at[1]) + weight[2] * (float)(at[2] - at[1]) +
                    weight[3] * (float)(at[3] - at[1]));
}

void takt_window_reach(const struct window *w, unsigned i, double *from_mm, double *to_mm)
{
    const double reach = maths_max(w->reach_min_mm, REACH * (w->at_mm[i + 1] - w->at_mm[i - 1]));

    TAKT_ASSERT(i >= 1 && i + 1 < w->count);
    *from_mm = w->at_mm[i] - reach;
    *to_mm = w->at_mm[i] + reach;
}

/* Square of the distance of the start of an element from the chord between two spots, weighted. */
static float chord_square(const struct window *w, const struct route *r, uint32_t element,
                          const struct window_spot *from, const struct window_spot *to)
{
    const double *corner = route_start(r, element);
    float chord[AXIS_COUNT];
    float off[AXIS_COUNT];
    float dot = 0.0f;
    float square = 0.0f;
    float rest = 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        const double here = w->origin[i] + w->unit_mm[i] * (double)from->at[i];

        chord[i] = w->weighted_unit_mm[i] * (float)(to->at[i] - from->at[i]);
        off[i] = r->slots.weight[i] * (float)(corner[i] - here);
        dot += off[i] * chord[i];
        square += chord[i] * chord[i];
    }
    const float part = square > 0.0f ? single_clamp(dot / square, 0.0f, 1.0f) : 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        const float d = off[i] - part * chord[i];

        rest += d * d;
    }
    return rest;
}

/* Does the curve pass a corner between two samples, as far as their chord can tell? */
static bool passes_near(const struct window *w, const struct route *r, uint32_t element,
                        const struct window_spot *from, const struct window_spot *to)
{
    const float near_mm = NEAR_CORNER * (float)r->tolerance_mm;

    return chord_square(w, r, element, from, to) <= near_mm * near_mm;
}

/*
 * A sharp corner is not left behind before the curve has been near it: where both sides lie close
 * together, a sample may be nearer to the far side while it is still on its way to the corner.
 */
static void stop_at_corner(const struct window *w, const struct route *r, unsigned i,
                           const struct window_spot *before, const struct window_spot *here,
                           struct route_closest *closest)
{
    for (uint32_t e = w->element[i - 1] + 1; e <= closest->element; e++) {
        if (route_turn(r, e) > SHARP && !passes_near(w, r, e, before, here)) {
            closest->element = e - 1;
            closest->at_mm = route_element(r, e)->start_mm;
            return;
        }
    }
}

/*
 * Fixed samples have their place already; places never go back, nor do elements at the junction of
 * two.
 */
void takt_window_locate(struct window *w, const struct route *r)
{
    struct window_spot before;

    takt_window_beside(w, r, SMOOTH_FIXED - 1, &before);
    for (unsigned i = SMOOTH_FIXED; i + SMOOTH_FIXED < w->count; i++) {
        struct route_closest closest = {.element = w->element[i], .at_mm = w->at_mm[i]};
        struct window_spot here;
        double from;
        double to;
        double p[AXIS_COUNT];

        takt_window_reach(w, i, &from, &to);
        takt_window_beside(w, r, i, &here);
        takt_window_place(w, r, &here, p);
        takt_route_closest(r, p, maths_max(from, w->at_mm[i - 1]), maths_max(to, w->at_mm[i - 1]),
                           &closest);
        stop_at_corner(w, r, i, &before, &here, &closest);
        w->at_mm[i] = closest.at_mm;
        w->element[i] = closest.element > w->element[i - 1] ? closest.element : w->element[i - 1];
        before = here;
    }
}
