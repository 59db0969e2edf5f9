/*
 * Whether a curve is worth it: whether it is as quick as the path that it smooths, which comes to rest where it turns.
 */
#ifndef TAKT_SMOOTH_WORTH_H
#define TAKT_SMOOTH_WORTH_H

#include "smooth/judge.h"
#include "smooth/window.h"

/* The first so many pieces of a window. */
struct worth_window {
    const struct window *window;
    const struct route *route;
    const struct smooth_limits *machine;
    const struct judge_change *change;
    unsigned pieces;
    float standing_s; /* what a curve takes longer at either end */
    bool ends;        /* they end where the chain does */
};

/*
 * From rest, is the path itself quicker: to the last place in the window where it rests, or to its end? to_mm: that place, or
 * the next one where there is none.
 */
bool worth_path_from_rest(const struct worth_window *now, double *to_mm);
/* In motion, is the path itself quicker, from the rest before these pieces to the one behind them? */
bool worth_path(const struct worth_window *now);

#endif
