/*
 * The backward pass over the pieces of a ceiling: the feed at the end of each from which what
 * follows can be met, and the last one stopped at, by constant deceleration: u = min(c^2,
 * u_next + 2 a L), u the feed squared.
 */
#include "plan/ceiling_backward.h"

#include "base/assert.h"
#include "base/maths.h"
#include "plan/ceiling.h"
#include "smooth/single.h"

/* Below this a square is 0, mm2/cycle2: what is above has all digits in single precision. */
#define FEED_SQUARED_MIN 1e-30

/*
 * The feed of single precision whose square is not above a square, mm2/cycle2: three steps below
 * the highest at most.
 */
static float feed_below(const struct ceiling *c, double feed_squared)
{
    float feed_mm_s = single_sqrt((float)feed_squared) / (float)c->cycle_s;

    if (feed_squared < FEED_SQUARED_MIN) {
        return 0.0F;
    }
    while (maths_square(ceiling_feed(c, feed_mm_s)) > feed_squared) {
        feed_mm_s = takt_maths_float_below((double)feed_mm_s * (1.0 - 0x1p-25));
    }
    return feed_mm_s;
}

/* Ceiling of a piece, and feed at its end: as the overrides are, or at their highest. */
static float feed_of(const struct ceiling *c, uint32_t k, bool highest)
{
    return highest ? takt_ceiling_top_feed(c, k) : c->piece[k].feed_mm_s;
}

static float end_feed_of(const struct ceiling_piece *p, bool highest)
{
    return highest ? p->end_feed_max_mm_s : p->end_feed_mm_s;
}

/* Feed at the beginning of a piece from which its end can be met: u = min(c^2, u_end + 2 a L). */
static float begin_feed(const struct ceiling *c, uint32_t k, float feed_mm_s, float end_mm_s)
{
    if (end_mm_s >= feed_mm_s) {
        return feed_mm_s;
    }
    const double length_mm = c->end_mm[k] - (k == 0 ? 0.0 : c->end_mm[k - 1]);
    const double feed_squared = maths_square(ceiling_feed(c, end_mm_s)) +
                                2.0 * (double)c->piece[k].acceleration * length_mm;

    TAKT_ASSERT(length_mm >= 0.0);
    return feed_squared < maths_square(ceiling_feed(c, feed_mm_s)) ? feed_below(c, feed_squared)
                                                                   : feed_mm_s;
}

/*
 * The feed up to feed at which the trapezoidal reference, when the setpoint is on a landed
 * junction, in piece k, can go on and meet what follows: it is then half the next span's window
 * ahead, at x; by the pieces up to there w is no more than their ceilings, and w^2 <= u + 2 a
 * (x_end - x).
 */
static float landed_feed(const struct ceiling *c, uint32_t k, enum ramp_profile profile,
                         bool highest)
{
    const float feed_mm_s = c->piece[k].feed_mm_s;
    const double start_mm = c->end_mm[k];
    double feed = ceiling_feed(c, feed_mm_s);
    uint32_t i = k + 1;

    if (i == c->count) {
        return feed_mm_s;
    }
    const double cycles =
        0.5 * (double)takt_ramp_profile_window_cycles(profile, takt_ceiling_cycles(c, i)) + 1.0;
    const double hold_mm = feed * cycles;

    while (i < c->count && c->end_mm[i] - start_mm < hold_mm) {
        feed = maths_min(feed, ceiling_feed(c, feed_of(c, i, highest)));
        feed = maths_min(feed, ceiling_feed(c, end_feed_of(&c->piece[i], highest)));
        i++;
    }
    if (i < c->count) {
        const struct ceiling_piece *p = &c->piece[i];
        const double a = (double)p->acceleration;
        const double m = a * cycles;
        const double feed_squared = maths_square(ceiling_feed(c, end_feed_of(p, highest))) +
                                    2.0 * a * (c->end_mm[i] - start_mm);

        feed = maths_min(feed, ceiling_feed(c, feed_of(c, i, highest)));
        feed = maths_min(feed, maths_sqrt(m * m + maths_max(0.0, feed_squared)) - m);
    }
    return takt_maths_float_below(feed / c->cycle_s);
}

/*
 * What the trapezoidal reference may do in a piece from which feeds at its end are known; they
 * become those at its beginning. Under no override is it faster there than under the highest one:
 * an override may be raised at any place.
 */
static void plan_piece(struct ceiling *c, uint32_t k, enum ramp_profile profile, float *feed_mm_s,
                       float *max_mm_s)
{
    struct ceiling_piece *p = &c->piece[k];
    const float end_mm_s = p->end == CEILING_STOPS ? 0.0F : *feed_mm_s;
    const float end_max_mm_s = p->end == CEILING_STOPS ? 0.0F : *max_mm_s;
    float top_mm_s = takt_ceiling_top_feed(c, k);

    p->end_feed_mm_s = end_mm_s;
    p->end_feed_max_mm_s = end_max_mm_s;
    if (p->end == CEILING_LANDS) {
        top_mm_s = landed_feed(c, k, profile, true);
        p->feed_mm_s = landed_feed(c, k, profile, false);
        p->end_feed_max_mm_s = top_mm_s;
    }
    *max_mm_s = begin_feed(c, k, top_mm_s, end_max_mm_s);
    *feed_mm_s = single_min(begin_feed(c, k, p->feed_mm_s, end_mm_s), *max_mm_s);
    TAKT_ASSERT(*feed_mm_s >= 0.0F && *feed_mm_s <= p->feed_mm_s);
}

/*
 * Between a piece and the junction that the span ends with: the pieces that ask for no more than
 * any behind them.
 */
static void note_lowest(struct ceiling *c, uint32_t k, float *low_mm_s)
{
    struct ceiling_piece *p = &c->piece[k];

    if (p->landing == CEILING_NONE || k + 1U >= p->landing) {
        *low_mm_s = (float)MATHS_INFINITY;
        return;
    }
    p->lowest = p->end_feed_mm_s <= *low_mm_s;
    *low_mm_s = p->lowest ? p->end_feed_mm_s : *low_mm_s;
}

void takt_ceiling_plan_backward(struct ceiling *c, enum ramp_profile profile)
{
    float feed_mm_s = 0.0F;
    float max_mm_s = 0.0F;
    float low_mm_s = 0.0F;
    unsigned landing = CEILING_NONE;
    bool open = true;

    c->open_from = c->count;
    for (uint32_t k = c->count; k-- > 0;) {
        struct ceiling_piece *p = &c->piece[k];

        landing = p->end == CEILING_STOPS ? CEILING_NONE : p->end == CEILING_LANDS ? k : landing;
        open =
            open && (p->end == CEILING_GOES_ON || (p->end == CEILING_LANDS && k + 1 == c->count));
        c->open_from = open ? k : c->open_from;
        p->landing = landing & CEILING_NONE;
        plan_piece(c, k, profile, &feed_mm_s, &max_mm_s);
        note_lowest(c, k, &low_mm_s);
    }
}
