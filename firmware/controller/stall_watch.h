/*
 * Whether the setpoint goes on while the program is executed. Where nothing explains that it stands, an alarm ends the run.
 *
 * From rest the full feed is reached after V/A + A/J; a smoothed path leaves CHANGE = 0.06 of the limits to changes of its
 * rate (smooth/judge.c), and the rate may have to fall as far before it rises. So after
 *
 *     T = 2 max over axes (V/A + A/J) / CHANGE
 *
 * at an override of 100 % the setpoint must have moved. Time counts by the override, so that at 0 it does not count.
 */
#ifndef TAKT_CONTROLLER_STALL_WATCH_H
#define TAKT_CONTROLLER_STALL_WATCH_H

#include "base/point.h"
#include "controller/machine.h"

#include <stdbool.h>
#include <stdint.h>

struct stall_watch {
    double cycle_s;
    double longest_s; /* that a standing setpoint is explained by ramps */
    double stood_s;   /* so far, by the override */
    struct point at;
    uint64_t
        late; /* the controller's: exchanges that its background has missed, which are waited for */
};

void stall_watch_init(struct stall_watch *w, const struct machine *machine);

/*
 * Every cycle. ratio: of the programmed feed that the operator lets through. explained: the program, the operator or the
 * spindle has the axes stand, or a block has been passed. False: it stands for no reason.
 */
bool stall_watch_cycle(struct stall_watch *w, const struct point *setpoint, double ratio,
                       bool explained);

#endif
