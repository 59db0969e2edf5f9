/*
 * Contract of a step/direction output: the drives that are told their way in single steps.
 *
 * At the start of a control cycle the firmware hands over all pulses of that cycle, in the order of
 * time; the port sends them while the cycle lasts. Non-blocking. On the host a virtual stepper
 * counts them; on a target a timer with direct memory access sends them.
 */
#ifndef TAKT_HAL_STEP_H
#define TAKT_HAL_STEP_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>

struct step_pulse {
    uint32_t
        time_ns; /* from the start of the cycle, below the cycle time; never falls within a cycle */
    uint8_t axes; /* bit i: axis i does one step */
    /*
     * bit i: that step is backwards. A driver that needs it earlier than the edge of the step is
     * the port's to serve, by holding the edge back
     */
    uint8_t direction;
};

struct step_port {
    /*
     * Queues a pulse of the cycle that begins. False: no room; the pulse is lost and the firmware
     * stops with an error.
     */
    bool (*pulse)(void *context, const struct step_pulse *pulse);
    /*
     * Position of an axis at the start of the cycle as an encoder counts it, in steps from where it
     * stood at power-on. False: this axis has no encoder. NULL: no axis has one.
     */
    bool (*read)(void *context, enum axis axis, int32_t *steps);
    void *context; /* owned by whoever made the port */
};

#endif
