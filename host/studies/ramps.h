/*
 * Digital integration as seed 002 has it, with ramps of its own (3.9): every line of a program once
 * more, between the feeds that the run began, drove at most and ended it with, in whole words,
 * without regard to jerk (classic/integrate_line.h).
 */
#ifndef TAKT_HOST_RAMPS_H
#define TAKT_HOST_RAMPS_H

#include "classic/integrate_line.h"
#include "machine/machine.h"
#include "motion/cycle_record.h"
#include "plan/block.h"

#include <stdbool.h>
#include <stdint.h>

struct ramps {
    double cycle_s;
    double unit_mm;
    unsigned end_shift;

    /* The line that the run is on. */
    bool follows;
    uint32_t block;
    struct block line;
    double start_mm_s, most_mm_s; /* feeds of it so far */
    double feed_mm_s;             /* of the last cycle; 0: at rest */

    /* Figures of all lines done. */
    unsigned lines;
    uint64_t cycles, run_cycles; /* of their own, and of the run */
    double off_mm, off_bound_mm; /* from the line, and what truncation may have taken */
    double step_mm_s2; /* largest change of the acceleration along the path from cycle to cycle */
    double slowest, fastest; /* feed under the end rule, of V_end; 0: it has not acted */
};

void ramps_init(struct ramps *r, const struct machine *machine, double unit_mm);
/* One cycle of the run; block as of takt_controller_get_block. */
void ramps_add(struct ramps *r, const struct cycle_record *record, const struct block *block);
/* The last line. */
void ramps_finish(struct ramps *r);

#endif
