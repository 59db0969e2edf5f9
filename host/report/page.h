/*
 * The page itself: a template with places like {{SUMMARY}}, filled while it is written.
 */
#ifndef TAKT_REPORT_PAGE_H
#define TAKT_REPORT_PAGE_H

#include "report/recording.h"

#include <stdbool.h>
#include <stdio.h>

/* Was the plotting library built in? */
bool page_has_plots(void);

/* map_json: NULL, none. False: the file could not be written (errno may say why) or memory is short. */
bool page_write(FILE *file, const struct recording *rec, const char *summary_json,
                const char *map_json);

#endif
