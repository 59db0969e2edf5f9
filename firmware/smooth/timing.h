/*
 * Times a smoothed window anew: nominal time passes faster where the axes have limits left, slower
 * where they are exceeded.
 */
#ifndef TAKT_SMOOTH_TIMING_H
#define TAKT_SMOOTH_TIMING_H

#include "smooth/tempo.h"
#include "smooth/window.h"

/* Working memory; holds nothing between calls but window. */
struct timing {
    struct tempo tempo;
    struct window window; /* the one before */
};

/* w again with its samples at other times, the same curve but for little. Fixed samples stay. */
void takt_timing_again(struct timing *t, struct window *w, const struct route *r);
/* Everything about a piece, and before it, takes longer: nothing else helped. */
void takt_timing_slow(struct timing *t, struct window *w, const struct route *r, unsigned piece);

#endif
