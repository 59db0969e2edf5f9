/*
 * A run of a program that is made for the machine, watched cycle by cycle: what circle, friction
 * and resonance have in common.
 */
#ifndef TAKT_HOST_STUDY_H
#define TAKT_HOST_STUDY_H

#include "cli/options.h"
#include "cli/status.h"
#include "session/session.h"
#include "simulation/simulation.h"

#include <stdbool.h>
#include <stdio.h>

struct study {
    const char *program; /* so it is called in messages */
    void *context;       /* of the functions */
    /* Looks at the machine, before its program is written. False after a message. */
    bool (*prepare)(void *context, const struct machine_setup *setup);
    void (*write)(void *context, const struct machine_setup *setup, FILE *program);
    /* A cycle of the program. */
    void (*see)(void *context, const struct machine_setup *setup, struct simulation *s,
                const struct cycle_record *record);
};

/* STATUS_DONE when the program has ended; else after messages. */
enum command_status study_run(const struct study *study, const struct options *options);

#endif
