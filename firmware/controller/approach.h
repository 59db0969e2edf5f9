/*
 * The way from where the drives stand to where the program starts, before its first cycle: axes in
 * the order they are homed in, those of an order together, the others last.
 */
#ifndef TAKT_CONTROLLER_APPROACH_H
#define TAKT_CONTROLLER_APPROACH_H

#include "base/point.h"
#include "machine/machine.h"

#include <stdbool.h>
#include <stdint.h>

struct approach {
    bool begun;
    struct point at;           /* setpoint: where the axes are that do not move now */
    struct point to;           /* where the program starts */
    double way_mm[AXIS_COUNT]; /* of the axes that move now; 0 for the others */
    uint32_t cycle, cycles;    /* of the present move; 0 cycles: there is none */
};

void takt_approach_init(struct approach *approach, const struct point *start);

/*
 * One cycle. actual: where the drives stand, looked at in the first cycle. True: the axes are where
 * the program starts; *setpoint is that. False: *setpoint is the next one on the way.
 */
bool takt_approach_cycle(struct approach *approach, const struct machine *machine,
                         const struct point *actual, struct point *setpoint);

#endif
