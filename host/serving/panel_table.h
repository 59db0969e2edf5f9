/*
 * The panel's registers as documentation, from the table that the server works by.
 */
#ifndef TAKT_HOST_PANEL_TABLE_H
#define TAKT_HOST_PANEL_TABLE_H

#include <stdio.h>

void panel_table_write_markdown(FILE *stream);
void panel_table_write_csv(FILE *stream);

#endif
