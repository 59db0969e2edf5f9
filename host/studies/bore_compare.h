/*
 * `takt bore --compare`: spirals to the same circle, run by the firmware on the same virtual
 * machine.
 */
#ifndef TAKT_HOST_BORE_COMPARE_H
#define TAKT_HOST_BORE_COMPARE_H

#include "bore/job.h"
#include "cli/options.h"
#include "cli/status.h"

/*
 * job: a roughing job that has been checked. Prints a table; options->output: file of the picture,
 * NULL: none.
 */
enum command_status bore_compare(const struct bore_job *job, const struct options *options);

#endif
