/*
 * Derivatives are bounded over parts of the way: with u, r and q between the values at both ends,
 * which they pass from one to the other without turning back (formulas: hold.c).
 */
#include "motion/hold_axes.h"

#include "smooth/single.h"

/*
 * Where the axes hardly move: the rate changes by no more than this part of what it began with in a
 * cycle.
 */
#define CHANGE_PART 0.2f

/* Rounding. */
#define SLACK 1e-5f

/*
 * What is tried in a cycle is looked at on so many pieces in all: what was found before can always
 * be gone on with.
 */
#define LOOKED_MAX 72

static inline struct range between(float a, float b)
{
    return a < b ? (struct range){a, b} : (struct range){b, a};
}

/* By something that is not below 0. */
static inline struct range times(struct range a, struct range by)
{
    return (struct range){a.low * (a.low < 0.0f ? by.high : by.low),
                          a.high * (a.high < 0.0f ? by.low : by.high)};
}

static inline struct range plus(struct range a, struct range b)
{
    return (struct range){a.low + b.low, a.high + b.high};
}

static inline bool is_within(struct range a, float limit)
{
    return a.high <= limit && a.low >= -limit;
}

/* Rate, size of the change, and products of them; the sign of the change, and w by that sign. */
struct part {
    struct range rate, change;
    struct range rate2, rate3;
    struct range three_rate_change;
    float sign;
    float w;
};

static struct range size_between(float a, float b)
{
    return between(single_abs(a), single_abs(b));
}

static struct part part_of(const struct hold_trial *a, const struct hold_trial *b, float w)
{
    const float sign = a->change < 0.0f || b->change < 0.0f ? -1.0f : 1.0f;
    struct part p = {
        .rate = between(a->rate, b->rate),
        .change = size_between(a->change, b->change),
        .sign = sign,
        .w = sign * w,
    };
    const struct range three = {3.0f * p.rate.low, 3.0f * p.rate.high};

    p.rate2 = times(p.rate, p.rate);
    p.rate3 = times(p.rate2, p.rate);
    p.three_rate_change = times(three, p.change);
    return p;
}

static inline struct range by_sign(struct range a, float sign)
{
    return sign < 0.0f ? (struct range){-a.high, -a.low} : a;
}

/*
 * Axis i on a piece from f to g of it. Both sums by the sign of the change:
 *     x' |q| + sign x'' r^2            x' (sign w) + 3 x'' r |q| + sign x''' r^3
 */
static bool axis_can(const struct hold *h, const float *piece, unsigned i, float f, float g,
                     const struct part *p)
{
    const float start = piece[i];
    const float bend = piece[h->axes + i];
    const float third = piece[2 * h->axes + i] - bend;

    if (start == 0.0f && bend == 0.0f && third == 0.0f) {
        return true;
    }
    const float bent = bend != 0.0f || third != 0.0f ? 1.0f : 0.0f;
    const float off = bent * h->off_second;
    const float off_third = bent * h->off_third;
    const float twist = p->sign * third;
    const float sag = single_abs(third) * (g - f) * (g - f) * 0.125f + off;
    const struct range at =
        between(start + f * (bend + 0.5f * f * third), start + g * (bend + 0.5f * g * third));
    const struct range first = {at.low - sag, at.high + sag};
    const struct range bends = between(bend + f * third, bend + g * third);
    const struct range second = {bends.low - off, bends.high + off};
    const struct range a = plus(times(first, p->change), times(by_sign(second, p->sign), p->rate2));
    const struct range j =
        plus(plus(between(first.low * p->w, first.high * p->w),
                  times((struct range){twist - off_third, twist + off_third}, p->rate3)),
             times(second, p->three_rate_change));

    return is_within(times(first, p->rate), h->velocity[i] * (1.0f + SLACK)) &&
           is_within(a, h->acceleration[i]) && is_within(j, h->jerk[i]);
}

/* The feed and the axes on a piece. */
static bool piece_can(struct hold *h, uint32_t k, float f, float g, const struct part *p)
{
    const float *piece = hold_piece(h, k);

    if (++h->looked > LOOKED_MAX) {
        return false;
    }
    if (p->rate.high > piece[hold_stride(h->axes) - 1]) {
        return false;
    }
    for (unsigned i = 0; i < h->axes; i++) {
        if (!axis_can(h, piece, i, f, g, p)) {
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

    if (b->at < a->at || last >= h->end - h->here) {
        return false;
    }
    for (uint32_t i = first; i <= last; i++) {
        const float f = i == first ? a->at - (float)i : 0.0f;
        const float g = i == last ? b->at - (float)i : 1.0f;

        if (!piece_can(h, h->here + i, f, g, &p)) {
            return false;
        }
    }
    return true;
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
    const float most = CHANGE_PART * (float)h->top;
    struct range w = {-most, most};

    for (unsigned i = 0; i < h->axes; i++) {
        const float bend = p[h->axes + i];
        const float third = p[2 * h->axes + i] - bend;
        const float first = p[i] + f * (bend + 0.5f * f * third);

        w = over(left_of(h, i, first, bend + f * third, third), first, w);
    }
    return w;
}
