/*
 * The panel of a controller from the outside, by the names of its registers.
 */
#ifndef TAKT_HOST_PANEL_LINE_H
#define TAKT_HOST_PANEL_LINE_H

#include "cli/options.h"
#include "cli/status.h"
#include "client/client.h"
#include "panel/registers.h"
#include "serve/serial_line.h"

#include <stdbool.h>

/* Longest value as text: an alarm, a line, a chunk in hexadecimal digits. */
#define PANEL_VALUE_MAX (2 * PANEL_CHUNK_MAX)

struct panel_line {
    struct client client;
    struct serial_settings serial;
    char address[512];
};

/* --connect, --serial, --unit, --timeout, --password. STATUS_DONE, else after a message. */
enum command_status panel_line_open(struct panel_line *line, const struct options *options);
void panel_line_close(struct panel_line *line);

/* A value as text, in its unit. False after a message. */
bool panel_line_read(struct panel_line *line, enum panel_id id, char text[PANEL_VALUE_MAX + 1]);

/* A value from text, in its unit. STATUS_INPUT: it is none, or refused. */
enum command_status panel_line_write(struct panel_line *line, enum panel_id id, const char *text);

/* The same in counts. False after a message. */
bool panel_line_get(struct panel_line *line, enum panel_id id, int64_t *value);
bool panel_line_set(struct panel_line *line, enum panel_id id, int64_t value);

/* A message about what went wrong last. */
void panel_line_report(struct panel_line *line, enum panel_id id, const char *what);

/* The register of that name; REGISTER_COUNT after a message with the nearest. */
enum panel_id panel_line_find(const char *name);

#endif
