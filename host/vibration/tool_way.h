/*
 * How far a point is from the way that was commanded, whenever it comes there: what is left behind
 * along the way does not count, as it does not on the part.
 */
#ifndef TAKT_VIBRATION_TOOL_WAY_H
#define TAKT_VIBRATION_TOOL_WAY_H

#include "base/point.h"

#include <stdint.h>

/* Points of the way that are kept: so many cycles may the tool be late. A power of two. */
#define TOOL_WAY_KEPT 1024

/* So many chords on from where it was the tool is looked for. */
#define TOOL_WAY_AHEAD 64

struct tool_way {
    struct point kept[TOOL_WAY_KEPT]; /* point n at n modulo TOOL_WAY_KEPT */
    uint64_t count;                   /* points so far */
    uint64_t at;                      /* the chord the tool was at ends in this point */
    uint64_t measured;
    double max_mm, square_sum_mm2;
};

/* The way goes on to here, X Y Z. */
void tool_way_add(struct tool_way *w, const struct point *commanded);

/* Measures. Before the first point: nothing. */
void tool_way_measure(struct tool_way *w, const struct point *tool);

/* Root mean square, mm; 0: nothing was measured. */
double tool_way_rms_mm(const struct tool_way *w);

#endif
