/*
 * The look-ahead window: canonical moves in, planned segments out, in order.
 *
 *     push -> [ block | block | ... | block ] -> take
 *
 * A segment may be taken when the window is full or the program has ended, so that every build plans with the same
 * sight and makes the same setpoints, however fast its background is.
 */
#ifndef TAKT_PLAN_WINDOW_H
#define TAKT_PLAN_WINDOW_H

#include "plan/limits.h"
#include "plan/segment.h"
#include "program/move.h"

#include <stdbool.h>
#include <stdint.h>

#include "plan/window_state.h"

/* capacity: blocks of look-ahead, 1 ... WINDOW_BLOCKS_MAX. start: where the machine stands. */
void window_init(struct window *w, const struct plan_limits *limits, uint32_t capacity,
                 const struct point *start);
/* Room for one more move? */
bool window_has_room(const struct window *w);
/* Adds the next move; a motion without length is counted and dropped. Needs room. */
void window_push(struct window *w, const struct move *move);
/* No more moves will come. */
void window_finish(struct window *w);
/* May a segment be taken now? */
bool window_is_ready(const struct window *w);
/* True when everything pushed has been taken. */
bool window_is_empty(const struct window *w);
/* The next segment. Needs window_is_ready. Its curve starts where the segment before it ended. */
void window_take(struct window *w, struct segment *segment);

#endif
