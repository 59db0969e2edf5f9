/*
 * With the curve x(u), u in samples, and the rate r = u' of it, b = r^2: u'' = b'/2 and u''' = r b''/2, so by the chain rule
 * the axes need
 *
 *     x' b'/2 + x'' b                        within A d^2
 *     r (x' b''/2 + 3/2 x'' b' + x''' b)     within J d^3
 *
 * less what a change of rate needs there (judge.h), at both ends of each piece: rows of the three coefficients of b
 * (Verscheure et al. 2009 have the first row; the second is theirs differentiated once more). Least time, the sum of
 * 1/sqrt(b), is found by a barrier method (Boyd and Vandenberghe 2004, 11.3): Newton's steps on
 * sum 1/sqrt(b) - mu sum log(slack)  while mu falls. What is exceeded to begin with may stay so far off but no farther, and is
 * drawn inside. So every iteration keeps what the one before kept.
 */
#include "smooth/tempo.h"

#include "smooth/judge.h"
#include "smooth/single.h"

#include <string.h>

#define ITERATIONS 6

/* The barrier's weight to begin with, and what is left of it after a step that went at least so far. */
#define BARRIER      0.3f
#define BARRIER_LESS 0.4f
#define STEP_FAR     0.3f

/* Of the way to the first limit in its direction so much is gone. */
#define STEP_PART 0.95f

/* Rates between 0.15 and 1.5: what is farther off is left to the next window. */
#define ENERGY_MIN  0.0225f
#define ENERGY_MOST 2.25f

/* The barrier's weight where a limit is exceeded, at least. */
#define DRAWN 0.03f

/* Where a row is nearer to its limit than this, that is so much farther off. */
#define NEAR    0.98f
#define FARTHER 1.02f

/* New samples are put on the curve from outside: that takes some of the jerk, and as much acceleration of an interval. */
#define TWIST_PART 0.95f
#define TWIST_BEND 0.5f

/* What an axis needs and what it has for that, in parts of what it may; how the need hangs on the three coefficients. */
struct row {
    lanes value;
    lanes most;
    lanes by[3];
};

/* Changes of rate leave this part of what an axis may at least: judge.c has bounds of its own. */
#define LEFT_LEAST 0.5f

/* An acceleration at a piece's start, a jerk there and one at its end. */
#define ROWS 3

static inline lanes all(float x)
{
    return (lanes){x, x, x, x};
}

/* By lanes of mask, all ones or all zeros. */
static inline lanes choose(lanes_int mask, lanes yes, lanes no)
{
    return (lanes)(((lanes_int)yes & mask) | ((lanes_int)no & ~mask));
}

/* What a change of rate leaves, or a little more than what is near it or beyond. */
static inline lanes limit_of(lanes size, lanes most)
{
    return choose(size > NEAR * most, FARTHER * size, most);
}

/* What a change of rate that needs a part leaves, of 1 or more, for the curve: 1 at most. */
static inline lanes left_by(lanes part, lanes of)
{
    const lanes left = of - part;
    const lanes least = choose(left > LEFT_LEAST, left, all(LEFT_LEAST));

    return choose(least < 1.0f, least, all(1.0f));
}

/* J - x' r r'' - 3 r' |x' b'/2 + x'' b| */
static inline lanes jerk_left(const struct tempo *p, unsigned group, lanes way, lanes bend)
{
    const lanes needed = p->rounded * lanes_size(way) + 3.0f * p->change * lanes_size(bend);

    return left_by(p->twist_per_unit[group] * needed, p->twist_all[group]);
}

static void rows_of(const struct tempo *p, const struct window *w, unsigned group, unsigned piece,
                    struct row row[ROWS])
{
    const lanes_int *c = w->x + (size_t)group * w->capacity + piece;
    const lanes step0 = lanes_of(c[1] - c[0]);
    const lanes step1 = lanes_of(c[2] - c[1]);
    const lanes step2 = lanes_of(c[3] - c[2]);
    const lanes first0 = 0.5f * (step0 + step1);
    const lanes first1 = 0.5f * (step1 + step2);
    const lanes second0 = step1 - step0;
    const lanes second1 = step2 - step1;
    const lanes third = second1 - second0;
    const float *e = p->energy + piece;
    const float slope0 = e[1] - e[0];
    const float slope1 = e[2] - e[1];
    const float bow = 0.5f * (slope1 - slope0);
    const float energy0 = 0.5f * (e[0] + e[1]);
    const float energy1 = 0.5f * (e[1] + e[2]);
    const float rate0 = single_sqrt(energy0);
    const float rate1 = single_sqrt(energy1);
    const lanes a = p->bend_per_unit[group];
    const lanes j0 = rate0 * p->twist_per_unit[group];
    const lanes j1 = rate1 * p->twist_per_unit[group];
    const lanes half0 = 0.5f * first0;
    const lanes half1 = 0.5f * first1;
    const lanes bend0 = slope0 * half0 + energy0 * second0;
    const lanes bend1 = slope1 * half1 + energy1 * second1;

    row[0].value = a * bend0;
    row[0].most = left_by(p->change * rate0 * a * lanes_size(first0), all(1.0f));
    row[0].by[0] = a * (0.5f * second0 - half0);
    row[0].by[1] = a * (0.5f * second0 + half0);
    row[0].by[2] = 0.0f * a;

    /* d rate / d energy = 1/2 / rate: half of that for each of the two coefficients */
    row[1].most = jerk_left(p, group, rate0 * first0, bend0);
    row[1].value = j0 * (bow * first0 + 1.5f * slope0 * second0 + energy0 * third);
    const lanes faster0 = row[1].value * (0.25f / energy0);
    row[1].by[0] = j0 * (half0 - 1.5f * second0 + 0.5f * third) + faster0;
    row[1].by[1] = j0 * (1.5f * second0 - first0 + 0.5f * third) + faster0;
    row[1].by[2] = j0 * half0;

    row[2].most = jerk_left(p, group, rate1 * first1, bend1);
    row[2].value = j1 * (bow * first1 + 1.5f * slope1 * second1 + energy1 * third);
    const lanes faster1 = row[2].value * (0.25f / energy1);
    row[2].by[0] = j1 * half1;
    row[2].by[1] = j1 * (0.5f * third - first1 - 1.5f * second1) + faster1;
    row[2].by[2] = j1 * (half1 + 1.5f * second1 + 0.5f * third) + faster1;
}

/* Of a piece's rows: the gradient by its three coefficients, and their products. */
struct sums {
    lanes gradient[3];
    lanes product[3][3];
};

/*
 * d/d of log(most - v) + log(most + v), and Newton's part of the second derivative. What is exceeded is
 * drawn inside all the time.
 */
static void add_row(struct sums *s, const struct row *row, float weight)
{
    const lanes size = lanes_size(row->value);
    const lanes most = limit_of(size, row->most);
    const lanes strength = choose(size > row->most, all(single_max(DRAWN, weight)), all(weight));
    const lanes above = 1.0f / (most - row->value);
    const lanes below = 1.0f / (most + row->value);
    const lanes pull = strength * (below - above);
    const lanes stiff = strength * (above * above + below * below);

    for (unsigned i = 0; i < 3; i++) {
        s->gradient[i] += pull * row->by[i];
        for (unsigned k = i; k < 3; k++) {
            s->product[i][k] += stiff * row->by[i] * row->by[k];
        }
    }
}

static void add_piece(struct tempo *p, const struct window *w, const struct route *r,
                      unsigned piece, float weight)
{
    struct sums s = {0};

    for (unsigned g = 0; g < r->slots.groups; g++) {
        struct row row[ROWS];

        rows_of(p, w, g, piece, row);
        for (unsigned i = 0; i < ROWS; i++) {
            add_row(&s, &row[i], weight);
        }
    }
    for (unsigned i = 0; i < 3; i++) {
        p->step[piece + i] += lanes_sum(s.gradient[i]);
        for (unsigned k = i; k < 3; k++) {
            p->band[k - i][piece + i] += lanes_sum(s.product[i][k]);
        }
    }
}

/* The highest energy that a coefficient may have now. */
static float most_of(const struct tempo *p, unsigned i)
{
    return single_max(p->most[i], p->energy[i] > NEAR * p->most[i] ? FARTHER * p->energy[i] : 0.0f);
}

/* Of a coefficient by itself: d/db of -1/sqrt(b) and of its own bounds. */
static void add_coefficient(struct tempo *p, unsigned i, float weight)
{
    const float b = p->energy[i];
    const float below = 1.0f / (b - ENERGY_MIN);
    const float above = 1.0f / (most_of(p, i) - b);
    const float gain = 0.5f / (b * single_sqrt(b));

    p->step[i] += gain + weight * (below - above);
    p->band[0][i] += 1.5f * gain / b + weight * (below * below + above * above);
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

static void assemble(struct tempo *p, const struct window *w, const struct route *r,
                     const struct span *f, float weight)
{
    const unsigned count = p->pieces + 2;

    memset(p->step, 0, sizeof p->step);
    memset(p->band, 0, sizeof p->band);
    for (unsigned i = 0; i < p->pieces; i++) {
        add_piece(p, w, r, i, weight);
    }
    for (unsigned i = 0; i < count; i++) {
        add_coefficient(p, i, weight);
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

/* The part of the step at which a row comes to its limit, if that is below t. */
static float part_of_row(const struct row *row, const float step[3], float t)
{
    const lanes change = row->by[0] * step[0] + row->by[1] * step[1] + row->by[2] * step[2];
    const lanes most = limit_of(lanes_size(row->value), row->most);

    for (unsigned k = 0; k < SMOOTH_LANES; k++) {
        const float room = change[k] > 0.0f ? most[k] - row->value[k] : most[k] + row->value[k];
        const float size = single_abs(change[k]);

        if (room < t * size) {
            t = room / size;
        }
    }
    return t;
}

static float part_of_coefficient(const struct tempo *p, unsigned i, float t)
{
    const float change = p->step[i];
    const float room = change > 0.0f ? most_of(p, i) - p->energy[i] : p->energy[i] - ENERGY_MIN;
    const float size = single_abs(change);

    return room < t * size ? room / size : t;
}

/* How much of the step keeps every limit. */
static float part_of_step(const struct tempo *p, const struct window *w, const struct route *r)
{
    float t = 1.0f / STEP_PART;

    for (unsigned i = 0; i < p->pieces + 2; i++) {
        t = part_of_coefficient(p, i, t);
    }
    for (unsigned i = 0; i < p->pieces; i++) {
        for (unsigned g = 0; g < r->slots.groups; g++) {
            struct row row[ROWS];

            rows_of(p, w, g, i, row);
            for (unsigned k = 0; k < ROWS; k++) {
                t = part_of_row(&row[k], p->step + i, t);
            }
        }
    }
    return STEP_PART * t;
}

/* b <= (V/x')^2 and (F/|x'|)^2 of every piece that the coefficient belongs to. */
static void set_most(struct tempo *p, const struct window *w, const struct route *r)
{
    for (unsigned i = 0; i < p->pieces + 2; i++) {
        p->most[i] = ENERGY_MOST;
    }
    for (unsigned i = 0; i < p->pieces; i++) {
        struct judge_need need;

        judge_need(w, r, i, &need);
        float feed =
            single_min(single_sqrt(ENERGY_MOST), judge_programmed(&need, r, w->element[i + 1]));

        for (unsigned k = 0; k < r->slots.count; k++) {
            if (feed * need.first[k] > r->slots.velocity_mm_s[k]) {
                feed = r->slots.velocity_mm_s[k] / need.first[k];
            }
        }
        for (unsigned k = 0; k < 3; k++) {
            p->most[i + k] = single_min(p->most[i + k], feed * feed);
        }
    }
    for (unsigned i = 0; i < p->pieces + 2; i++) {
        p->most[i] = single_max(p->most[i], 2.0f * ENERGY_MIN);
    }
}

static void set_scale(struct tempo *p, const struct window *w, const struct route *r)
{
    const float d = (float)w->interval_s;

    p->change = r->slots.change_per_s * d;
    p->rounded = r->slots.rounded_per_s2 * d * d;
    memset(p->bend_per_unit, 0, sizeof p->bend_per_unit);
    memset(p->twist_per_unit, 0, sizeof p->twist_per_unit);
    memset(p->twist_all, 0, sizeof p->twist_all);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const float unit = (float)w->unit_mm[i];
        const float bend = r->slots.acceleration_mm_s2[i] * d * d;
        const float twist = TWIST_PART * r->slots.jerk_mm_s3[i] * d * d * d;

        p->bend_per_unit[i / SMOOTH_LANES][i % SMOOTH_LANES] = unit / bend;
        p->twist_per_unit[i / SMOOTH_LANES][i % SMOOTH_LANES] =
            unit / single_min(twist, TWIST_BEND * bend);
        p->twist_all[i / SMOOTH_LANES][i % SMOOTH_LANES] =
            twist / single_min(twist, TWIST_BEND * bend);
    }
}

static void set_even(struct tempo *p, const struct window *w)
{
    p->pieces = w->count - SMOOTH_FIXED;
    for (unsigned i = 0; i < p->pieces + 2; i++) {
        p->energy[i] = 1.0f;
    }
}

void tempo_find(struct tempo *p, const struct window *w, const struct route *r)
{
    float weight = BARRIER;

    set_even(p, w);
    set_scale(p, w, r);
    set_most(p, w, r);
    const struct span free = {.first = 2, .end = w->at_end ? p->pieces + 2 : p->pieces};

    for (unsigned n = 0; n < ITERATIONS && free.first < free.end; n++) {
        assemble(p, w, r, &free, weight);
        solve(p);
        const float t = part_of_step(p, w, r);

        for (unsigned i = 0; i < p->pieces + 2; i++) {
            p->energy[i] += t * p->step[i];
        }
        weight *= t > STEP_FAR ? BARRIER_LESS : 1.0f;
    }
}

void tempo_slow(struct tempo *p, const struct window *w, unsigned piece, unsigned around,
                float rate)
{
    set_even(p, w);
    for (unsigned i = 2; i < p->pieces + 2; i++) {
        if (i + around > piece + 1 && i < piece + 1 + around) {
            p->energy[i] = rate * rate;
        }
    }
}

float tempo_energy(const struct tempo *p, float u, float *slope)
{
    const float place = single_clamp(u - 1.0f, 0.0f, (float)p->pieces);
    const unsigned i = place < (float)p->pieces ? (unsigned)place : p->pieces - 1;
    const float f = place - (float)i;
    const float *e = p->energy + i;
    const float slope0 = e[1] - e[0];
    const float slope1 = e[2] - e[1];

    *slope = slope0 + f * (slope1 - slope0);
    return 0.5f * (e[0] + e[1]) + f * (slope0 + 0.5f * f * (slope1 - slope0));
}
