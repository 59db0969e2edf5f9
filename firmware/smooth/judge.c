#include "smooth/judge.h"

#include "smooth/single.h"

#include <stddef.h>

/* Rounding of limits. */
#define LIMIT 0.999f

/* Part of its acceleration that an axis at its highest velocity is left for changes of rate (override, hold). */
#define CHANGE_PART 0.06

/* Part of its jerk that is left for that, and that changing the rate in a bend may need: the curve needs the rest. */
#define CHANGE_JERK  0.12
#define TURNING_PART 0.4f

/* Where the axes nearly stand, nothing else bounds the rate. */
#define RATE_MAX 4.0f

/* Changes of rate are not rounded over more cycles than these. */
#define ROUNDING_CYCLES_MAX 64.0

/* Between the places looked at the curve goes on by less than this part of the tolerance. */
#define JUDGED 0.985f

/* A rate does not change faster than this times what it may change by on every piece. */
#define CHANGE_MOST 64.0f

/*
 * Part of by that a piece must leave at its highest rate: beside others that leave more a little is enough, and to pass it
 * more slowly costs more. Halvings in search of that rate.
 */
#define CHANGE_LEAST 0.25f
#define HALVINGS     9

/* Of a piece's highest rate, the parts at which what it leaves is looked at: closer where more of it is used. */
static const float parts[] = {1.0f, 0.97f, 0.9f, 0.8f, 0.65f};

/* Part of its acceleration that an axis has for a change of rate at rest: rounding must not take it away. */
#define STILL_PART 0.98

/* Rates at which what is left for changes of it is looked at. */
#define STILL_RATES 8

/* Places looked at in a piece. */
#define PLACES 4

/* A corner is passed so many pieces from where its place is, at most. */
#define CORNER_PIECES 3

/* Corners of lines that turn less are within the tube anyway. */
#define CORNER_MIN 0.005f

static float larger(float a, float b)
{
    return single_max(single_abs(a), single_abs(b));
}

/* The derivative is a parabola in a piece: it exceeds both its ends by |third difference| / 8 at most. */
static void need_of_axis(const struct window *w, unsigned slot, unsigned piece,
                         struct judge_need *need)
{
    const unsigned lane = slot % SMOOTH_LANES;
    const lanes_int *c = w->x + (size_t)(slot / SMOOTH_LANES) * w->capacity + piece;
    const int32_t step0 = c[1][lane] - c[0][lane];
    const int32_t step1 = c[2][lane] - c[1][lane];
    const int32_t step2 = c[3][lane] - c[2][lane];
    const float bend0 = (float)(step1 - step0);
    const float bend1 = (float)(step2 - step1);
    const float twist = single_abs((float)(step2 - 2 * step1 + step0));
    const float per_s = 1.0f / (float)w->interval_s;
    const float first = (float)w->unit_mm[slot] * per_s;

    need->first[slot] =
        (0.5f * larger((float)(step0 + step1), (float)(step1 + step2)) + twist / 8.0f) * first;
    need->second[slot] = larger(bend0, bend1) * first * per_s;
    need->third[slot] = twist * first * per_s * per_s;
}

/* Over the linear axes, or over the others. */
static float feed_of(const struct route *r, const struct judge_need *need, bool rotary)
{
    float square = 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        if ((r->slots.axis[i] >= AXIS_LINEAR_COUNT) == rotary) {
            square += need->first[i] * need->first[i];
        }
    }
    return single_sqrt(square);
}

void judge_need(const struct window *w, const struct route *r, unsigned piece,
                struct judge_need *need)
{
    for (unsigned i = 0; i < r->slots.count; i++) {
        need_of_axis(w, i, piece, need);
    }
    need->feed_mm_s = feed_of(r, need, route_element(r, w->element[piece + 1])->rotary);
}

/* Of its acceleration what an axis can use: on the way to its highest velocity, and in a circle at that, jerk allows no more. */
static double usable(const struct smooth_limits *limits, int axis)
{
    return maths_min(limits->acceleration_mm_s2[axis],
                     maths_sqrt(limits->velocity_mm_s[axis] * limits->jerk_mm_s3[axis]));
}

/*
 * The most that leaves every axis its limits at any rate, whatever the curve needs of them at the full one:
 *     V still                                                                      <= A
 *     still (1 - r^2) (V/R + A + 3 A r) + by r^2 (1 - r) (V/R + 4 A) + J r^3       <= J
 */
static double still_of(const struct smooth_limits *limits, const struct judge_change *change)
{
    double still = MATHS_INFINITY;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double v = limits->velocity_mm_s[i];
        const double a = usable(limits, i);

        for (int k = 0; (limits->axes >> i & 1U) != 0 && k < STILL_RATES; k++) {
            const double r = (double)k / STILL_RATES;
            const double rounding = v / change->rounding_s + a;
            const double left = limits->jerk_mm_s3[i] * (1.0 - r * r * r) -
                                change->by * r * r * (1.0 - r) * (rounding + 3.0 * a);

            still = maths_min(still, maths_min(STILL_PART * a / v,
                                               left / ((1.0 - r * r) * (rounding + 3.0 * a * r))));
        }
    }
    return maths_max(STILL_PART * still, change->by);
}

/*
 * Rounded over what the axes need from no acceleration to all of it, a/J, within a bound; and so slow that no axis at its
 * highest velocity needs more than a part of its limits for a change:
 *     V r' <= CHANGE_PART a,      V r'/R + 4 a r' <= CHANGE_JERK J
 */
void judge_change(const struct smooth_limits *limits, struct judge_change *change)
{
    double rounding_s = limits->cycle_s;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes >> i & 1U) != 0) {
            rounding_s = maths_max(rounding_s, usable(limits, i) / limits->jerk_mm_s3[i]);
        }
    }
    change->rounding_s = maths_min(rounding_s, ROUNDING_CYCLES_MAX * limits->cycle_s);
    change->by = MATHS_INFINITY;
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double v = limits->velocity_mm_s[i];
        const double a = usable(limits, i);

        if ((limits->axes >> i & 1U) != 0) {
            change->by = maths_min(
                change->by, maths_min(CHANGE_PART * a / v, CHANGE_JERK * limits->jerk_mm_s3[i] /
                                                               (v / change->rounding_s + 4.0 * a)));
        }
    }
    change->rounded = change->by / change->rounding_s;
    change->still = still_of(limits, change);
}

/*
 * The highest rate r of one axis that may still change by r' and r'':
 *     velocity      x' r                             <= V
 *     acceleration  x' r' + x'' r^2                  <= A
 *     jerk          x' r'' + 3 x'' r r' + x''' r^3   <= J
 * Each of the jerk's terms has a part for itself: a curve that needed all of it for one could not be gone along.
 */
static float most_of_axis(const struct judge_need *need, const struct route_slots *slots,
                          const struct judge_change *change, unsigned i, float most)
{
    const float first = need->first[i];
    const float second = need->second[i];
    const float third = need->third[i];
    const float by = (float)change->by;

    if (first * most > slots->velocity_mm_s[i]) {
        most = slots->velocity_mm_s[i] / first;
    }
    const float a = single_max(0.0f, single_min(LIMIT * slots->acceleration_mm_s2[i],
                                                LIMIT * slots->whole_mm_s2[i] - first * by));

    if (second * most * most > a) {
        most = single_sqrt(a / second);
    }
    const float turning = TURNING_PART * slots->jerk_mm_s3[i];

    if (3.0f * second * most * by > turning) {
        most = turning / (3.0f * second * by);
    }
    const float j = single_max(0.0f, LIMIT * slots->jerk_mm_s3[i] - first * (float)change->rounded -
                                         3.0f * second * most * by);

    return third * most * most * most > j ? single_cbrt(j / third) : most;
}

void judge_rate(const struct judge_need *need, const struct route *r, uint32_t element,
                const struct judge_change *change, struct judge_rate *rate)
{
    rate->most = RATE_MAX;
    for (unsigned i = 0; i < r->slots.count; i++) {
        rate->most = most_of_axis(need, &r->slots, change, i, rate->most);
    }
    rate->programmed =
        need->feed_mm_s > 0.0f ? route_programmed(r, element) / need->feed_mm_s : SINGLE_INFINITY;
}

/*
 * What an axis leaves at a rate for r' and r'' = r' (1/R + still), R the rounding: see most_of_axis(). The lead point, that
 * slows down ahead of it, is at a lower rate by r' R/2, where it may slow down faster by still R r'.
 */
static float left_of_axis(const struct judge_need *need, const struct route_slots *slots,
                          float beginning, unsigned i, float rate, float most)
{
    const float first = need->first[i];
    const float second = need->second[i];
    const float a = LIMIT * slots->whole_mm_s2[i] - second * rate * rate;
    const float j = LIMIT * slots->jerk_mm_s3[i] - need->third[i] * rate * rate * rate;
    const float per_by = first * beginning + 3.0f * second * rate;

    most = first * most > a ? a / first : most;
    return per_by * most > j ? j / per_by : most;
}

/* The highest change by, 1/s, for which every axis has by r^2 + still (1 - r^2) left at a rate r. */
static float change_at(const struct judge_need *need, const struct route *r,
                       const struct judge_change *change, float rate)
{
    const float square = single_min(1.0f, rate * rate);
    const float still = (float)change->still * (1.0f - square);
    const float beginning = (float)(1.0 / change->rounding_s + change->still);
    float most = square * CHANGE_MOST * (float)change->by + still;

    for (unsigned i = 0; i < r->slots.count; i++) {
        most = left_of_axis(need, &r->slots, beginning, i, rate, most);
    }
    return (most - still) / square;
}

/* Likewise at every rate up to this one. */
static float change_up_to(const struct judge_need *need, const struct route *r,
                          const struct judge_change *change, float rate)
{
    float most = SINGLE_INFINITY;

    for (unsigned i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        most = single_min(most, change_at(need, r, change, parts[i] * rate));
    }
    return most;
}

/* At which no axis is faster than it may be. */
static float rate_of_velocity(const struct judge_need *need, const struct route_slots *slots)
{
    float rate = 1.0f;

    for (unsigned i = 0; i < slots->count; i++) {
        if (need->first[i] * rate > slots->velocity_mm_s[i]) {
            rate = slots->velocity_mm_s[i] / need->first[i];
        }
    }
    return rate;
}

float judge_most(const struct judge_need *need, const struct route *r,
                 const struct judge_change *change)
{
    const float least = CHANGE_LEAST * (float)change->by;
    float high = rate_of_velocity(need, &r->slots);
    float low = 0.0f;

    if (change_up_to(need, r, change, high) >= least) {
        return high;
    }
    for (unsigned i = 0; i < HALVINGS; i++) {
        const float middle = 0.5f * (low + high);

        if (change_up_to(need, r, change, middle) >= least) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

float judge_change_on(const struct judge_need *need, const struct route *r,
                      const struct judge_change *change, float rate)
{
    const float most = change_up_to(need, r, change, rate);
    float by = CHANGE_LEAST * (float)change->by;

    while (2.0f * by <= most) {
        by *= 2.0f;
    }
    return by;
}

static bool place_is_near(const struct window *w, const struct route *r, unsigned piece,
                          const float weight[4], const struct window_spot *spot)
{
    struct route_foot foot = {.element = w->element[piece + 1],
                              .at_mm = window_at(w, piece, weight)};
    double from;
    double to;
    double ignored;
    double p[AXIS_COUNT];

    window_reach(w, piece + 1, &from, &ignored);
    window_reach(w, piece + 2 < w->count - 1 ? piece + 2 : piece + 1, &ignored, &to);
    window_place(w, r, spot, p);
    route_foot(r, p, from, to, &foot);
    return foot.distance_mm <= JUDGED * (float)r->tolerance_mm;
}

/* Is a chord between the places looked at in a piece near enough to the corner? */
static bool piece_passes_corner(const struct window *w, const struct route *r, unsigned piece,
                                uint32_t element)
{
    const float within = JUDGED * (float)r->tolerance_mm - (float)r->chord_mm;
    struct window_spot a;
    struct window_spot b;
    float weight[4];

    window_weights(0.0f, weight);
    window_spot(w, r, piece, weight, &a);
    for (unsigned k = 1; k <= PLACES; k++) {
        window_weights((float)k / PLACES, weight);
        window_spot(w, r, piece, weight, &b);
        if (window_chord_square(w, r, element, &a, &b) <= within * within) {
            return true;
        }
        a = b;
    }
    return false;
}

/* The piece beside the corner mostly does; else one of its neighbours may, of the first count. */
static bool passes_corner(const struct window *w, const struct route *r, unsigned piece,
                          uint32_t element, unsigned count)
{
    const unsigned first = piece > CORNER_PIECES ? piece - CORNER_PIECES : 0;
    const unsigned end = piece + CORNER_PIECES < count ? piece + CORNER_PIECES + 1 : count;

    if (piece_passes_corner(w, r, piece, element)) {
        return true;
    }
    for (unsigned i = first; i < end; i++) {
        if (i != piece && piece_passes_corner(w, r, i, element)) {
            return true;
        }
    }
    return false;
}

/* Can the curve leave the element's start aside? A bend of a few tolerances it can cut short within the tube. */
static bool is_corner(const struct route *r, uint32_t element)
{
    const struct route_element *e = route_element(r, element);

    return route_turn(r, element) > CORNER_MIN || e->bent || route_element(r, element - 1)->bent;
}

/* Do the first count pieces pass the corners beside one of them? */
static bool passes_corners(const struct window *w, const struct route *r, unsigned piece,
                           unsigned count)
{
    for (uint32_t e = w->element[piece + 1] + 1; e <= w->element[piece + 2]; e++) {
        if (is_corner(r, e) && !passes_corner(w, r, piece, e, count)) {
            return false;
        }
    }
    return true;
}

static bool piece_is_good(const struct window *w, const struct route *r, unsigned piece)
{
    for (unsigned k = 1; k <= PLACES; k++) {
        struct window_spot spot;
        float weight[4];

        window_weights((float)k / PLACES, weight);
        window_spot(w, r, piece, weight, &spot);
        if (!place_is_near(w, r, piece, weight, &spot)) {
            return false;
        }
    }
    return passes_corners(w, r, piece, w->count - 3);
}

unsigned judge_pieces(const struct window *w, const struct route *r, unsigned count)
{
    unsigned good = 0;

    while (good < count && piece_is_good(w, r, good)) {
        good++;
    }
    return good;
}

/* Only the last of them can have left a corner to what follows. */
static bool leaves_corner(const struct window *w, const struct route *r, unsigned count)
{
    for (unsigned i = 1; i <= CORNER_PIECES && i <= count; i++) {
        if (!passes_corners(w, r, count - i, count)) {
            return true;
        }
    }
    return false;
}

unsigned judge_whole(const struct window *w, const struct route *r, unsigned count)
{
    while (count > 0 && leaves_corner(w, r, count)) {
        count--;
    }
    return count;
}
