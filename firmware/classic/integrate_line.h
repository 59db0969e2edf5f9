/*
 * A whole line by digital integration with its own feed: acceleration, constant feed, braking, the
 * end rule. The source's form, for comparison; it knows no jerk.
 *
 *     V |      ____________
 *       |     /            \           Braking begins dS + N V_end before the end, dS = (V^2 - V_end^2) / (2 a), so that
 *       |    /              \___ V_end V has come down to V_end when the end rule takes over: way left <= N V_end.
 *       |   /                  |       With V_end = 0 that rule never acts: the last cycles creep, and end exactly.
 *       +-----------------------> s
 */
#ifndef TAKT_CLASSIC_INTEGRATE_LINE_H
#define TAKT_CLASSIC_INTEGRATE_LINE_H

#include "classic/integrate.h"

#include <stdbool.h>

/*
 * Along the path, per cycle: feeds mm, acceleration mm per cycle and cycle. All feeds <= feed,
 * acceleration > 0.
 */
struct integrate_line_config {
    double unit_mm;
    double length_mm;
    double start_mm, feed_mm, end_mm;
    double acceleration_mm;
    unsigned end_shift; /* k of N = 2^k */
};

enum integrate_phase {
    INTEGRATE_ACCELERATING,
    INTEGRATE_CONSTANT,
    INTEGRATE_BRAKING,
    INTEGRATE_ENDING, /* at V_end, or creeping */
    INTEGRATE_AIMED,  /* by the end rule */
    INTEGRATE_LANDED
};

struct integrate_line {
    struct integrate_line_config config;
    struct integrate axes;
    enum integrate_phase phase;
    double way_mm;  /* of the path, per cycle: what V stands for */
    double left_mm; /* of the path, by the words */
    unsigned leading;
    unsigned aimed_cycles;
};

void takt_integrate_line_begin(struct integrate_line *l, const struct integrate_line_config *config,
                               const struct point *start, const struct point *end);

/* One cycle. False: the end had been reached before. */
bool takt_integrate_line_cycle(struct integrate_line *l);

#endif
