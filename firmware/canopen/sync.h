/*
 * SYNC (CiA 301, 7.2.5): one frame without data; on it synchronous PDOs are sampled, sent and acted
 * upon.
 */
#ifndef TAKT_CANOPEN_SYNC_H
#define TAKT_CANOPEN_SYNC_H

#include "hal/can.h"

#include <stdbool.h>

#define SYNC_COB_ID 0x080

void takt_sync_write(struct can_frame *frame);
/* A producer may add one byte, the SYNC counter (object 1019); it is tolerated and ignored. */
bool takt_sync_is(const struct can_frame *frame);

#endif
