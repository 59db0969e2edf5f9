/*
 * A number that follows its target smoothly, without overshooting (2e-5 of the step at most): what switches on and off while axes move goes
 * through one of these. The number, its velocity and its acceleration are continuous whatever the target does, and the
 * jerk is bounded.
 */
#ifndef TAKT_CORRECTION_FADE_H
#define TAKT_CORRECTION_FADE_H

#include <stdbool.h>

struct fade {
    double value;
    double slope; /* change of the value per cycle */
    double bend;  /* change of the slope per cycle */
};

/* How fast a fade is: made once from the time it takes. */
struct fade_pace {
    double rate;    /* per cycle */
    double cycle_s; /* control cycle */
};

/* Shortest time of a fade, in control cycles. */
#define FADE_CYCLES_MIN 40

/* time_s: until 99 % of a step are done; at least FADE_CYCLES_MIN cycles are taken. */
void fade_pace_set(struct fade_pace *pace, double time_s, double cycle_s);

/* One cycle. True while the value moves; when it has come it is the target itself, to the last bit. */
bool fade_cycle(struct fade *f, double target, const struct fade_pace *pace);

/* Has it come to target? */
static inline bool fade_is_at(const struct fade *f, double target)
{
    return f->value == target && f->slope == 0.0 && f->bend == 0.0;
}

/* Largest velocity, acceleration and jerk of the value for a target that jumps between 0 and 1 at any times. */
double fade_velocity_per_s(const struct fade_pace *pace);
double fade_acceleration_per_s2(const struct fade_pace *pace);
double fade_jerk_per_s3(const struct fade_pace *pace);

#endif
