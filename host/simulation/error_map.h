/*
 * The error of the tool's point over the working volume, before and after correction, for the
 * report.
 */
#ifndef TAKT_HOST_ERROR_MAP_H
#define TAKT_HOST_ERROR_MAP_H

#include "session/session.h"
#include "simulation/simulation.h"

/*
 * As report_set_map wants it, zero-terminated, to be freed by the caller. Over the volume table, or
 * where there is none the travel of X Y Z, warm and worn as the machine is at the end. NULL: the
 * machine has no errors, or no memory.
 */
char *error_map_json(const struct session *session, const struct simulation *simulation);

#endif
