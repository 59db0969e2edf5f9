/*
 * What the touch probes of virtual drives meet: the solids of a probe file, where the drives
 * themselves say the axes are.
 */
#ifndef TAKT_HOST_PROBE_CONTACT_H
#define TAKT_HOST_PROBE_CONTACT_H

#include "drives/virtual_drives.h"
#include "machine/machine.h"
#include "probe/virtual_probe.h"

/* It must stay where it is. */
struct probe_contact {
    const struct virtual_probe *probe;
    enum axis axis[VIRTUAL_DRIVES_MAX]; /* of each drive; AXIS_COUNT: of none */
    unsigned count;
    struct point at; /* of axes without such a drive */
};

/*
 * Wires the drives of a machine, by their nodes, to what is in the file; an empty one is met
 * nowhere.
 */
void probe_contact_wire(struct probe_contact *contact, const struct virtual_probe *probe,
                        const struct machine *machine, struct virtual_drives *drives);

#endif
