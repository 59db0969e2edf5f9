/*
 * The canonical moves of a whole program, one a line: what `takt canon` prints.
 */
#ifndef TAKT_HOST_CANON_WRITE_H
#define TAKT_HOST_CANON_WRITE_H

#include "cli/status.h"
#include "session/session.h"

#include <stdio.h>

/* The program has been checked. STATUS_DONE or STATUS_INTERRUPTED. */
enum command_status canon_write(FILE *stream, const struct session *session);

#endif
