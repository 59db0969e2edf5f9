/*
 * A program brought to a controller through its panel's mailbox.
 */
#ifndef TAKT_HOST_PANEL_UPLOAD_H
#define TAKT_HOST_PANEL_UPLOAD_H

#include "serving/panel_line.h"

/* Goes on where an upload of the same program was left. STATUS_DONE, else after a message. */
enum command_status panel_upload_file(struct panel_line *line, const char *path, bool quiet);

/*
 * A compiled program for the program that is there, brought as there is room; whoever writes
 * CYCLE_START runs it meanwhile: with starts, this, as soon as the controller holds as much as it
 * has room for. Returns when all of it has been taken, likewise.
 */
enum command_status panel_upload_plan(struct panel_line *line, const char *path, bool starts,
                                      bool quiet);

/*
 * Settings of `takt machine --pack`, for a controller that keeps them; its drives must be off.
 * Returns likewise.
 */
enum command_status panel_upload_settings(struct panel_line *line, const char *path, bool quiet);

#endif
