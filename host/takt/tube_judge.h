/*
 * The judge of a rounded path (G64): how far setpoints are from the programmed path, and how far the path's corners are
 * from the line through the setpoints.
 *
 * It knows nothing of the planner's reasoning: it reads the part program itself and follows the setpoints along it, never
 * backwards. Of the path only what is near the setpoint is in memory. X, Y and Z alone.
 */
#ifndef TAKT_HOST_TUBE_JUDGE_H
#define TAKT_HOST_TUBE_JUDGE_H

#include "geometry/curve.h"
#include "offset/offset.h"
#include "program/program.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct tube_figures {
    double deviation_mm;  /* largest distance of a setpoint from the path */
    double corner_mm;     /* largest distance of a corner of the path from the setpoints' line */
    double beyond_mm;     /* most that one of them is beyond its tolerance; <= 0: none */
    uint32_t beyond_line; /* of the motion where that is */
};

/* A motion near the setpoint. */
struct tube_element {
    struct curve curve;
    double start_mm; /* along the path */
    double tolerance_mm;
    double corner_mm; /* nearest that the setpoints' line has come to its end */
    uint32_t line;
};

struct tube_judge {
    struct program program;
    struct offset offset;
    bool program_ended;
    double exact_mm;              /* tolerance where the program rounds nothing */
    struct point end;             /* of what has been read */
    double length_mm;             /* of what has been read */
    struct tube_element *element; /* a queue, owned */
    size_t first, count, capacity;
    double place_mm; /* of the last setpoint */
    struct point last;
    struct tube_figures figures;
};

/* exact_mm: what motions in exact path may be off. source: its context stays the caller's. */
void tube_judge_init(struct tube_judge *t, const struct program_config *program,
                     const struct source *source, double exact_mm);
void tube_judge_free(struct tube_judge *t);
/* The next setpoint. False: out of memory. */
bool tube_judge_add(struct tube_judge *t, const struct point *setpoint);
/* After the last one. */
void tube_judge_finish(struct tube_judge *t);

#endif
