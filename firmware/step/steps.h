/*
 * The step drives of a machine as seen from the controller: setpoints in, pulses with their times
 * out.
 *
 * Once a cycle takt_steps_cycle hands all pulses of the cycle that begins to the port. Whatever the
 * form, setpoints are what counts: overrides, holds and corrections are in them.
 *
 *     even       every axis steps at the moment at which the straight way between two setpoints passes the middle between
 *                two positions: off by half a step at most, and every axis at its own even rate
 *     improved   lines, circles and helices by evaluation functions: the leading axis steps as above, the others with it
 *     plain      the same, one axis at a time
 *
 * The forms by evaluation functions need a curve to follow; where there is none, or not one of
 * these, or the setpoint is not on it, the even form takes over.
 */
#ifndef TAKT_STEP_STEPS_H
#define TAKT_STEP_STEPS_H

#include "base/error.h"
#include "base/point.h"
#include "geometry/curve.h"
#include "hal/step.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Cycles from a setpoint's being given to the report of the position it led to: as long as through
 * CAN drives, so that axes of both kinds stay together (DRIVES_LATENCY_CYCLES).
 */
#define STEPS_LATENCY_CYCLES 3

enum steps_form { STEPS_EVEN, STEPS_IMPROVED, STEPS_PLAIN };

struct steps_config {
    enum steps_form form;
    uint32_t cycle_us;
    unsigned axes; /* bit i: axis i is a step drive */
    struct steps_config_axis {
        double steps_per_mm;           /* > 0 */
        double rate_max_hz;            /* > 0: more steps a second are an error */
        double following_error_max_mm; /* alarm beyond, if there is an encoder; 0: not watched */
        double stop_mm_s2;             /* > 0: deceleration of takt_steps_brake */
    } axis[AXIS_COUNT];
};

#include "step/steps_state.h"

/* Is any axis a step drive? Where none is, nothing below has anything to do. */
static inline bool steps_are_there(const struct steps *s)
{
    return s->config.axes != 0U;
}

/* start: where the axes stand. */
void takt_steps_init(struct steps *s, const struct steps_config *config, const struct point *start);

/*
 * One cycle: reads the encoders, then hands over the pulses that bring the axes to the setpoint of
 * the call before. curve: what the setpoint is on, NULL: unknown; number: tells one block's curve
 * from the next. False: see takt_steps_get_fault.
 */
bool takt_steps_cycle(struct steps *s, const struct step_port *port, const struct point *setpoint,
                      const struct curve *curve, uint32_t number);

/* At rest: blocks are numbered anew. */
void takt_steps_leave_path(struct steps *s);

/* Instead of takt_steps_cycle, after a fault: every axis brakes by itself. */
void takt_steps_brake(struct steps *s, const struct step_port *port);

/* Have they come to rest so? */
static inline bool steps_rest(const struct steps *s)
{
    return s->rests;
}

/* After a fault, at rest: the axes are where they stand, as reported; the fault is forgotten. */
void takt_steps_restart(struct steps *s);

/*
 * Position of every step axis as of a setpoint STEPS_LATENCY_CYCLES ago; other axes are left alone.
 */
void takt_steps_get_actual(const struct steps *s, struct point *actual);

const struct diagnostic *takt_steps_get_fault(const struct steps *s);

#endif
