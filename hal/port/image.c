#include "port/image.h"

#include "base/crc32.h"

#include <stdint.h>

/* From image.ld. */
extern const uint8_t image_begin[], image_end[];

/* The CRC-32 of everything before it, by seal_image.py. */
__attribute__((section(".seal"), used)) static const volatile uint32_t seal = 0;

bool takt_image_is_sound(struct diagnostic *why)
{
    const uint32_t found =
        takt_crc32_add(CRC32_START, image_begin, (size_t)(image_end - image_begin));

    if (found == seal)
        return true;
    takt_diagnostic_set(why, TAKT_ERROR_IMAGE_DAMAGED, 0, 0, "", 0, (double)found);
    return false;
}
