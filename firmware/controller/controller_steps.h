/*
 * The axes of the machine that are driven by steps: the controller's other output. Inside this
 * room.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_STEPS_H
#define TAKT_CONTROLLER_CONTROLLER_STEPS_H

#include "controller/controller.h"

/* The step drives that follow from a machine; they stand at 0. */
void takt_controller_steps_init(struct controller *c, const struct step_port *port);

/* At the end of every control cycle, after takt_drives_send: the pulses of the next one. */
void takt_controller_steps_cycle(struct controller *c);

/* The drives are being enabled again. */
void takt_controller_steps_restart(struct controller *c);

#endif
