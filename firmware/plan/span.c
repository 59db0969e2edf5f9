/*
 * Goal: the averaging window with which a span takes the least time, without running the
 * trapezoidal reference through it.
 *
 * A long window lets ramps reach a high acceleration; with a short one the trapezoidal reference
 * comes later to a slow block, leaves it earlier, and waits less between speeding up and slowing
 * down. For some windows the time is predicted, by parts of equal limits laid where the trapezoidal
 * reference feels them. With N the first box, W the whole window, h = (W - 1)/2, c a feed a cycle:
 *
 *     feed |   ______ c1             into a slower part   h + 2 cycles before it, at that part's feed:  c2 (h + 2)
 *          |         |        ____   out of it            h cycles behind it:                           c2 h
 *          |         |_______|       a = min(A, J N)
 *          +---------+-------+----> trapezoidal reference
 *
 * Feed squared where parts begin is what both ends of the span and all ceilings allow, backwards
 * and then forwards: u = min(c^2, u_next + 2 a L). Where the feed rises and falls again without
 * being kept for W cycles, the peak is lower: W q = l + (p^2 - q^2)/a, l the way at the old peak p,
 * q the new one. A stop is come to W - 1 cycles after the trapezoidal reference.
 *
 * Each window costs one step for each part. Rejected: to lay the pieces of the ceiling themselves
 * for each window (ten times the cost, and no better choice); the window of the fastest block for
 * all (up to 17 % slower).
 */
#include "plan/span.h"

#include "base/assert.h"
#include "base/maths.h"

/* Parts looked at: what lies behind them counts as unknown. */
#define PARTS_MAX 32

/* Cycles by which a slower part begins earlier, beside h. */
#define MARGIN CEILING_MARGIN_CYCLES

/* A change of feed by less than this part of it is rounding. */
#define CHANGE_MIN 1e-6

/* Limits of blocks are of single precision: so much may be missing of a quotient of two. */
#define SINGLE 2.4e-7

/* mm and cycles */
struct part {
    double end_mm; /* of its blocks, from the start of the span */
    double feed;
    double a;
    double j;
};

struct span {
    double cycle_s;
    enum ramp_profile profile;
    double feed_start;
    double feed_end; /* 0: it rests there; below 0: the parts do not reach to its end */
    unsigned count;
    struct part part[PARTS_MAX];
};

/* A part where the trapezoidal reference feels it. */
struct laid {
    const struct part *part;
    double from_mm; /* the way of the trapezoidal reference from the start of the span */
    double a;
    double feed_squared; /* feed squared there */
};

struct trial {
    const struct span *span;
    double box;    /* N */
    double window; /* W */
    double behind; /* h */
    double end_mm; /* where the trapezoidal reference ends */
    unsigned count;
    struct laid laid[PARTS_MAX];
};

bool takt_span_stops(const struct path *path, uint32_t index)
{
    return path_at(path, index)->end == JUNCTION_STOP;
}

bool takt_span_lands(const struct path *path, uint32_t index)
{
    const struct path_block *b = path_at(path, index);

    return b->end == JUNCTION_REDUCED ||
           (b->end == JUNCTION_PASSED && path->limits.landing == LANDING_BLOCK && !b->smooth);
}

/* -- the parts of a span -- */

static bool is_known(const struct span *s)
{
    return s->feed_end >= 0.0;
}

/* False: there is no room for one more. */
static bool add_block(struct span *s, const struct path *path, uint32_t index,
                      const struct ceiling_request *asked)
{
    const struct path_block *b = path_at(path, index);
    const double t = s->cycle_s;
    struct part part = {
        .end_mm = takt_path_length(path, index),
        .feed = takt_ceiling_block_feed(path, index, asked) * t,
        .a = (double)b->a_mm_s2 * t * t,
        .j = (double)b->j_mm_s3 * t * t * t,
    };
    TAKT_ASSERT(part.end_mm > 0.0 && part.feed > 0.0 && part.a > 0.0 && part.j > 0.0);

    if (s->count > 0) {
        struct part *last = &s->part[s->count - 1];

        part.end_mm += last->end_mm;
        if (last->feed == part.feed && last->a == part.a && last->j == part.j) {
            last->end_mm = part.end_mm;
            return true;
        }
    }
    if (s->count == PARTS_MAX) {
        return false;
    }
    s->part[s->count++] = part;
    return true;
}

/* Closed blocks up to the end of the span; the first one even if it is not closed. */
static void survey(struct span *s, const struct path *path, const struct ceiling_request *request,
                   uint32_t index)
{
    const struct ceiling_request asked = {
        .feed_ratio = 1.0, .rapid_ratio = 1.0, .spindle_rev_s = request->spindle_rev_s};

    for (; !is_known(s); index++) {
        const struct path_block *b = path_at(path, index);

        if ((s->count > 0 && index == path->closed) || !b->motion ||
            !add_block(s, path, index, &asked) || index == path->closed) {
            return;
        }
        if (takt_span_stops(path, index) || takt_span_lands(path, index)) {
            s->feed_end = (double)b->feed_junction_mm_s * s->cycle_s;
        }
    }
}

/* Feed at which the span begins: of the junction before it, or rest. */
static double feed_at_start(const struct path *path, const struct ceiling_request *request,
                            uint32_t index)
{
    return index == request->first
               ? 0.0
               : (double)path_at(path, index - 1)->feed_junction_mm_s * path->limits.cycle_s;
}

/* -- the time it takes with a window -- */

/* Where a part begins for the trapezoidal reference, behind a part laid before. */
static double part_begin(const struct trial *t, const struct part *before, const struct part *part)
{
    const double early = part[-1].end_mm - part->feed * (t->behind + MARGIN);

    return part->feed < before->feed ? early
                                     : maths_max(early, before->end_mm + before->feed * t->behind);
}

/*
 * Lays the parts for the trapezoidal reference; one that others cover, up to the end or in between,
 * is left out.
 */
static void lay_parts(struct trial *t)
{
    const struct span *s = t->span;

    for (unsigned k = 0; k < s->count; k++) {
        const struct part *part = &s->part[k];
        double from_mm = s->feed_start * t->behind;

        for (; t->count > 0; t->count--) {
            const struct laid *last = &t->laid[t->count - 1];

            from_mm = part_begin(t, last->part, part);
            if (from_mm > last->from_mm) {
                break;
            }
            from_mm = last->from_mm;
        }
        TAKT_ASSERT(t->count < PARTS_MAX);
        t->laid[t->count++] =
            (struct laid){part, from_mm, maths_min(part->a, part->j * t->box), 0.0};
    }
    while (t->count > 1 && t->laid[t->count - 1].from_mm >= t->end_mm) {
        t->count--;
    }
}

/* The way of the trapezoidal reference through what is laid. */
static double laid_length(const struct trial *t, unsigned k)
{
    const double to_mm = k + 1 == t->count ? t->end_mm : t->laid[k + 1].from_mm;

    return maths_max(0.0, to_mm - t->laid[k].from_mm);
}

/* Feed squared at the end of the span, if the ceilings and the way to it allow. */
static double last_feed_squared(const struct trial *t)
{
    const struct laid *last = &t->laid[t->count - 1];

    TAKT_ASSERT(t->count > 0);
    return maths_min(maths_min(maths_square(last->part->feed), maths_square(t->span->feed_end)),
                     last->feed_squared + 2.0 * last->a * laid_length(t, t->count - 1));
}

static void plan_energies(struct trial *t)
{
    double feed_squared = maths_square(t->span->feed_end);

    for (unsigned k = t->count; k-- > 0;) {
        struct laid *p = &t->laid[k];
        const double ceiling = maths_square(p->part->feed);

        feed_squared =
            maths_min(ceiling, maths_min(feed_squared, ceiling) + 2.0 * p->a * laid_length(t, k));
        p->feed_squared = feed_squared;
    }
    feed_squared = maths_square(t->span->feed_start);
    for (unsigned k = 0; k < t->count; k++) {
        struct laid *p = &t->laid[k];

        p->feed_squared = maths_min(p->feed_squared, feed_squared);
        TAKT_ASSERT(p->feed_squared >= 0.0);
        feed_squared = maths_min(maths_square(p->part->feed),
                                 p->feed_squared + 2.0 * p->a * laid_length(t, k));
    }
}

struct walk {
    double cycles; /* so far */
    double
        kept_mm; /* at its feed since it rose last; infinite: it has fallen since, or not risen */
};

/* Falls from a peak that was kept for too short: what the lower peak takes more. */
static void lower_peak(struct walk *w, double window, double peak, double a)
{
    const double half = 0.5 * a * window;
    const double lower = maths_sqrt(half * half + peak * peak + a * w->kept_mm) - half;
    const double had = 2.0 * (peak - lower) / a + w->kept_mm / peak;

    TAKT_ASSERT(peak > 0.0 && a > 0.0);
    w->cycles += maths_max(0.0, window - had);
}

/*
 * Up from the feed at the start of what is laid to its highest, p^2 = (u + u_end)/2 + a L <= c^2,
 * and down again.
 */
static void pass_part(struct walk *w, const struct trial *t, unsigned k)
{
    const struct laid *p = &t->laid[k];
    const double length_mm = laid_length(t, k);
    const double end_feed_squared =
        k + 1 == t->count ? last_feed_squared(t) : t->laid[k + 1].feed_squared;
    const double both = p->feed_squared + end_feed_squared;
    const double from = maths_sqrt(p->feed_squared);
    const double to = maths_sqrt(end_feed_squared);
    const double peak = maths_min(p->part->feed, maths_sqrt(0.5 * both + p->a * length_mm));
    const double kept_mm = maths_max(0.0, length_mm - (2.0 * peak * peak - both) / (2.0 * p->a));

    if (!(peak > 0.0)) {
        return;
    }
    w->cycles += (2.0 * peak - from - to) / p->a + kept_mm / peak;
    if (peak - from > CHANGE_MIN * peak) {
        w->kept_mm = 0.0;
    }
    w->kept_mm += kept_mm;
    if (peak - to > CHANGE_MIN * peak) {
        if (w->kept_mm < t->window * peak) {
            lower_peak(w, t->window, peak, p->a);
        }
        w->kept_mm = MATHS_INFINITY;
    }
}

/* Cycles that a span that is known takes with a first box of this many. */
static double predict(const struct span *s, uint32_t box)
{
    const double window = (double)takt_ramp_profile_window_cycles(s->profile, box);
    const double behind = 0.5 * (window - 1.0);
    struct walk walk = {.cycles = s->feed_end == 0.0 ? window - 1.0 : 0.0,
                        .kept_mm = MATHS_INFINITY};
    struct trial t = {
        .span = s,
        .box = (double)box,
        .window = window,
        .behind = behind,
        .end_mm = s->part[s->count - 1].end_mm + s->feed_end * behind,
    };

    TAKT_ASSERT(box >= 1 && box <= takt_ramp_profile_cycles_max(s->profile));
    lay_parts(&t);
    plan_energies(&t);
    for (unsigned k = 0; k < t.count; k++) {
        pass_part(&walk, &t, k);
    }
    TAKT_ASSERT(walk.cycles >= 0.0);
    return walk.cycles;
}

/* -- the window -- */

/*
 * The longest first box N that can be of use, by a profile of windows w N: with A/J a ramp reaches
 * its full acceleration. A ramp to a feed F that does not, a = J N, takes F/a + w N: least with
 * sqrt(F/wJ). From rest to rest over L it takes twice R + w N, with L = a R (R + w N): least with
 * cbrt(L/2Jw^2).
 */
static uint32_t longest_box(const struct span *s)
{
    const double w = takt_ramp_profile_windows(s->profile);
    double cycles = 0.0;
    double j = MATHS_INFINITY;

    for (unsigned k = 0; k < s->count; k++) {
        const struct part *p = &s->part[k];

        cycles = maths_max(cycles, maths_min(p->a / p->j, maths_sqrt(p->feed / (w * p->j))));
        j = maths_min(j, p->j);
    }
    if (is_known(s)) {
        const double length_mm = s->part[s->count - 1].end_mm;

        cycles = maths_min(cycles, takt_maths_cbrt(length_mm / (2.0 * j * w * w)));
    }
    return (uint32_t)maths_clamp(takt_maths_ceil(cycles * (1.0 - SINGLE) - 1e-9), 1.0,
                                 takt_ramp_profile_cycles_max(s->profile));
}

/*
 * For one part from rest to rest the longest is the best: seven segments, or four, of the closed
 * form. So it is where the end of the span is out of sight: what is in sight may be a way up to
 * speed alone, on which every short window looks good.
 */
static uint32_t best_box(const struct span *s)
{
    static const double shorter[] = {0.85, 0.7, 0.55, 0.4, 0.25};
    const uint32_t longest = longest_box(s);

    if (!is_known(s) || (s->count == 1 && s->feed_end == 0.0 && s->feed_start == 0.0)) {
        return longest;
    }
    double least = predict(s, longest);
    uint32_t best = longest;

    for (unsigned i = 0; i < sizeof(shorter) / sizeof(shorter[0]); i++) {
        const uint32_t box =
            (uint32_t)maths_max(1.0, takt_maths_round(shorter[i] * (double)longest));
        const double cycles = predict(s, box);

        if (cycles < least) {
            least = cycles;
            best = box;
        }
    }
    return best;
}

uint32_t takt_span_window(const struct path *path, const struct ceiling_request *request,
                          uint32_t index, bool *known)
{
    struct span s = {
        .cycle_s = path->limits.cycle_s, .profile = path->limits.profile, .feed_end = -1.0};

    survey(&s, path, request, index);
    TAKT_ASSERT(s.count > 0);
    s.feed_start = maths_min(feed_at_start(path, request, index), s.part[0].feed);
    s.feed_end = maths_min(s.feed_end, s.part[s.count - 1].feed);
    *known = is_known(&s);
    return best_box(&s);
}
