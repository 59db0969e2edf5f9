/*
 * Process data objects (CiA 301, 7.2.2): objects of the dictionary packed into a frame by a mapping
 * that both ends know. RPDOs are received by the node, TPDOs transmitted by it.
 */
#ifndef TAKT_CANOPEN_PDO_H
#define TAKT_CANOPEN_PDO_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

/* Objects in a PDO that takt maps or understands, with CAN FD too; a power of two. */
#define PDO_MAPPED_MAX 8

/* Default identifiers, each plus the node id (CiA 301, 7.3.5). */
#define PDO_TPDO1_FUNCTION 0x180
#define PDO_RPDO1_FUNCTION 0x200
#define PDO_TPDO2_FUNCTION 0x280
#define PDO_RPDO2_FUNCTION 0x300

/* From PDO n to PDO n + 1. */
#define PDO_NEXT_FUNCTION 0x100

/* Transmission types: every SYNC; at an event of the node (TPDO), at once (RPDO). */
#define PDO_EVERY_SYNC 1
#define PDO_EVENT_MIN  254 /* that, or an event of the maker's */
#define PDO_EVENT      255

/*
 * A mapped object as objects 1600 ff. and 1A00 ff. write it: index, sub-index, length in bits
 * (0x60410010).
 */
#define PDO_MAPPED(index, sub, bits) ((uint32_t)(index) << 16 | (uint32_t)(sub) << 8 | (bits))

/*
 * An RPDO skips what is mapped to a dummy: the data type's own index, here UNSIGNED32 (CiA 301,
 * 7.4.7.1).
 */
#define PDO_DUMMY_32 PDO_MAPPED(0x0007, 0, 32)

struct pdo_mapping {
    uint8_t count;  /* mapped objects, 0 ... PDO_MAPPED_MAX */
    uint8_t length; /* bytes of the frame, 0 ... CAN_DATA_MAX */
    uint32_t object[PDO_MAPPED_MAX];
};

struct pdo {
    uint16_t cob_id;
    uint8_t transmission; /* PDO_EVERY_SYNC or PDO_EVENT */
    struct pdo_mapping mapping;
};

/*
 * False, and the mapping empty: more than CAN_DATA_MAX bytes or PDO_MAPPED_MAX objects, or an
 * object that is not of 8, 16 or 32 bits.
 */
bool takt_pdo_map(struct pdo_mapping *mapping, const uint32_t *objects, unsigned count);

/*
 * One value for every mapped object, dummies included, as raw bits: a signed object is the caller's
 * to cast from the width it has. pack: frame->id and length are set too. unpack: the caller has
 * checked pdo_fits.
 */
void takt_pdo_pack(const struct pdo *pdo, const uint32_t value[], struct can_frame *frame);
void takt_pdo_unpack(const struct pdo_mapping *mapping, const uint8_t *data, uint32_t value[]);

/* A frame may be longer than its mapping, never shorter (CiA 301, 7.2.2.5: error 8210). */
static inline bool pdo_fits(const struct pdo_mapping *mapping, const struct can_frame *frame)
{
    return frame->length >= mapping->length;
}

/* Byte at which a mapped object begins in the frame; -1: not mapped. */
int takt_pdo_offset(const struct pdo_mapping *mapping, uint32_t object);

#endif
