/* The even form: each axis steps when the way passes the middle between two of its positions. */
#include "base/assert.h"
#include "step/steps_private.h"

#include "base/maths.h"

/* One axis on its way: position x(t) = from + (to - from) t in steps, 0 <= t <= 1. */
struct way {
    double from, to;
    int64_t end; /* nearest position to `to` */
    double due;  /* t of the next step; MATHS_INFINITY: none is left */
};

/* x(t) = at + 1/2 (or at - 1/2): t = (at +- 1/2 - from) / (to - from) */
static void set_due(struct way *w, int64_t at)
{
    TAKT_ASSERT(w->due >= 0.0);
    if (at == w->end) {
        w->due = MATHS_INFINITY;
        return;
    }
    const double middle = (double)at + (w->end > at ? 0.5 : -0.5);
    const double length = w->to - w->from;

    w->due = length != 0.0 ? maths_clamp((middle - w->from) / length, 0.0, 1.0) : 0.0;
}

static void begin(const struct steps *s, const struct point *from, const struct point *to,
                  struct way way[AXIS_COUNT])
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double ratio = s->config.axis[i].steps_per_mm;

        way[i] = (struct way){.end = s->at[i], .due = MATHS_INFINITY};
        if (steps_has(s, i)) {
            way[i].from = from->at[i] * ratio;
            way[i].to = to->at[i] * ratio;
            way[i].end = (int64_t)takt_maths_round(way[i].to);
            set_due(&way[i], s->at[i]);
        }
    }
}

static double earliest(const struct way way[AXIS_COUNT])
{
    double due = MATHS_INFINITY;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        due = maths_min(due, way[i].due);
    }
    return due;
}

/* The axes due at that time. */
static struct evaluate_tick tick_at(const struct steps *s, const struct way way[AXIS_COUNT],
                                    double due)
{
    struct evaluate_tick tick = {0};

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (way[i].due <= due) {
            tick.axes |= (uint8_t)(1U << i);
            tick.direction |= (uint8_t)(way[i].end < s->at[i] ? 1U << i : 0U);
        }
    }
    return tick;
}

void takt_steps_even(struct steps *s, const struct step_port *port, const struct point *from,
                     const struct point *to, struct steps_span span)
{
    struct way way[AXIS_COUNT];
    double due;

    if (s->held.axes != 0) {
        return;
    }
    begin(s, from, to, way);
    while ((due = earliest(way)) <= 1.0) {
        const struct evaluate_tick tick = tick_at(s, way, due);

        if (!takt_steps_emit(s, port, span.from + (span.to - span.from) * due, &tick)) {
            return;
        }
        for (unsigned i = 0; i < AXIS_COUNT; i++) {
            if (evaluate_has(tick.axes, i)) {
                set_due(&way[i], s->at[i]);
            }
        }
    }
}
