/*
 * What `takt precision` found: errors of every interpolator beside their bounds, and lengths of
 * words.
 */
#ifndef TAKT_HOST_FINDINGS_PRECISION_FINDINGS_H
#define TAKT_HOST_FINDINGS_PRECISION_FINDINGS_H

#include "studies/precision.h"

void precision_findings_print(const char *program, const struct precision *p);

#endif
