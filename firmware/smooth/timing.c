#include "smooth/timing.h"

#include "smooth/judge.h"
#include "smooth/single.h"

/* The step from what is to what should be, and its bounds: the samples move after that, so it is taken with care. */
#define RATE_LOW  0.5f
#define RATE_HIGH 1.3f

/* Pieces to both sides that share the lowest rate, and over which rates are averaged. */
#define AROUND 1

/* How much slower, and for how many pieces around, when a tolerance cannot be kept. */
#define SLOWER        0.8f
#define SLOWER_AROUND 12

static unsigned pieces_of(const struct window *w)
{
    return w->count - 3;
}

/* Rate at which a piece would just keep every limit, and the programmed feed: its power of 3/4 is taken. */
static float wanted(const struct window *w, const struct route *r,
                    const struct judge_change *change, unsigned piece)
{
    struct judge_need need;
    struct judge_rate rate;

    judge_need(w, r, piece, &need);
    judge_rate(&need, r, w->element[piece + 1], change, &rate);
    const float root = single_sqrt(single_sqrt(single_min(rate.most, rate.programmed)));

    return single_clamp(root * root * root, RATE_LOW, RATE_HIGH);
}

static void lowest_around(struct timing *t, unsigned pieces)
{
    for (unsigned i = 0; i < pieces; i++) {
        const unsigned from = i < AROUND ? 0 : i - AROUND;
        const unsigned to = i + AROUND < pieces ? i + AROUND : pieces - 1;

        t->least[i] = t->rate[from];
        for (unsigned k = from + 1; k <= to; k++) {
            t->least[i] = single_min(t->least[i], t->rate[k]);
        }
    }
}

static void mean_around(struct timing *t, unsigned pieces)
{
    for (unsigned i = 0; i < pieces; i++) {
        const unsigned from = i < AROUND ? 0 : i - AROUND;
        const unsigned to = i + AROUND < pieces ? i + AROUND : pieces - 1;
        float sum = 0.0f;

        for (unsigned k = from; k <= to; k++) {
            sum += t->least[k];
        }
        t->rate[i] = sum / (float)(to - from + 1);
    }
}

/* Rate at u samples from the first one of w, linear between the middles of pieces. */
static float rate_at(const struct timing *t, unsigned pieces, float u)
{
    const float middle = single_clamp(u - 1.5f, 0.0f, (float)(pieces - 1));
    const unsigned i = (unsigned)middle;
    const float f = middle - (float)i;

    return i + 1 < pieces ? (1.0f - f) * t->rate[i] + f * t->rate[i + 1] : t->rate[i];
}

static void append(struct window *w, const struct window *from, const struct route *r, float u)
{
    const unsigned last = from->count - 4;
    const unsigned piece = u - 1.0f < (float)last ? (unsigned)(u - 1.0f) : last;
    struct window_spot spot;
    float weight[4];

    window_weights(single_min(1.0f, u - 1.0f - (float)piece), weight);
    window_spot(from, r, piece, weight, &spot);
    window_set(w, r, w->count, &spot);
    w->at_mm[w->count] = window_at(from, piece, weight);
    w->element[w->count] = from->element[piece + 1];
    w->count++;
}

static void append_end(struct window *w, const struct window *from, const struct route *r)
{
    const unsigned last = from->count - 1;
    struct window_spot spot;

    for (unsigned g = 0; g < r->slots.groups; g++) {
        spot.group[g] = from->x[g * from->capacity + last];
    }
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        window_set(w, r, w->count, &spot);
        w->at_mm[w->count] = from->at_mm[last];
        w->element[w->count] = from->element[last];
        w->count++;
    }
    w->at_end = true;
}

/* Samples of the window before at the rates found, by the midpoint rule. */
static void resample(struct timing *t, struct window *w, const struct route *r)
{
    const struct window *from = &t->window;
    const unsigned pieces = pieces_of(from);
    const float end = (float)(from->count - 2);
    float u = SMOOTH_FIXED - 1;

    w->count = SMOOTH_FIXED;
    w->at_end = false;
    while (w->count + SMOOTH_FIXED < w->capacity) {
        const float half = u + 0.5f * rate_at(t, pieces, u);

        u += rate_at(t, pieces, half);
        if (u >= end) {
            if (from->at_end) {
                append_end(w, from, r);
            }
            return;
        }
        append(w, from, r, u);
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
    resample(t, w, r);
}

void timing_slow(struct timing *t, struct window *w, const struct route *r, unsigned piece)
{
    const unsigned pieces = pieces_of(w);

    for (unsigned i = 0; i < pieces; i++) {
        t->least[i] = i + SLOWER_AROUND > piece && i < piece + SLOWER_AROUND ? SLOWER : 1.0f;
    }
    mean_around(t, pieces);
    t->window = *w;
    resample(t, w, r);
}
