/*
 * Gains of a cascade of position and velocity loop, from what it moves, and how much room they
 * leave.
 */
#ifndef TAKT_HOST_TUNING_GAINS_H
#define TAKT_HOST_TUNING_GAINS_H

#include "tuning/identify.h"

/* What is promised of gains that are found here: of the model, and of a step on the machine. */
#define TUNING_PHASE_DEG       60.0
#define TUNING_MODEL_OVERSHOOT 0.05
#define TUNING_OVERSHOOT       0.10

/* As object 2020 of a drive has them. */
struct tuning_gains {
    double told_inertia_kg_m2;
    double velocity_bandwidth_hz; /* Kp / 2 pi */
    double velocity_integral_s;   /* 0: none */
    double position_gain_per_s;
    double velocity_forward, torque_forward; /* 0 ... 1 */
};

/* What the drive is, beside what it moves. */
struct tuning_drive {
    double step_s;        /* of its loops */
    double position_step; /* of its encoder, mm or rad */
    double torque_rated_nm;
    double bandwidth_max_hz; /* that it takes */
};

struct tuning_margins {
    double velocity_phase_deg; /* not above 0: that loop is not stable */
    double position_phase_deg;
    /*
     * of a step of the target without feed-forward, part of the step; infinite: it does not settle
     */
    double overshoot;
};

void tuning_margins_of(const struct tuning_plant *plant, const struct tuning_drive *drive,
                       const struct tuning_gains *gains, struct tuning_margins *margins);

/* They keep what is promised of the model. */
bool tuning_margins_are_good(const struct tuning_margins *margins);

/* The fastest that keep the promises. False: there are none. */
bool tuning_find_gains(const struct tuning_plant *plant, const struct tuning_drive *drive,
                       struct tuning_gains *gains);

#endif
