/*
 * `takt friction`: the friction of every axis with a drive on CAN, by its torque at constant
 * velocities either way.
 */
#ifndef TAKT_HOST_FRICTION_TEST_H
#define TAKT_HOST_FRICTION_TEST_H

#include "base/point.h"
#include "cli/options.h"
#include "cli/status.h"
#include "servo/friction.h"

#include <stdbool.h>

/*
 * Velocities at which an axis is moved, from the lowest: whole multiples of it. At rest friction is
 * what it tends to.
 */
#define FRICTION_VELOCITIES (FRICTION_POINTS - 1)

struct friction_axis {
    bool is_measured;
    unsigned bus, node;                    /* of its drive */
    unsigned drive;                        /* which it is on the buses, from 0 */
    double step_mm_s;                      /* the lowest velocity; rad/s of a rotary axis */
    double torque_rated_nm;                /* as the machine file has it */
    double torque_nm[FRICTION_POINTS];     /* half of what differs between both ways */
    double offset_nm[FRICTION_VELOCITIES]; /* the mean of both: weight, say */
};

struct friction_test {
    struct friction_axis axis[AXIS_COUNT];
};

/* axes: bit i: axis i is to be measured; 0: all that can be. STATUS_DONE; else after messages. */
enum command_status friction_test_run(struct friction_test *test, unsigned axes,
                                      const struct options *options);

#endif
