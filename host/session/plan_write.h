/*
 * The planned blocks of a whole program as a table and as JSON: what `takt plan` writes.
 */
#ifndef TAKT_HOST_PLAN_WRITE_H
#define TAKT_HOST_PLAN_WRITE_H

#include "cli/status.h"
#include "session/session.h"

#include <stdio.h>

/* table, json: NULL: not wanted. found: of session_check. STATUS_DONE; else as planner_walk. */
enum command_status plan_write(const struct session *session, const struct session_totals *found,
                               FILE *table, FILE *json);

#endif
