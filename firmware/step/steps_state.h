/*
 * Memory of the step drives: public only so that the caller can own it. Read steps.h instead.
 */
#include "step/steps.h" /* before the guard: that one includes this in its place */

#ifndef TAKT_STEP_STEPS_STATE_H
#define TAKT_STEP_STEPS_STATE_H

#include "step/evaluate_helix.h"
#include "step/evaluate_line.h"

/* A block followed by an evaluation function. */
struct steps_path {
    bool active;
    bool curved; /* helix, else line */
    struct curve curve;
    double part;         /* of the curve, 0 ... 1, that has been stepped */
    double due;          /* part at which the next tick is due */
    int64_t ticks, made; /* of a line: in all, and so far */
    struct evaluate_line line;
    struct evaluate_helix helix;
};

/* A setpoint on its way: it is stepped to one cycle after it was given. */
struct steps_target {
    struct point at;
    bool has_curve;
    uint32_t number;
    struct curve curve;
};

struct steps {
    struct steps_config config;
    struct point now;           /* where the pulses handed over lead to */
    struct steps_target next;   /* the setpoint of the last call */
    int64_t at[AXIS_COUNT];     /* steps made */
    struct point read;          /* by the encoders, at the start of the last cycle */
    double braking[AXIS_COUNT]; /* takt_steps_brake: mm in the cycle */
    bool rests;                 /* takt_steps_brake: at rest, as read */
    uint32_t number;            /* of the path */
    struct steps_path path;
    int64_t last_ns;             /* time of the last pulse, from the start of this cycle */
    int64_t free_ns[AXIS_COUNT]; /* likewise: earliest time of an axis's next step */
    struct evaluate_tick held;   /* a tick that found no room before the end of the cycle */
    bool failed;                 /* the port refused a pulse of this cycle */
    struct diagnostic fault;     /* TAKT_OK: none */
};

#endif
