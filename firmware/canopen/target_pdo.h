/*
 * RPDO2 of the drives of a machine: their target positions, two drives to a frame.
 *
 * Drives are paired in the order of the machine. The frame has the identifier of the first drive of
 * its pair; each drive of the pair maps its own half and skips the other by a dummy:
 *
 *     bytes         0 1 2 3     4 5 6 7
 *     first drive   607A:00     dummy
 *     second drive  dummy       607A:00
 *
 * A last drive without a partner has a frame of 4 bytes. An 8-byte frame is 135 bits at worst, two
 * 4-byte frames are 190: by this four axes fit into a cycle of 1 ms at 1 Mbit/s.
 */
#ifndef TAKT_CANOPEN_TARGET_PDO_H
#define TAKT_CANOPEN_TARGET_PDO_H

#include "canopen/pdo.h"

#include <stdint.h>

/*
 * node: ids of all drives of the machine, count of them, in its order; index: which drive's RPDO2
 * is asked for.
 */
void target_pdo_set(struct pdo *pdo, const uint8_t node[], unsigned count, unsigned index);

#endif
