/*
 * Compiled programs: planned ahead of the run (room ahead), verified, kept in a file, replayed
 * (room replay).
 */
#ifndef TAKT_HOST_COMPILED_H
#define TAKT_HOST_COMPILED_H

#include "replay/intake.h"
#include "session/session.h"
#include "verifier/tube_verifier.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* What the verifier found of a compiled program, replayed as compiled. */
struct compiled_figures {
    uint64_t cycles;
    uint32_t blocks;
    double time_s;
    double compile_s; /* of the wall clock */
    uint64_t bytes;
    double velocity[AXIS_COUNT]; /* largest over the limit */
    double acceleration[AXIS_COUNT];
    double jerk[AXIS_COUNT];
    double at_velocity, at_acceleration,
        at_jerk; /* share of cycles in which an axis is at that limit */
    struct tube_figures tube;
    bool of_tool;   /* the tube's figures are the tool's: the machine has modes */
    bool of_strays; /* the modes' frequencies are uncertain: */
    struct tube_figures
        stray[2];      /* the tool's where they are lower, and higher, by what they may be */
    char why[160];     /* refused: what is not kept, */
    uint32_t why_line; /* of this line; 0: of the whole */
};

/* What --ceiling says, per cent. False after a message. */
bool compiled_read_ceiling(const struct options *options, uint32_t *percent);

/*
 * Compiles the session's program into an open file, and verifies what is there: STATUS_DONE; else
 * after a message. What is in the file then is worth nothing.
 */
enum command_status compiled_make(const struct session *s, const struct session_totals *totals,
                                  uint32_t ceiling_percent, FILE *stream,
                                  struct compiled_figures *figures);

/* A compiled program being read. */
struct compiled {
    FILE *stream; /* NULL: none */
    const char *name;
    struct replay_source source;
};

/*
 * The session's program as compiled in the file at path, or, with path NULL, compiled now.
 * STATUS_DONE; else after a message: it was compiled for something else, or is damaged.
 */
enum command_status compiled_open(struct compiled *c, const struct session *s,
                                  const struct session_totals *totals, const char *path);
void compiled_close(struct compiled *c);

/* The planner's limits on the session's machine, with what correction needs taken off. */
void compiled_limits(const struct session *s, const struct point *start,
                     struct plan_limits *limits);

/* False after a message: this machine cannot replay. */
bool compiled_check_machine(const struct session *s);

#endif
