/*
 * Service data objects (CiA 301, 7.2.4): reading and writing the objects of a node. What client
 * (sdo_client.h) and server (the virtual drives) have in common.
 *
 * Frames are 8 bytes. Byte 0 is the command with its flags; in the first frame of a transfer bytes
 * 1 to 3 name the object, bytes 4 to 7 hold its value (expedited) or its length.
 */
#ifndef TAKT_CANOPEN_SDO_H
#define TAKT_CANOPEN_SDO_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

/* Default identifiers, each plus the node id (CiA 301, 7.3.5). */
#define SDO_REQUEST_FUNCTION  0x600 /* client to server */
#define SDO_RESPONSE_FUNCTION 0x580 /* server to client */

#define SDO_LENGTH        8 /* of every frame */
#define SDO_EXPEDITED_MAX 4 /* bytes of a value that travels in the first frame */
#define SDO_SEGMENT_MAX   7 /* bytes of a segment */

/* Commands, bits 7 to 5 of byte 0. */
#define SDO_COMMAND_MASK              0xE0
#define SDO_REQUEST_DOWNLOAD_SEGMENT  0x00
#define SDO_REQUEST_DOWNLOAD          0x20
#define SDO_REQUEST_UPLOAD            0x40
#define SDO_REQUEST_UPLOAD_SEGMENT    0x60
#define SDO_ABORT                     0x80 /* of either side */
#define SDO_REQUEST_BLOCK_UPLOAD      0xA0
#define SDO_REQUEST_BLOCK_DOWNLOAD    0xC0
#define SDO_RESPONSE_UPLOAD_SEGMENT   0x00
#define SDO_RESPONSE_DOWNLOAD_SEGMENT 0x20
#define SDO_RESPONSE_UPLOAD           0x40
#define SDO_RESPONSE_DOWNLOAD         0x60
#define SDO_RESPONSE_BLOCK_DOWNLOAD   0xA0
#define SDO_RESPONSE_BLOCK_UPLOAD     0xC0

/* Flags of the first frame; with both, bits 3 and 2 say how many of the 4 bytes are unused. */
#define SDO_SIZE_GIVEN 0x01
#define SDO_EXPEDITED  0x02

/* Flags of a segment; bits 3 to 1 say how many of its 7 bytes are unused. */
#define SDO_LAST   0x01
#define SDO_TOGGLE 0x10

/* An object: index and sub-index as they stand in a mapping entry. */
#define SDO_OBJECT(index, sub) ((uint32_t)(index) << 16 | (uint32_t)(sub) << 8)

static inline uint16_t sdo_index(uint32_t object)
{
    return (uint16_t)(object >> 16);
}

static inline uint8_t sdo_sub(uint32_t object)
{
    return (uint8_t)(object >> 8);
}

/* Abort codes (CiA 301, table 22). SDO_ABORT_NONE: nothing to abort. */
enum sdo_abort {
    SDO_ABORT_NONE = 0,
    SDO_ABORT_TOGGLE = 0x05030000,
    SDO_ABORT_TIMEOUT = 0x05040000,
    SDO_ABORT_COMMAND = 0x05040001,
    SDO_ABORT_BLOCK_SIZE = 0x05040002,
    SDO_ABORT_SEQUENCE = 0x05040003,
    SDO_ABORT_CRC = 0x05040004,
    SDO_ABORT_MEMORY = 0x05040005,
    SDO_ABORT_ACCESS = 0x06010000,
    SDO_ABORT_WRITE_ONLY = 0x06010001,
    SDO_ABORT_READ_ONLY = 0x06010002,
    SDO_ABORT_NO_OBJECT = 0x06020000,
    SDO_ABORT_NOT_MAPPABLE = 0x06040041,
    SDO_ABORT_PDO_LENGTH = 0x06040042,
    SDO_ABORT_PARAMETERS = 0x06040043,
    SDO_ABORT_HARDWARE = 0x06060000,
    SDO_ABORT_LENGTH = 0x06070010,
    SDO_ABORT_TOO_LONG = 0x06070012,
    SDO_ABORT_TOO_SHORT = 0x06070013,
    SDO_ABORT_NO_SUB_INDEX = 0x06090011,
    SDO_ABORT_VALUE = 0x06090030,
    SDO_ABORT_TOO_HIGH = 0x06090031,
    SDO_ABORT_TOO_LOW = 0x06090032,
    SDO_ABORT_GENERAL = 0x08000000,
    SDO_ABORT_STORE = 0x08000020,
    SDO_ABORT_STATE = 0x08000022,
    SDO_ABORT_NO_DATA = 0x08000024
};

/* There is no such object. */
static inline bool sdo_says_absent(uint32_t abort_code)
{
    return abort_code == SDO_ABORT_NO_OBJECT || abort_code == SDO_ABORT_NO_SUB_INDEX;
}

/*
 * Meaning of an abort code in a few words; of one that CiA 301 does not know "unknown abort code".
 */
const char *takt_sdo_abort_text(uint32_t code);

/* Bytes of the first frame, or of a segment, that hold nothing. */
static inline unsigned sdo_unused_expedited(uint8_t command)
{
    return command >> 2 & 3u;
}

static inline unsigned sdo_unused_segment(uint8_t command)
{
    return command >> 1 & 7u;
}

/* The object of a first frame or an abort, as SDO_OBJECT makes it. */
uint32_t takt_sdo_read_object(const struct can_frame *frame);

/* A first frame, of either side. value: bytes 4 to 7. */
void takt_sdo_write_initiate(struct can_frame *frame, uint16_t cob_id, uint8_t command,
                             uint32_t object, uint32_t value);

/* A request to write a number of two bytes. object: as it is mapped. */
void takt_sdo_write_word(struct can_frame *frame, uint8_t node, uint32_t object, uint16_t value);

/* function: SDO_REQUEST_FUNCTION or SDO_RESPONSE_FUNCTION, by who aborts. */
void takt_sdo_write_abort(struct can_frame *frame, uint16_t function, uint8_t node, uint32_t object,
                          uint32_t code);

#endif
