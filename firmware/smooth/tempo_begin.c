/* What the search for the best tempo begins with: the window's differences, and what limits b. */
#include "smooth/tempo.h"

#include "base/assert.h"
#include "smooth/single.h"
#include "smooth/verifier.h"

/*
 * New samples are put on the curve from outside: that takes some of the jerk, and as much
 * acceleration of an interval.
 */
#define THIRD_PART      0.95f
#define THIRD_OF_SECOND 0.5f

/* b <= (V/x')^2 and (F/|x'|)^2 of every piece that the coefficient belongs to. */
static void set_most(struct tempo *p, const struct window *w, const struct route *r)
{
    for (unsigned i = 0; i < p->pieces + 2; i++) {
        p->most[i] = RATE_SQUARED_MOST;
    }
    for (unsigned i = 0; i < p->pieces; i++) {
        struct verifier_need need;

        takt_verifier_need(w, r, i, &need);
        float feed = single_min(single_sqrt(RATE_SQUARED_MOST),
                                takt_verifier_programmed(&need, r, w->element[i + 1]));

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
        p->most[i] = single_max(p->most[i], 2.0f * RATE_SQUARED_MIN);
    }
}

static void set_scale(struct tempo *p, const struct window *w, const struct route *r)
{
    const float d = (float)w->interval_s;

    p->change = r->slots.change_per_s * d;
    p->rounded = r->slots.rounded_per_s2 * d * d;
    for (unsigned i = 0; i < r->slots.count; i++) {
        const float unit = (float)w->unit_mm[i];
        const float second = r->slots.acceleration_mm_s2[i] * d * d;
        const float third = THIRD_PART * r->slots.jerk_mm_s3[i] * d * d * d;

        p->second_per_unit[i] = unit / second;
        p->third_per_unit[i] = unit / single_min(third, THIRD_OF_SECOND * second);
        p->third_all[i] = third / single_min(third, THIRD_OF_SECOND * second);
    }
}

/* The curve's differences where pieces begin, and where the last one ends. */
static void set_differences(struct tempo *p, const struct window *w, const struct route *r)
{
    p->capacity = w->capacity;
    for (unsigned slot = 0; slot < r->slots.count; slot++) {
        for (unsigned i = 0; i + 2 < w->count; i++) {
            const int32_t x = window_x(w, slot, i + 1);
            const float before = (float)(x - window_x(w, slot, i));
            const float after = (float)(window_x(w, slot, i + 2) - x);

            p->first[slot * w->capacity + i] = 0.5f * (before + after);
            p->second[slot * w->capacity + i] = after - before;
        }
    }
}

void takt_tempo_begin(struct tempo *p, const struct window *w, const struct route *r)
{
    TAKT_ASSERT(p->pieces + 2 <= TEMPO_MAX);
    set_scale(p, w, r);
    set_differences(p, w, r);
    set_most(p, w, r);
}
