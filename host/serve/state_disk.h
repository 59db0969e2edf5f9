/*
 * Two files as the two sectors of storage/store.h: what a service keeps over power-off.
 *
 *     FOLDER/state-0, FOLDER/state-1      two generations, each with sequence and checksums before its bytes
 *
 * What the store programs is gathered in memory and goes to the disk when its head comes: first the
 * bytes, brought to the disk, then the head, brought to the disk. So a head never counts before
 * what it stands for is there.
 */
#ifndef TAKT_SERVE_STATE_DISK_H
#define TAKT_SERVE_STATE_DISK_H

#include "hal/flash.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a disk does; tests put one between that loses power. False: errno says why. */
struct state_disk_ops {
    bool (*write)(void *context, unsigned file, uint32_t offset, const uint8_t *bytes, size_t size);
    bool (*sync)(void *context, unsigned file);
    void *context; /* owned by whoever made it */
};

/* It must not be moved once opened. Private. */
struct state_disk {
    struct state_disk_ops ops;
    uint32_t sector_bytes;
    uint8_t *mirror[FLASH_SECTORS]; /* owned */
    uint32_t
        written[FLASH_SECTORS]; /* bytes from the start that are not on the disk yet; 0: none */
    int file[FLASH_SECTORS];    /* -1: not there yet */
    bool was_there;             /* a file of it, when it was opened */
    int folder;
};

/*
 * Opens the files in a folder that is there; the first write makes them. False: errno says why,
 * and nothing is open.
 */
bool state_disk_open(struct state_disk *disk, const char *folder, uint32_t sector_bytes);
/*
 * The same without files: the mirrors are the caller's to fill, see state_disk_mirror. False: out
 * of memory.
 */
bool state_disk_open_on(struct state_disk *disk, const struct state_disk_ops *ops,
                        uint32_t sector_bytes);
void state_disk_close(struct state_disk *disk);

/* What a sector holds at power-on, before the store looks at it. */
uint8_t *state_disk_mirror(struct state_disk *disk, unsigned sector);

struct flash_port state_disk_get_port(struct state_disk *disk);

#endif
