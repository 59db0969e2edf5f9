/*
 * A checked program, written in the words of another controller (convert.h).
 */
#ifndef TAKT_HOST_CONVERT_WRITE_H
#define TAKT_HOST_CONVERT_WRITE_H

#include "cli/status.h"
#include "session/convert.h"
#include "session/session.h"

/* False after a message: it is none that can be written. */
bool convert_read_dialect(const char *name, enum dialect *dialect);

/*
 * STATUS_DONE; STATUS_INPUT after a message: the dialect has no words for a move;
 * STATUS_INTERRUPTED.
 */
enum command_status convert_write(const struct session *session, FILE *out, enum dialect dialect);

#endif
