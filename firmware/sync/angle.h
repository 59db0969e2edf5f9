/*
 * The spindle's angle, speed and acceleration out of its encoder's counts: a filter of third order,
 * so that neither speed nor acceleration, while they are constant, put it off.
 *
 * Units here are revolutions and control cycles.
 */
#ifndef TAKT_SYNC_ANGLE_H
#define TAKT_SYNC_ANGLE_H

#include <stdbool.h>

/* Its highest bandwidth; less with a slow control cycle. */
#define ANGLE_BANDWIDTH_RAD_S     200.0
#define ANGLE_BANDWIDTH_RAD_CYCLE 0.2

enum angle_state {
    ANGLE_UNKNOWN, /* nothing has been measured yet */
    ANGLE_STANDS,  /* speed and acceleration are 0 */
    ANGLE_TURNS
};

struct angle {
    double gain_angle, gain_speed, gain_acceleration;
    enum angle_state state;
    double rev;
    double speed;        /* rev/cycle */
    double acceleration; /* rev/cycle2 */
};

/* What it expects of the spindle some cycles ahead. */
struct angle_ahead {
    double rev;
    double speed;
    double acceleration;
};

/* Nothing has been measured yet. */
void takt_angle_init(struct angle *a);

/* bandwidth > 0, in rad/cycle. The angle known so far stays. */
void takt_angle_tune(struct angle *a, double bandwidth_rad_cycle);

/* Every control cycle: what the encoder says at its start. */
void takt_angle_follow(struct angle *a, double measured_rev);
static inline void angle_measure(struct angle *a, double measured_rev)
{
    if (a->state != ANGLE_STANDS || measured_rev != a->rev) {
        takt_angle_follow(a, measured_rev);
    }
}

struct angle_ahead takt_angle_look_ahead(const struct angle *a, double cycles);

#endif
