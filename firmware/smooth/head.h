/*
 * Samples at a window's beginning as they were proved: what is gone to the end of where no way
 * leads on.
 */
#ifndef TAKT_SMOOTH_HEAD_H
#define TAKT_SMOOTH_HEAD_H

#include "smooth/window.h"

/* Half as many where the window has half. */
#define SMOOTH_HEAD_MAX 16

struct smooth_head {
    unsigned proved; /* pieces */
    double origin[AXIS_COUNT];
    double at_mm[SMOOTH_HEAD_MAX];
    uint32_t element[SMOOTH_HEAD_MAX];
    lanes_int x[SMOOTH_HEAD_MAX]; /* one group of lanes after the other */
};

/* Keeps the beginning of a window. proved: how many of its pieces were. */
void takt_head_keep(struct smooth_head *h, const struct window *w, const struct route *r,
                    unsigned proved);
/* The window is what was kept again. */
void takt_head_take(const struct smooth_head *h, struct window *w, const struct route *r);

#endif
