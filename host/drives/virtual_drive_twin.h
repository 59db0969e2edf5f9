/*
 * A drive that runs somewhere else, beside the virtual drive of this process: whatever one is told
 * the other is told, and what that one does goes to bus and motor (host/target has the one in
 * QEMU).
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_TWIN_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_TWIN_H

#include "servo/servo.h"
#include "twin/twin.h"

struct virtual_drive_twin {
    /*
     * Before the drive is switched on: the ports become those over which both go. servo: the one of
     * this process, which must stay.
     */
    void (*open)(void *context, struct servo *servo, const struct servo_config *config,
                 const struct pdo *target, struct can_port *port, struct motor_port *motor);
    /*
     * The same order is now given to the drive here; end: it has been carried out. bytes: of
     * TWIN_EDS, else NULL.
     */
    void (*begin)(void *context, const struct twin_order *order, const char *bytes);
    void (*end)(void *context);
    /* Over which the meddler of the drive here is asked. */
    struct servo_meddler (*meddle)(void *context, const struct servo_meddler *meddler);
    void *context;
};

#endif
