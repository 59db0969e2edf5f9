/*
 * RPDO2 of the drives of a machine: their target positions, as many drives to a frame as it holds:
 * two, with CAN FD six.
 *
 * Drives are grouped in the order of the machine. The frame has the identifier of the first drive
 * of its group; each drive maps its own part and skips the others by dummies. Of a pair:
 *
 *     bytes         0 1 2 3     4 5 6 7
 *     first drive   607A:00     dummy
 *     second drive  dummy       607A:00
 *
 * A last group may be smaller; its frame is shorter. An 8-byte frame is 135 bits at worst, two
 * 4-byte frames are 190: by this four axes fit into a cycle of 1 ms at 1 Mbit/s.
 */
#ifndef TAKT_CANOPEN_TARGET_PDO_H
#define TAKT_CANOPEN_TARGET_PDO_H

#include "canopen/pdo.h"

#include <stdint.h>

/*
 * node: ids of all drives of the machine, count of them, in its order; index: which drive's RPDO2
 * is asked for; group: drives to a frame, TARGET_PDO_PAIR or TARGET_PDO_FD.
 */
#define TARGET_PDO_PAIR 2
#define TARGET_PDO_FD   6
void takt_target_pdo_set(struct pdo *pdo, const uint8_t node[], unsigned count, unsigned index,
                         unsigned group);

/* Drives of the group of this one. */
unsigned takt_target_pdo_members(unsigned count, unsigned index, unsigned group);

#endif
