/*
 * Electronic data sheet (CiA 306): the object dictionary as the file by which tools know a drive.
 */
#ifndef TAKT_DRIVES_EDS_H
#define TAKT_DRIVES_EDS_H

#include "servo/servo.h"

#include <stdio.h>

/*
 * Writes the dictionary of this drive as it was at power-on: default values are its own, those that
 * follow its node id are written relative to it. name: of the file, without a folder.
 */
void eds_write(FILE *stream, const struct servo *drive, const char *name);

#endif
