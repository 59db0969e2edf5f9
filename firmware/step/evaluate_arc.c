/*
 * Clockwise about the origin one coordinate grows in size, g, and one shrinks, s:
 *
 *     quadrant   0: a grows upwards,   b shrinks       (from the b axis to the a axis)
 *                1: b grows downwards, a shrinks
 *                2: a grows downwards, b shrinks
 *                3: b grows upwards,   a shrinks
 *
 * F = g^2 + s^2 - R^2 changes by 2 g + 1 with a step of g, by -2 s + 1 with one of s, by 2 g - 2
 * s + 2 with both. Improved: while g < s, the first 45 degrees, g steps at every tick and s with it
 * if F > 0; from there s, and g with it if F < 0. Plain: F < 0 steps g, F > 0 steps s, F = 0 the
 * leading one. So -2 R < F < 2 R, radially less than a step. In the quadrant with the end, where
 * both coordinates are monotone, the first that has its end value leaves the rest to a line on the
 * other. Source: seed 002, part A.
 */
#include "step/evaluate_arc.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* For the coordinates a, b in each quadrant: which one grows, and the signs of their steps. */
struct quadrant {
    unsigned grows;
    int step[2];
};

static const struct quadrant quadrants[4] = {
    {0, {1, -1}}, {1, {-1, -1}}, {0, {-1, 1}}, {1, {1, 1}}};

/*
 * The quadrant that begins at p or holds it: its growing coordinate may be 0 there, the shrinking
 * one not.
 */
static unsigned quadrant_of(const int64_t p[2])
{
    if (p[1] > 0 && p[0] >= 0) {
        return 0;
    }
    if (p[0] > 0) {
        return 1;
    }
    return p[1] < 0 ? 2 : 3;
}

/* Angle from the beginning of the quadrant: sin = g / R, cos = s / R. */
static double angle_in_quadrant(unsigned quadrant, const int64_t p[2])
{
    const unsigned g = quadrants[quadrant].grows;

    TAKT_ASSERT(quadrant < 4);
    return takt_maths_atan2((double)evaluate_size(p[g]), (double)evaluate_size(p[1U - g]));
}

static int64_t square_of(const int64_t p[2])
{
    return p[0] * p[0] + p[1] * p[1];
}

/* Quadrants that begin on the way from start to end. */
static unsigned quadrants_between(const int64_t start[2], const int64_t end[2], unsigned turns)
{
    const unsigned quarters = (quadrant_of(end) - quadrant_of(start)) % 4U;
    const bool behind = start[0] * end[1] - start[1] * end[0] > 0;

    return (quarters == 0U && behind ? 4U : quarters) + 4U * turns;
}

static void go_straight(struct evaluate_arc *arc)
{
    const int64_t rest[AXIS_COUNT] = {arc->end[0] - arc->at[0], arc->end[1] - arc->at[1]};

    arc->straight = true;
    takt_evaluate_line_begin(&arc->rest, arc->form, rest);
}

static void look_for_end(struct evaluate_arc *arc)
{
    const bool reached = arc->at[0] == arc->end[0] || arc->at[1] == arc->end[1];

    if (!arc->straight && arc->quadrants_left == 0U && reached) {
        go_straight(arc);
    }
}

void takt_evaluate_arc_begin(struct evaluate_arc *arc, const struct evaluate_arc_config *config)
{
    const unsigned first = config->clockwise ? 0U : 1U;

    memset(arc, 0, sizeof(*arc));
    arc->form = config->form;
    arc->swapped = !config->clockwise;
    for (unsigned i = 0; i < 2; i++) {
        arc->at[i] = config->start[i ^ first];
        arc->end[i] = config->end[i ^ first];
    }
    arc->quadrant = quadrant_of(arc->at);
    arc->quadrants_left = quadrants_between(arc->at, arc->end, config->turns);
    arc->radius = maths_sqrt((double)square_of(arc->at));
    arc->start_rad = angle_in_quadrant(arc->quadrant, arc->at);
    arc->sweep_rad = (double)arc->quadrants_left * MATHS_HALF_PI +
                     angle_in_quadrant(quadrant_of(arc->end), arc->end) - arc->start_rad;
    look_for_end(arc);
}

static bool grower_leads(const struct evaluate_arc *arc)
{
    const unsigned g = quadrants[arc->quadrant].grows;

    return evaluate_size(arc->at[g]) < evaluate_size(arc->at[1U - g]);
}

/* Which coordinates step: bit 0 the one that grows, bit 1 the one that shrinks. */
static unsigned choose(const struct evaluate_arc *arc)
{
    const bool lead = grower_leads(arc);

    if (arc->form == EVALUATE_PLAIN) {
        return arc->function < 0 || (arc->function == 0 && lead) ? 1U : 2U;
    }
    if (lead) {
        return arc->function > 0 ? 3U : 1U;
    }
    return arc->function < 0 ? 3U : 2U;
}

static void enter_next_quadrant(struct evaluate_arc *arc)
{
    TAKT_ASSERT(arc->quadrant < 4U);
    if (arc->quadrants_left == 0U) {
        go_straight(arc);
        return;
    }
    arc->quadrant = (arc->quadrant + 1U) % 4U;
    arc->passed++;
    arc->quadrants_left--;
}

/* Steps along the circle; returns the mask over a and b. */
static unsigned step_round(struct evaluate_arc *arc, unsigned *backwards)
{
    const struct quadrant *q = &quadrants[arc->quadrant];
    const unsigned g = q->grows;
    const unsigned s = 1U - g;
    const unsigned chosen = choose(arc);
    unsigned mask = 0;

    if ((chosen & 1U) != 0U) {
        arc->function += 2 * evaluate_size(arc->at[g]) + 1;
        arc->at[g] += q->step[g];
        mask |= 1U << g;
    }
    if ((chosen & 2U) != 0U) {
        arc->function += 1 - 2 * evaluate_size(arc->at[s]);
        arc->at[s] += q->step[s];
        mask |= 1U << s;
    }
    *backwards = (q->step[0] < 0 ? 1U : 0U) | (q->step[1] < 0 ? 2U : 0U);
    if (arc->at[s] == 0) {
        enter_next_quadrant(arc);
    }
    look_for_end(arc);
    return mask;
}

static unsigned step_straight(struct evaluate_arc *arc, unsigned *backwards)
{
    struct evaluate_tick tick;

    TAKT_ASSERT(arc->straight);
    (void)takt_evaluate_line_next(&arc->rest, &tick);
    for (unsigned i = 0; i < 2; i++) {
        if (evaluate_has(tick.axes, i)) {
            arc->at[i] += evaluate_has(tick.direction, i) ? -1 : 1;
        }
    }
    *backwards = tick.direction;
    return tick.axes;
}

static unsigned exchange_bits(unsigned mask)
{
    return (mask & 1U) << 1 | mask >> 1;
}

bool takt_evaluate_arc_next(struct evaluate_arc *arc, struct evaluate_tick *tick)
{
    unsigned backwards;
    unsigned mask;

    *tick = (struct evaluate_tick){0};
    if (arc->straight && arc->rest.left == 0) {
        return false;
    }
    mask = arc->straight ? step_straight(arc, &backwards) : step_round(arc, &backwards);
    backwards &= mask;
    tick->axes = (uint8_t)(arc->swapped ? exchange_bits(mask) : mask);
    tick->direction = (uint8_t)(arc->swapped ? exchange_bits(backwards) : backwards);
    return true;
}

/*
 * f0 = V max(|I|, |J|) / (h R), plain V (|I| + |J|) / (h R), with I and J of this place, brought
 * onto the circle
 */
double takt_evaluate_arc_rate(const struct evaluate_arc *arc)
{
    const double a = (double)evaluate_size(arc->at[0]);
    const double b = (double)evaluate_size(arc->at[1]);

    TAKT_ASSERT(arc->radius > 0.0);
    return (arc->form == EVALUATE_PLAIN ? a + b : maths_max(a, b)) / maths_sqrt(a * a + b * b);
}

double takt_evaluate_arc_angle(const struct evaluate_arc *arc)
{
    return (double)arc->passed * MATHS_HALF_PI + angle_in_quadrant(arc->quadrant, arc->at) -
           arc->start_rad;
}
