/* The summary as people read it. */
#include "cli/axis_unit.h"
#include "results/summary.h"
#include "results/summary_correction.h"
#include "results/summary_steps.h"

#include <inttypes.h>

/* 0:01:23.456 */
static void write_time(FILE *stream, double time_s)
{
    uint64_t ms = (uint64_t)(time_s * 1000.0 + 0.5);

    (void)fprintf(stream, "%" PRIu64 ":%02u:%02u.%03u", ms / 3600000, (unsigned)(ms / 60000 % 60),
                  (unsigned)(ms / 1000 % 60), (unsigned)(ms % 1000));
}

static void write_head(FILE *stream, const struct summary *summary)
{
    const struct verifier_figures *figures = &summary->figures;

    (void)fprintf(stream, "%s on %s: %s\n", summary->program, summary->machine->name,
                  summary_outcome_name(summary->outcome));
    if (summary->outcome == OUTCOME_FAULTED)
        (void)fprintf(stream, "  fault         %s\n", summary->fault);
    (void)fputs("  program time  ", stream);
    write_time(stream, summary_program_time_s(summary));
    (void)fprintf(stream, "   (%" PRIu64 " cycles of %g ms)\n", figures->cycles,
                  summary->cycle_s * 1000);
    (void)fprintf(stream, "  wall time     %.3f s, %.0f x real time", summary->wall_time_s,
                  summary_realtime_ratio(summary));
    if (summary->cost_measured)
        (void)fprintf(stream, "; a control cycle takes %.2f us (99 %%: %.2f, max: %.2f)",
                      summary->cost_mean_ns / 1000, summary->cost_p99_ns / 1000,
                      summary->cost_max_ns / 1000);
    (void)fprintf(stream, "\n  path          %.3f mm in %u moves\n", figures->path_length_mm,
                  (unsigned)figures->blocks);
}

static void write_peak(FILE *stream, double value, double limit, double ratio)
{
    (void)fprintf(stream, "  %10.3f /%9.7g %5.1f %%", value * ratio, limit * ratio,
                  100 * value / limit);
}

static void write_axis(FILE *stream, const struct summary *summary, unsigned i)
{
    const struct machine_axis *axis = &summary->machine->axis[i];
    const struct verifier_figures *figures = &summary->figures;
    double ratio = axis_unit_ratio(i);

    (void)fprintf(stream, "  %c (%s)%*s", AXIS_LETTERS[i], axis_unit_name(i),
                  axis_unit_is_rotary(i) ? 0 : 1, "");
    write_peak(stream, figures->velocity_mm_s[i], axis->max_velocity_mm_s, ratio);
    write_peak(stream, figures->acceleration_mm_s2[i], axis->max_acceleration_mm_s2, ratio);
    write_peak(stream, figures->jerk_mm_s3[i], axis->max_jerk_mm_s3, ratio);
    (void)fprintf(stream, "  %9.6f\n", figures->following_error_mm[i] * ratio);
}

static void write_axes(FILE *stream, const struct summary *summary)
{
    (void)fprintf(stream, "\n  %-7s  %-28s  %-28s  %-28s  %s\n", "axis",
                  "peak velocity / limit [1/s]", "acceleration [1/s2]", "jerk [1/s3]", "lag");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (summary->machine->axis[i].present)
            write_axis(stream, summary, i);
    }
}

/* The longest of the frames of a cycle, on an outside bus only predicted. */
static void write_response(FILE *stream, const struct summary *summary,
                           const struct summary_bus *bus)
{
    uint64_t predicted_ns = 0, observed_ns = 0;

    for (unsigned i = 0; i < bus->plan.count; i++) {
        const uint64_t worst_ns = bus->plan.worst_ns[i];

        if (worst_ns != UINT64_MAX && worst_ns > predicted_ns)
            predicted_ns = worst_ns;
        if (bus->response_ns[i] > observed_ns)
            observed_ns = bus->response_ns[i];
    }
    (void)fprintf(stream, "                longest response ");
    if (summary->responses_observed)
        (void)fprintf(stream, "%.0f us ", 1e-3 * (double)observed_ns);
    (void)fprintf(stream, "(worst case %.0f us)\n", 1e-3 * (double)predicted_ns);
}

/* One is the bus; of several each has the name that it has in a log. */
static void write_buses(FILE *stream, const struct summary *summary)
{
    for (unsigned i = 0; i < summary->buses; i++) {
        const struct summary_bus *bus = &summary->bus[i];
        char name[8] = "bus";

        if (summary->buses > 1)
            (void)snprintf(name, sizeof name, "can%u", i % 10);
        (void)fprintf(stream, "  %-13s %" PRIu64 " frames, load %.1f %% (worst case %.1f %%)\n",
                      name, bus->frames, bus->load_percent, bus->predicted_percent);
        write_response(stream, summary, bus);
    }
}

static void write_pace(FILE *stream, const struct summary *summary)
{
    const struct pace_figures *pace = &summary->pace;

    if (!summary->is_paced)
        return;
    (void)fprintf(stream,
                  "  real time     cycles begin %.1f us late (99 %%: %.0f, max: %.0f), %" PRIu64
                  " overruns; %s priority, memory %s\n",
                  1e-3 * pace->lateness_mean_ns, 1e-3 * pace->lateness_p99_ns,
                  1e-3 * (double)pace->lateness_max_ns, pace->overruns,
                  summary->permission.has_priority ? "real-time" : "normal",
                  summary->permission.has_memory ? "locked" : "not locked");
}

static void write_drive_images(FILE *stream, const struct summary *summary)
{
    const struct drive_images *images = summary->drive_images;
    char first[DRIVE_IMAGES_FIRST_MAX];
    uint64_t differences;

    if (images == NULL)
        return;
    differences = drive_images_differences(images);
    (void)fprintf(stream, "  drives        %u on %s: ", images->count, images->name);
    if (differences == 0) {
        (void)fprintf(stream, "every frame and torque as on the host, bit for bit\n");
        return;
    }
    drive_images_write_first(images, first);
    (void)fprintf(stream, "%" PRIu64 " frames and torques differ from the host's, first %s\n",
                  differences, first);
}

static void write_target(FILE *stream, const struct summary *summary)
{
    const struct target *target = summary->target;
    const struct target_cost *cost = target != NULL ? &target->cost : NULL;

    if (target == NULL)
        return;
    (void)fprintf(stream, "  target        %s: ", target->name);
    if (target->differences == 0)
        (void)fprintf(stream, "every cycle as on the host, bit for bit\n");
    else
        (void)fprintf(stream,
                      "%" PRIu64 " cycles differ from the host's, the first is number %" PRIu64
                      " since power-on\n",
                      target->differences, target->first_difference);
    if (cost->cycles > 0 && cost->blocks > 0)
        (void)fprintf(stream,
                      "                a cycle takes %.0f instructions (max: %" PRIu64
                      "), planning %.0f a block\n",
                      (double)cost->sum / (double)cost->cycles, cost->max,
                      (double)cost->background_sum / (double)cost->blocks);
}

static void write_path(FILE *stream, const struct summary *summary)
{
    const struct verifier_figures *figures = &summary->figures;

    (void)fprintf(stream, "\n  landing error %.3g mm   path error %.3g mm   chord error %.3g mm\n",
                  figures->landing_error_mm, figures->path_error_mm, figures->chord_error_mm);
    (void)fprintf(stream, "  feed step     %.3g mm/s at most at a junction\n",
                  figures->junction_feed_step_mm_s);
    write_buses(stream, summary);
    drives_table_write_text(stream, &summary->drives);
    write_pace(stream, summary);
    summary_steps_write_text(stream, summary);
    write_target(stream, summary);
    write_drive_images(stream, summary);
}

static void write_checks(FILE *stream, const struct summary *summary)
{
    unsigned held = 0;

    for (unsigned i = 0; i < summary->checks; i++)
        held += summary->check[i].held ? 1 : 0;
    (void)fprintf(stream, "  checks        %u of %u held\n", held, summary->checks);
    for (unsigned i = 0; i < summary->checks; i++) {
        const struct summary_check *check = &summary->check[i];
        const char *space = check->unit[0] != '\0' ? " " : "";

        if (!check->held)
            (void)fprintf(stream, "    FAILED      %s: %.9g%s%s, limit %.9g%s%s\n", check->name,
                          check->value, space, check->unit, check->limit, space, check->unit);
    }
}

void summary_write_text(FILE *stream, const struct summary *summary)
{
    write_head(stream, summary);
    write_axes(stream, summary);
    write_path(stream, summary);
    summary_correction_write_text(stream, summary);
    write_checks(stream, summary);
    (void)fprintf(stream, "  digest        %016" PRIx64 "\n", summary->figures.digest);
}
