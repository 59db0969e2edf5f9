/*
 * Shared by the sources of a virtual drive.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H

#include "drives/virtual_drive.h"

/* Position as the drive reports it: rounded to increments, held at the ends of the int32 range. */
int32_t virtual_drive_increments(const struct virtual_drive *drive, double position_mm);

/* The drive profile's share of a controlword, and of one cycle. */
void virtual_drive_take_controlword(struct virtual_drive *drive, uint16_t controlword);
void virtual_drive_move(struct virtual_drive *drive, uint32_t cycle_ns);

/* The connection to the controller is gone: an enabled drive stops quickly (object 6007 = 3). */
void virtual_drive_lose_connection(struct virtual_drive *drive);

/* Back to the state after power-on; the motor runs out without torque. */
void virtual_drive_reset_profile(struct virtual_drive *drive);

/* Tells the error code in an emergency message, in the states that have them. */
void virtual_drive_send_emergency(const struct virtual_drive *drive, uint16_t code,
                                  uint8_t error_register);

#endif
