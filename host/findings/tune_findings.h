/*
 * What `takt tune` found: figures, sections of a machine file, a configuration of the drive, JSON,
 * pictures.
 */
#ifndef TAKT_HOST_FINDINGS_TUNE_FINDINGS_H
#define TAKT_HOST_FINDINGS_TUNE_FINDINGS_H

#include "studies/tune_test.h"

#include <stdio.h>

void tune_findings_print_axis(const struct tune_axis *t, unsigned axis);

/* Of the axes that were measured. */
void tune_findings_write_sections(FILE *file, const struct tune_test *test);
/* Gains of the axis that was measured: a concise configuration (CiA 302, 1F22). */
void tune_findings_write_dcf(FILE *file, const struct tune_test *test);
void tune_findings_write_json(FILE *file, const struct tune_test *test);
void tune_findings_write_report(FILE *file, const struct tune_test *test);

#endif
