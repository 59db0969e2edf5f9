/*
 * What a drive has stored by object 1010, as a text: a line for every value that is not the one of
 * power-on,
 *
 *     node 9              the node id it has been given by LSS; 255: none
 *     1017:00 0064        index and sub-index, then the number, all hexadecimal
 *     2000:00 "4C656674"  bytes of a text
 */
#ifndef TAKT_DRIVES_DRIVE_STORE_H
#define TAKT_DRIVES_DRIVE_STORE_H

#include "servo/servo.h"

#include <stdio.h>

void drive_store_write(FILE *stream, const struct servo *drive);

#define DRIVE_STORE_PROBLEM_MAX 120

struct drive_store_problem {
    unsigned line; /* from 1 */
    char text[DRIVE_STORE_PROBLEM_MAX + 1];
};

/*
 * Before the drive boots: it is switched on with these values. False: *wrong says why; the drive
 * must not be used. Values that go beyond what may be written, and objects the drive does not have,
 * are wrong; whether a mapping makes sense is looked at when it is used, as with a data sheet.
 */
bool drive_store_read(struct servo *drive, const char *text, size_t length,
                      struct drive_store_problem *wrong);

#endif
