/*
 * A run on a target (takt run --target NAME --image FILE): what its image must know of the session.
 */
#ifndef TAKT_HOST_TARGET_SETUP_H
#define TAKT_HOST_TARGET_SETUP_H

#include "cli/status.h"
#include "session/session.h"
#include "target/target.h"

/* Do the options and the machine go together? STATUS_INPUT after a message. */
enum command_status target_setup_check(const struct session *session);

/* Starts the target. STATUS_DONE; else after a message. target_close is due in either case. */
enum command_status target_setup_open(struct target *target, const struct session *session,
                                      const struct can_port *bus);

#endif
