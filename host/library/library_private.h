/* What the parts of the library share. */
#ifndef TAKT_LIBRARY_LIBRARY_PRIVATE_H
#define TAKT_LIBRARY_LIBRARY_PRIVATE_H

#include "cli/text.h"
#include "library/columns.h"
#include "library/library.h"
#include "report/report.h"
#include "results/run.h"
#include "takt/command.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct takt_job {
    char **argv; /* owned, as its words are; NULL at the end */
    int argc;
    struct text_held *texts; /* owned */
    unsigned text_count;
    struct options options;
    struct takt_message *messages; /* owned, as their texts are */
    unsigned message_count;
    char *text; /* owned; NULL: none */
    size_t text_length;
    struct run run;
    bool is_open, is_started, is_finished; /* the run */
    struct cycle_record last;              /* of the program's cycles */
    bool keeps_trace;
    struct columns columns;
    struct report *report; /* NULL: none is kept */
    char *map, *shares;    /* for the report; owned */
    char *json;            /* the summary; owned */
};

/* Between them messages of this thread are the job's, and texts are found in its memory. */
void library_enter(struct takt_job *job);
void library_leave(struct takt_job *job);

/* The words of the command line. STATUS_DONE; else after messages. */
enum command_status library_read_options(struct takt_job *job, const struct command *command);

/* A stream that becomes the job's text when library_keep_text ends it. NULL after a message. */
FILE *library_open_text(struct takt_job *job);
enum command_status library_keep_text(struct takt_job *job, FILE *stream,
                                      enum command_status status);

/* Closes the run alone. */
void library_close_run(struct takt_job *job);

#endif
