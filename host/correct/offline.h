/*
 * Correction of a program instead of a motion, for machines without a direct channel: a program in,
 * a corrected program out. Each motion's words are replaced; a long line in a curved field of
 * errors, or an arc, becomes several. Everything else stays as it is: comments, feeds, modes, line
 * numbers, subroutines.
 */
#ifndef TAKT_HOST_OFFLINE_H
#define TAKT_HOST_OFFLINE_H

#include "correction/correction.h"
#include "program/program.h"
#include "session/session.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct offline_config {
    const struct session *session;
    double tolerance_mm; /* distance of the written path from the corrected one, > 0 */
    FILE *out;
    /* The program: all of its text, or a stream that is read and written line by line. */
    char *text; /* not changed; NULL: a stream */
    size_t length;
    FILE *stream;
    const char *name; /* for messages */
};

struct offline_totals {
    uint32_t motions;  /* of the program */
    uint32_t pieces;   /* that they have become */
    double error_mm;   /* largest distance of the written path from the corrected one */
    double largest_mm; /* largest correction */
    bool compensated;  /* contours with G41, G42 were among them */
    double
        thread_error_mm; /* the same of threads, which are not divided, and where it is largest */
    uint32_t thread_line;
    uint32_t input_line; /* the first M66: what it reads is not known; 0: none */
};

/* STATUS_DONE; else after a message. */
enum command_status offline_correct(const struct offline_config *config,
                                    struct offline_totals *totals);

#endif
