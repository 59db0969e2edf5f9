/*
 * Where the tool's point really is in a run on a machine with errors, or one that swings
 * ([geometry]), and how far from where the program wants it. Only the virtual machine knows; the
 * controller is told no more than a temperature.
 */
#ifndef TAKT_HOST_TOOL_POINT_H
#define TAKT_HOST_TOOL_POINT_H

#include "config/machine_setup.h"
#include "deviation/deviation.h"
#include "motion/cycle_record.h"
#include "plan/block.h"
#include "vibration/tool_way.h"
#include "vibration/vibration.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Largest and mean distance of the tool's point from the commanded one, X Y Z. */
struct tool_point_error {
    uint64_t count;
    double sum_mm, max_mm;
};

struct tool_point {
    bool is_watched; /* the machine has errors, and its drives are inside */
    double cycle_s;
    struct deviation real; /* by the positions of the drives */
    struct point real_at;
    struct point tool;          /* in the last program cycle */
    struct vibration vibration; /* between them and the tool */
    struct deviation nominal;   /* by the setpoints, as if the drives followed at once */
    double cut_mm, cut_s;       /* of cutting so far */
    bool has_cmd;
    struct point cmd;    /* of the last cycle */
    uint32_t still;      /* cycles without motion until now */
    double still_mm;     /* error in the last of them */
    uint32_t still_line; /* of the program, and where the tool was then */
    struct point still_at;
    FILE *rests; /* a row for every standstill; NULL: not wanted. The caller's */
    struct tool_point_error at_rest; /* by the drives, at the end of every standstill of REST_S */
    bool is_shaped; /* setpoints are late on purpose: no error of theirs is measured */
    struct tool_point_error of_setpoints; /* by the setpoints, in every program cycle */
    struct tool_way way; /* from the commanded way, wherever along it; of machines that swing */
};

/* Shortest standstill that is a measurement: drives have settled then. */
#define TOOL_POINT_REST_S 0.05

void tool_point_init(struct tool_point *t, const struct machine_setup *setup);

/* Rows of CSV from now on: where each standstill was wanted, and where the tool's point was. */
void tool_point_write_rests(struct tool_point *t, FILE *stream);

/*
 * After every cycle. drives: where they have brought the axes; record and segment: of the program
 * cycle, NULL: there was none.
 */
void tool_point_follow(struct tool_point *t, const struct point *drives, double time_s,
                       const struct cycle_record *record, const struct block *block);

/* After the last. */
void tool_point_finish(struct tool_point *t);

/* Where the tool is when the drives stand as they do; cmd says where the table is wanted. */
void tool_point_get(const struct tool_point *t, const struct point *cmd, struct point *tool);

/* Mean, mm; 0: nothing was measured. */
double tool_point_mean(const struct tool_point_error *error);

#endif
