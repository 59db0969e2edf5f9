/*
 * Control cycles on an outside bus, as fast as its drives answer: a cycle ends when the status of
 * every drive has come.
 *
 *     takt_controller_cycle   SYNC, controlwords, targets  --->  drives
 *     lockstep_end_cycle                              <---  statusword and position of every drive
 *
 * So what the controller receives in a cycle does not depend on the speed of either side, and a run
 * over any bus gives the setpoints and positions of a run over the embedded one. Drives do their
 * part by taking SYNC for their clock.
 *
 * A drive is waited for once it is in step. Until all are, cycles take their time by the clock, as
 * drives need it to boot. When the last one is heard first, several of its answers may be under
 * way; so one cycle waits until it is quiet.
 */
#ifndef TAKT_HOST_LOCKSTEP_H
#define TAKT_HOST_LOCKSTEP_H

#include "base/point.h"
#include "drive/drives.h"
#include "hal/can.h"
#include "link/link.h"

#include <stdbool.h>
#include <stdint.h>

#define LOCKSTEP_FRAMES_MAX 1024 /* received in one cycle; more are lost, the oldest first */
#define LOCKSTEP_TEXT_MAX   127

/*
 * A drive in step that does not answer for so long is given up: the controller then finds it
 * silent.
 */
#define LOCKSTEP_ANSWER_NS UINT64_C(5000000000)

/* So long without an answer: none is under way any more. */
#define LOCKSTEP_QUIET_NS 100000000u

struct lockstep_drive {
    uint8_t node;
    bool is_in_step;
    bool has_answered; /* in this cycle */
    uint8_t reported;  /* in this cycle, enum drives_report */
};

/* Private. */
struct lockstep {
    struct link *link;           /* the caller's */
    unsigned bus;                /* of the machine that it is */
    const struct drives *drives; /* of the controller: which frames are answers; NULL: TPDO1 is */
    struct can_port link_port;
    uint64_t cycle_ns;
    uint64_t cycle_start_ns; /* by link_clock_ns */
    unsigned count;
    struct lockstep_drive drive[AXIS_COUNT];
    unsigned read, written;
    struct can_frame frame[LOCKSTEP_FRAMES_MAX];
    char warning[LOCKSTEP_TEXT_MAX + 1];
};

/*
 * link: open, and usable as long as the lockstep. nodes: of the drives on this bus, which are
 * waited for.
 */
void lockstep_init(struct lockstep *lockstep, struct link *link, unsigned bus, uint64_t cycle_ns,
                   const uint8_t nodes[], unsigned count);

/* Another link in the place of one that is gone; drives are in step anew. */
void lockstep_set_link(struct lockstep *lockstep, struct link *link);

/* The controller's bus: sends at once, receives what came until the last lockstep_end_cycle. */
struct can_port lockstep_get_port(struct lockstep *lockstep);

/*
 * Waits for the end of the cycle, through signals. False: the bus is gone, link_get_problem says
 * why.
 */
bool lockstep_end_cycle(struct lockstep *lockstep);

/* The cycle ends at a time of the clock, whoever has answered. False as above. */
bool lockstep_end_cycle_at(struct lockstep *lockstep, uint64_t time_ns);

/* What is worth telling since the last call: a drive that was given up. False: nothing. */
bool lockstep_take_warning(struct lockstep *lockstep, char text[LOCKSTEP_TEXT_MAX + 1]);

#endif
