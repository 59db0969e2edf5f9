/*
 * The files a run leaves: trace, logs of bus and pulses, report, JSON, JUnit, parameters.
 *
 * All are opened before anything moves and put in place together at the end; until then nothing of
 * them can be seen.
 */
#ifndef TAKT_HOST_RUN_OUTPUTS_H
#define TAKT_HOST_RUN_OUTPUTS_H

#include "bus/candump.h"
#include "cli/output_file.h"
#include "report/report.h"
#include "results/summary.h"
#include "results/trace_writer.h"
#include "session/session.h"
#include "simulation/frame_buffer.h"
#include "simulation/simulation.h"
#include "stepper/pulse_log.h"

#include <stdbool.h>

enum run_output {
    RUN_TRACE,
    RUN_BUS_LOG,
    RUN_REPORT,
    RUN_JSON,
    RUN_JUNIT,
    RUN_PARAMETERS,
    RUN_RESTS,
    RUN_PULSE_LOG,
    RUN_OUTPUT_COUNT
};

struct run_outputs {
    const char *path[RUN_OUTPUT_COUNT]; /* NULL: not wanted */
    struct output_file file[RUN_OUTPUT_COUNT];
    struct trace_writer *trace; /* NULL: not wanted */
    struct candump *bus_log;
    struct frame_buffer *frames;
    struct pulse_log pulse_log; /* of RUN_PULSE_LOG */
    struct report *report;
    const struct point *tool; /* its point in each cycle, the simulation's; NULL: it is not known */
    char *shares;             /* of the time at each limit, as JSON; NULL: none. Owned */
    char *map;                /* error of the tool's point, as JSON; NULL: none. Owned */
    bool each_cycle;          /* something is to be written every cycle */
};

/*
 * The paths that the options ask for, without touching any file. False after a message: two are the
 * same, or one is a file that is read.
 */
bool run_outputs_plan(struct run_outputs *o, const struct session *session);
/* True when standard output is one of the files. */
bool run_outputs_use_stdout(const struct run_outputs *o);

/* Opens everything. False after a message; nothing is left then. */
bool run_outputs_open(struct run_outputs *o, const struct session *session,
                      struct simulation *simulation);
/* Frames since the last call, and the cycle if it was one of the program (record not NULL). */
void run_outputs_add(struct run_outputs *o, const struct cycle_record *record,
                     const struct block *block);
/* A write has failed; there is no use in going on. */
bool run_outputs_failed(const struct run_outputs *o);
/* True after a message for each file to which something could not be written. */
bool run_outputs_tell_failed(struct run_outputs *o);
/* One of them is not wanted after all. */
void run_outputs_drop(struct run_outputs *o, enum run_output which);
/*
 * For the report, before run_outputs_commit: as error_map_json gives it; the text becomes the
 * outputs'.
 */
void run_outputs_set_map(struct run_outputs *o, char *map);
/* The same of what compiled_shares_json gives. */
void run_outputs_set_shares(struct run_outputs *o, char *shares);
/* Writes what comes at the end and puts all files in place. False after a message. */
bool run_outputs_commit(struct run_outputs *o, const struct summary *summary,
                        const struct parameter_file *parameters);
/* Lists the files on stream, one a line. */
void run_outputs_list(const struct run_outputs *o, FILE *stream);
/* Gives up whatever is not in place, and frees everything. */
void run_outputs_close(struct run_outputs *o);

#endif
