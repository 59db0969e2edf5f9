/*
 * The log of an image: what a reader wants to know who was not there. Inside the port.
 */
#ifndef TAKT_PORT_EMBEDDED_LOG_H
#define TAKT_PORT_EMBEDDED_LOG_H

#include "port/embedded.h"

void takt_embedded_log_line(const struct embedded *e, const char *text);

void takt_embedded_log_alarm(const struct embedded *e, const struct diagnostic *alarm);

/* What has changed since the last call. */
void takt_embedded_log_changes(struct embedded *e);

#endif
