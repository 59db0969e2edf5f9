#include "correction/fade.h"

#include "base/assert.h"
#include "base/maths.h"

/*
 * A chain of three equal first-order lags, w = p^3 / (s + p)^3 target. Its step response is
 *
 *     w(t) = 1 - (1 + x + x^2 / 2) e^-x,   x = p t
 *
 * which reaches 99 % at x = 8.406.
 */
#define FADE_DONE_X 8.406

/*
 * Bounds of responses to a target that jumps between 0 and 1 at the worst times: half the integral
 * of the absolute impulse response. In units of p, p^2, p^3 (tests/unit/test_correction_fade.c
 * tries to exceed them).
 */
#define FADE_VELOCITY_MAX     0.28
#define FADE_ACCELERATION_MAX 0.33
#define FADE_JERK_MAX         1.3

void takt_fade_pace_set(struct fade_pace *pace, double time_s, double cycle_s)
{
    TAKT_ASSERT(time_s >= 0.0 && cycle_s > 0.0);
    pace->cycle_s = cycle_s;
    pace->rate = FADE_DONE_X * cycle_s / maths_max(time_s, FADE_CYCLES_MIN * cycle_s);
}

static double per_s(const struct fade_pace *pace)
{
    TAKT_ASSERT(pace->rate > 0.0 && pace->cycle_s > 0.0);
    return pace->rate / pace->cycle_s;
}

double takt_fade_velocity_per_s(const struct fade_pace *pace)
{
    return FADE_VELOCITY_MAX * per_s(pace);
}

double takt_fade_acceleration_per_s2(const struct fade_pace *pace)
{
    return FADE_ACCELERATION_MAX * per_s(pace) * per_s(pace);
}

double takt_fade_jerk_per_s3(const struct fade_pace *pace)
{
    return FADE_JERK_MAX * per_s(pace) * per_s(pace) * per_s(pace);
}
