#include "mps2/file_flash.h"

#include "semihosting/semihosting.h"

#include <string.h>

/* Erased at once. */
#define ERASE_BYTES 32U

static uint8_t *mirror_of(struct file_flash *flash, unsigned sector, uint32_t offset)
{
    return (uint8_t *)flash->mirror[sector] + offset;
}

/* Bytes of the mirror to the file. */
static bool keep(struct file_flash *flash, unsigned sector, uint32_t offset, uint32_t length)
{
    return takt_semihosting_seek(flash->file, sector * FILE_FLASH_SECTOR_BYTES + offset) &&
           takt_semihosting_write(flash->file, mirror_of(flash, sector, offset), length);
}

static bool erase(void *context, unsigned sector)
{
    struct file_flash *flash = context;

    for (uint32_t at = 0; at < FILE_FLASH_SECTOR_BYTES; at += ERASE_BYTES) {
        memset(mirror_of(flash, sector, at), 0xFF, ERASE_BYTES);
        if (!keep(flash, sector, at, ERASE_BYTES))
            return false;
    }
    return true;
}

/* Programming clears bits and sets none. */
static bool program(void *context, unsigned sector, uint32_t offset, const uint8_t *bytes,
                    uint32_t words)
{
    struct file_flash *flash = context;
    bool same = true;

    for (uint32_t i = 0; i < words * FLASH_WORD_BYTES; i++) {
        uint8_t *byte = mirror_of(flash, sector, offset + i);

        *byte &= bytes[i];
        same = keep(flash, sector, offset + i, 1) && *byte == bytes[i] && same;
    }
    return same;
}

bool takt_file_flash_open(struct file_flash *flash, const char *path, struct flash_port *port)
{
    *port = (struct flash_port){
        .sector_bytes = FILE_FLASH_SECTOR_BYTES,
        .sector = {mirror_of(flash, 0, 0), mirror_of(flash, 1, 0)},
        .erase = erase,
        .program = program,
        .context = flash,
    };
    flash->file = takt_semihosting_open(path, SEMIHOSTING_UPDATE);
    return flash->file >= 0 && takt_semihosting_read(flash->file, flash->mirror,
                                                     sizeof flash->mirror) == sizeof flash->mirror;
}
