/*
 * The wiring of threads (room sync) into the controller.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_SPINDLE_SYNC_H
#define TAKT_CONTROLLER_CONTROLLER_SPINDLE_SYNC_H

#include "controller/controller.h"

/* From the controller's machine. */
void takt_controller_spindle_sync_init(struct controller *c);

/* Every cycle, after the program's events: what a thread asks of the spindle goes before. */
static inline void controller_spindle_sync_command(struct controller *c)
{
    (void)spindle_sync_get_command(&c->sync, &c->outputs.spindle_speed_rpm);
}

#endif
