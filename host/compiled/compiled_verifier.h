/*
 * The verifier of a compiled program: it is replayed as the controller would, in virtual time and
 * without drives, and every setpoint is looked at.
 */
#ifndef TAKT_HOST_COMPILED_VERIFIER_H
#define TAKT_HOST_COMPILED_VERIFIER_H

#include "compiled/compiled.h"

/*
 * STATUS_DONE: it keeps limits, tolerance and order. STATUS_FAILED: figures say what it does not;
 * else after a message.
 */
enum command_status compiled_verifier(const struct session *s, FILE *stream,
                                      struct compiled_figures *figures);

/*
 * The time, and the shares of it at each limit, that the planner on board and the compiled program
 * in the stream take, as report_set_shares wants them; to be freed by the caller. NULL: they are
 * not known.
 */
char *compiled_shares_json(const struct session *s, FILE *stream);

#endif
