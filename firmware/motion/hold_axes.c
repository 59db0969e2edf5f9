/*
 * Derivatives are bounded over parts of the way: with u, r and q between the values at both ends,
 * which they pass from one to the other without turning back (formulas: hold.c).
 */
#include "motion/hold_axes.h"

#include "base/assert.h"
#include "smooth/single.h"

/*
 * Where the axes hardly move: the rate changes by no more than this part of what it began with in a
 * cycle.
 */
#define CHANGE_PART 0.2f

/* Parts that a way is looked at in. */
#define WAY_PARTS 4

/* Rounding. */
#define SLACK 1e-5f

/* All within `off` of mid, and none of it further than `most` from 0. */
struct spread {
    float mid;
    float off;
    float most;
};

static inline struct spread spread_between(float a, float b)
{
    return (struct spread){0.5f * (a + b), single_abs(0.5f * (b - a)),
                           single_max(single_abs(a), single_abs(b))};
}

/* What the rate and its change are on a part of the way, and products of them. */
struct part {
    float rate;
    struct spread change;
    struct spread rate2;
    struct spread rate3;
    struct spread three_rate_change;
    float w;
    float w_size;
};

static struct part part_of(const struct hold_trial *a, const struct hold_trial *b, float w)
{
    const float low = single_min(a->rate, b->rate);
    const float high = single_max(a->rate, b->rate);
    const bool falls = single_abs(a->change) < single_abs(b->change);
    const float less = falls ? a->change : b->change;
    const float more = falls ? b->change : a->change;

    return (struct part){
        .rate = high,
        .change = spread_between(less, more),
        .rate2 = spread_between(low * low, high * high),
        .rate3 = spread_between(low * low * low, high * high * high),
        .three_rate_change = spread_between(3.0f * low * less, 3.0f * high * more),
        .w = w,
        .w_size = single_abs(w),
    };
}

/* A part of a piece: its middle, and half its length. */
struct stretch {
    float mid;
    float half;
};

/* An axis on it: its derivatives in the middle, and how far off that they are at most. */
struct moves {
    float first, second, third;
    float off1, off2, off3;
};

/* x' is off by what x'' makes of half the length and by the sag of x''', x'' by what x''' makes. */
static inline struct moves moves_of(const struct hold *h, const float *piece, unsigned i,
                                    const struct stretch *s)
{
    const float start = piece[i];
    const float bend = piece[h->axes + i];
    const float third = piece[2 * h->axes + i] - bend;
    const float bent = bend != 0.0f || third != 0.0f ? 1.0f : 0.0f;
    const float second = bend + s->mid * third;
    const float by_third = s->half * single_abs(third);
    const float off = bent * h->off_second;

    return (struct moves){
        .first = start + s->mid * (bend + 0.5f * s->mid * third),
        .second = second,
        .third = third,
        .off1 = s->half * (single_abs(second) + 0.5f * by_third) + off,
        .off2 = by_third + off,
        .off3 = bent * h->off_third,
    };
}

/* x' q + x'' r^2 and x' w + 3 x'' r q + x''' r^3 of axis i. */
static inline bool axis_can(const struct hold *h, unsigned i, const struct moves *m,
                            const struct part *p)
{
    const float size1 = single_abs(m->first);
    const float size2 = single_abs(m->second);
    const float a = single_abs(m->first * p->change.mid + m->second * p->rate2.mid) +
                    size1 * p->change.off + m->off1 * p->change.most + size2 * p->rate2.off +
                    m->off2 * p->rate2.most;
    const float j = single_abs(m->first * p->w + m->second * p->three_rate_change.mid +
                               m->third * p->rate3.mid) +
                    m->off1 * p->w_size + size2 * p->three_rate_change.off +
                    m->off2 * p->three_rate_change.most + single_abs(m->third) * p->rate3.off +
                    m->off3 * p->rate3.most;

    return (size1 + m->off1) * p->rate <= h->velocity[i] * (1.0f + SLACK) &&
           a <= h->acceleration[i] && j <= h->jerk[i];
}

void takt_hold_bound(const struct hold *h, float *piece)
{
    const struct stretch whole = {0.5f, 0.5f};
    float *most = piece + hold_stride(h->axes) - HOLD_BOUNDS;

    for (unsigned i = 0; i < HOLD_BOUNDS; i++) {
        most[i] = 0.0f;
    }
    for (unsigned i = 0; i < h->axes; i++) {
        const struct moves m = moves_of(h, piece, i, &whole);
        const float first = single_abs(m.first) + m.off1;
        const float second = single_abs(m.second) + m.off2;
        const float by_a = 1.0f / h->acceleration[i];
        const float by_j = 1.0f / h->jerk[i];

        most[0] = single_max(most[0], first / h->velocity[i]);
        most[1] = single_max(most[1], first * by_a);
        most[2] = single_max(most[2], second * by_a);
        most[3] = single_max(most[3], first * by_j);
        most[4] = single_max(most[4], second * by_j);
        most[5] = single_max(most[5], (single_abs(m.third) + m.off3) * by_j);
    }
}

/* Can all axes, even if one did the most of each of them, with one sign? */
static inline bool all_can(const float most[], const struct part *p)
{
    return most[0] * p->rate <= 1.0f &&
           most[1] * p->change.most + most[2] * p->rate2.most <= 1.0f - SLACK &&
           most[3] * p->w_size + most[4] * p->three_rate_change.most + most[5] * p->rate3.most <=
               1.0f - SLACK;
}

/* The feed and the axes on a piece. */
static bool piece_can(struct hold *h, uint32_t k, float f, float g, const struct part *p)
{
    const float *piece = hold_piece(h, k);
    const float *most = piece + hold_stride(h->axes) - HOLD_BOUNDS;
    const struct stretch s = {0.5f * (f + g), 0.5f * (g - f)};

    if (++h->looked > HOLD_LOOKED_MAX) {
        return false;
    }
    if (p->rate > most[-1] || all_can(most, p)) {
        return p->rate <= most[-1];
    }
    for (unsigned i = 0; i < h->axes; i++) {
        const struct moves m = moves_of(h, piece, i, &s);

        h->looked += HOLD_LOOKED_BY_AXIS;
        if (!axis_can(h, i, &m, p)) {
            return false;
        }
    }
    return true;
}

bool takt_hold_can_go(struct hold *h, const struct hold_trial *a, const struct hold_trial *b,
                      float w)
{
    const uint32_t first = (uint32_t)a->at;
    const uint32_t last = (uint32_t)b->at;
    const struct part p = part_of(a, b, w);

    h->looked += HOLD_LOOKED_BY_WAY;
    if (b->at < a->at || last >= h->end - h->here) {
        return false;
    }
    for (uint32_t k = first; k <= last; k++) {
        const uint32_t i = b->rate > a->rate ? last - (k - first) : k;
        const float f = i == first ? a->at - (float)i : 0.0f;
        const float g = i == last ? b->at - (float)i : 1.0f;

        if (!piece_can(h, h->here + i, f, g, &p)) {
            return false;
        }
    }
    return true;
}

/* u + r t + q t^2/2 + w t^3/6 */
void takt_hold_try(struct hold_trial *s, float w, float time)
{
    s->at += time * (s->rate + time * (0.5f * s->change + time * w * (1.0f / 6.0f)));
    s->rate = single_max(0.0f, s->rate + time * (s->change + 0.5f * time * w));
    s->change += time * w;
}

/*
 * What holds for all of the way together need not be looked at in parts; of these the first to be
 * looked at is where it is fastest: there it fails.
 */
bool takt_hold_can_pass(struct hold *h, struct hold_trial *s, float w, float time)
{
    struct hold_trial at[WAY_PARTS + 1] = {*s};

    for (unsigned i = 0; i < WAY_PARTS; i++) {
        at[i + 1] = at[i];
        takt_hold_try(&at[i + 1], w, time / (float)WAY_PARTS);
    }
    *s = at[WAY_PARTS];
    if (takt_hold_can_go(h, &at[0], s, w)) {
        return true;
    }
    const bool rises = s->rate > at[0].rate;

    for (unsigned i = 0; i < WAY_PARTS; i++) {
        const struct hold_trial *part = &at[rises ? WAY_PARTS - 1 - i : i];

        if (!takt_hold_can_go(h, part, part + 1, w)) {
            return false;
        }
    }
    return true;
}

bool takt_hold_can_change(struct hold *h, struct hold_trial *s, float to, float w)
{
    TAKT_ASSERT(w != 0.0f);
    if (s->change == to) {
        return true;
    }
    const bool can = takt_hold_can_pass(h, s, w, (to - s->change) / w);

    s->change = to;
    return can;
}

/*
 * What an axis has left for x' w in this cycle: of J beside 3 x'' r q + x''' r^3, of A beside x'
 * q + x'' r^2.
 */
static struct range left_of(const struct hold *h, unsigned i, float x1, float x2, float x3)
{
    const float r = (float)h->place.rate;
    const float q = (float)h->place.change;
    const float j = 3.0f * x2 * r * q + x3 * r * r * r;
    const float a = x1 * q + x2 * r * r;

    return (struct range){-single_min(h->jerk[i] + j, h->acceleration[i] + a),
                          single_min(h->jerk[i] - j, h->acceleration[i] - a)};
}

static float most_change(const struct hold *h)
{
    return CHANGE_PART * (float)h->top;
}

/* The part of the range of w that a range of x' w allows. */
static struct range over(struct range left, float x1, struct range w)
{
    const struct range by = x1 < 0.0f ? (struct range){-left.high, -left.low} : left;
    const float size = single_abs(x1);

    return (struct range){by.low > w.low * size ? by.low / size : w.low,
                          by.high < w.high * size ? by.high / size : w.high};
}

struct range takt_hold_steps(const struct hold *h)
{
    const float *p = hold_piece(h, h->here);
    const float f = (float)h->place.at;
    const float most = most_change(h);
    struct range w = {-most, most};

    for (unsigned i = 0; i < h->axes; i++) {
        const float bend = p[h->axes + i];
        const float third = p[2 * h->axes + i] - bend;
        const float first = p[i] + f * (bend + 0.5f * f * third);

        w = over(left_of(h, i, first, bend + f * third, third), first, w);
    }
    return w;
}

/* x' w within J, x' q within A and 3 x'' r q within J, of all axes. */
struct hold_ending takt_hold_hardest(const struct hold *h)
{
    const float least = 1.0f / most_change(h);
    const float rate = (float)h->place.rate;
    float ease = least;
    float peak = least;

    for (uint32_t k = h->here; k != h->end; k++) {
        const float *most = hold_piece(h, k) + hold_stride(h->axes) - HOLD_BOUNDS;

        ease = single_max(ease, most[3]);
        peak = single_max(peak, single_max(most[1], 3.0f * rate * most[4]));
    }
    return (struct hold_ending){(double)(1.0f / ease), (double)(1.0f / peak)};
}
