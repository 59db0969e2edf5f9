/*
 * The ordered end, the same for every way out: the program's end, a signal, a bus or a file that
 * fails.
 *
 *     hold on the path -> quick stop of every drive -> spindle and coolant off -> drives off, or "switched on"
 *
 * The caller goes on with its cycles meanwhile. Drives do not depend on it: without a controller
 * they stop by themselves (heartbeat, firmware/drive).
 */
#ifndef TAKT_HOST_ENDING_H
#define TAKT_HOST_ENDING_H

#include "controller/controller.h"

#include <stdbool.h>

enum ending_way {
    ENDING_NOT,     /* nobody has asked */
    ENDING_ON_PATH, /* once: the axes come to rest on their path */
    ENDING_AT_ONCE  /* twice: they brake where they are */
};

struct ending {
    enum ending_way way;
    bool stays_on; /* drives that have come to rest are left "switched on" */
    unsigned switching_cycles;
};

/* Between two cycles. What has been asked for is never taken back, only hastened. */
void ending_ask(struct ending *ending, struct controller *c, enum ending_way way);
/* The way that the signals so far ask for. */
enum ending_way ending_by_signals(void);
/*
 * After every cycle since then. True: the axes stand, and no drive is enabled as far as it can be
 * reached.
 */
bool ending_is_over(struct ending *ending, struct controller *c);

#endif
