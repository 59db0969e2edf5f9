#include "smooth/braking.h"

#include "smooth/single.h"

/* v t + a t^2 / 2 + j t^3 / 6 */
static float way(float v, float a, float j, float t)
{
    return ((j * t * (1.0f / 6.0f) + 0.5f * a) * t + v) * t;
}

/*
 * From a deceleration b to p and back to none, p^2 = J (v - to) + b^2 / 2 where A does not bind:
 * the times of its rise and fall are (p - b)/J and p/J, and what is left of the change of feed is
 * braked by p.
 */
static float way_braked(const struct braking_limits *l, float v, float b, float to)
{
    const float change = v - to;
    const float p = single_min(l->acceleration, single_sqrt(l->jerk * change + 0.5f * b * b));
    const float rise = (p - b) / l->jerk;
    const float fall = p / l->jerk;
    const float hold = (change - 0.5f * (p + b) * rise - 0.5f * p * fall) / p;
    const float v1 = v - 0.5f * (p + b) * rise;
    const float v2 = v1 - p * hold;

    return way(v, -b, -l->jerk, rise) + way(v1, -p, 0.0f, hold) + way(v2, -p, l->jerk, fall);
}

float takt_braking_way(const struct braking_limits *l, float feed, float acceleration, float to)
{
    const float b = single_clamp(-acceleration, 0.0f, l->acceleration);
    float at = 0.0f;

    if (acceleration > 0.0f) {
        const float ends = acceleration / l->jerk;

        at = way(feed, acceleration, -l->jerk, ends);
        feed += 0.5f * acceleration * ends;
    }
    return feed - 0.5f * b * b / l->jerk > to ? at + way_braked(l, feed, b, to) : 0.0f;
}
