/*
 * The image itself: is what lies in the flash memory what was built?
 */
#ifndef TAKT_PORT_IMAGE_H
#define TAKT_PORT_IMAGE_H

#include "base/error.h"

/* False: bits have been lost; *why says so. Takes about 6 cycles of the processor a byte. */
bool takt_image_is_sound(struct diagnostic *why);

#endif
