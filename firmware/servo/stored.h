/*
 * What a drive has stored by object 1010, as bytes for a memory of its own: all that is not the
 * value of power-on.
 *
 *     node id by LSS, then of each:  index (2) | sub-index | length | bytes         the lowest byte first
 *
 * host/drives/drive_store.h has the same as a text.
 */
#ifndef TAKT_SERVO_STORED_H
#define TAKT_SERVO_STORED_H

#include "servo/servo.h"

/* Bytes of all objects of a drive's own dictionary. */
#define SERVO_STORED_MAX 4096

/* All that can be written, and does not change from cycle to cycle. */
bool takt_servo_is_stored(const struct object_row *row);

/* How many of the bytes; 0: there is no room for all of it. */
size_t takt_servo_write_stored(const struct servo *drive, uint8_t *bytes, size_t room);

/*
 * Before the drive boots: it is switched on with these values. False: an object is not there, of
 * another width, or beyond its limits, as after an update of the firmware; the drive has its node
 * id then, and the values of power-on.
 */
bool takt_servo_read_stored(struct servo *drive, const uint8_t *bytes, size_t length);

#endif
