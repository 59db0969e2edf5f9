#include "smooth/window.h"

#include "base/maths.h"

#include <assert.h>
#include <string.h>

/* Part of the distance between the neighbours of a sample within which it may move along the route. */
#define REACH        0.8
#define REACH_MIN_MM 0.01

/* A corner that turns by more than this must be passed by the curve before its samples are beyond it. */
#define SHARP 0.2

/* So many tolerances from a corner is near it: the chord of two samples cannot tell more. */
#define NEAR_CORNER 3.0

/* b0 = (1-f)^3/6, b1 = (4 - 6f^2 + 3f^3)/6, b2 = (1 + 3f + 3f^2 - 3f^3)/6, b3 = f^3/6 (uniform cubic B-spline). */
void window_weights(double f, double weight[4])
{
    const double g = 1.0 - f;

    weight[0] = g * g * g / 6.0;
    weight[1] = (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0;
    weight[2] = (4.0 - 6.0 * g * g + 3.0 * g * g * g) / 6.0;
    weight[3] = f * f * f / 6.0;
}

static void append(struct window *w, const struct route *r, double at_mm)
{
    const unsigned i = w->count;
    uint32_t element = i == 0 ? r->first : w->element[i - 1];
    struct point p;

    route_point(r, at_mm, &element, &p);
    w->at_mm[i] = at_mm;
    w->element[i] = element;
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        w->x[axis][i] = p.at[axis];
    }
    w->count++;
}

void window_start(struct window *w, const struct route *r)
{
    w->count = 0;
    w->at_end = false;
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        append(w, r, 0.0);
    }
}

void window_rest(struct window *w)
{
    struct point p;
    const double at = window_at(w, 0, 0.0);
    const uint32_t element = w->element[1];

    window_point(w, 0, 0.0, &p);
    w->at_end = false;
    w->count = SMOOTH_FIXED;
    for (unsigned i = 0; i < w->count; i++) {
        w->at_mm[i] = at;
        w->element[i] = element;
        for (int axis = 0; axis < AXIS_COUNT; axis++) {
            w->x[axis][i] = p.at[axis];
        }
    }
}

/* The next place at the nominal feed: no faster than acceleration and what follows allow. */
static double next_place(const struct window *w, const struct route *r)
{
    const unsigned last = w->count - 1;
    const double here = w->at_mm[last];
    const double moved = (here - w->at_mm[last - 1]) / w->interval_s;
    uint32_t hint = w->element[last];
    const double along = route_acceleration(r, hint);
    double feed = moved + along * w->interval_s;

    feed = maths_min(feed, route_feed(r, here, &hint) + 0.5 * along * w->interval_s);
    feed = maths_min(feed, route_feed(r, here + feed * w->interval_s, &hint));
    return here + maths_max(feed, 0.25 * along * w->interval_s) * w->interval_s;
}

void window_extend(struct window *w, const struct route *r)
{
    const double end = route_end(r);

    while (!w->at_end && w->count + SMOOTH_FIXED <= SMOOTH_SAMPLES_MAX) {
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

void window_drop(struct window *w, unsigned count)
{
    assert(count <= w->count);
    w->count -= count;
    memmove(w->at_mm, w->at_mm + count, w->count * sizeof w->at_mm[0]);
    memmove(w->element, w->element + count, w->count * sizeof w->element[0]);
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        memmove(w->x[axis], w->x[axis] + count, w->count * sizeof w->x[axis][0]);
    }
}

void window_point(const struct window *w, unsigned i, double f, struct point *p)
{
    double weight[4];

    window_weights(f, weight);
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        const double *x = w->x[axis] + i;

        p->at[axis] = weight[0] * x[0] + weight[1] * x[1] + weight[2] * x[2] + weight[3] * x[3];
    }
}

double window_at(const struct window *w, unsigned i, double f)
{
    const double *at = w->at_mm + i;
    double weight[4];

    window_weights(f, weight);
    return weight[0] * at[0] + weight[1] * at[1] + weight[2] * at[2] + weight[3] * at[3];
}

void window_reach(const struct window *w, unsigned i, double *from_mm, double *to_mm)
{
    const double reach = maths_max(REACH_MIN_MM, REACH * (w->at_mm[i + 1] - w->at_mm[i - 1]));

    *from_mm = w->at_mm[i] - reach;
    *to_mm = w->at_mm[i] + reach;
}

/* Does the curve pass a corner between sample i - 1 and i, as far as their chord can tell? */
static bool passes_near(const struct point *from, const struct point *to,
                        const struct point *corner, double tolerance_mm)
{
    double dot = 0.0;
    double square = 0.0;
    double rest = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d = smooth_weight(i) * (to->at[i] - from->at[i]);

        dot += smooth_weight(i) * (corner->at[i] - from->at[i]) * d;
        square += d * d;
    }
    const double part = square > 0.0 ? maths_clamp(dot / square, 0.0, 1.0) : 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d =
            smooth_weight(i) * (corner->at[i] - from->at[i] - part * (to->at[i] - from->at[i]));

        rest += d * d;
    }
    return rest <= NEAR_CORNER * NEAR_CORNER * tolerance_mm * tolerance_mm;
}

/*
 * A sharp corner is not left behind before the curve has been near it: where both sides lie close together, a sample may
 * be nearer to the far side while it is still on its way to the corner.
 */
static void stop_at_corner(const struct window *w, const struct route *r, unsigned i,
                           const struct point *here, struct route_foot *foot)
{
    struct point before;

    window_point(w, i - 2, 0.0, &before);
    for (uint32_t e = w->element[i - 1] + 1; e <= foot->element; e++) {
        const struct route_element *next = route_element(r, e);

        if (next->turn > SHARP &&
            !passes_near(&before, here, &next->curve.start, r->tolerance_mm)) {
            foot->element = e - 1;
            foot->at_mm = next->start_mm;
            return;
        }
    }
}

/* Fixed samples have their place already; places never go back. */
void window_locate(struct window *w, const struct route *r)
{
    for (unsigned i = SMOOTH_FIXED; i + SMOOTH_FIXED < w->count; i++) {
        struct route_foot foot = {.element = w->element[i], .at_mm = w->at_mm[i]};
        double from;
        double to;
        struct point p;

        window_reach(w, i, &from, &to);
        window_point(w, i - 1, 0.0, &p);
        route_foot(r, &p, maths_max(from, w->at_mm[i - 1]), maths_max(to, w->at_mm[i - 1]), &foot);
        stop_at_corner(w, r, i, &p, &foot);
        w->at_mm[i] = foot.at_mm;
        w->element[i] = foot.element;
    }
}
