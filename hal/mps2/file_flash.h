/*
 * Flash that is kept in a file of the computer that QEMU runs on: what has been erased and
 * programmed is in it at once, byte by byte, so that an image that is stopped at any moment finds
 * there what it has left behind.
 */
#ifndef TAKT_MPS2_FILE_FLASH_H
#define TAKT_MPS2_FILE_FLASH_H

#include "hal/flash.h"

#include <stdbool.h>
#include <stdint.h>

#define FILE_FLASH_SECTOR_BYTES 16384U

/* Private, but the caller owns it. */
struct file_flash {
    int file;
    uint64_t mirror[FLASH_SECTORS][FILE_FLASH_SECTOR_BYTES / sizeof(uint64_t)];
};

/* The file holds both sectors, one after the other. False: it is not there, or shorter. */
bool takt_file_flash_open(struct file_flash *flash, const char *path, struct flash_port *port);

#endif
