/*
 * The part of a summary about step drives and named interpolators: empty for machines without them.
 */
#ifndef TAKT_HOST_SUMMARY_STEPS_H
#define TAKT_HOST_SUMMARY_STEPS_H

#include "results/summary.h"

#include <cjson/cJSON.h>

/* Fields step_drives and interpolator. */
void summary_steps_add_json(cJSON *root, const struct summary *summary);
void summary_steps_write_text(FILE *stream, const struct summary *summary);

#endif
