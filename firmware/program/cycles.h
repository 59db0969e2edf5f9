/*
 * Drilling and boring cycles: G73, G74, G81 to G89.
 *
 * Every cycle goes at rapid over the hole and down to R, does what its script in drilling.c says,
 * and ends at the clear height: R with G99, with G98 the height before the first of a row of cycles
 * if that is above R. With L it is done so often, with G91 each time a step further. Its moves are
 * made while they are fetched, so that no number of holes and pecks needs room; the line has been
 * checked as a whole before.
 */
#ifndef TAKT_PROGRAM_CYCLES_H
#define TAKT_PROGRAM_CYCLES_H

#include "program/program.h"

/* argument: enum cycle, or with CYCLE_LEFT the same with the spindle turning the other way */
#define CYCLE_LEFT 0x10
enum cycle {
    CYCLE_CHIP_BREAK, /* G73 */
    CYCLE_DRILL,      /* G81 */
    CYCLE_DRILL_WAIT, /* G82 */
    CYCLE_PECK,       /* G83 */
    CYCLE_TAP,        /* G84, and to the left G74 */
    CYCLE_REAM,       /* G85 */
    CYCLE_BORE_STOP,  /* G86 */
    CYCLE_BORE_BACK,  /* G87 */
    CYCLE_BORE_PAUSE, /* G88 */
    CYCLE_BORE_WAIT,  /* G89 */
    CYCLE_COUNT
};
bool takt_cycles_start(struct program *p, const struct program_code *code);

static inline enum cycle cycles_kind(const struct program_code *code)
{
    return (enum cycle)(code->argument & ~CYCLE_LEFT);
}

/* The words all of them take. */
#define WORDS_CYCLE (LETTERS_LINEAR | LETTER_BIT('r') | LETTER_BIT('l'))

/* No cycle is under way. */
void takt_cycles_open(struct program *p);

/* A code is about to act: any other motion ends a row of cycles. */
void takt_cycles_see(struct program *p, const struct program_code *code);

/* The next move of the cycle under way, when it is its turn; false: there is none. */
bool takt_cycles_next(struct program *p, struct move *move);

/* A move of the queue has been fetched. */
void takt_cycles_count_queued(struct program *p);

/* For G76: a straight move of the cycle to work coordinates; false: it has no length. */
bool takt_cycles_move(struct program *p, enum move_kind kind, const struct point *work,
                      struct move *move);

/* Would the machine leave its travel there? False: p->error is set. */
bool takt_cycles_check_travel(struct program *p, const struct point *work);

#endif
