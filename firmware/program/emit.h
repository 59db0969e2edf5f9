/*
 * The way out: moves made by the current line, checked and queued until they are fetched.
 */
#ifndef TAKT_PROGRAM_EMIT_H
#define TAKT_PROGRAM_EMIT_H

#include "program/program.h"

/* A new move at the end of the queue, of the current line, everything but its kind 0. */
struct move *takt_emit_event(struct program *p, enum move_kind kind);

/* Sets *m to a motion from the current position to end, in the current path mode; no feed yet. */
void takt_emit_prepare(const struct program *p, enum move_kind kind, const struct point *end,
                       struct move *m);

/* The next move of the queue, or of the cycle under way, into *move. False: there is none. */
bool takt_emit_take(struct program *p, struct move *move);

/*
 * Gives a cutting motion from the current position its feed: of F, or where feed_rev_mm is set
 * already, of the spindle. False: p->error is set.
 */
bool takt_emit_set_feed(struct program *p, struct move *m);

/*
 * Gives a cutting motion its feed and queues it when it stays inside the travel; the position is
 * then its end. False: p->error is set.
 */
bool takt_emit_motion(struct program *p, struct move *m);

#endif
