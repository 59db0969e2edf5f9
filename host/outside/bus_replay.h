/*
 * The frames of a bus log, sent again onto a bus outside of the process, at the times of the log.
 */
#ifndef TAKT_HOST_OUTSIDE_BUS_REPLAY_H
#define TAKT_HOST_OUTSIDE_BUS_REPLAY_H

#include "cli/options.h"
#include "cli/status.h"

/* The log is the first operand; --bus is given. Status after messages. */
enum command_status bus_replay_run(const struct options *options);

#endif
