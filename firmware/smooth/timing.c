#include "smooth/timing.h"

#include "base/maths.h"
#include "smooth/judge.h"

/* The step from what is to what should be, and its bounds: the samples move after that, so it is taken with care. */
#define RATE_LOW  0.5
#define RATE_HIGH 1.3

/* Pieces to both sides that share the lowest rate, and over which rates are averaged. */
#define AROUND 2

/* How much slower, and for how many pieces around, when a tolerance cannot be kept. */
#define SLOWER        0.8
#define SLOWER_AROUND 12

static unsigned pieces_of(const struct window *w)
{
    return w->count - 3;
}

/* Rate at which a piece would just keep every limit, and the programmed feed: its power of 3/4 is taken. */
static double wanted(const struct window *w, const struct route *r,
                     const struct judge_change *change, unsigned piece)
{
    struct judge_need need;
    struct judge_rate rate;

    judge_need(w, r, piece, &need);
    judge_rate(&need, route_element(r, w->element[piece + 1]), &r->limits, change, &rate);
    const double most = maths_min(rate.most, rate.programmed);
    const double root = maths_sqrt(maths_sqrt(most));

    return maths_clamp(root * root * root, RATE_LOW, RATE_HIGH);
}

static void lowest_around(struct timing *t, unsigned pieces)
{
    for (unsigned i = 0; i < pieces; i++) {
        const unsigned from = i < AROUND ? 0 : i - AROUND;
        const unsigned to = i + AROUND < pieces ? i + AROUND : pieces - 1;

        t->least[i] = t->rate[from];
        for (unsigned k = from + 1; k <= to; k++) {
            t->least[i] = maths_min(t->least[i], t->rate[k]);
        }
    }
}

static void mean_around(struct timing *t, unsigned pieces)
{
    for (unsigned i = 0; i < pieces; i++) {
        const unsigned from = i < AROUND ? 0 : i - AROUND;
        const unsigned to = i + AROUND < pieces ? i + AROUND : pieces - 1;
        double sum = 0.0;

        for (unsigned k = from; k <= to; k++) {
            sum += t->least[k];
        }
        t->rate[i] = sum / (double)(to - from + 1);
    }
}

/* Rate at u samples from the first one of w, linear between the middles of pieces. */
static double rate_at(const struct timing *t, unsigned pieces, double u)
{
    const double middle = maths_clamp(u - 1.5, 0.0, (double)(pieces - 1));
    const unsigned i = (unsigned)middle;
    const double f = middle - (double)i;

    return i + 1 < pieces ? (1.0 - f) * t->rate[i] + f * t->rate[i + 1] : t->rate[i];
}

static void append(struct window *w, const struct window *from, double u)
{
    const unsigned last = from->count - 4;
    const unsigned piece = u - 1.0 < (double)last ? (unsigned)(u - 1.0) : last;
    const double f = maths_min(1.0, u - 1.0 - (double)piece);
    const unsigned i = w->count;
    struct point p;

    window_point(from, piece, f, &p);
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        w->x[axis][i] = p.at[axis];
    }
    w->at_mm[i] = window_at(from, piece, f);
    w->element[i] = from->element[piece + 1];
    w->count++;
}

static void append_end(struct window *w, const struct window *from)
{
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        for (int axis = 0; axis < AXIS_COUNT; axis++) {
            w->x[axis][w->count] = from->x[axis][from->count - 1];
        }
        w->at_mm[w->count] = from->at_mm[from->count - 1];
        w->element[w->count] = from->element[from->count - 1];
        w->count++;
    }
    w->at_end = true;
}

/* Samples of the window before at the rates found, by the midpoint rule. */
static void resample(struct timing *t, struct window *w)
{
    const struct window *from = &t->window;
    const unsigned pieces = pieces_of(from);
    const double end = (double)(from->count - 2);
    double u = SMOOTH_FIXED - 1;

    w->count = SMOOTH_FIXED;
    w->at_end = false;
    while (w->count + SMOOTH_FIXED < SMOOTH_SAMPLES_MAX) {
        const double half = u + 0.5 * rate_at(t, pieces, u);

        u += rate_at(t, pieces, half);
        if (u >= end) {
            if (from->at_end) {
                append_end(w, from);
            }
            return;
        }
        append(w, from, u);
    }
}

void timing_again(struct timing *t, struct window *w, const struct route *r,
                  const struct judge_change *change)
{
    const unsigned pieces = pieces_of(w);

    for (unsigned i = 0; i < pieces; i++) {
        t->rate[i] = wanted(w, r, change, i);
    }
    lowest_around(t, pieces);
    mean_around(t, pieces);
    t->window = *w;
    resample(t, w);
}

void timing_slow(struct timing *t, struct window *w, unsigned piece)
{
    const unsigned pieces = pieces_of(w);

    for (unsigned i = 0; i < pieces; i++) {
        t->least[i] = i + SLOWER_AROUND > piece && i < piece + SLOWER_AROUND ? SLOWER : 1.0;
    }
    mean_around(t, pieces);
    t->window = *w;
    resample(t, w);
}
