/*
 * Contract of what a drive moves: power stage, encoder and inputs of one motor.
 *
 * A torque is told by the acceleration that it gives the axis without friction, positions by what
 * the encoder says, both in mm (rotary: rad) of the axis; a port knows lead, inertia and the
 * motor's torque for a current. Moments between two calls are those of hardware: the encoder is
 * latched where a switch or the index pulse truly is.
 */
#ifndef TAKT_HAL_MOTOR_H
#define TAKT_HAL_MOTOR_H

#include <stdint.h>

/* Inputs, as object 60FD of CiA 402 has them, in the motor's own direction. */
#define MOTOR_NEGATIVE_LIMIT 0x1U
#define MOTOR_POSITIVE_LIMIT 0x2U
#define MOTOR_HOME           0x4U
#define MOTOR_INPUTS         3 /* bit 0 to 2 */

/* What has been latched when an input changed last, or at the last index pulse. */
struct motor_latch {
    double encoder_mm;
    int32_t direction; /* 1: the encoder rose, -1: it fell, 0: it stood */
};

struct motor_sense {
    double encoder_mm; /* now */
    double temperature_c;
    double torque_ratio; /* the part of its torque that the motor can have now, 0 ... 1 */
    uint32_t inputs;     /* MOTOR_... */
    uint32_t pulses;     /* index pulses so far, in either direction */
    struct motor_latch edge[MOTOR_INPUTS]; /* of the input of this bit */
    struct motor_latch pulse;
};

struct motor_port {
    /*
     * For step_s from now on the motor has the torque; then: what the encoder says. May wait so
     * long.
     */
    double (*turn)(void *context, double torque_mm_s2, double step_s);
    /* The rest, once after the steps of a cycle of cycle_ns; 0: at power-on, or between cycles. */
    void (*sense)(void *context, uint32_t cycle_ns, struct motor_sense *sense);
    void *context; /* owned by whoever made the port */
};

#endif
