/*
 * Events of a drive (servo/drive_event.h) as lines of a log.
 */
#ifndef TAKT_DRIVES_DRIVE_EVENT_H
#define TAKT_DRIVES_DRIVE_EVENT_H

#include "servo/drive_event.h"

#include <stdio.h>

/* One line: "12.345000 node 2: operation enabled -> quick stop active". */
void drive_event_write(FILE *stream, const struct drive_event *event);

#endif
