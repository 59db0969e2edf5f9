/*
 * Virtual step drives: stand behind hal/step.h, count what they are told, and say what they made of
 * it.
 *
 * A stepping motor has no feedback and no way to complain. A step that comes sooner after the last
 * one of its axis than the motor can follow is lost: it is counted as missed, and the axis does not
 * move. The encoder beside it tells.
 */
#ifndef TAKT_HOST_VIRTUAL_STEPPERS_H
#define TAKT_HOST_VIRTUAL_STEPPERS_H

#include "hal/step.h"

#include <stdbool.h>
#include <stdint.h>

struct virtual_stepper_config {
    bool present;
    uint32_t has_encoder; /* 1: yes */
    double rate_max_hz;   /* > 0: steps that come faster are missed */
};

struct virtual_stepper {
    struct virtual_stepper_config config;
    int32_t position_steps;
    uint64_t steps;       /* told to make, either way */
    uint64_t missed;      /* of them */
    uint64_t reversals;   /* of direction */
    double rate_peak_hz;  /* of the shortest time between two steps */
    uint64_t shortest_ns; /* that time; UINT64_MAX: fewer than two steps */
    uint64_t last_ns;     /* of the last step; UINT64_MAX: none yet */
    bool backwards;       /* direction of the last step */
};

/* Pulses with their times, for whoever wants to see them. */
struct virtual_steppers_listener {
    void (*on_pulse)(void *context, uint64_t time_ns, const struct step_pulse *pulse);
    void *context;
};

struct virtual_steppers {
    struct virtual_stepper axis[AXIS_COUNT];
    uint64_t cycle_start_ns;
    /* pulses whose time was before that of the one handed over last, or after the cycle */
    uint64_t disordered;
    uint64_t newest_ns;
    uint32_t cycle_ns;
    struct virtual_steppers_listener listener;
};

/* All stand at 0. */
void virtual_steppers_init(struct virtual_steppers *v,
                           const struct virtual_stepper_config config[AXIS_COUNT],
                           uint32_t cycle_ns);

/* The port to give to the firmware; v must stay where it is. */
struct step_port virtual_steppers_get_port(struct virtual_steppers *v);

/* The cycle whose pulses have been handed over is over. */
void virtual_steppers_end_cycle(struct virtual_steppers *v);

void virtual_steppers_listen(struct virtual_steppers *v,
                             const struct virtual_steppers_listener *listener);

#endif
