#include "smooth/timing.h"

#include "smooth/single.h"

/* How much slower, and for how many pieces around, when a tolerance cannot be kept. */
#define SLOWER        0.8f
#define SLOWER_AROUND 12

/* Where a new sample is on the window before: its piece, how far in that, and b there. */
struct spot {
    unsigned piece;
    float fraction;
    float rate_squared;
    float slope; /* b' */
};

static float rate_at(const struct tempo *p, float u)
{
    float slope;

    return single_sqrt(takt_tempo_rate_squared(p, u, &slope));
}

/* One interval on, u' = r(u), by Runge and Kutta's rule of fourth order. */
static float next(const struct tempo *p, float u)
{
    const float a = rate_at(p, u);
    const float b = rate_at(p, u + 0.5f * a);
    const float c = rate_at(p, u + 0.5f * b);
    const float d = rate_at(p, u + c);

    return u + (a + 2.0f * (b + c) + d) * (1.0f / 6.0f);
}

static struct spot spot_at(const struct timing *t, float u)
{
    const unsigned last = t->window.count - 4;
    const unsigned piece = u - 1.0f < (float)last ? (unsigned)(u - 1.0f) : last;
    struct spot s = {.piece = piece, .fraction = single_min(1.0f, u - 1.0f - (float)piece)};

    s.rate_squared = takt_tempo_rate_squared(&t->tempo, u, &s.slope);
    return s;
}

/*
 * The control point that has the curve where it was: c = x - (x'' b + x' b'/2)/6, its own second
 * derivative being the one of time (Schoenberg's quasi-interpolant of third order).
 */
static void stand_off(const struct window *from, unsigned group, const struct spot *s,
                      struct window_spot *spot)
{
    const lanes_int *c = from->x + (size_t)group * from->capacity + s->piece;
    const lanes step0 = lanes_of(c[1] - c[0]);
    const lanes step1 = lanes_of(c[2] - c[1]);
    const lanes step2 = lanes_of(c[3] - c[2]);
    const lanes third = step2 - 2.0f * step1 + step0;
    const lanes second = step1 - step0 + s->fraction * third;
    const lanes first =
        0.5f * (step0 + step1) + s->fraction * (step1 - step0 + (0.5f * s->fraction) * third);
    const lanes off = (second * s->rate_squared + first * (0.5f * s->slope)) * (1.0f / 6.0f);

    for (unsigned k = 0; k < SMOOTH_LANES; k++) {
        spot->group[group][k] -= single_round(off[k]);
    }
}

static void append(const struct timing *t, struct window *w, const struct route *r, float u)
{
    const struct window *from = &t->window;
    const struct spot s = spot_at(t, u);
    struct window_spot spot;
    float weight[4];

    takt_window_weights(s.fraction, weight);
    takt_window_spot(from, r, s.piece, weight, &spot);
    for (unsigned g = 0; g < r->slots.groups; g++) {
        stand_off(from, g, &s, &spot);
    }
    takt_window_set(w, r, w->count, &spot);
    w->at_mm[w->count] = takt_window_at(from, s.piece, weight);
    w->element[w->count] = from->element[s.piece + 1];
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
        takt_window_set(w, r, w->count, &spot);
        w->at_mm[w->count] = from->at_mm[last];
        w->element[w->count] = from->element[last];
        w->count++;
    }
    w->at_end = true;
}

/* Samples of the window before at the pace found. */
static void resample(struct timing *t, struct window *w, const struct route *r)
{
    const float end = (float)(w->count - 2);
    float u = SMOOTH_FIXED - 1;

    t->window = *w;
    w->count = SMOOTH_FIXED;
    w->at_end = false;
    while (w->count + SMOOTH_FIXED < w->capacity) {
        u = next(&t->tempo, u);
        if (u >= end) {
            if (t->window.at_end) {
                append_end(w, &t->window, r);
            }
            return;
        }
        append(t, w, r, u);
    }
}

void takt_timing_again(struct timing *t, struct window *w, const struct route *r)
{
    takt_tempo_find(&t->tempo, w, r);
    resample(t, w, r);
}

void takt_timing_slow(struct timing *t, struct window *w, const struct route *r, unsigned piece)
{
    takt_tempo_slow(&t->tempo, w, piece, SLOWER_AROUND, SLOWER);
    resample(t, w, r);
}
