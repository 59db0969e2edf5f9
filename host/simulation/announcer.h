/*
 * What a program says in its comments while it runs: messages to the operator, and lines of its log
 * files.
 *
 * Messages come when their line is read, which is before what stands in front of it has been cut:
 * reading is ahead of the axes, and stops at M66 and G38 alone.
 */
#ifndef TAKT_HOST_ANNOUNCER_H
#define TAKT_HOST_ANNOUNCER_H

#include "cli/output_file.h"
#include "cli/program_text.h"
#include "program/program.h"

#include <stdbool.h>

/* A file the program writes: there when it is closed, or the run ends. */
struct announcer_file {
    struct output_file file;
    bool is_open;
};

struct announcer {
    const struct program_text *program;
    struct announcer_file log;   /* (LOGOPEN,FILE), (LOGAPPEND,FILE) */
    struct announcer_file probe; /* (PROBEOPEN FILE) */
    bool failed;                 /* a file could not be written, which has been said */
};

void announcer_init(struct announcer *a, const struct program_text *program);

/* For struct program_config, say. */
void announcer_say(void *announcer, const struct program *p);

/* A probing move has met something; its place stands in the parameters. */
void announcer_add_contact(struct announcer *a, const struct parameters *parameters);

/* Closes the files that are still open. False: one could not be written. */
bool announcer_finish(struct announcer *a);

/* Gives up the files that are still open. */
void announcer_close(struct announcer *a);

#endif
