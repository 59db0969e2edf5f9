/*
 * A run from its options to its summary, cycle by cycle: what `takt run` and the library are made
 * of.
 *
 *     status = run_open(&run, &options);                       machine, tables, program
 *     if (status == STATUS_DONE)
 *         status = run_prepare(&run);                          checked, planned, drives booting
 *     while (!run_is_over(&run) && run_cycle(&run)) ...
 *     run_finish(&run, cut);                                   run.summary
 *     run_close(&run);                                         in every case
 */
#ifndef TAKT_HOST_RUN_H
#define TAKT_HOST_RUN_H

#include "cli/status.h"
#include "compiled/compiled.h"
#include "results/summary.h"
#include "session/session.h"
#include "simulation/ending.h"
#include "simulation/simulation.h"
#include "verifier/verifier.h"

#include <stdbool.h>
#include <stdint.h>

/* Who sees every cycle. record and block: NULL where it was none of the program. */
struct run_watcher {
    void (*see)(void *context, const struct cycle_record *record, const struct block *block);
    void *context;
};

/* All zero at the beginning, and not to be moved once opened. */
struct run {
    struct session session;
    struct session_totals totals;
    struct session_reading reading[2]; /* the verifier's */
    struct verifier verifier;
    struct compiled compiled;
    uint32_t answers; /* of the run that the verifier has been told */
    struct simulation *simulation;
    struct run_watcher watcher; /* the caller's; without see: nobody */
    struct ending ending;
    struct diagnostic fault; /* before its end */
    enum command_status cut; /* not STATUS_DONE: the run ends before its time, with this status */
    uint64_t until_cycles;   /* program cycles after which to stop; UINT64_MAX: the program's end */
    uint64_t wall_ns;        /* of the cycles; kept by the caller */
    struct summary summary;  /* of run_finish */
};

/*
 * Reads everything the options name; they must outlive the run. STATUS_DONE; else after messages.
 */
enum command_status run_open(struct run *run, const struct options *options);
/* Checks the program, plans it ahead if that is asked for, boots the drives. Likewise. */
enum command_status run_prepare(struct run *run);

/*
 * One cycle of the world and of everybody who watches it. False: the bus or the target is gone, or
 * memory is.
 */
bool run_cycle(struct run *run);
/* The program has ended or faulted, or --until has come. */
bool run_is_over(const struct run *run);

/*
 * The ordered end, and the summary. cut: STATUS_DONE where run_is_over, else why the run ends
 * before: it comes to rest first, so that the summary counts the way there.
 */
void run_finish(struct run *run, enum command_status cut);
/* Only the drives' end: nothing is left moving. */
void run_end_drives(struct run *run);
void run_close(struct run *run);

#endif
