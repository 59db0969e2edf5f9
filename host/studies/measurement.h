/*
 * The part of the measuring engineer: sends the machine to points, lets it settle, and reads how
 * far the tool's point is from where it was sent.
 */
#ifndef TAKT_HOST_MEASUREMENT_H
#define TAKT_HOST_MEASUREMENT_H

#include "base/point.h"
#include "cli/status.h"
#include "session/session.h"

#include <stdbool.h>
#include <stdint.h>

/* Distance from which a point is approached, so that the direction of approach is known. */
#define MEASUREMENT_APPROACH_MM 1.0

/* Standard deviation of the instrument unless something else is asked for, um or urad. */
#define MEASUREMENT_NOISE 0.1

struct measurement_instrument {
    double sigma;   /* mm: standard deviation of its noise */
    uint64_t state; /* of the random numbers, not 0 */
    /*
     * enum axis of the unit it looks at: its three shifts and turns; AXIS_COUNT: at the tool's
     * point
     */
    uint32_t unit;
    /*
     * the tool's point as seen from the table where it really stands, instead of where it is wanted
     */
    bool on_table;
};

/* One point, and what was found there. */
struct measurement_visit {
    struct point at;        /* where the machine is sent: machine coordinates */
    int direction;          /* of the approach in all axes: 1 from below, -1 from above */
    struct point deviation; /* mm, and rad of the turning axis; of a unit its shifts and turns */
};

/*
 * Visits all points in their order on the session's machine. Its program is replaced. STATUS_DONE;
 * else after a message.
 */
enum command_status measurement_run(struct session *session, struct measurement_visit *visits,
                                    uint32_t count, struct measurement_instrument *instrument);

#endif
