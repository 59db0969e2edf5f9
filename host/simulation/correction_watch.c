#include "simulation/correction_watch.h"

#include "base/maths.h"
#include "cli/axis_unit.h"
#include "cli/message.h"

void correction_watch_init(struct correction_watch *w, double cycle_s)
{
    *w = (struct correction_watch){.rate_hz = 1.0 / cycle_s};
}

static void raise_to(double *largest, double value)
{
    *largest = maths_max(*largest, maths_abs(value));
}

static void add_axis(struct correction_watch *w, unsigned i, double k_mm)
{
    const double v = (k_mm - w->k_mm[i]) * w->rate_hz;
    const double a = (v - w->v_mm_s[i]) * w->rate_hz;

    raise_to(&w->max_mm[i], k_mm);
    raise_to(&w->max_velocity_mm_s[i], v);
    raise_to(&w->max_acceleration_mm_s2[i], a);
    raise_to(&w->max_jerk_mm_s3[i], (a - w->a_mm_s2[i]) * w->rate_hz);
    w->k_mm[i] = k_mm;
    w->v_mm_s[i] = v;
    w->a_mm_s2[i] = a;
}

/* Once an axis. */
static void report_outside(struct correction_watch *w, unsigned outside,
                           const struct cycle_record *record, const char *program)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((outside & ~w->reported & 1U << i) != 0)
            message_warning(program, record->line, 0,
                            "axis %c leaves its correction table at %.3f %s: the edge value holds",
                            AXIS_LETTERS[i], record->cmd.at[i] * axis_unit_ratio(i),
                            axis_unit_name(i));
    }
    w->reported |= outside;
}

void correction_watch_add(struct correction_watch *w, struct correction *correction,
                          const struct cycle_record *record, const char *program)
{
    w->present = takt_correction_get_present(correction);
    if (w->present == 0)
        return;
    report_outside(w, takt_correction_take_outside(correction), record, program);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        add_axis(w, i, record->set.at[i] - record->cmd.at[i]);
}
