/*
 * A trace against the limits of a machine, and against another trace.
 */
#ifndef TAKT_HOST_TRACE_CHECK_H
#define TAKT_HOST_TRACE_CHECK_H

#include "cli/status.h"
#include "machine/machine.h"
#include "trace/trace_reader.h"

/*
 * Prints peaks of velocity, acceleration and jerk by differences of the set columns, how many
 * cycles are above the limits and where first. STATUS_FAILED when any is.
 */
enum command_status trace_check_limits(struct trace_reader *r, const struct machine *machine);

/*
 * Prints where two traces differ by more than tolerance first and most, column by column.
 * STATUS_FAILED when any does, or when one has more rows.
 */
enum command_status trace_check_equal(struct trace_reader *a, struct trace_reader *b,
                                      double tolerance);

#endif
