#include "controller/spindle_watch.h"

#include "base/maths.h"

/* Feedback is older than the command by less than this. */
#define FEEDBACK_CYCLES 4

void spindle_watch_init(struct spindle_watch *w, double cycle_s, double load_limit_percent,
                        double at_speed_s)
{
    *w = (struct spindle_watch){.cycle_s = cycle_s,
                                .load_limit_percent = load_limit_percent,
                                .at_speed_s = at_speed_s,
                                .ratio = 1.0};
}

void spindle_watch_pass(struct spindle_watch *w, const struct move *event)
{
    if (event->kind == MOVE_SPINDLE) {
        w->waits = w->at_speed_s > 0.0 && event->direction != SPINDLE_OFF;
        w->waited = 0;
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

bool spindle_watch_cycle(struct spindle_watch *w, const struct spindle_feedback *spindle)
{
    w->ratio = maths_clamp(w->ratio + ratio_rate(w, spindle->load_percent) * w->cycle_s,
                           SPINDLE_RATIO_MIN, 1.0);
    if (!w->waits) {
        return true;
    }
    w->waited++;
    w->waits = w->waited < FEEDBACK_CYCLES || !spindle->at_speed;
    return !w->waits || (double)w->waited * w->cycle_s <= w->at_speed_s;
}
