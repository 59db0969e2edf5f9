/*
 * Flow of a program: which line comes next. O-words: IF, WHILE, DO, REPEAT; their calls are in
 * calls.h.
 *
 * Blocks are a stack: one is opened by its first line and closed by its last, and inside another it
 * closes first. Nothing of their text is kept but the place to jump to. Lines that are not executed
 * are passed over, and only their O-words are looked at.
 */
#ifndef TAKT_PROGRAM_FLOW_H
#define TAKT_PROGRAM_FLOW_H

#include "program/oword.h"

void takt_flow_open(struct program *p);

static inline bool flow_is_skipping(const struct program *p)
{
    return p->flow.skip != SKIP_NOTHING;
}

/* Does what the O-word of the current line says, whose O is read. False: p->error is set. */
bool takt_flow_take(struct program *p);

/*
 * Counts the line that has been read. False: too many were read again without a move in between,
 * p->error is set.
 */
bool takt_flow_count_line(struct program *p);

/*
 * The text is at its end. False: something is open, p->error says what; the end may have been taken
 * back.
 */
bool takt_flow_end_of_text(struct program *p);

/*
 * There has been an error: nothing is repeated from now on, and no subroutine called a second time.
 */
void takt_flow_fail(struct program *p);

/* Goes back to a place, as o says. False: p->error is set. */
bool takt_flow_jump(struct program *p, const struct program_place *place, const struct oword *o);

#endif
