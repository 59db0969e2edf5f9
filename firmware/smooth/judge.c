#include "smooth/judge.h"

#include "base/maths.h"

/* Rounding of limits. */
#define LIMIT 0.999

/* Part of its acceleration that an axis at its highest velocity is left for changes of rate (override, hold). */
#define CHANGE_PART 0.06

/* Where the axes nearly stand, nothing else bounds the rate. */
#define RATE_MAX 4.0

/* Changes of rate are not rounded over more cycles than these. */
#define ROUNDING_CYCLES_MAX 64.0

/* Between the places looked at the curve goes on by less than this part of the tolerance. */
#define JUDGED 0.985

/* Places looked at in a piece. */
#define PLACES 4

/* A corner is passed so many pieces from where its place is, at most. */
#define CORNER_PIECES 3

/* Corners that turn less are within the tube anyway. */
#define CORNER_MIN 0.005

static double larger(double a, double b)
{
    return maths_max(maths_abs(a), maths_abs(b));
}

/* The derivative is a parabola in a piece: it exceeds both its ends by |third difference| / 8 at most. */
static void need_of_axis(const double *c, double interval_s, struct judge_need *need, int axis)
{
    const double bend0 = c[0] - 2.0 * c[1] + c[2];
    const double bend1 = c[1] - 2.0 * c[2] + c[3];
    const double twist = maths_abs(bend1 - bend0);

    need->first[axis] =
        (larger(0.5 * (c[2] - c[0]), 0.5 * (c[3] - c[1])) + twist / 8.0) / interval_s;
    need->second[axis] = larger(bend0, bend1) / (interval_s * interval_s);
    need->third[axis] = twist / (interval_s * interval_s * interval_s);
}

static double length_over(const double *v, int from, int to)
{
    double square = 0.0;

    for (int i = from; i < to; i++) {
        square += v[i] * v[i];
    }
    return maths_sqrt(square);
}

void judge_need(const struct window *w, const struct route *r, unsigned piece,
                struct judge_need *need)
{
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        need_of_axis(w->x[axis] + piece, w->interval_s, need, axis);
    }
    const bool rotary = curve_is_rotary(&route_element(r, w->element[piece + 1])->curve);

    need->feed_mm_s = rotary ? length_over(need->first, AXIS_LINEAR_COUNT, AXIS_COUNT)
                             : length_over(need->first, 0, AXIS_LINEAR_COUNT);
}

static bool has_axis(const struct smooth_limits *limits, int axis)
{
    return (limits->axes >> axis & 1U) != 0;
}

/* Rounded over what the axes need from no acceleration to all of it, A/J. */
void judge_change(const struct smooth_limits *limits, struct judge_change *change)
{
    double rounding_s = limits->cycle_s;

    change->by = MATHS_INFINITY;
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double a = limits->acceleration_mm_s2[i];

        if (has_axis(limits, i)) {
            change->by = maths_min(change->by, CHANGE_PART * a / limits->velocity_mm_s[i]);
            rounding_s = maths_max(rounding_s, a / limits->jerk_mm_s3[i]);
        }
    }
    change->rounding_s = maths_min(rounding_s, ROUNDING_CYCLES_MAX * limits->cycle_s);
    change->rounded = change->by / change->rounding_s;
}

/*
 * The highest rate r of one axis that may still change by r' and r'':
 *     velocity      x' r                             <= V
 *     acceleration  x' r' + x'' r^2                  <= A
 *     jerk          x' r'' + 3 x'' r r' + x''' r^3   <= J
 * In the jerk's middle term stands what the other two leave of r.
 */
static double most_of_axis(const struct judge_need *need, const struct smooth_limits *limits,
                           const struct judge_change *change, int i, double most)
{
    const double first = need->first[i];
    const double second = need->second[i];
    const double third = need->third[i];

    if (first * most > limits->velocity_mm_s[i]) {
        most = limits->velocity_mm_s[i] / first;
    }
    const double a = maths_max(0.0, LIMIT * limits->acceleration_mm_s2[i] - first * change->by);

    if (second * most * most > a) {
        most = maths_sqrt(a / second);
    }
    const double j = maths_max(0.0, LIMIT * limits->jerk_mm_s3[i] - first * change->rounded -
                                        3.0 * second * most * change->by);

    return third * most * most * most > j ? maths_cbrt(j / third) : most;
}

void judge_rate(const struct judge_need *need, const struct route_element *e,
                const struct smooth_limits *limits, const struct judge_change *change,
                struct judge_rate *rate)
{
    rate->most = RATE_MAX;
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (has_axis(limits, i)) {
            rate->most = most_of_axis(need, limits, change, i, rate->most);
        }
    }
    rate->programmed = e->move.kind == MOVE_RAPID || need->feed_mm_s <= 0.0
                           ? MATHS_INFINITY
                           : e->move.feed_mm_s / need->feed_mm_s;
}

static bool place_is_near(const struct window *w, const struct route *r, unsigned piece, double f)
{
    struct route_foot foot = {.element = w->element[piece + 1], .at_mm = window_at(w, piece, f)};
    double from;
    double to;
    double ignored;
    struct point p;

    window_reach(w, piece + 1, &from, &ignored);
    window_reach(w, piece + 2 < w->count - 1 ? piece + 2 : piece + 1, &ignored, &to);
    window_point(w, piece, f, &p);
    route_foot(r, &p, from, to, &foot);
    return foot.distance_mm <= JUDGED * r->tolerance_mm;
}

/* Weighted distance of a corner from the chord between two points of the curve. */
static double chord_distance(const struct point *corner, const struct point *a,
                             const struct point *b)
{
    double dot = 0.0;
    double square = 0.0;
    double rest = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d = smooth_weight(i) * (b->at[i] - a->at[i]);

        dot += smooth_weight(i) * (corner->at[i] - a->at[i]) * d;
        square += d * d;
    }
    const double part = square > 0.0 ? maths_clamp(dot / square, 0.0, 1.0) : 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d =
            smooth_weight(i) * (corner->at[i] - a->at[i] - part * (b->at[i] - a->at[i]));

        rest += d * d;
    }
    return maths_sqrt(rest);
}

/* Looks for a place near enough to the corner in a piece and its neighbours. */
static bool passes_corner(const struct window *w, const struct route *r, unsigned piece,
                          uint32_t element)
{
    const struct point *corner = &route_element(r, element)->curve.start;
    const unsigned first = piece > CORNER_PIECES ? piece - CORNER_PIECES : 0;
    const unsigned last =
        piece + CORNER_PIECES + 4 < w->count ? piece + CORNER_PIECES : w->count - 4;
    struct point a;
    struct point b;

    window_point(w, first, 0.0, &a);
    for (unsigned i = first; i <= last; i++) {
        for (unsigned k = 1; k <= PLACES; k++) {
            window_point(w, i, (double)k / PLACES, &b);
            if (chord_distance(corner, &a, &b) <= JUDGED * r->tolerance_mm - r->limits.chord_mm) {
                return true;
            }
            a = b;
        }
    }
    return false;
}

static bool piece_is_good(const struct window *w, const struct route *r, unsigned piece)
{
    for (unsigned k = 1; k <= PLACES; k++) {
        if (!place_is_near(w, r, piece, (double)k / PLACES)) {
            return false;
        }
    }
    for (uint32_t e = w->element[piece + 1] + 1; e <= w->element[piece + 2]; e++) {
        if (route_element(r, e)->turn > CORNER_MIN && !passes_corner(w, r, piece, e)) {
            return false;
        }
    }
    return true;
}

unsigned judge_pieces(const struct window *w, const struct route *r, unsigned count)
{
    unsigned good = 0;

    while (good < count && piece_is_good(w, r, good)) {
        good++;
    }
    return good;
}
