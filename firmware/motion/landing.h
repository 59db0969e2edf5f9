/*
 * Landing in motion: a setpoint falls on a junction exactly.
 *
 * The setpoint follows the trapezoidal reference by (N - 1)/2 cycles when that has kept its feed
 * for the averaging window N. So the trapezoidal reference slows down from w to w' in n cycles and
 * then keeps w' for N: the setpoint is then
 *     n (w + w')/2 + w' (N + 1)/2
 * beyond where the trapezoidal reference was. n is the least whole number for which w' need not be
 * above the junction's feed; w' makes the sum the distance of the junction. It is begun as late as
 * possible: the deceleration is then nearly the full one, and w' below the junction's feed by about
 * as much as one cycle of it.
 */
#ifndef TAKT_MOTION_LANDING_H
#define TAKT_MOTION_LANDING_H

#include <stdbool.h>
#include <stdint.h>

/* mm and cycles */
struct landing_case {
    double gap_mm;       /* from the trapezoidal reference to the junction */
    double feed;         /* of the trapezoidal reference */
    double feed_max;     /* of the junction */
    double acceleration; /* of slowing down, at most */
    double window;       /* cycles */
};

enum landing_phase {
    LANDING_NONE,
    LANDING_ACTIVE,
    LANDING_OVER /* its last cycle has been made: the setpoint is on the junction */
};

struct landing_run {
    enum landing_phase phase;
    uint64_t junction; /* path position */
    uint32_t cycle;    /* passed */
    uint32_t ramp;     /* n */
    uint32_t total;    /* n + N */
    uint64_t start;    /* path position of the trapezoidal reference */
    double feed_start;
    double feed_end;
};

/* Can the junction be landed on from here? Fills ramp, total and the feeds of run. */
bool takt_landing_solve(const struct landing_case *l, struct landing_run *run);

/*
 * Distance of the trapezoidal reference from the start of the run after this many of its cycles,
 * and its feed then.
 */
double takt_landing_distance(const struct landing_run *run, uint32_t cycle, double *feed);

#endif
