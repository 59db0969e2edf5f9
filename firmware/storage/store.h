/*
 * One set of bytes kept over power-off in two sectors of flash: while a new set is written the old
 * one stays whole, so that power may fail at any moment and either the old or the new set is there.
 *
 *     sector     mark | sequence | size | CRC of the bytes | CRC of this head | blank | bytes ...
 *
 * A set counts when its head and its bytes are right; of two the later sequence counts. The head is
 * programmed last, as one word of the flash, so that nothing counts before it is complete.
 */
#ifndef TAKT_STORAGE_STORE_H
#define TAKT_STORAGE_STORE_H

#include "hal/flash.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STORE_HEAD_BYTES FLASH_WORD_BYTES

/* The head that makes bytes a set: whoever writes a sector by other means puts it before them. */
void takt_store_make_head(const uint8_t *bytes, uint32_t size, uint32_t sequence,
                          uint8_t head[STORE_HEAD_BYTES]);

/* Private, but the caller owns it. */
struct store {
    struct flash_port flash;
    int current;             /* the sector whose set counts; -1: none does */
    uint32_t sequence, size; /* of that set */
    uint32_t coming;         /* size of the set that is being written; 0: none is */
    uint32_t written; /* bytes of it in flash, a multiple of FLASH_WORD_BYTES but for its end */
    uint8_t word[FLASH_WORD_BYTES]; /* bytes that do not make a word yet */
    uint32_t in_word;
};

/* Looks what is there. The port is copied; its context stays the caller's. */
void takt_store_open(struct store *store, const struct flash_port *flash);

/* The set that counts, at an address that is a multiple of 8. False: there is none. */
bool takt_store_get(const struct store *store, const uint8_t **bytes, uint32_t *size);

/* Largest set. */
uint32_t takt_store_room(const struct store *store);

/*
 * Begins a new set beside the one that counts; one that was begun before is given up. Erases,
 * unless the sector is blank: see hal/flash.h. False: size is 0 or too large, or the flash refuses.
 */
bool takt_store_begin(struct store *store, uint32_t size);

/*
 * The next bytes of it. False: more than announced, none has been begun, or the flash refuses; it
 * is given up then.
 */
bool takt_store_write(struct store *store, const uint8_t *bytes, size_t length);

/* All bytes of the new set, to be looked at before it counts. NULL: they are not all there. */
const uint8_t *takt_store_look(const struct store *store);

/*
 * The new set counts from now on. False: it is not complete, or not what was written; the old one
 * still counts.
 */
bool takt_store_commit(struct store *store);

#endif
