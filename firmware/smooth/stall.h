/*
 * Whether a curve goes on along its route, and how much of the tolerance it is to use.
 *
 * Where parts of the route lie within the tolerance of each other, a curve may find no way on between them: it keeps every limit
 * and stands. Nearer to the route its parts disturb each other less, so a part of the tolerance is used there, and all of it
 * again some tolerances farther on. Either begins where the axes stand.
 */
#ifndef TAKT_SMOOTH_STALL_H
#define TAKT_SMOOTH_STALL_H

#include "smooth/window.h"

struct stall {
    double mark_mm;   /* place on the route that the curve had come to when it went on last, */
    unsigned idle;    /* and pieces kept since then */
    double rest_mm;   /* where it has come to rest last, farther on than before, */
    unsigned rests;   /* and how often since then */
    double all_mm;    /* the chain's tolerance */
    double narrow_mm; /* to this place less of it is used */
};

/* What a window comes to. */
struct stall_window {
    bool rests;     /* it ends at rest */
    unsigned ready; /* pieces that are kept */
    unsigned most;  /* that may be kept at one time */
    unsigned good;  /* pieces that keep the tolerance, */
    unsigned
        whole; /* and of those after which the curve can have come as far as it is thought to be */
};

void stall_start(struct stall *s, double tolerance_mm);
/* It begins anew from rest at this place, which may lie before those that it was thought to have come to. */
static inline void stall_rest(struct stall *s, double at_mm)
{
    s->mark_mm = at_mm < s->mark_mm ? at_mm : s->mark_mm;
}
/* Is a curve with such a tolerance near a place where it stood? */
static inline bool stall_is_near(const struct stall *s, double tolerance_mm)
{
    return tolerance_mm < s->all_mm;
}
/* Does the curve stand where it is, with such a window? */
bool stall_stands(struct stall *s, const struct window *w, const struct route *r,
                  const struct stall_window *now);
/* The tolerance to be used from the next rest on, mm; 0: the present one. stands: the curve does. */
double stall_tolerance(struct stall *s, const struct window *w, const struct route *r,
                       unsigned ready, bool stands);

#endif
