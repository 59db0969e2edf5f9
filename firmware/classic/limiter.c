#include "classic/limiter.h"

#include "base/maths.h"

static double smooth(double velocity, double most)
{
    const double band = LIMITER_BAND * most;
    const double x = (velocity - most + band) / (2.0 * band);
    const double k = x * x * (1.0 - 0.5 * x);

    if (x <= 0.0) {
        return 1.0;
    }
    return x < 1.0 ? (most - band + (1.0 - k) * 2.0 * band * x) / velocity : most / velocity;
}

double limiter_axis(enum limiter_form form, double velocity_mm_s, double most_mm_s)
{
    if (form == LIMITER_SMOOTH) {
        return smooth(velocity_mm_s, most_mm_s);
    }
    return form == LIMITER_THRESHOLD && velocity_mm_s > most_mm_s ? most_mm_s / velocity_mm_s : 1.0;
}

double limiter_factor(enum limiter_form form, const struct point *velocity_mm_s,
                      const double most_mm_s[AXIS_COUNT])
{
    double factor = 1.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if (most_mm_s[i] > 0.0) {
            factor = maths_min(factor,
                               limiter_axis(form, maths_abs(velocity_mm_s->at[i]), most_mm_s[i]));
        }
    }
    return factor;
}
