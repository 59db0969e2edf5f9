#include "classic/limiter.h"

#include "base/assert.h"
#include "base/maths.h"

static double threshold(double velocity, double most)
{
    return velocity > most ? most / velocity : 1.0;
}

/* Outside of the band, and where it has no width, the same as threshold. */
static double smooth(double velocity, double most, double band)
{
    const double over = velocity - most + band;

    if (over <= 0.0 || over >= 2.0 * band) {
        return threshold(velocity, most);
    }
    const double x = over / (2.0 * band);
    const double k = x * x * (1.0 - 0.5 * x);

    return (most - band + (1.0 - k) * over) / velocity;
}

double takt_limiter_axis(enum limiter_form form, double velocity_mm_s, double most_mm_s,
                         uint8_t band_percent)
{
    switch (form) {
    case LIMITER_CEILING:
        return 1.0;
    case LIMITER_THRESHOLD:
        return threshold(velocity_mm_s, most_mm_s);
    case LIMITER_SMOOTH:
        return smooth(velocity_mm_s, most_mm_s, 0.01 * (double)band_percent * most_mm_s);
    }
    return 1.0;
}

double takt_limiter_factor(enum limiter_form form, const struct point *velocity_mm_s,
                           const double most_mm_s[AXIS_COUNT],
                           const uint8_t band_percent[AXIS_COUNT])
{
    double factor = 1.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if (most_mm_s[i] > 0.0) {
            factor = maths_min(factor, takt_limiter_axis(form, maths_abs(velocity_mm_s->at[i]),
                                                         most_mm_s[i], band_percent[i]));
        }
    }
    return factor;
}
