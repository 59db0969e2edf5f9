/*
 * Inside the controller: public only so that the caller can own the memory. Read controller.h instead.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_STATE_H
#define TAKT_CONTROLLER_CONTROLLER_STATE_H

#include "drive/drives.h"
#include "hal/inputs.h"
#include "hal/outputs.h"
#include "motion/motion.h"
#include "offset/offset.h"
#include "plan/window.h"

struct controller {
    struct machine machine;
    struct can_port can;
    enum controller_state state;
    struct diagnostic fault;
    bool program_ended; /* nothing more comes from the program: its end or an error in it */
    bool has_record;
    struct diagnostic
        program_error;    /* TAKT_OK: none. Reported when everything before it has been done */
    struct inputs inputs; /* of this cycle */
    struct outputs outputs;
    struct point setpoint;
    struct cycle_record record;
    struct program program;
    struct offset offset;
    struct window window;
    struct motion motion;
    struct drives drives;
};

#endif
