/*
 * Who makes the setpoints of blocks that motion does not run itself: threads (room sync), and on a
 * machine with a form of the source in the place of the planner's feed, all but probing moves
 * (classic/product.h).
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_FEED_H
#define TAKT_CONTROLLER_CONTROLLER_FEED_H

#include "controller/controller.h"

/* After takt_motion_init: a program begins. compiled: see struct controller_config. */
void takt_controller_feed_init(struct controller *c, const struct replay_source *compiled);

/* Is the block that motion stands before executed by the product? Else by the lock. */
bool takt_controller_feed_is_product(const struct controller *c);

#endif
