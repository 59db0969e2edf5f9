/*
 * What is in the PDOs of a drive, wherever it is: from mappings to frames. For the sources of this
 * room.
 */
#ifndef TAKT_DRIVE_DRIVES_LAYOUT_H
#define TAKT_DRIVE_DRIVES_LAYOUT_H

#include "drive/drives_private.h"

/*
 * Passes of drives_map.c: of the target, of RPDO1 again, from which TPDOs are meant, and from which
 * one of either report will do.
 */
#define PASS_TARGET 1
#define PASS_AGAIN  4
#define PASS_STATUS 5
#define PASS_APART  9

#define PDO_SYNC_MAX 240

/* No TPDO: the reserved identifiers of heartbeats. */
#define NO_TPDO NODE_FUNCTION_MASK

static inline bool drives_is_transmitted(const struct drives_mapping *m)
{
    return m->pass >= PASS_STATUS;
}

/* Byte at which an object begins; DRIVES_NOWHERE: it is not in it. */
uint8_t takt_drives_byte_of(const struct pdo *pdo, uint32_t object);
/* The object that is the target, by the mode in which the drive follows. */
uint32_t takt_drives_target_of(const struct drives_axis *axis);
/* Entries and type that the PDO being configured is to have. */
void takt_drives_want(const struct drives *d, struct pdo *pdo);
/* Something of this PDO is used. */
bool takt_drives_uses(const struct drives_axis *axis, const struct pdo *pdo);

/* The PDO being configured is known: what is in it has its place. */
void takt_drives_take_layout(struct drives *d);
/* It has nothing that is wanted, and stays. */
void takt_drives_suffer(struct drives *d);
/* The drive's value of what else is in a frame. */
void takt_drives_store_rest(struct drives_frame *frame, const struct pdo *pdo, uint32_t object,
                            uint32_t value);
/*
 * Nothing is left to be mapped: what goes by SDO, and whether the rest suffices. True: there is
 * more to map after all.
 */
bool takt_drives_finish_map(struct drives *d);
/* A frame of this length is sent in every cycle, of the drive that is being configured. */
void takt_drives_count_bits(struct drives *d, unsigned length);

#endif
