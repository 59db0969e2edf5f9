/*
 * The averaging window of a span. See spans.md.
 */
#ifndef TAKT_PLAN_SPAN_H
#define TAKT_PLAN_SPAN_H

#include "plan/path.h"

#include <stdbool.h>
#include <stdint.h>

/* Does a span end with a block, at a stop? */
bool takt_span_stops(const struct path *path, uint32_t index);

/* Or at a junction that is passed and landed on? */
bool takt_span_lands(const struct path *path, uint32_t index);

/*
 * Cycles of the first averaging box for the span that begins with the motion at index: those with
 * which the span is predicted to take the least time, as far as it is known; of a span that begins
 * behind the closed blocks its first block is. Feeds count as programmed: the overrides do not
 * change the window. known: all of the span is, and more blocks do not change it.
 */
uint32_t takt_span_window(const struct path *path, const struct ceiling_request *request,
                          uint32_t index, bool *known);

#endif
