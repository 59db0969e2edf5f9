/*
 * Times a smoothed window anew: nominal time passes faster where the axes have limits left, slower where they are exceeded.
 */
#ifndef TAKT_SMOOTH_TIMING_H
#define TAKT_SMOOTH_TIMING_H

#include "smooth/judge.h"
#include "smooth/window.h"

/* Working memory; holds nothing between calls. */
struct timing {
    float rate[SMOOTH_SAMPLES_MAX]; /* of each piece */
    float least[SMOOTH_SAMPLES_MAX];
    struct window window; /* the one before */
};

/* w again with its samples at other times. Fixed samples stay; slower: pieces from this one on are at least halved. */
void timing_again(struct timing *t, struct window *w, const struct route *r,
                  const struct judge_change *change);
/* Everything about a piece, and before it, takes longer: nothing else helped. */
void timing_slow(struct timing *t, struct window *w, const struct route *r, unsigned piece);

#endif
