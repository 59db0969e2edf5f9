#include "controller/spindle_watch.h"

#include "base/assert.h"
#include "base/maths.h"

/* Feedback is older than the command by less than this. */
#define FEEDBACK_CYCLES 4

#define SECONDS_PER_MINUTE 60.0

/* Slower than this it stands: 1 rev/min. */
#define STANDS_REV_S (1.0 / SECONDS_PER_MINUTE)

void takt_spindle_watch_init(struct spindle_watch *w, double cycle_s, double load_limit_percent,
                             double at_speed_s)
{
    TAKT_ASSERT(cycle_s > 0.0);
    *w = (struct spindle_watch){.cycle_s = cycle_s,
                                .smoothing = cycle_s / (SPINDLE_SMOOTH_S + cycle_s),
                                .load_limit_percent = load_limit_percent,
                                .at_speed_s = at_speed_s,
                                .rests = !(load_limit_percent > 0.0),
                                .ratio = 1.0};
}

void takt_spindle_watch_pass(struct spindle_watch *w, const struct move *event)
{
    if (event->kind == MOVE_SPINDLE) {
        w->waits = w->at_speed_s > 0.0 && event->direction != SPINDLE_OFF;
        w->waited = 0;
        w->rests = false;
    }
}

/* 1/s by which the ratio changes. */
static double ratio_rate(const struct spindle_watch *w, double load_percent)
{
    if (w->load_limit_percent > 0.0 && load_percent > w->load_limit_percent) {
        return (1.0 - load_percent / w->load_limit_percent) / SPINDLE_FALL_S;
    }
    return 1.0 / SPINDLE_RISE_S;
}

static void follow_speed(struct spindle_watch *w, double speed_rpm)
{
    const double rev_s = maths_abs(speed_rpm) * (1.0 / SECONDS_PER_MINUTE);

    TAKT_ASSERT(w->cycle_s > 0.0);
    if (rev_s == 0.0 && w->smooth_rev_s == 0.0) {
        return;
    }
    w->smooth_rev_s += (rev_s - w->smooth_rev_s) * w->smoothing;
    if (w->smooth_rev_s < STANDS_REV_S) {
        w->rev_s = 0.0;
    } else if (maths_abs(w->smooth_rev_s - w->rev_s) > SPINDLE_STEP * w->smooth_rev_s) {
        w->rev_s = w->smooth_rev_s;
    }
}

bool takt_spindle_watch_look(struct spindle_watch *w, const struct spindle_feedback *spindle)
{
    const bool loads = w->ratio < 1.0 || w->load_limit_percent > 0.0;

    if (loads) {
        w->ratio = maths_clamp(w->ratio + ratio_rate(w, spindle->load_percent) * w->cycle_s,
                               SPINDLE_RATIO_MIN, 1.0);
    }
    follow_speed(w, spindle->speed_rpm);
    w->rests = !loads && !w->waits && w->smooth_rev_s == 0.0;
    if (!w->waits) {
        return true;
    }
    w->waited++;
    w->waits = w->waited < FEEDBACK_CYCLES || !spindle->at_speed;
    return !w->waits || (double)w->waited * w->cycle_s <= w->at_speed_s;
}
