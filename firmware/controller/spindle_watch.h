/*
 * What the spindle's feedback does to the feed: motion waits until it has reached its speed, and
 * goes slower while it is loaded beyond its limit.
 *
 *     load > limit    ratio falls by (load/limit - 1) / SPINDLE_FALL_S a second, not below SPINDLE_RATIO_MIN
 *     load <= limit   ratio rises by 1 / SPINDLE_RISE_S a second, up to 1
 *
 * Feeds per revolution go by the measured speed, smoothed over SPINDLE_SMOOTH_S; changes by less
 * than SPINDLE_STEP of it are not told.
 *
 * The ratio multiplies the feed override; acceleration and jerk of the change are the planner's.
 */
#ifndef TAKT_CONTROLLER_SPINDLE_WATCH_H
#define TAKT_CONTROLLER_SPINDLE_WATCH_H

#include "hal/inputs.h"
#include "program/move.h"

#include <stdbool.h>
#include <stdint.h>

#define SPINDLE_FALL_S    0.5
#define SPINDLE_RISE_S    2.0
#define SPINDLE_RATIO_MIN 0.1
#define SPINDLE_SMOOTH_S  0.03
#define SPINDLE_STEP      0.002

struct spindle_watch {
    double cycle_s;
    double smoothing;          /* part of a change of speed that a cycle follows */
    double load_limit_percent; /* 0: the load changes nothing */
    double at_speed_s;         /* longest wait for a commanded speed; 0: none is made */
    double ratio;              /* of the feed, SPINDLE_RATIO_MIN ... 1 */
    bool rests;                /* a spindle that stands changes nothing here */
    bool waits;                /* for the speed commanded last */
    uint64_t waited;           /* cycles */
    double smooth_rev_s;       /* measured speed, >= 0 */
    double rev_s;              /* as told; 0: it stands */
};

void takt_spindle_watch_init(struct spindle_watch *w, double cycle_s, double load_limit_percent,
                             double at_speed_s);

/* Motion has passed an event: a speed that has been commanded is waited for. */
void takt_spindle_watch_pass(struct spindle_watch *w, const struct move *event);

/* Every control cycle. False: the speed has not been reached in time. */
bool takt_spindle_watch_look(struct spindle_watch *w, const struct spindle_feedback *spindle);
static inline bool spindle_watch_cycle(struct spindle_watch *w,
                                       const struct spindle_feedback *spindle)
{
    return (w->rests && spindle->speed_rpm == 0.0) || takt_spindle_watch_look(w, spindle);
}

#endif
