/*
 * The summary's part on position-error correction and the tool's point. Private to the summary.
 */
#ifndef TAKT_HOST_SUMMARY_CORRECTION_H
#define TAKT_HOST_SUMMARY_CORRECTION_H

#include "results/summary.h"

#include <cjson/cJSON.h>
#include <stdio.h>

void summary_correction_add_json(cJSON *root, const struct summary *summary);
void summary_correction_write_text(FILE *stream, const struct summary *summary);

#endif
