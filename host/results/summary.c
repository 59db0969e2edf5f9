#include "results/summary.h"

#include "base/maths.h"
#include "cli/axis_unit.h"

/*
 * Above the largest chord error a machine allows: rounding of the planner's and the verifier's
 * formula.
 */
#define SUMMARY_CHORD_ROOM_MM 1e-6

const char *summary_outcome_name(enum summary_outcome outcome)
{
    static const char *const names[] = {"completed", "stopped", "faulted", "interrupted"};

    return names[outcome];
}

double summary_program_time_s(const struct summary *summary)
{
    return (double)summary->figures.cycles * summary->cycle_s;
}

double summary_realtime_ratio(const struct summary *summary)
{
    return summary->wall_time_s > 0 ? summary_program_time_s(summary) / summary->wall_time_s : 0;
}

bool summary_held(const struct summary *summary)
{
    for (unsigned i = 0; i < summary->checks; i++) {
        if (!summary->check[i].held)
            return false;
    }
    return true;
}

enum command_status summary_status(const struct summary *summary)
{
    if (summary->outcome == OUTCOME_INTERRUPTED)
        return summary->interrupted;
    if (!summary_held(summary))
        return STATUS_FAILED;
    return summary->outcome == OUTCOME_STOPPED ? STATUS_STOPPED : STATUS_DONE;
}

/* axis: index, or AXIS_COUNT for a check that is not of an axis. */
static void add_check(struct summary *summary, const char *name, unsigned axis, const char *unit,
                      double value, double limit)
{
    struct summary_check *check = &summary->check[summary->checks++];

    if (axis < AXIS_COUNT)
        (void)snprintf(check->name, sizeof check->name, "%s.%c", name, AXIS_LETTERS[axis]);
    else
        (void)snprintf(check->name, sizeof check->name, "%s", name);
    check->unit = unit;
    check->value = value;
    check->limit = limit;
    check->held = value <= limit;
}

static void check_axis(struct summary *summary, unsigned i)
{
    static const char *const units[2][3] = {{"mm/s", "mm/s2", "mm/s3"},
                                            {"deg/s", "deg/s2", "deg/s3"}};
    const char *const *unit = units[axis_unit_is_rotary(i) ? 1 : 0];
    const struct machine_axis *axis = &summary->machine->axis[i];
    const struct verifier_figures *figures = &summary->figures;
    double ratio = axis_unit_ratio(i);

    add_check(summary, "velocity", i, unit[0], figures->velocity_mm_s[i] * ratio,
              axis->max_velocity_mm_s * ratio * VERIFIER_VELOCITY_RATIO);
    add_check(summary, "acceleration", i, unit[1], figures->acceleration_mm_s2[i] * ratio,
              axis->max_acceleration_mm_s2 * ratio * VERIFIER_ACCELERATION_RATIO);
    add_check(summary, "jerk", i, unit[2], figures->jerk_mm_s3[i] * ratio,
              axis->max_jerk_mm_s3 * ratio * VERIFIER_JERK_RATIO);
    if (axis->following_error_max_mm > 0)
        add_check(summary, "following", i, axis_unit_name(i),
                  figures->following_error_mm[i] * ratio, axis->following_error_max_mm * ratio);
    if (machine_axis_is_stepped(axis))
        add_check(summary, "missed_steps", i, "steps", (double)summary->steppers->axis[i].missed,
                  0);
}

static void check_path(struct summary *summary)
{
    const struct verifier_figures *figures = &summary->figures;

    add_check(summary, "landing", AXIS_COUNT, "mm", figures->landing_error_mm,
              VERIFIER_LANDING_MAX_MM);
    add_check(summary, "path", AXIS_COUNT, "mm", figures->path_error_mm,
              VERIFIER_PATH_MAX_MM + figures->chord_error_mm);
    if (figures->smoothed_path_part > 0) {
        add_check(summary, "smoothed_path", AXIS_COUNT, "of P", figures->smoothed_path_part, 1);
        add_check(summary, "smoothed_corner", AXIS_COUNT, "of P", figures->smoothed_corner_part, 1);
    }
    add_check(summary, "chord", AXIS_COUNT, "mm", figures->chord_error_mm,
              1.0 / summary->machine->resolution_per_mm + SUMMARY_CHORD_ROOM_MM);
}

/*
 * After a complete run nothing may be missing; a run that ended early may only not have done what
 * is not there. What waits behind the last motion with a length may have the number of one without.
 */
static void check_blocks(struct summary *summary, const struct summary_source *source)
{
    double missing = source->verifier->strayed ? 1 : 0;

    if (source->outcome == OUTCOME_COMPLETED && !source->verifier->strayed)
        missing =
            source->totals->is_open
                ? maths_abs(verifier_get_missing(source->verifier))
                : maths_max(0, (double)source->totals->last - (double)summary->figures.blocks);
    add_check(summary, "blocks_missing", AXIS_COUNT, "", missing, 0);
}

static void set_cost(struct summary *summary, const struct cycle_cost *cost)
{
    summary->cost_measured = cost->count > 0;
    if (!summary->cost_measured)
        return;
    summary->cost_min_ns = (double)cost->min_ns;
    summary->cost_mean_ns = (double)cost->sum_ns / (double)cost->count;
    summary->cost_p99_ns = cycle_cost_get_p99_ns(cost);
    summary->cost_max_ns = (double)cost->max_ns;
}

/* The first bus has the plain name. */
static void add_bus_check(struct summary *summary, unsigned bus, const char *name, double percent)
{
    char full[SUMMARY_CHECK_NAME_MAX + 1];

    if (bus > 0)
        (void)snprintf(full, sizeof full, "%s.can%u", name, bus);
    add_check(summary, bus > 0 ? full : name, AXIS_COUNT, "%", percent, 100);
}

static bool is_planned(const struct summary *summary)
{
    return !drives_table_has(&summary->drives, DRIVES_NO_SILENCE) &&
           !drives_table_has(&summary->drives, DRIVES_NO_ONE_REPORT) &&
           !drives_table_has(&summary->drives, DRIVES_NO_SYNC_REPORT);
}

/*
 * Predicted and observed; what faults of the buses, and frames that nobody wants or that come by a
 * timer of the drive, have done is no fault of the prediction.
 */
static void set_responses(struct summary *summary, const struct drive_network *network,
                          const struct drives *drives, unsigned index)
{
    struct summary_bus *bus = &summary->bus[index];
    double nearest = 0;

    bus_plan_set(&bus->plan, summary->machine, drives, index);
    if (!summary->responses_observed)
        return;
    bus_plan_get_observed(&bus->plan, &network->bus[index], bus->response_ns);
    for (unsigned i = 0; i < bus->plan.count; i++)
        nearest =
            maths_max(nearest, 100.0 * (double)bus->response_ns[i] / (double)bus->plan.worst_ns[i]);
    if (drive_network_is_sound(network) && is_planned(summary))
        add_bus_check(summary, index, "bus_response", nearest);
}

static void set_buses(struct summary *summary, const struct drive_network *network,
                      const struct drives *drives)
{
    summary->buses = network->buses;
    summary->responses_observed = !network->is_outside && summary->figures.cycles > 0;
    for (unsigned i = 0; i < network->buses; i++) {
        struct summary_bus *bus = &summary->bus[i];
        const double found_percent = summary->drives.load[i].percent;

        bus->frames = drive_network_get_frames(network, i);
        bus->load_percent = drive_network_get_load_percent(network, i);
        bus->predicted_percent = found_percent > 0
                                     ? found_percent
                                     : machine_setup_predict_load_percent(summary->machine, i);
        add_bus_check(summary, i, "bus_load", bus->load_percent);
        set_responses(summary, network, drives, i);
    }
}

static void set_pace(struct summary *summary, const struct drive_network *network)
{
    summary->is_paced = network->is_paced;
    if (!network->is_paced)
        return;
    pace_get_figures(&network->pace, &summary->pace);
    summary->permission = network->permission;
}

/* Whatever the image did otherwise than the host, it did wrong. */
static void set_target(struct summary *summary, const struct simulation *simulation)
{
    if (!simulation->has_target)
        return;
    summary->target = &simulation->target;
    add_check(summary, "target", AXIS_COUNT, "cycles", (double)simulation->target.differences, 0);
}

/* The same of drives. */
static void set_drive_images(struct summary *summary, const struct simulation *simulation)
{
    const struct drive_images *images = &simulation->network.images;

    if (images->count == 0)
        return;
    summary->drive_images = images;
    add_check(summary, "drive_images", AXIS_COUNT, "frames and torques",
              (double)drive_images_differences(images), 0);
}

/* A spindle that cuts and has tripped has stood in the material. */
static void check_spindle(struct summary *summary, const struct virtual_spindle *spindle)
{
    if (spindle->config.cut_width_mm > 0)
        add_check(summary, "spindle_trip", AXIS_COUNT, "", (double)spindle->trip, 0);
}

static void set_fault(struct summary *summary, const struct diagnostic *fault)
{
    const char *remedy = drives_table_remedy(fault);
    char text[DIAGNOSTIC_TEXT_MAX];

    (void)takt_diagnostic_text(fault, text);
    (void)snprintf(summary->fault, sizeof summary->fault, "%s%s%s", text,
                   remedy[0] != '\0' ? ": " : "", remedy);
}

void summary_set(struct summary *summary, const struct summary_source *source)
{
    const struct simulation *simulation = source->simulation;
    const struct machine *machine = &source->session->setup.machine;
    const struct drives *drives = takt_controller_get_drives(&simulation->controller);

    *summary = (struct summary){
        .program = source->session->program.name,
        .machine = machine,
        .outcome = source->outcome,
        .interrupted = source->interrupted,
        .cycle_s = 1e-6 * (double)machine->cycle_us,
        .wall_time_s = source->wall_time_s,
        .figures = source->verifier->figures,
        .correction = simulation->correction,
        .tool_point = simulation->tool_point,
        .steppers = &simulation->network.steppers,
        .interpolator = *takt_controller_get_interpolator_errors(&simulation->controller),
    };
    tool_point_finish(&summary->tool_point);
    drives_table_set(&summary->drives, drives);
    if (source->outcome == OUTCOME_FAULTED)
        set_fault(summary, takt_controller_get_fault(&simulation->controller));
    set_cost(summary, &simulation->cost);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present)
            check_axis(summary, i);
    }
    check_path(summary);
    check_blocks(summary, source);
    set_buses(summary, &simulation->network, drives);
    set_pace(summary, &simulation->network);
    set_target(summary, simulation);
    set_drive_images(summary, simulation);
    check_spindle(summary, &simulation->spindle);
    add_check(summary, "fault", AXIS_COUNT, "", source->outcome == OUTCOME_FAULTED ? 1 : 0, 0);
}
