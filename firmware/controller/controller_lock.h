/*
 * The wiring of threads (room sync) into the controller.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_LOCK_H
#define TAKT_CONTROLLER_CONTROLLER_LOCK_H

#include "controller/controller.h"

/* From the controller's machine. */
void takt_controller_lock_init(struct controller *c);

/* Every cycle, after the program's events: what a thread asks of the spindle goes before. */
static inline void controller_lock_command(struct controller *c)
{
    (void)lock_get_command(&c->lock, &c->outputs.spindle_speed_rpm);
}

#endif
