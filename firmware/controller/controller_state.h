/*
 * Inside the controller: public only so that the caller can own the memory. Read controller.h
 * instead.
 */
#include "controller/controller.h" /* before the guard: that one includes this in its place */

#ifndef TAKT_CONTROLLER_CONTROLLER_STATE_H
#define TAKT_CONTROLLER_CONTROLLER_STATE_H

#include "classic/interpolator.h"
#include "classic/product.h"
#include "controller/approach.h"
#include "controller/controller_probe.h"
#include "controller/controller_reader.h"
#include "controller/outputs.h"
#include "controller/spindle_watch.h"
#include "controller/tool_changer.h"
#include "correction/correction.h"
#include "drive/drives.h"
#include "hal/inputs.h"
#include "hal/outputs.h"
#include "motion/motion.h"
#include "plan/path.h"
#include "replay/replay.h"
#include "shape/shape.h"
#include "step/steps.h"
#include "sync/spindle_sync.h"

struct controller {
    struct machine machine;
    struct can_buses can;
    const struct concise_dcf *dcf;
    enum controller_state state;
    struct diagnostic fault;
    struct diagnostic warning; /* TAKT_OK: none */
    bool keeps_outputs;        /* the end of the program leaves spindle and coolant as they are */
    bool program_waits;        /* for an answer: what it asked (G38, M66) is being done */
    bool program_late;         /* its next line has not come yet */
    bool program_begins;       /* though its text comes slowly: what is there is driven */
    bool (*refuse)(void *listener, const struct diagnostic *why); /* as of the configuration */
    bool program_ended; /* nothing more comes from the program: its end or an error in it */
    bool has_record;
    /* motions of the program, and what stands between them: on the path so far, and begun */
    uint32_t pushed, reached;
    uint32_t waits; /* of what stands between motions, passed */
    struct diagnostic
        program_error; /* TAKT_OK: none. Reported when everything before it has been done */
    struct outputs outputs;
    struct spindle_watch spindle;
    struct tool_changer changer;
    struct spindle_sync sync;       /* threads */
    struct outputs_surface surface; /* G96 */
    /*
     * cmd and set also without a program cycle: where the axes stand by the program, and what is
     * sent to the drives
     */
    struct cycle_record record;
    struct controller_reader *reader;
    struct path path;
    struct motion motion;
    struct correction correction;
#ifndef SHAPE_IS_ABSENT
    struct shape *shape; /* NULL: none */
#endif
    bool replays; /* a compiled program */
    struct replay replay;
    struct drives drives;
    struct step_port step_port;
    struct steps steps;
    struct controller_probe probe;
    struct approach approach;
    /*
     * For comparison, of setpoints and of the feed: last, so that what is used in every cycle lies
     * close together.
     */
    struct interpolator interpolator;
    struct product product;
};

#endif
