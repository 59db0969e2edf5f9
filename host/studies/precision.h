/*
 * What every way of turning a planned feed into positions errs by on one program: watched beside a
 * run of it.
 *
 * The run is exact. Each cycle its setpoint is also given to the interpolators by digital
 * integration and to the three step forms, and what they make of it is compared with it.
 */
#ifndef TAKT_HOST_PRECISION_H
#define TAKT_HOST_PRECISION_H

#include "classic/interpolator.h"
#include "machine/machine.h"
#include "motion/cycle_record.h"
#include "plan/block.h"
#include "step/steps.h"
#include "stepper/virtual_steppers.h"
#include "studies/ramps.h"

#define PRECISION_FORMS 3

struct precision_form {
    struct steps steps;
    struct virtual_steppers motors;
    struct point before; /* setpoint of the cycle before: what the pulses handed over now lead to */
    double off_steps;    /* largest distance along an axis, in steps */
    double rate_hz;      /* highest of any axis */
};

struct precision {
    struct machine machine;
    struct precision_form form[PRECISION_FORMS]; /* by enum steps_form */
    struct interpolator integrate, rotate;
    struct ramps ramps;
    double longest_mm[AXIS_COUNT]; /* way of an axis in one line */
    double radius_mm;              /* largest of an arc; 0: there is none */
    double cycles_max;             /* of one line */
    unsigned axes;                 /* that move, bits */
    uint64_t setpoints;
    uint32_t block;
    double block_cycles;
};

void precision_init(struct precision *p, const struct machine *machine);
/* One cycle of the program. */
void precision_add(struct precision *p, const struct cycle_record *record,
                   const struct block *block);
/* After the last one. */
void precision_finish(struct precision *p);

#endif
