/*
 * A number that follows its target smoothly, without overshooting (2e-5 of the step at most): what
 * switches on and off while axes move goes through one of these. The number, its velocity and its
 * acceleration are continuous whatever the target does, and the jerk is bounded.
 */
#ifndef TAKT_CORRECTION_FADE_H
#define TAKT_CORRECTION_FADE_H

#include "base/maths.h"

#include <stdbool.h>

struct fade {
    double value;
    double slope;  /* change of the value per cycle */
    double second; /* change of the slope per cycle */
};

/* How fast a fade is: made once from the time it takes. */
struct fade_pace {
    double rate;    /* per cycle */
    double cycle_s; /* control cycle */
};

/* Shortest time of a fade, in control cycles. */
#define FADE_CYCLES_MIN 40

/* time_s: until 99 % of a step are done; at least FADE_CYCLES_MIN cycles are taken. */
void takt_fade_pace_set(struct fade_pace *pace, double time_s, double cycle_s);

/*
 * Nearer than this the value is taken for its target: far below a drive's increment, whatever it is
 * multiplied by.
 */
#define FADE_NEAR 1e-9

/*
 * One cycle. True while the value moves; when it has come it is the target itself, to the last bit.
 * The differential equation w''' = p^3 (target - w) - 3 p^2 w' - 3 p w'', in steps of a cycle; p in
 * 1/cycle. The third difference of the values is the step itself, so it is bounded as the jerk of
 * the equation is.
 */
static inline bool fade_cycle(struct fade *f, double target, const struct fade_pace *pace)
{
    const double p = pace->rate;
    const double gap = target - f->value;

    if (maths_abs(gap) + maths_abs(f->slope) + maths_abs(f->second) <
        FADE_NEAR * maths_max(1.0, maths_abs(target))) {
        *f = (struct fade){target, 0.0, 0.0};
        return false;
    }
    f->second += p * (p * (p * gap - 3.0 * f->slope) - 3.0 * f->second);
    f->slope += f->second;
    f->value += f->slope;
    return true;
}

/* Has it come to target? */
static inline bool fade_is_at(const struct fade *f, double target)
{
    return f->value == target && f->slope == 0.0 && f->second == 0.0;
}

/*
 * Largest velocity, acceleration and jerk of the value for a target that jumps between 0 and 1 at
 * any times.
 */
double takt_fade_velocity_per_s(const struct fade_pace *pace);
double takt_fade_acceleration_per_s2(const struct fade_pace *pace);
double takt_fade_jerk_per_s3(const struct fade_pace *pace);

#endif
