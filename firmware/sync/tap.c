#include "sync/tap.h"

#include "base/maths.h"

/*
 * From a command to the spindle's obeying it, at most; of its ramp, what is used in slowing down.
 */
#define DELAY_S   0.02
#define RAMP_PART 0.5

/* It turns back so far above the bottom, rev, and is not slowed below this before. */
#define GUARD_REV  0.02
#define SLOW_REV_S 1.0

double takt_tap_turns(const struct tap *t)
{
    const double w = t->in_rev_s;

    return GUARD_REV + w * DELAY_S + 0.5 * w * w / t->ramp_rev_s2;
}

/*
 * Turning back at once takes w delay + w^2/(2 ramp) more turns. As long as there are more than
 * these the speed is that from which the rest can be slowed down in: w = sqrt(2 part ramp (turns
 * left - w delay)).
 */
double takt_tap_command(struct tap *t, double turns_left, double speed_rev_s)
{
    const double w = maths_max(0.0, speed_rev_s);
    const double left = turns_left - GUARD_REV - w * DELAY_S;

    if (t->phase == TAP_IN && left <= 0.5 * w * w / t->ramp_rev_s2) {
        t->phase = TAP_TURNS;
    }
    if (t->phase != TAP_IN) {
        return -t->out_rev_s;
    }
    const double slower =
        maths_max(SLOW_REV_S, maths_sqrt(2.0 * RAMP_PART * t->ramp_rev_s2 * left));

    return maths_min(t->in_rev_s, slower);
}
