/*
 * A recording as JSON, for the page's scripts. Columns of numbers are base64 of little-endian
 * uint32 or float32.
 */
#ifndef TAKT_REPORT_DATA_H
#define TAKT_REPORT_DATA_H

#include "report/recording.h"

#include <stdbool.h>
#include <stdio.h>

/* False: the file could not be written or memory is short. */
bool data_write(FILE *file, const struct recording *rec);

#endif
