/*
 * The spindle's part in rigid tapping: slower towards the bottom, so that it turns back there and
 * not below, then out.
 */
#ifndef TAKT_SYNC_TAP_H
#define TAKT_SYNC_TAP_H

#include <stdbool.h>

enum tap_phase {
    TAP_NONE, /* a thread */
    TAP_IN,
    TAP_TURNS, /* the order to turn back has been given */
    TAP_OUT    /* the axes have turned round */
};

struct tap {
    enum tap_phase phase;
    double in_rev_s;    /* commanded, > 0 */
    double out_rev_s;   /* > 0 */
    double ramp_rev_s2; /* by which the spindle's drive changes its speed, > 0 */
};

/* Is it one, and no thread? */
static inline bool tap_is(const struct tap *t)
{
    return t->phase != TAP_NONE;
}

/* Turns that turning back takes at least. */
double takt_tap_turns(const struct tap *t);

/*
 * Each cycle: the speed to command, positive into the hole. turns_left: to the bottom, speed_rev_s:
 * as measured.
 */
double takt_tap_command(struct tap *t, double turns_left, double speed_rev_s);

#endif
