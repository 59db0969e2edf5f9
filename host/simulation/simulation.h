/*
 * The machine a program runs on, cycle by cycle: firmware, CAN bus and drives.
 *
 *     takt_controller_background, takt_controller_cycle -> frames -> bus -> drives -> motors -> frames -> controller
 */
#ifndef TAKT_HOST_SIMULATION_H
#define TAKT_HOST_SIMULATION_H

#include "controller/controller.h"
#include "hal/inputs.h"
#include "probe/virtual_probe.h"
#include "session/session.h"
#include "simulation/announcer.h"
#include "simulation/correction_watch.h"
#include "simulation/cycle_cost.h"
#include "simulation/drive_network.h"
#include "simulation/probe_contact.h"
#include "simulation/tool_point.h"
#include "spindle/stock.h"
#include "spindle/virtual_spindle.h"
#include "tables/override_file.h"
#include "target/target.h"

#include <stdbool.h>
#include <stdint.h>

struct simulation {
    struct drive_network network; /* bus and drives */
    bool has_begun;               /* the program has had its first cycle */
    struct controller controller;
    struct controller_reader reader; /* of the controller */
    struct shape shape;              /* likewise, if the machine has a shaper */
    struct inject script;            /* of faults */
    struct parameters parameters;    /* what the program sets */
    struct program_text_reader text;
    struct announcer announcer; /* of what the program says */
    uint32_t answers;           /* to its questions, so far */
    struct virtual_probe probe;
    struct probe_contact contact; /* of it and the drives inside */
    struct override_file feed_override, rapid_override;
    struct inputs inputs; /* of the next cycle */
    struct virtual_spindle spindle;
    struct stock stock; /* that it cuts; empty: every cut is as deep as the machine file says */
    bool has_target;
    struct target target;
    double rise_k[AXIS_COUNT];    /* that the controllers have been told of the axes */
    struct tool_point tool_point; /* on a machine with errors */
    struct correction_watch correction;
    const char *program; /* its name, for warnings */
    uint64_t cycles;     /* since power-on, drive start included */
    uint64_t begun;      /* cycles before the drives were enabled */
    struct cycle_cost cost;
};

/*
 * The drives boot and stand at 0; the program waits for its first cycle. STATUS_DONE; else NULL in
 * *opened and a message.
 */
enum command_status simulation_open(const struct session *session, struct simulation **opened);
void simulation_close(struct simulation *s); /* NULL: nothing */

/*
 * One control cycle of everything. False: an outside bus is gone (drive_network_get_problem), or
 * the target is (its problem).
 */
bool simulation_step(struct simulation *s);

/*
 * The operator turns an override, until the next row of its file. Per cent within the panel's
 * range; else false.
 */
bool simulation_set_overrides(struct simulation *s, double feed_percent, double rapid_percent);

/*
 * Faults join those of --inject: the text of a script, and its name for messages. False after a
 * message: none has.
 */
bool simulation_add_faults(struct simulation *s, const char *name, const char *bytes,
                           size_t length);

/*
 * Where the tool's point was in it; NULL: drives stand for it, on a machine without errors or with
 * drives outside.
 */
const struct point *simulation_get_tool(const struct simulation *s);

/* What the last cycle did, on the target if there is one; NULL: it was none of the program. */
const struct cycle_record *simulation_get_record(const struct simulation *s);

#endif
