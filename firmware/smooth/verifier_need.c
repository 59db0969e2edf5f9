/*
 * What a piece needs of velocity, acceleration and jerk, and what that leaves: the highest rate
 * that it may be gone along at, and how fast that may change on it.
 */
#include "smooth/verifier.h"

#include "base/assert.h"
#include "base/maths.h"
#include "smooth/single.h"

#include <stddef.h>

/* Rounding of limits. */
#define LIMIT 0.999f

/*
 * Parts of its acceleration that an axis at its highest velocity is left for changes of rate
 * (override, hold).
 */
#define LEFT_LEAST 0.06
#define LEFT_MOST  0.5

/* Part of the pieces before the trapezoidal reference that are known on the average: README.md. */
#define KNOWN_PART 0.7

/*
 * Parts of the jerk that beginning to change the rate may need, and changing it on a curve: the
 * curve needs the rest.
 */
#define ROUNDING_PART 0.3
#define TURNING_PART  0.4f

/*
 * A power of two times what every piece leaves is what is needed, if no farther from it than by
 * this.
 */
#define NEAR_ENOUGH 1.4142

/* Where the axes nearly stand, nothing else bounds the rate. */
#define RATE_MAX 4.0f

/* Changes of rate are not rounded over more cycles than these. */
#define ROUNDING_CYCLES_MAX 64.0

/* A piece leaves more for changes of rate as long as that leaves so much of the rate. */
#define NEARLY 0.9f

/* A rate does not change faster than this times what it may change by on every piece. */
#define CHANGE_MOST 64.0f

/*
 * Need of a group of slots. The derivative is a parabola in a piece: it exceeds both its ends by
 * |third difference| / 8 at most. square: of the first derivative, over the linear axes and over
 * the others.
 */
static void need_of_group(const struct window *w, const struct route *r, unsigned group,
                          unsigned piece, struct verifier_need *need, float square[2])
{
    const lanes_int *c = w->x + (size_t)group * w->capacity + piece;
    const lanes_int step0 = c[1] - c[0];
    const lanes_int step1 = c[2] - c[1];
    const lanes_int step2 = c[3] - c[2];
    const lanes third = lanes_size(lanes_of(step2 - 2 * step1 + step0));
    const lanes way =
        lanes_max(lanes_size(lanes_of(step0 + step1)), lanes_size(lanes_of(step1 + step2)));
    const lanes second =
        lanes_max(lanes_size(lanes_of(step1 - step0)), lanes_size(lanes_of(step2 - step1)));
    const lanes most = 0.5f * way + third / 8.0f;
    const float per_s = 1.0f / (float)w->interval_s;

    for (unsigned k = 0, i = group * SMOOTH_LANES; k < SMOOTH_LANES && i < r->slots.count;
         k++, i++) {
        const float first = (float)w->unit_mm[i] * per_s;

        need->first[i] = most[k] * first;
        need->second[i] = second[k] * first * per_s;
        need->third[i] = third[k] * first * per_s * per_s;
        square[r->slots.axis[i] < AXIS_LINEAR_COUNT ? 0 : 1] += need->first[i] * need->first[i];
    }
}

void takt_verifier_need(const struct window *w, const struct route *r, unsigned piece,
                        struct verifier_need *need)
{
    float square[2] = {0.0f, 0.0f};

    TAKT_ASSERT(piece + 3 < w->count);
    for (unsigned g = 0; g < r->slots.groups; g++) {
        need_of_group(w, r, g, piece, need, square);
    }
    need->linear_mm_s = single_sqrt(square[0]);
    need->rotary_mm_s = single_sqrt(square[1]);
}

float takt_verifier_programmed(const struct verifier_need *need, const struct route *r,
                               uint32_t element)
{
    const float feed = route_element(r, element)->rotary ? need->rotary_mm_s : need->linear_mm_s;

    return feed > 0.0f ? route_programmed(r, element) / feed : SINGLE_INFINITY;
}

/*
 * The highest acceleration that an axis reaches on its way to V: A, or sqrt(V J) where that is
 * less.
 */
static double reached(const struct smooth_limits *limits, int axis)
{
    TAKT_ASSERT(limits->velocity_mm_s[axis] > 0.0 && limits->jerk_mm_s3[axis] > 0.0);
    return maths_min(limits->acceleration_mm_s2[axis],
                     maths_sqrt(limits->velocity_mm_s[axis] * limits->jerk_mm_s3[axis]));
}

/*
 * The trapezoidal reference comes to rest from the full rate over the pieces that it knows, n of d
 * s: r' = 1/(2 n d). Less would make it slow before the end of what is known, over and over.
 */
static double change_needed(double interval_s)
{
    return 1.0 / (2.0 * KNOWN_PART * SMOOTH_AHEAD_PIECES * interval_s);
}

/* What an axis may do of that at its highest velocity. */
static double change_at_full(const struct smooth_limits *limits, double interval_s, int axis)
{
    const double most = reached(limits, axis) / limits->velocity_mm_s[axis];

    return maths_clamp(change_needed(interval_s), LEFT_LEAST * most, LEFT_MOST * most);
}

/* The least J/V of the axes, 1/s2. */
static double least_jerk_of_velocity(const struct smooth_limits *limits)
{
    double least = MATHS_INFINITY;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes >> i & 1U) != 0) {
            least = maths_min(least, limits->jerk_mm_s3[i] / limits->velocity_mm_s[i]);
        }
    }
    return least;
}

/* The least jerk of the axes, as distances count: mm/s3. */
static double least_jerk(const struct smooth_limits *limits)
{
    double least = MATHS_INFINITY;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes >> i & 1U) != 0) {
            least = maths_min(least, smooth_weight(i) * limits->jerk_mm_s3[i]);
        }
    }
    return least;
}

/*
 * Over R are changes of rate rounded: what the axes need from no acceleration to all of it, A/J. On
 * a short way x it is less: at both ends the axes stand for as long as the rate needs for w windows
 * of R, and what beginning to change it may need of the jerk, x' r'/R, makes the curve slower by a
 * third of that part of it where jerk binds, as if that were half of the way: by x r'/(6 R J) in
 * all. The sum is least where
 *
 *     R^2 = x r'/(12 w J)
 */
static double rounding_of_way(const struct smooth_limits *limits, double by, double way_mm)
{
    return maths_sqrt(way_mm * by / (12.0 * limits->windows * least_jerk(limits)));
}

/*
 * Where changes are rounded over less than A/J they are so slow that no axis needs more than its
 * part of the jerk for them, V r'/R <= part J. A chain that goes on behind what is known needs them
 * for that, so it has no shorter R.
 */
void takt_verifier_change(const struct smooth_limits *limits, double interval_s,
                          const struct verifier_way *way, struct verifier_change *change)
{
    const double most = ROUNDING_PART * least_jerk_of_velocity(limits);
    double ramp_s = limits->cycle_s;

    TAKT_ASSERT(interval_s > 0.0 && way->expected_mm > 0.0);
    TAKT_ASSERT(way->known_mm <= way->expected_mm);
    change->by = MATHS_INFINITY;
    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes >> i & 1U) != 0) {
            change->by = maths_min(change->by, change_at_full(limits, interval_s, i));
            ramp_s = maths_max(ramp_s, reached(limits, i) / limits->jerk_mm_s3[i]);
        }
    }
    const double go_on_s = way->known_mm < way->expected_mm ? change->by / most : 0.0;
    const double least = maths_max(limits->cycle_s, go_on_s);
    const double wanted = maths_max(least, rounding_of_way(limits, change->by, way->expected_mm));

    change->rounding_s =
        maths_min(maths_min(ramp_s, ROUNDING_CYCLES_MAX * limits->cycle_s), wanted);
    if (change->rounding_s < ramp_s) {
        change->by = maths_min(change->by, most * change->rounding_s);
    }
    change->wanted = change->by;
    while (2.0 * change->wanted < NEAR_ENOUGH * change_needed(interval_s)) {
        change->wanted *= 2.0;
    }
    TAKT_ASSERT(change->by > 0.0 && change->rounding_s > 0.0);
}

/*
 * The highest rate r of one axis that may still change by r' and r'':
 *     velocity      x' r                             <= V
 *     acceleration  x' r' + x'' r^2                  <= A
 *     jerk          x' r'' + 3 x'' r r' + x''' r^3   <= J
 * Each of the jerk's terms has a part for itself: a curve that needed all of it for one could not
 * be gone along.
 */
static float most_of_axis(const struct verifier_need *need, const struct route_slots *slots,
                          float by, float rounded, unsigned i, float most)
{
    const float first = need->first[i];
    const float second = need->second[i];
    const float third = need->third[i];

    if (first * most > slots->velocity_mm_s[i]) {
        most = slots->velocity_mm_s[i] / first;
    }
    const float a = single_max(0.0f, LIMIT * slots->acceleration_mm_s2[i] - first * by);

    if (second * most * most > a) {
        most = single_sqrt(a / second);
    }
    const float turning = TURNING_PART * slots->jerk_mm_s3[i];

    if (3.0f * second * most * by > turning) {
        most = turning / (3.0f * second * by);
    }
    const float j = single_max(0.0f, LIMIT * slots->jerk_mm_s3[i] - first * rounded -
                                         3.0f * second * most * by);

    return third * most * most * most > j ? takt_single_cbrt(j / third) : most;
}

/* The highest rate of a piece that may still change by so much. */
static float most_of_piece(const struct verifier_need *need, const struct route_slots *slots,
                           float by, float rounding_s)
{
    float most = RATE_MAX;

    for (unsigned i = 0; i < slots->count; i++) {
        most = most_of_axis(need, slots, by, by / rounding_s, i, most);
    }
    return most;
}

void takt_verifier_rate(const struct verifier_need *need, const struct route *r, uint32_t element,
                        const struct verifier_change *change, struct verifier_rate *rate)
{
    const float rounding_s = (float)change->rounding_s;

    rate->by = (float)change->by;
    rate->most = most_of_piece(need, &r->slots, rate->by, rounding_s);
    const float enough = NEARLY * single_min(1.0f, rate->most);

    while (2.0f * rate->by <= (float)change->wanted) {
        const float most = most_of_piece(need, &r->slots, 2.0f * rate->by, rounding_s);

        if (most < enough) {
            break;
        }
        rate->by *= 2.0f;
        rate->most = most;
    }
    TAKT_ASSERT(rate->most >= 0.0f && rate->most <= RATE_MAX);
    rate->programmed = takt_verifier_programmed(need, r, element);
}

/* What is left at a rate for r' and r'' = r'/R, R the rounding: see most_of_axis(). */
static float change_of_axis(const struct verifier_need *need, const struct route_slots *slots,
                            float rounding_s, unsigned i, float rate, float by)
{
    const float first = need->first[i];
    const float second = need->second[i];
    const float a = LIMIT * slots->acceleration_mm_s2[i] - second * rate * rate;
    const float j = LIMIT * slots->jerk_mm_s3[i] - need->third[i] * rate * rate * rate;
    const float per_by = first / rounding_s + 3.0f * second * rate;

    by = first * by > a ? a / first : by;
    return per_by * by > j ? j / per_by : by;
}

float takt_verifier_change_on(const struct verifier_need *need, const struct route *r,
                              const struct verifier_change *change,
                              const struct verifier_rate *rate)
{
    const float rounding_s = (float)change->rounding_s;
    const float at = single_min(1.0f, rate->most);
    float by = rate->by;
    float most = CHANGE_MOST * by;

    for (unsigned i = 0; i < r->slots.count; i++) {
        most = change_of_axis(need, &r->slots, rounding_s, i, at, most);
    }
    while (2.0f * by <= most) {
        by *= 2.0f;
    }
    return by;
}
