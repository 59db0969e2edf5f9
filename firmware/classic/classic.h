/*
 * Does this build have the forms for comparison? An image that needs its flash memory for something
 * else may be without (TAKT_CLASSIC): its machines interpolate exactly and keep every ceiling.
 */
#ifndef TAKT_CLASSIC_CLASSIC_H
#define TAKT_CLASSIC_CLASSIC_H

#include <stdbool.h>

bool takt_classic_is_there(void);

#endif
