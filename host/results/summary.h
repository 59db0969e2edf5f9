/*
 * What a run comes to: figures, checks, and their three forms: JSON (summary.schema.json), JUnit,
 * text.
 */
#ifndef TAKT_HOST_SUMMARY_H
#define TAKT_HOST_SUMMARY_H

#include "base/error.h"
#include "session/session.h"
#include "simulation/bus_plan.h"
#include "simulation/drives_table.h"
#include "simulation/simulation.h"
#include "verifier/verifier.h"

#include <stdbool.h>
#include <stdio.h>

enum summary_outcome {
    OUTCOME_COMPLETED,
    OUTCOME_STOPPED,    /* by --until */
    OUTCOME_FAULTED,    /* by a drive or the program */
    OUTCOME_INTERRUPTED /* by a signal, or the loss of the bus */
};

#define SUMMARY_CHECK_NAME_MAX 31
#define SUMMARY_CHECKS_MAX     (5 * AXIS_COUNT + 8 + 2 * CAN_BUSES_MAX)

struct summary_check {
    char name[SUMMARY_CHECK_NAME_MAX + 1];
    const char *unit;
    bool held; /* value <= limit */
    double value, limit;
};

/* The text of a fault, and what helps. */
#define SUMMARY_FAULT_MAX 400

struct summary_bus {
    uint64_t frames;
    double load_percent;
    double predicted_percent;
    struct bus_plan plan;
    uint64_t response_ns[BUS_PLAN_MAX]; /* observed, of the plan's messages */
};

struct summary {
    const char *program;
    const struct machine *machine;
    enum summary_outcome outcome;
    enum command_status interrupted; /* OUTCOME_INTERRUPTED: the status it ends with */
    char fault[SUMMARY_FAULT_MAX];   /* OUTCOME_FAULTED */
    double cycle_s;
    double wall_time_s;
    struct verifier_figures figures;
    struct correction_watch correction;
    struct tool_point tool_point;
    const struct virtual_steppers *steppers;
    struct interpolator_errors interpolator;
    unsigned buses;
    struct summary_bus bus[CAN_BUSES_MAX];
    struct drives_table drives;
    bool responses_observed; /* by a program, and on embedded buses */
    bool is_paced;
    struct pace_figures pace;
    struct pace_permission permission;
    const struct target *target;             /* NULL: the run was on none */
    const struct drive_images *drive_images; /* NULL: the drives were none */
    bool cost_measured;
    double cost_min_ns, cost_mean_ns, cost_p99_ns, cost_max_ns;
    unsigned checks;
    struct summary_check check[SUMMARY_CHECKS_MAX];
};

/* What a run leaves behind. All of it must outlive the summary. */
struct summary_source {
    const struct session *session;
    const struct session_totals *totals;
    const struct simulation *simulation;
    const struct verifier *verifier; /* finished */
    enum summary_outcome outcome;
    enum command_status interrupted; /* OUTCOME_INTERRUPTED: the status it ends with */
    double wall_time_s;
};

void summary_set(struct summary *summary, const struct summary_source *source);
bool summary_held(const struct summary *summary);
/* With which takt run ends. */
enum command_status summary_status(const struct summary *summary);
const char *summary_outcome_name(enum summary_outcome outcome);
double summary_program_time_s(const struct summary *summary);
double summary_realtime_ratio(const struct summary *summary); /* 0: no time has passed */

/* Zero-terminated, the caller frees it with free(); NULL: out of memory. */
char *summary_json(const struct summary *summary);
void summary_write_junit(FILE *stream, const struct summary *summary);
void summary_write_text(FILE *stream, const struct summary *summary);

#endif
