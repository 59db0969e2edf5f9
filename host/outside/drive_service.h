/*
 * Virtual drives as a service: nodes of a bus outside of this process, for whatever master is
 * there.
 *
 * The drives keep their own time, a cycle of the wall clock each, until a controller tells all of
 * them the period of SYNC (object 1006): from then on SYNC is their clock, so that the controller
 * may run as fast as both sides go and gets the same answers in every run. Paced drives keep to the
 * wall clock whatever they are told.
 */
#ifndef TAKT_HOST_DRIVE_SERVICE_H
#define TAKT_HOST_DRIVE_SERVICE_H

#include "bus/frame_bits.h"
#include "cli/status.h"
#include "drives/virtual_drives.h"
#include "link/link.h"
#include "simulation/probe_contact.h"

#include <stdbool.h>
#include <stdio.h>

struct drive_service_config {
    const char *bus; /* bus/link.h */
    struct frame_rates rates;
    uint32_t cycle_us;
    bool is_paced;
    struct virtual_drives_config *drives; /* gets twins */
    const struct inject *script;          /* NULL: no faults */
    const struct machine *machine;
    const struct virtual_probe *probe; /* what touch probes meet, by the machine's axes */
    FILE *log;                         /* one line an event; NULL: none */
    const char *bus_log;               /* simulation/bus_log.h */
    const char *target, *image; /* each drive is this image in QEMU; NULL: it runs here alone */
    const char *store;          /* folder with what drives store (object 1010); NULL: none */
};

/* Until a signal comes: STATUS_DONE. Else after a message. */
enum command_status drive_service_run(const struct drive_service_config *config);

#endif
