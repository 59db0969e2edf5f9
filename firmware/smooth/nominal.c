#include "smooth/nominal.h"

#include "base/assert.h"
#include "smooth/single.h"

/*
 * Part of the axes' acceleration and jerk for the nominal feed along the path; smoothing needs the
 * rest to round its ramps.
 */
#define ALONG 0.95f

/* Part of the axes' limits for the curvature of arcs. */
#define CURVED 0.9f

/*
 * A corner may use the tolerance on both sides: the curve swings out before it and cuts in at it.
 */
#define SIDES 2.0f

/* Where directions differ by less, rounding of them is what differs. */
#define TURN_MIN 1e-6f

/* How many elements a corner is looked at together with, and how many after it must have come. */
#define NEIGHBOURS 8
#define BEHIND     4

static struct route_element *at(struct route *r, uint32_t index)
{
    return &r->element[route_slot(r, index)];
}

static float length_of(const struct route *r, uint32_t index)
{
    return (float)(route_end_of(r, index) - route_element(r, index)->start_mm);
}

/* v <= V/|x_s|, sqrt(A/|x_ss|), cbrt(J/|x_sss|) on every axis. */
static float feed_of(const struct curve_bounds *b, const struct route_slots *slots)
{
    float feed = SINGLE_INFINITY;

    for (unsigned i = 0; i < slots->count; i++) {
        const float first = (float)b->first[slots->axis[i]];
        const float second = (float)b->second[slots->axis[i]];
        const float third = (float)b->third[slots->axis[i]];

        if (first > 0.0f) {
            feed = single_min(feed, slots->velocity_mm_s[i] / first);
        }
        if (second > 0.0f) {
            feed = single_min(feed, single_sqrt(CURVED * slots->acceleration_mm_s2[i] / second));
        }
        if (third > 0.0f) {
            feed = single_min(feed, takt_single_cbrt(CURVED * slots->jerk_mm_s3[i] / third));
        }
    }
    return feed;
}

/* j = J/|x_s| */
static float jerk_of(const struct curve_bounds *b, const struct route_slots *slots)
{
    float jerk = SINGLE_INFINITY;

    for (unsigned i = 0; i < slots->count; i++) {
        const float first = (float)b->first[slots->axis[i]];

        if (first > 0.0f) {
            jerk = single_min(jerk, slots->jerk_mm_s3[i] / first);
        }
    }
    return ALONG * jerk;
}

/* a = sqrt(A^2 - (x_ss v^2)^2) / |x_s| */
static float along_of(const struct curve_bounds *b, const struct route_slots *slots, float feed)
{
    float along = SINGLE_INFINITY;

    for (unsigned i = 0; i < slots->count; i++) {
        const float a = slots->acceleration_mm_s2[i];
        const float first = (float)b->first[slots->axis[i]];
        const float normal = (float)b->second[slots->axis[i]] * feed * feed;

        if (first > 0.0f) {
            along = single_min(along, single_sqrt(a * a - normal * normal) / first);
        }
    }
    return ALONG * along;
}

void takt_nominal_set(struct route_element *e, const struct curve *curve, float per_mm,
                      const struct route *r)
{
    struct curve_bounds b;

    takt_curve_bound(curve, &b);
    const float feed = single_min(e->programmed_mm_s, feed_of(&b, &r->slots));

    e->feed_mm_s = per_mm * feed;
    e->along.acceleration = per_mm * along_of(&b, &r->slots, feed);
    e->along.jerk = per_mm * jerk_of(&b, &r->slots);
    TAKT_ASSERT(e->feed_mm_s > 0.0f && e->along.acceleration > 0.0f && e->along.jerk > 0.0f);
}

/*
 * A change of direction d, rounded over w mm to both sides with curvature that rises and falls
 * evenly, bends the path by d/w at most and leaves the corner by |d| w / 6: v <= sqrt(A w/|d_i|),
 * cbrt(J w^2/|d_i|) on every axis.
 */
static float feed_over(const struct route_slots *slots, const float d[], float w_mm)
{
    float square = SINGLE_INFINITY;
    float cube = SINGLE_INFINITY;

    TAKT_ASSERT(w_mm >= 0.0f);
    for (unsigned i = 0; i < slots->count; i++) {
        const float turn = single_abs(d[i]) / slots->weight[i];

        if (turn > 0.0f) {
            square = single_min(square, slots->acceleration_mm_s2[i] * w_mm / turn);
            cube = single_min(cube, slots->jerk_mm_s3[i] * w_mm * w_mm / turn);
        }
    }
    if (square == SINGLE_INFINITY) {
        return square;
    }
    return single_min(single_sqrt(square), takt_single_cbrt(cube));
}

/* Both sides of a corner while it is looked at from farther and farther away. */
struct surroundings {
    uint32_t left, right; /* elements reached */
    float left_mm, right_mm;
    float before[AXIS_COUNT], after[AXIS_COUNT]; /* directions there */
};

static float turn_of(const struct surroundings *s, unsigned count, float d[])
{
    float square = 0.0f;

    for (unsigned i = 0; i < count; i++) {
        d[i] = s->after[i] - s->before[i];
        square += d[i] * d[i];
    }
    return single_sqrt(square);
}

/* The shorter side grows by an element. False when there is none. */
static bool widen(const struct route *r, struct surroundings *s)
{
    if (s->left_mm < s->right_mm) {
        if (s->left <= r->first + 1) {
            return false;
        }
        s->left--;
        (void)takt_route_direction(r, s->left, route_end_of(r, s->left), s->before);
        s->left_mm += length_of(r, s->left);
        return true;
    }
    if (s->right + 1 >= r->count) {
        return false;
    }
    s->right++;
    (void)takt_route_direction(r, s->right, route_element(r, s->right)->start_mm, s->after);
    s->right_mm += length_of(r, s->right);
    return true;
}

/*
 * The highest feed at the start of an element: the best of all widths over which the corner may be
 * rounded. Many small corners in a row are one bend, and some that go to and fro nearly none: so
 * the directions are also compared farther off.
 */
static float corner_feed(struct route *r, uint32_t index)
{
    struct surroundings s = {.left = index - 1, .right = index};
    const float enough =
        single_min(route_element(r, index - 1)->feed_mm_s, route_element(r, index)->feed_mm_s);
    const float tolerance_mm = r->part * (float)r->tolerance_mm;
    float best = 0.0f;
    float d[AXIS_COUNT];

    takt_route_corner(r, index, s.before, s.after);
    s.left_mm = length_of(r, index - 1);
    s.right_mm = length_of(r, index);
    at(r, index)->turn = (uint16_t)(turn_of(&s, r->slots.count, d) / ROUTE_TURN + 0.5f);
    for (unsigned i = 0; i < NEIGHBOURS && best < enough; i++) {
        const float turn = turn_of(&s, r->slots.count, d);
        const float allowed = 6.0f * SIDES * tolerance_mm / single_max(turn, TURN_MIN);
        const float width = single_min(s.left_mm, s.right_mm);

        best = single_max(best, feed_over(&r->slots, d, single_min(allowed, width)));
        if (allowed < width || !widen(r, &s)) {
            break;
        }
    }
    return single_min(best, enough);
}

static void set_corner(struct route *r, uint32_t index)
{
    at(r, index)->start_mm_s = corner_feed(r, index);
}

static struct braking_limits lower(struct braking_limits a, struct braking_limits b)
{
    return (struct braking_limits){single_min(a.acceleration, b.acceleration),
                                   single_min(a.jerk, b.jerk)};
}

/* Backwards, which starts of elements bind: those that are slower than what follows asks for. */
static void find_binding(struct route *r, uint32_t changed)
{
    const struct braking_limits none = {SINGLE_INFINITY, SINGLE_INFINITY};
    struct braking_limits limits = none;
    double end_mm = r->end_mm;
    float to = 0.0f;

    for (uint32_t i = r->count; i > r->first; i--) {
        struct route_element *e = at(r, i - 1);
        const bool bound = e->binds;

        limits = lower(limits, e->along);
        e->binds =
            takt_braking_way(&limits, e->start_mm_s, 0.0f, to) <= (float)(end_mm - e->start_mm);
        if (!e->binds) {
            continue;
        }
        if (bound && i - 1 < changed) {
            return;
        }
        limits = none;
        end_mm = e->start_mm;
        to = e->start_mm_s;
    }
}

bool takt_nominal_allows(const struct route *r, uint32_t element, double at_mm, float feed,
                         float acceleration)
{
    const struct route_element *e = route_element(r, element);
    const float rise = single_max(acceleration, 0.0f);
    struct braking_limits limits = e->along;
    uint32_t i = element + 1;

    if (feed + 0.5f * rise * rise / limits.jerk > e->feed_mm_s) {
        return false;
    }
    while (i < r->count && !route_element(r, i)->binds) {
        limits = lower(limits, route_element(r, i)->along);
        i++;
    }
    const double end_mm = i < r->count ? route_element(r, i)->start_mm : r->end_mm;
    const float to = i < r->count ? route_element(r, i)->start_mm_s : 0.0f;

    return takt_braking_way(&limits, feed, acceleration, to) <= (float)(end_mm - at_mm);
}

void takt_nominal_update(struct route *r)
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
    find_binding(r, changed);
}

void takt_nominal_again(struct route *r)
{
    for (uint32_t i = r->first + 1; i < r->count; i++) {
        set_corner(r, i);
    }
    find_binding(r, r->first);
}
