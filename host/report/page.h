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

/* JSON; NULL, but for the summary: none. */
struct page_texts {
    const char *summary_json;
    const char *map_json;
    const char *shares_json;
};

/* False: the file could not be written (errno may say why) or memory is short. */
bool page_write(FILE *file, const struct recording *rec, const struct page_texts *texts);

#endif
