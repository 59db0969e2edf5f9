/*
 * Goal: at every junction passed in motion, the setpoints keep the axes' limits although velocity
 * steps by D v (D the change of tangent) and acceleration by K v^2 (K the change of curvature
 * vector).
 *
 * What a step costs. Setpoints are samples of the path, one a cycle. The third difference of
 * samples over cycle^3 is the mean of the jerk over three cycles with the quadratic B-spline as
 * weight, whose peak is 3/4 per cycle and whose slope is at most 1 per cycle^2. A step of
 * acceleration (a spike of jerk) therefore shows as at most 3/4 K v^2 / cycle, a step of velocity
 * (a double spike) as D v / cycle^2. Likewise the second difference shows a step of velocity as at
 * most D v / cycle. So with
 *
 *     P = max_i D_i / (J_i cycle^2),  Q = max_i 3/4 K_i / (J_i cycle),  R = max_i D_i / (A_i cycle)
 *
 * a junction at feed v uses the part P v + Q v^2 of the jerk limit and R v of the acceleration
 * limit. The blocks beside it leave it that part (block.c): up to BLOCK_JERK_BUDGET_MAX.
 *
 * The line between two setpoints leaves out the corner, by D v cycle / 4 at most: |D| v
 * cycle / 4 <= d over the axes X, Y, Z, and d what a chord may be off. It binds where a cycle is
 * long beside what the axes can do. Where the motions have a tolerance P, what curves beside the
 * corner take counts, too: |D| v cycle / 4 + k v^2 cycle^2 / 8 <= P, k the larger curvature.
 *
 * Short blocks. Junctions less than three cycles apart add up. With f = min(1, d / (6 cycles)), d
 * the time of the shorter block beside a junction at its ceiling, a junction may use f of the jerk
 * budget. If several fall into three cycles, each block between them, of time D_b, bounds f by
 * D_b / (6 cycles) for the junctions at its two ends, and the D_b add up to less than three cycles:
 * the sum of all f is below 1. That needs the ceilings of short blocks to agree with d, so they are
 * lowered. Each block that can fall into the same three cycles as a junction (jerk_budget.c) leaves
 * it (what the junction takes) / f: what all junctions of those three cycles take together is then
 * at most what each block in them leaves.
 *
 * Rejected: one fixed corner feed (wrong for every other cycle time and angle); using the limit in
 * full at each junction (two junctions in three cycles then break it, seen as jerk of 1.4 times the
 * limit on chains of 0.1 mm blocks).
 */
#include "plan/junction.h"

#include "base/assert.h"
#include "base/maths.h"
#include "plan/ramp_profile.h"

/* The line between two setpoints is near enough while turn v + bend v^2 <= within_mm. */
struct nearness {
    double turn_s;
    double bend_s2_mm;
    double within_mm;
};

struct junction_steps {
    double p_s_mm;   /* P, s/mm */
    double q_s2_mm2; /* Q, s2/mm2 */
    double r_s_mm;   /* R, s/mm */
    struct nearness chord;
    struct nearness tolerance;
};

/* Tangent and curvature by the path, at a place of a block's curve. */
static void measure_at(const struct block *b, double at_mm, struct point *t, struct point *k)
{
    takt_curve_tangent(&b->curve, at_mm, t);
    takt_curve_curvature(&b->curve, at_mm, k);
    for (int i = 0; i < AXIS_COUNT; i++) {
        t->at[i] *= b->scale;
        k->at[i] *= b->scale * b->scale;
    }
}

/* What a block's motion may leave its path by; infinite: it is exact. */
static double tolerance_of(const struct block *b)
{
    return b->move.path == PATH_BLEND && b->move.tolerance_mm > 0.0 ? b->move.tolerance_mm
                                                                    : MATHS_INFINITY;
}

/* d v cycle / 4 + k v^2 cycle^2 / 8 <= within, d the change of tangent and k the curvature. */
static struct nearness nearness_of(double d, double k, double within_mm, double cycle_s)
{
    TAKT_ASSERT(d >= 0.0 && k >= 0.0 && within_mm > 0.0);
    if (within_mm == MATHS_INFINITY) {
        return (struct nearness){0.0, 0.0, 0.0};
    }
    return (struct nearness){0.25 * d * cycle_s, 0.125 * k * cycle_s * cycle_s, within_mm};
}

/* The largest v of a junction by itself. */
static double near_alone(const struct nearness *n)
{
    const double root =
        n->turn_s + maths_sqrt(n->turn_s * n->turn_s + 4.0 * n->bend_s2_mm * n->within_mm);

    return root > 0.0 ? 2.0 * n->within_mm / root : MATHS_INFINITY;
}

/* Of v / reach corners on a line: turn v^2 / reach + bend v^2 <= within. */
static double near_crowded(const struct nearness *n, double reach_mm_s)
{
    const double square = n->turn_s / reach_mm_s + n->bend_s2_mm;

    TAKT_ASSERT(reach_mm_s > 0.0);
    return square > 0.0 ? maths_sqrt(n->within_mm / square) : MATHS_INFINITY;
}

static void junction_measure(const struct block *before, const struct block *after,
                             const struct plan_limits *limits, struct junction_steps *steps)
{
    const double cycle = limits->cycle_s;
    struct point t0, t1, k0, k1;

    TAKT_ASSERT(before->curve.length_mm > 0.0 && after->curve.length_mm > 0.0);
    measure_at(before, before->curve.length_mm, &t0, &k0);
    measure_at(after, 0.0, &t1, &k1);
    static const struct point straight;
    const double curvature = maths_max(point_distance(&k0, &straight, AXIS_COUNT),
                                       point_distance(&k1, &straight, AXIS_COUNT));
    const double tolerance_mm = maths_min(tolerance_of(before), tolerance_of(after));

    *steps =
        (struct junction_steps){.chord = nearness_of(point_distance(&t0, &t1, AXIS_LINEAR_COUNT),
                                                     0.0, limits->chord_error_max_mm, cycle),
                                .tolerance = nearness_of(point_distance(&t0, &t1, AXIS_COUNT),
                                                         curvature, tolerance_mm, cycle)};
    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes >> i & 1U) != 0) {
            const double d = maths_abs(t1.at[i] - t0.at[i]);
            const double k = maths_abs(k1.at[i] - k0.at[i]);
            const double j = limits->jerk_mm_s3[i] * cycle;

            steps->p_s_mm = maths_max(steps->p_s_mm, d / (j * cycle));
            steps->q_s2_mm2 = maths_max(steps->q_s2_mm2, JUNCTION_CURVATURE * k / j);
            steps->r_s_mm = maths_max(steps->r_s_mm, d / (limits->acceleration_mm_s2[i] * cycle));
        }
    }
}

/*
 * Largest v with P v + Q v^2 <= jerk budget, R v <= acceleration, and the corner near enough: a
 * junction by itself.
 */
static double alone_feed(const struct junction_steps *steps)
{
    const double p = steps->p_s_mm;
    const double q = steps->q_s2_mm2;
    const double root = p + maths_sqrt(p * p + 4.0 * q * BLOCK_JERK_BUDGET_MAX);
    const double by_jerk = root > 0.0 ? 2.0 * BLOCK_JERK_BUDGET_MAX / root : MATHS_INFINITY;
    const double by_acceleration =
        steps->r_s_mm > 0.0 ? JUNCTION_ACCELERATION / steps->r_s_mm : MATHS_INFINITY;

    return maths_min(maths_min(by_jerk, by_acceleration),
                     maths_min(near_alone(&steps->chord), near_alone(&steps->tolerance)));
}

/*
 * The same with f = reach / v, reach = length / (6 cycles) the feed at which blocks stop being
 * short: P v^2 + Q v^3 <= jerk budget reach, R v^2 <= acceleration reach, and near enough. v0,
 * where the larger of the first two terms meets the right side, then scaled by the root of the
 * excess: exact for one term, safe for both.
 */
static double crowded_feed(const struct junction_steps *steps, double reach_mm_s)
{
    const double right = BLOCK_JERK_BUDGET_MAX * reach_mm_s;
    const double p = steps->p_s_mm;
    const double q = steps->q_s2_mm2;
    double v = MATHS_INFINITY;

    TAKT_ASSERT(reach_mm_s > 0.0);
    if (p > 0.0) {
        v = maths_min(v, maths_sqrt(right / p));
    }
    if (q > 0.0) {
        v = maths_min(v, takt_maths_cbrt(right / q));
    }
    if (p > 0.0 || q > 0.0) {
        v *= maths_sqrt(right / (p * v * v + q * v * v * v));
    }
    if (steps->r_s_mm > 0.0) {
        v = maths_min(v, maths_sqrt(JUNCTION_ACCELERATION * reach_mm_s / steps->r_s_mm));
    }
    return maths_min(v, maths_min(near_crowded(&steps->chord, reach_mm_s),
                                  near_crowded(&steps->tolerance, reach_mm_s)));
}

/*
 * 1/f: how many times shorter than JUNCTION_CYCLES_APART the shorter block beside a junction lasts
 * at its ceiling.
 */
static double junction_crowding(const struct block *before, const struct block *after,
                                double apart_s)
{
    const double rate_per_s = maths_max(takt_block_top_feed(before) / before->length_mm,
                                        takt_block_top_feed(after) / after->length_mm);

    TAKT_ASSERT(before->length_mm > 0.0 && after->length_mm > 0.0);
    return maths_max(1.0, apart_s * rate_per_s);
}

/* Share of jerk for a junction at feed v: the part of the limits it takes, over f. */
static double junction_jerk_budget(const struct junction_steps *steps, double v, double crowding)
{
    const double jerk = steps->p_s_mm * v + steps->q_s2_mm2 * v * v;
    const double acceleration = steps->r_s_mm * v * (BLOCK_JERK_BUDGET_MAX / JUNCTION_ACCELERATION);

    TAKT_ASSERT(v >= 0.0 && crowding >= 1.0);
    return maths_min(BLOCK_JERK_BUDGET_MAX, maths_max(jerk, acceleration) * crowding);
}

/*
 * Keeps d true: a block of length L is passed no faster than L / d, or than it would be if it were
 * not short.
 */
static double short_ceiling(const struct block *b, double v, double shorter_mm, double apart_s)
{
    return maths_max(v * b->length_mm / shorter_mm, b->length_mm / apart_s);
}

/* -- to pass a junction, or to stop -- */

/*
 * Time of a ramp from one feed to another: F/A + A/J, or 2 sqrt(F/J) where full acceleration is not
 * reached.
 */
static double ramp_s(double change_mm_s, double a, double j)
{
    TAKT_ASSERT(change_mm_s >= 0.0 && a > 0.0 && j > 0.0);
    return change_mm_s * j >= a * a ? change_mm_s / a + a / j : 2.0 * maths_sqrt(change_mm_s / j);
}

/*
 * The feed that a ramp from rest over a length reaches, by full acceleration or by full jerk: V
 * T(V) / 2 = L.
 */
static double feed_over(double length_mm, double a, double j)
{
    TAKT_ASSERT(length_mm > 0.0 && a > 0.0 && j > 0.0);
    return maths_min(maths_sqrt(2.0 * length_mm * a), takt_maths_cbrt(length_mm * length_mm * j));
}

/*
 * The blocks beside a junction, as if they had the lower limits of both: jerk J and acceleration A
 * for ramps if the axes stop there, J (1 - S) if they pass at v < V, V the feed that they reach.
 * Each way a ramp from V down to v loses T (V - v) / 2V of the time at V.
 */
static bool is_worth_passing(const struct block *before, const struct block *after, double v,
                             double jerk_budget, double cycle_s)
{
    TAKT_ASSERT(before->jerk_budget < 1.0 && after->jerk_budget < 1.0 && jerk_budget >= 0.0 &&
                jerk_budget < 1.0);
    if (v < JUNCTION_LEAST_CYCLES * before->j_mm_s3 * cycle_s * cycle_s) {
        return false;
    }
    const double a = maths_min(before->a_mm_s2, after->a_mm_s2);
    const double j = maths_min(before->j_mm_s3 / (1.0 - before->jerk_budget),
                               after->j_mm_s3 / (1.0 - after->jerk_budget));
    const double length_mm = maths_min(before->length_mm, after->length_mm);
    const double top = maths_min(maths_min(takt_block_top_feed(before), takt_block_top_feed(after)),
                                 feed_over(length_mm, a, j));
    const double fall = maths_max(0.0, top - v);

    return ramp_s(fall, a, j * (1.0 - jerk_budget)) * fall <=
           JUNCTION_WORTH * ramp_s(top, a, j) * top;
}

/*
 * The trapezoidal reference brakes in whole cycles, and so comes to a low feed too late: by half of
 * a cycle's way at the feed before, or by a cycle2 / 8 at most. The two cycles by which a ceiling
 * begins earlier (ceiling.h) make up for that if it is at least a quarter of that feed, or a
 * cycle / 16. A slower block is come to at rest.
 */
static bool is_too_slow(const struct block *before, const struct block *after, double cycle_s)
{
    const double top = takt_block_top_feed(after);

    return 4.0 * top < takt_block_top_feed(before) && 16.0 * top < before->a_mm_s2 * cycle_s;
}

void takt_junction_stop(struct block *b)
{
    b->end = JUNCTION_STOP;
    b->feed_junction_mm_s = 0.0;
    b->jerk_budget_junction = 0.0;
}

static void junction_pass(struct block *before, const struct block *after, double v,
                          double jerk_budget)
{
    const double top = maths_min(takt_block_top_feed(before), takt_block_top_feed(after));

    TAKT_ASSERT(v > 0.0 && jerk_budget >= 0.0 && jerk_budget <= BLOCK_JERK_BUDGET_MAX);
    before->end = v >= top ? JUNCTION_PASSED : JUNCTION_REDUCED;
    before->feed_junction_mm_s = v;
    before->jerk_budget_junction = jerk_budget;
}

/*
 * Does a block lose nothing by going along at the feed v < V of a junction beside it? By its
 * programmed feed it is no faster; or at v it takes no longer than what that junction makes of its
 * time anyway: half of it from rest to rest, 2 L / F where that reaches F T(F) = L; and half of
 * what it takes to land at v, which it must keep for the windows of ramps before, and to get up to
 * V and back.
 */
static bool may_keep(const struct block *b, double v, double top, const struct plan_limits *limits)
{
    const double j = b->j_mm_s3;

    if (v >= b->feed_program_mm_s) {
        return true;
    }
    if (b->length_mm > v * ramp_s(v, b->a_mm_s2, j)) {
        return false;
    }
    const double a = maths_min(b->a_mm_s2, maths_sqrt(top * j));
    const double window_s = takt_ramp_profile_windows(limits->profile) * a / j;

    return b->length_mm <= v * (0.5 * window_s + ramp_s(top - v, a, j));
}

/*
 * The feed V that the blocks beside a junction of feed v allow: v, if one of them loses nothing by
 * it, the shorter one first.
 */
static double meet_at(struct block *before, struct block *after, double v,
                      const struct plan_limits *limits)
{
    const double top = maths_min(takt_block_top_feed(before), takt_block_top_feed(after));
    struct block *beside[] = {before, after};

    if (after->length_mm < before->length_mm) {
        beside[0] = after;
        beside[1] = before;
    }
    for (unsigned i = 0; i < 2 && v < top; i++) {
        if (may_keep(beside[i], v, top, limits)) {
            takt_block_cap_feed(beside[i], v, GOVERNOR_SHORT);
            return v;
        }
    }
    return top;
}

void takt_junction_form(struct block *before, struct block *after, const struct plan_limits *limits)
{
    const double apart_s = JUNCTION_CYCLES_APART * limits->cycle_s;
    const double shorter_mm = maths_min(before->length_mm, after->length_mm);
    const double reach_mm_s = shorter_mm / apart_s;
    struct junction_steps steps;

    TAKT_ASSERT(block_is_motion(before) && block_is_motion(after));
    if (before->move.path == PATH_EXACT_STOP) {
        takt_junction_stop(before);
        return;
    }
    junction_measure(before, after, limits, &steps);
    double v = alone_feed(&steps);
    double top = maths_min(takt_block_top_feed(before), takt_block_top_feed(after));

    if (maths_min(v, top) > reach_mm_s) {
        v = crowded_feed(&steps, reach_mm_s);
    }
    top = meet_at(before, after, v, limits);
    const double jerk_budget =
        junction_jerk_budget(&steps, maths_min(v, top), junction_crowding(before, after, apart_s));

    if (is_too_slow(before, after, limits->cycle_s) ||
        (v < top && !is_worth_passing(before, after, v, jerk_budget, limits->cycle_s))) {
        takt_junction_stop(before);
        return;
    }
    takt_block_cap_feed(before, short_ceiling(before, v, shorter_mm, apart_s), GOVERNOR_SHORT);
    takt_block_cap_feed(after, short_ceiling(after, v, shorter_mm, apart_s), GOVERNOR_SHORT);
    junction_pass(before, after, v, jerk_budget);
}
