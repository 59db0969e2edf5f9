/*
 * With the curve x(u), u in samples, and the rate r = u' of it, b = r^2: u'' = b'/2 and u''' = r
 * b''/2, so by the chain rule the axes need
 *
 *     x' b'/2 + x'' b                        within A d^2
 *     r (x' b''/2 + 3/2 x'' b' + x''' b)     within J d^3
 *
 * less what a change of rate needs there (verifier.h), at both ends of each piece: rows of the
 * three coefficients of b (Verscheure et al. 2009 have the first row; the second is theirs
 * differentiated once more). Least time, the sum of 1/sqrt(b), is found by a barrier method (Boyd
 * and Vandenberghe 2004, 11.3): Newton's steps on sum 1/sqrt(b) - mu sum log(slack)  while mu
 * falls. What is exceeded to begin with may stay so far off but no farther, and is drawn inside. So
 * every iteration keeps what the one before kept.
 */
#include "smooth/tempo.h"

#include "base/assert.h"
#include "smooth/single.h"
#include "smooth/verifier.h"

#include <string.h>

#define ITERATIONS 6

/*
 * The barrier's weight to begin with, and what is left of it after a step that went at least so
 * far.
 */
#define BARRIER      0.3f
#define BARRIER_LESS 0.4f
#define STEP_FAR     0.3f

/* Part of the way to the first limit in its direction that a step goes. */
#define STEP_PART 0.95f

/* The barrier's weight where a limit is exceeded, at least. */
#define DRAWN 0.03f

/* Where a row is nearer to its limit than this, that is so much farther off. */
#define NEAR    0.98f
#define FARTHER 1.02f

/*
 * What pieces need of an axis and what it has for that, in parts of what it may; how the need hangs
 * on three coefficients.
 */
struct row {
    lanes value;
    lanes most;
    lanes by[3];
};

/*
 * Changes of rate leave this part of what an axis may at least: verifier.c has bounds of its own.
 */
#define LEFT_LEAST 0.5f

/* What a change of rate leaves, or a little more than what is near it or beyond. */
static inline lanes limit_of(lanes size, lanes most)
{
    return lanes_choose(size > NEAR * most, FARTHER * size, most);
}

/* What a change of rate that needs a part leaves, of 1 or more, for the curve: 1 at most. */
static inline lanes left_by(lanes part, lanes of)
{
    return lanes_min(lanes_max(of - part, lanes_all(LEFT_LEAST)), lanes_all(1.0f));
}

/* b, its slope and the rate at an end of pieces, and what the rate grows by for a coefficient. */
struct end {
    lanes rate_squared, slope, rate, faster;
};

static struct end end_of(const float *rate_squared)
{
    const lanes before = lanes_at(rate_squared);
    const lanes after = lanes_at(rate_squared + 1);
    const lanes middle = 0.5f * (before + after);

    /* d rate / d squared rate = 1/2 / rate: half of that for each of the two coefficients */
    return (struct end){middle, after - before, lanes_sqrt(middle), 0.25f / middle};
}

/* What an axis does at an end of pieces: its differences, and what it needs there. */
struct motion_at {
    lanes first, half, second, acceleration, jerk, jerk_most;
};

/* J - x' r r'' - 3 r' |x' b'/2 + x'' b| */
static inline struct motion_at motion_at(const struct tempo *p, unsigned slot, unsigned piece,
                                         const struct end *e)
{
    const float per_unit = p->third_per_unit[slot];
    const size_t at = (size_t)slot * p->capacity + piece;
    struct motion_at m = {.first = lanes_at(p->first + at), .second = lanes_at(p->second + at)};

    m.half = 0.5f * m.first;
    m.acceleration = e->slope * m.half + e->rate_squared * m.second;
    m.jerk = e->rate * per_unit;
    const lanes needed =
        p->rounded * lanes_size(e->rate * m.first) + 3.0f * p->change * lanes_size(m.acceleration);

    m.jerk_most = left_by(per_unit * needed, lanes_all(p->third_all[slot]));
    return m;
}

static inline void rows_of(const struct tempo *p, unsigned slot, unsigned piece,
                           const struct end end[2], struct row row[TEMPO_ROWS])
{
    const struct motion_at m0 = motion_at(p, slot, piece, &end[0]);
    const struct motion_at m1 = motion_at(p, slot, piece + 1, &end[1]);
    const lanes third = m1.second - m0.second;
    const lanes bow = 0.5f * (end[1].slope - end[0].slope);
    const float a = p->second_per_unit[slot];

    row[0].value = a * m0.acceleration;
    row[0].most = left_by(p->change * end[0].rate * a * lanes_size(m0.first), lanes_all(1.0f));
    row[0].by[0] = a * (0.5f * m0.second - m0.half);
    row[0].by[1] = a * (0.5f * m0.second + m0.half);
    row[0].by[2] = lanes_all(0.0f);

    row[1].most = m0.jerk_most;
    row[1].value =
        m0.jerk * (bow * m0.first + 1.5f * end[0].slope * m0.second + end[0].rate_squared * third);
    const lanes faster0 = row[1].value * end[0].faster;
    row[1].by[0] = m0.jerk * (m0.half - 1.5f * m0.second + 0.5f * third) + faster0;
    row[1].by[1] = m0.jerk * (1.5f * m0.second - m0.first + 0.5f * third) + faster0;
    row[1].by[2] = m0.jerk * m0.half;

    row[2].most = m1.jerk_most;
    row[2].value =
        m1.jerk * (bow * m1.first + 1.5f * end[1].slope * m1.second + end[1].rate_squared * third);
    const lanes faster1 = row[2].value * end[1].faster;
    row[2].by[0] = m1.jerk * m1.half;
    row[2].by[1] = m1.jerk * (0.5f * third - m1.first - 1.5f * m1.second) + faster1;
    row[2].by[2] = m1.jerk * (m1.half + 1.5f * m1.second + 0.5f * third) + faster1;
}

/*
 * Sums over pieces' rows: for each of their three coefficients the gradient, and its products with
 * itself and with those behind.
 */
struct sums {
    lanes of[TEMPO_SUMS];
};

/* Where the gradient of a coefficient stands among the sums, and its first product. */
static const unsigned sums_of[3] = {0, 4, 7};

/*
 * d/d of log(most - v) + log(most + v), and Newton's part of the second derivative. What is
 * exceeded is drawn inside all the time.
 */
static inline void add_row(struct sums *s, const struct row *row, float weight)
{
    const lanes size = lanes_size(row->value);
    const lanes most = limit_of(size, row->most);
    const lanes strength =
        lanes_choose(size > row->most, lanes_all(single_max(DRAWN, weight)), lanes_all(weight));
    const lanes above = 1.0f / (most - row->value);
    const lanes below = 1.0f / (most + row->value);
    const lanes pull = strength * (below - above);
    const lanes stiff = strength * (above * above + below * below);

    for (unsigned i = 0; i < 3; i++) {
        lanes *sum = &s->of[sums_of[i]];

        sum[0] += pull * row->by[i];
        for (unsigned k = i; k < 3; k++) {
            sum[1 + k - i] += stiff * row->by[i] * row->by[k];
        }
    }
}

/* Sums over the slots that lie in a lane. */
static inline void sum_lane(const struct tempo *p, const struct route *r, unsigned lane,
                            unsigned piece, const struct end end[2], float weight, struct sums *s)
{
    for (unsigned n = 0; n < TEMPO_SUMS; n++) {
        s->of[n] = lanes_all(0.0f);
    }
    for (unsigned slot = lane; slot < r->slots.count; slot += SMOOTH_LANES) {
        struct row row[TEMPO_ROWS];

        rows_of(p, slot, piece, end, row);
        for (unsigned i = 0; i < TEMPO_ROWS; i++) {
            add_row(s, &row[i], weight);
        }
    }
}

/*
 * Sums of the pieces from one on, as many as there are lanes, over all slots: in the order of
 * lanes_sum().
 */
static void sum_pieces(struct tempo *p, const struct route *r, unsigned piece, float weight)
{
    const struct end end[2] = {end_of(p->rate_squared + piece),
                               end_of(p->rate_squared + piece + 1)};
    struct sums s[SMOOTH_LANES];

    for (unsigned lane = 0; lane < SMOOTH_LANES; lane++) {
        sum_lane(p, r, lane, piece, end, weight, &s[lane]);
    }
    for (unsigned n = 0; n < TEMPO_SUMS; n++) {
        const lanes sum = (s[0].of[n] + s[1].of[n]) + (s[2].of[n] + s[3].of[n]);

        lanes_put(&p->sum[n][piece + 2], sum);
    }
}

/* Before the first piece (takt_tempo_find) and behind the last one there is none. */
static void sum_all(struct tempo *p, const struct route *r, float weight)
{
    for (unsigned i = 0; i < p->pieces; i += SMOOTH_LANES) {
        sum_pieces(p, r, i, weight);
    }
    for (unsigned n = 0; n < TEMPO_SUMS; n++) {
        memset(&p->sum[n][p->pieces + 2], 0, 2 * sizeof p->sum[n][0]);
    }
}

/* The highest squared rate that coefficients may have now. */
static inline lanes most_of(const struct tempo *p, unsigned i)
{
    const lanes rate_squared = lanes_at(p->rate_squared + i);
    const lanes most = lanes_at(p->most + i);

    return lanes_max(
        most, lanes_choose(rate_squared > NEAR * most, FARTHER * rate_squared, lanes_all(0.0f)));
}

/*
 * One of the sums of coefficient i where that is the first one of its piece, the second, or the
 * third.
 */
static inline lanes sum_at(const struct tempo *p, unsigned as, unsigned n, unsigned i)
{
    return lanes_at(&p->sum[sums_of[as] + n][i + 2 - as]);
}

/*
 * Adds up the three pieces that each coefficient belongs to, and its own part: d/db of -1/sqrt(b)
 * and of its bounds.
 */
static void set_coefficients(struct tempo *p, unsigned i, float weight)
{
    const lanes b = lanes_at(p->rate_squared + i);
    const lanes below = 1.0f / (b - RATE_SQUARED_MIN);
    const lanes above = 1.0f / (most_of(p, i) - b);
    const lanes gain = 0.5f / (b * lanes_sqrt(b));
    const lanes pull = gain + weight * (below - above);
    const lanes stiff = 1.5f * gain / b + weight * (below * below + above * above);

    lanes_put(p->step + i, sum_at(p, 2, 0, i) + sum_at(p, 1, 0, i) + sum_at(p, 0, 0, i) + pull);
    lanes_put(p->band[0] + i, sum_at(p, 2, 1, i) + sum_at(p, 1, 1, i) + sum_at(p, 0, 1, i) + stiff);
    lanes_put(p->band[1] + i, sum_at(p, 1, 2, i) + sum_at(p, 0, 2, i));
    lanes_put(p->band[2] + i, sum_at(p, 0, 3, i));
}

/* Only the coefficients from first to before end are free. */
struct span {
    unsigned first, end;
};

static void fix(struct tempo *p, const struct span *f, unsigned i)
{
    if (i < f->first || i >= f->end) {
        p->band[0][i] = 1.0f;
        p->band[1][i] = 0.0f;
        p->band[2][i] = 0.0f;
        p->step[i] = 0.0f;
        return;
    }
    p->band[1][i] = i + 1 < f->end ? p->band[1][i] : 0.0f;
    p->band[2][i] = i + 2 < f->end ? p->band[2][i] : 0.0f;
}

static void assemble(struct tempo *p, const struct route *r, const struct span *f, float weight)
{
    const unsigned count = p->pieces + 2;

    sum_all(p, r, weight);
    for (unsigned i = 0; i < count; i += SMOOTH_LANES) {
        set_coefficients(p, i, weight);
    }
    for (unsigned i = 0; i < count; i++) {
        fix(p, f, i);
    }
}

/* L D L' of the matrix, forward and back; the multipliers take the bands' places. */
static void solve(struct tempo *p)
{
    const unsigned count = p->pieces + 2;
    float *restrict d0 = p->band[0];
    float *restrict d1 = p->band[1];
    float *restrict d2 = p->band[2];
    float *restrict y = p->step;

    TAKT_ASSERT(p->pieces > 0);
    for (unsigned i = 0; i + 2 < count; i++) {
        const float l1 = d1[i] / d0[i];
        const float l2 = d2[i] / d0[i];

        d0[i + 1] -= l1 * d1[i];
        d1[i + 1] -= l1 * d2[i];
        d0[i + 2] -= l2 * d2[i];
        y[i + 1] -= l1 * y[i];
        y[i + 2] -= l2 * y[i];
        y[i] /= d0[i];
        d1[i] = l1;
        d2[i] = l2;
    }
    /* the last two coefficients have no product where they are free: that of the last piece */
    const unsigned last = count - 1;
    const float l = d1[last - 1] / d0[last - 1];

    y[last] = (y[last] - l * y[last - 1]) / (d0[last] - l * d1[last - 1]);
    y[last - 1] = y[last - 1] / d0[last - 1] - l * y[last];
    for (unsigned i = count - 2; i-- > 0;) {
        y[i] -= d1[i] * y[i + 1] + d2[i] * y[i + 2];
    }
}

/* Lanes that what is left from i on takes. */
static unsigned lanes_used(unsigned count, unsigned i)
{
    TAKT_ASSERT(i < count);
    return count - i < SMOOTH_LANES ? count - i : SMOOTH_LANES;
}

/* How far the rows of pieces come with the step. True: farther than a part of it, in some lane. */
static bool approach_limits(struct tempo *p, const struct route *r, unsigned piece, float t)
{
    const struct end end[2] = {end_of(p->rate_squared + piece),
                               end_of(p->rate_squared + piece + 1)};
    const float *step = p->step + piece;
    lanes_int beyond = {0};

    for (unsigned slot = 0; slot < r->slots.count; slot++) {
        struct row row[TEMPO_ROWS];

        rows_of(p, slot, piece, end, row);
        for (unsigned k = 0; k < TEMPO_ROWS; k++) {
            const lanes change = row[k].by[0] * lanes_at(step) + row[k].by[1] * lanes_at(step + 1) +
                                 row[k].by[2] * lanes_at(step + 2);
            const lanes most = limit_of(lanes_size(row[k].value), row[k].most);
            struct tempo_approach *a = &p->approach[slot][k];

            a->size = lanes_size(change);
            a->room = lanes_choose(change > 0.0f, most - row[k].value, most + row[k].value);
            beyond |= a->room < t * a->size;
        }
    }
    return lanes_any(beyond);
}

/* The part of the step at which a limit is come to in a lane, if that is below t. */
static float part_of(const struct tempo_approach *a, unsigned lane, float t)
{
    return a->room[lane] < t * a->size[lane] ? a->room[lane] / a->size[lane] : t;
}

/* That of a piece's rows. */
static float part_of_piece(const struct tempo *p, const struct route *r, unsigned lane, float t)
{
    for (unsigned g = 0; g < r->slots.count; g += SMOOTH_LANES) {
        for (unsigned k = 0; k < TEMPO_ROWS; k++) {
            for (unsigned slot = g; slot < r->slots.count && slot < g + SMOOTH_LANES; slot++) {
                t = part_of(&p->approach[slot][k], lane, t);
            }
        }
    }
    return t;
}

static float part_of_coefficients(const struct tempo *p, unsigned i, unsigned used, float t)
{
    const lanes change = lanes_at(p->step + i);
    const lanes rate_squared = lanes_at(p->rate_squared + i);
    const struct tempo_approach a = {
        lanes_choose(change > 0.0f, most_of(p, i) - rate_squared, rate_squared - RATE_SQUARED_MIN),
        lanes_size(change)};

    if (lanes_any(a.room < t * a.size)) {
        for (unsigned lane = 0; lane < used; lane++) {
            t = part_of(&a, lane, t);
        }
    }
    return t;
}

/* How much of the step keeps every limit. */
static float part_of_step(struct tempo *p, const struct route *r)
{
    const unsigned count = p->pieces + 2;
    float t = 1.0f / STEP_PART;

    for (unsigned i = 0; i < count; i += SMOOTH_LANES) {
        t = part_of_coefficients(p, i, lanes_used(count, i), t);
    }
    for (unsigned i = 0; i < p->pieces; i += SMOOTH_LANES) {
        const unsigned used = lanes_used(p->pieces, i);

        if (approach_limits(p, r, i, t)) {
            for (unsigned lane = 0; lane < used; lane++) {
                t = part_of_piece(p, r, lane, t);
            }
        }
    }
    return STEP_PART * t;
}

static void set_even(struct tempo *p, const struct window *w)
{
    TAKT_ASSERT(w->count > SMOOTH_FIXED && w->count <= SMOOTH_SAMPLES_MAX);
    p->pieces = w->count - SMOOTH_FIXED;
    for (unsigned i = 0; i < TEMPO_MAX; i++) {
        p->rate_squared[i] = 1.0f;
    }
}

void takt_tempo_find(struct tempo *p, const struct window *w, const struct route *r)
{
    float weight = BARRIER;

    memset(p, 0, sizeof(*p));
    set_even(p, w);
    takt_tempo_begin(p, w, r);
    const struct span free = {.first = 2, .end = w->at_end ? p->pieces + 2 : p->pieces};

    for (unsigned n = 0; n < ITERATIONS && free.first < free.end; n++) {
        assemble(p, r, &free, weight);
        solve(p);
        const float t = part_of_step(p, r);
        TAKT_ASSERT(t >= 0.0f);

        for (unsigned i = 0; i < p->pieces + 2; i++) {
            p->rate_squared[i] += t * p->step[i];
        }
        weight *= t > STEP_FAR ? BARRIER_LESS : 1.0f;
    }
}

void takt_tempo_slow(struct tempo *p, const struct window *w, unsigned piece, unsigned around,
                     float rate)
{
    TAKT_ASSERT(rate > 0.0f);
    set_even(p, w);
    for (unsigned i = 2; i < p->pieces + 2; i++) {
        if (i + around > piece + 1 && i < piece + 1 + around) {
            p->rate_squared[i] = rate * rate;
        }
    }
}

float takt_tempo_rate_squared(const struct tempo *p, float u, float *slope)
{
    const float place = single_clamp(u - 1.0f, 0.0f, (float)p->pieces);
    const unsigned i = place < (float)p->pieces ? (unsigned)place : p->pieces - 1;
    const float f = place - (float)i;
    const float *e = p->rate_squared + i;
    const float slope0 = e[1] - e[0];
    const float slope1 = e[2] - e[1];

    TAKT_ASSERT(p->pieces > 0);
    *slope = slope0 + f * (slope1 - slope0);
    return 0.5f * (e[0] + e[1]) + f * (slope0 + 0.5f * f * (slope1 - slope0));
}
