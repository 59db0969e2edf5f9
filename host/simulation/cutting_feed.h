/*
 * What the virtual spindle's load depends on.
 */
#ifndef TAKT_HOST_CUTTING_FEED_H
#define TAKT_HOST_CUTTING_FEED_H

#include "controller/controller.h"

/*
 * Feed along the path in the last cycle, if it was one that cuts: 0 in rapids and between programs.
 */
double cutting_feed_mm_s(const struct controller *controller);

#endif
