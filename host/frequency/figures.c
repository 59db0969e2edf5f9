#include "frequency/figures.h"

#include "frequency/machines.h"

#include <math.h>
#include <stdio.h>

static void print_limits(unsigned limits)
{
    static const char *const names[] = {"feed", "acceleration", "jerk"};
    bool any = false;

    for (unsigned i = 0; i < 3; i++) {
        if ((limits >> i & 1U) == 0)
            continue;
        (void)printf("%s%s", any ? " and " : "", names[i]);
        any = true;
    }
}

static void print_limit(const char *name, double value, const char *unit)
{
    if (isfinite(value))
        (void)printf("%s %.6g %s", name, value, unit);
    else
        (void)printf("no limit of %s", name);
}

void frequency_print_question(const struct frequency_question *q)
{
    (void)printf("%s\n  limits       ", q->machine);
    print_limit("feed", q->limits.feed_mm_s * 60, "mm/min");
    (void)fputs(", ", stdout);
    print_limit("acceleration", q->limits.acceleration_mm_s2, "mm/s2");
    if (isfinite(q->limits.acceleration_mm_s2))
        (void)printf(" (%.4g g)", q->limits.acceleration_mm_s2 / STANDARD_GRAVITY_MM_S2);
    (void)fputs(", ", stdout);
    print_limit("jerk", q->limits.jerk_mm_s3 / 1000, "m/s3");
    (void)printf("\n  tolerance    %.6g mm (%.6g increments)\n", q->tolerance_mm,
                 q->tolerance_mm * q->resolution_per_mm);
}

void frequency_print_need(const struct frequency_question *q, const struct cycle_need *need)
{
    (void)printf("  needed       %.1f Hz, a cycle of at most %.4g ms\n", need->frequency_hz,
                 1000 / need->frequency_hz);
    (void)fputs("  governed by  ", stdout);
    print_limits(need->limits);
    (void)printf(", on a circle of R %.4g mm at %.6g mm/min\n", need->radius_mm,
                 need->feed_mm_s * 60);
    if (q->frequency_hz <= 0)
        return;
    (void)printf("  the cycle    %.6g Hz: %s; there the chord error would be %.4g mm\n",
                 q->frequency_hz,
                 q->frequency_hz >= need->frequency_hz
                     ? "enough"
                     : "too slow, so the feed of curves is limited to keep the tolerance",
                 takt_cycle_chord_error_mm(need->radius_mm,
                                           takt_cycle_step_mm(need->feed_mm_s, q->frequency_hz)));
}

static void print_row(const struct frequency_question *q, double radius_mm)
{
    unsigned limits;
    double feed = takt_cycle_feed_allowed_mm_s(&q->limits, radius_mm, &limits);

    (void)printf("  %10.4g %12.6g %12.1f", radius_mm, feed * 60,
                 takt_cycle_frequency_hz(radius_mm, feed, q->tolerance_mm));
    if (q->frequency_hz > 0)
        (void)printf(
            " %14.6g %14.4g",
            60 * takt_cycle_feed_chord_mm_s(radius_mm, q->frequency_hz, q->tolerance_mm),
            takt_cycle_chord_error_mm(radius_mm, takt_cycle_step_mm(feed, q->frequency_hz)));
    (void)fputs("  ", stdout);
    print_limits(limits);
    (void)fputc('\n', stdout);
}

/* 1, 2, 5 of each decade from the tolerance to far beyond the radius that needs most. */
void frequency_print_table(const struct frequency_question *q, const struct cycle_need *need)
{
    static const double steps[] = {1, 2, 5};
    int first = (int)floor(log10(q->tolerance_mm));
    double radius_mm = pow(10, first), last = 1000 * need->radius_mm;

    (void)printf("\n  %10s %12s %12s", "R [mm]", "F [mm/min]", "needed [Hz]");
    if (q->frequency_hz > 0)
        (void)printf(" %14s %14s", "F chord", "error [mm]");
    (void)fputs("  by\n", stdout);
    for (int i = 1; radius_mm <= last; i++) {
        int decade = i / 3;

        if (radius_mm >= q->tolerance_mm)
            print_row(q, radius_mm);
        radius_mm = steps[i % 3] * pow(10, first + decade);
    }
}
