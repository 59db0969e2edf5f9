/*
 * Emergency messages (CiA 301, 7.2.7): a node tells a new error, or that all are gone (EMCY_NONE).
 */
#ifndef TAKT_CANOPEN_EMCY_H
#define TAKT_CANOPEN_EMCY_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

#define EMCY_FUNCTION 0x080 /* identifier: this plus the node id; without a node it is SYNC */

/* Error codes of CiA 301, table 26, and CiA 402-2, table of error codes. */
#define EMCY_NONE            0x0000
#define EMCY_PDO_LENGTH      0x8210 /* a PDO was shorter than its mapping; not processed */
#define EMCY_FOLLOWING_ERROR 0x8611
#define EMCY_HEARTBEAT       0x8130 /* one that is watched has stayed out */
#define EMCY_SYNC            0x8700 /* SYNC has stayed out */
#define EMCY_TEMPERATURE     0x4310 /* of the drive */

/* Bits of the error register, object 1001. */
#define EMCY_REGISTER_GENERIC       0x01
#define EMCY_REGISTER_CURRENT       0x02
#define EMCY_REGISTER_VOLTAGE       0x04
#define EMCY_REGISTER_TEMPERATURE   0x08
#define EMCY_REGISTER_COMMUNICATION 0x10
#define EMCY_REGISTER_PROFILE       0x20 /* defined by the device profile: CiA 402 */

struct emcy {
    uint8_t node;           /* 1 ... 127 */
    uint16_t code;          /* EMCY_... */
    uint8_t error_register; /* EMCY_REGISTER_... */
    uint8_t vendor[5];      /* the manufacturer's own; 0 unless documented by the drive */
};

void takt_emcy_write(struct can_frame *frame, const struct emcy *emcy);
/* False: the frame is no emergency message. Codes 00xx, "error reset", are EMCY_NONE. */
bool takt_emcy_read(const struct can_frame *frame, struct emcy *emcy);

/*
 * Meaning of an error code in a few words: the code itself where it is known, else the class it
 * belongs to.
 */
const char *takt_emcy_text(uint16_t code);

#endif
