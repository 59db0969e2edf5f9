#include "motion/landing.h"

#include "base/assert.h"
#include "base/maths.h"

/* A landing takes fewer cycles than this, or is not begun yet. */
#define RAMP_MAX 1e6

/* Rounding of the deceleration that is solved for. */
#define SLACK 1e-9

bool takt_landing_solve(const struct landing_case *l, struct landing_run *run)
{
    const double w = l->feed;

    TAKT_ASSERT(l->window >= 1.0 && l->acceleration > 0.0);
    if (!(w > 0.0)) {
        return false;
    }
    const double top = maths_min(l->feed_max, w);
    const double n =
        maths_max(1.0, takt_maths_ceil((2.0 * l->gap_mm - top * (l->window + 1.0)) / (w + top)));
    const double end = (2.0 * l->gap_mm - n * w) / (n + l->window + 1.0);

    if (!(n < RAMP_MAX) || !(end > 0.0) || w - end > n * l->acceleration * (1.0 + SLACK)) {
        return false;
    }
    TAKT_ASSERT(end <= w * (1.0 + SLACK));
    run->ramp = (uint32_t)n;
    run->total = run->ramp + (uint32_t)l->window;
    run->feed_start = w;
    run->feed_end = end;
    return true;
}

double takt_landing_distance(const struct landing_run *run, uint32_t cycle, double *feed)
{
    const double n = (double)run->ramp;
    const double i = maths_min((double)cycle, n);
    const double slower = (run->feed_start - run->feed_end) / n;
    const double rest = (double)cycle - i;

    *feed = run->feed_start - i * slower;
    return i * run->feed_start - 0.5 * i * i * slower + rest * run->feed_end;
}
