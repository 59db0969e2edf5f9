/*
 * The virtual drives of a machine: on one embedded bus, or on any bus through a port.
 *
 * On the embedded bus, every control cycle: the controller sends, bus_run_until lets the frames of
 * the cycle travel, and virtual_drives_step moves the motors by one cycle.
 *
 * On another bus whoever owns the port hands in what it has received (virtual_drives_take) and the
 * time (virtual_drives_step).
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVES_H
#define TAKT_DRIVES_VIRTUAL_DRIVES_H

#include "bus/bus.h"
#include "drives/virtual_drive.h"

#define VIRTUAL_DRIVES_MAX 16

/* Frames of these drives that wait to be heard by the others of them. */
#define VIRTUAL_DRIVES_OWN_FRAMES_MAX 64

struct virtual_drives_config {
    unsigned count; /* 0 ... VIRTUAL_DRIVES_MAX */
    bool is_fd;     /* of an outside bus: it is CAN FD */
    struct virtual_drive_config drive
        [VIRTUAL_DRIVES_MAX]; /* in the machine's order: it makes the pairs; I/O nodes come last */
};

/* One drive's way to a bus that is not embedded. */
struct virtual_drives_port {
    struct virtual_drives *set;
    unsigned index;
};

/*
 * What the touch probes of all drives are wired to: does it touch where the drives are, mm or rad,
 * by their index?
 */
struct virtual_drives_contact {
    bool (*touches)(void *context, const double position_mm[VIRTUAL_DRIVES_MAX]);
    void *context;
};

struct virtual_drives {
    unsigned count;
    unsigned motors; /* of these; the others are I/O nodes */
    struct inject_clock clock;
    struct virtual_drives_contact contact; /* without touches: nothing */
    bool touches;

    /* Not on the embedded bus: the drives hear each other, too. */
    struct can_port port;
    bool has_sync;      /* one has come since SYNC is the clock */
    bool is_left;       /* since then somebody has left */
    uint64_t silent_ns; /* real time since the last one */
    uint64_t alone_ns;  /* that the drives' time has gone on without it */
    struct virtual_drives_port way[VIRTUAL_DRIVES_MAX];
    unsigned own_count;
    struct virtual_drives_own {
        unsigned sender;
        struct can_frame frame;
    } own[VIRTUAL_DRIVES_OWN_FRAMES_MAX];

    struct virtual_drive drive[VIRTUAL_DRIVES_MAX];
};

/*
 * The default plant for every drive, nodes 1, 2, ..., 100,000 increments/mm, standing at 0, a
 * target every millisecond.
 */
void virtual_drives_set_default(struct virtual_drives_config *config, unsigned count);

/*
 * Attaches the drives to their buses and boots them. bus: all of them. set and bus must stay where
 * they are from now on.
 */
void virtual_drives_init(struct virtual_drives *set, struct bus bus[],
                         const struct virtual_drives_config *config);

/* Nodes of those on this bus, in the order in which they were attached to it; their number. */
unsigned virtual_drives_on_bus(const struct virtual_drives *set, unsigned bus,
                               uint8_t node[VIRTUAL_DRIVES_MAX]);

/*
 * Switches the drives on behind a port; they have not booted yet. They know nothing of each other's
 * targets: their PDOs are those of the dictionary.
 */
void virtual_drives_open(struct virtual_drives *set, const struct can_port *port,
                         const struct virtual_drives_config *config);
void virtual_drives_boot(struct virtual_drives *set);

/* Who is told of everything that happens in the drives. */
void virtual_drives_observe(struct virtual_drives *set, const struct drive_observer *observer);

/* Faults of the script happen from now on, by the time of virtual_drives_step. It must stay. */
void virtual_drives_inject(struct virtual_drives *set, const struct inject *script);

/* Without it touch probes meet nothing. */
void virtual_drives_set_contact(struct virtual_drives *set,
                                const struct virtual_drives_contact *contact);

/* A frame has come by the port of virtual_drives_open. */
void virtual_drives_take(struct virtual_drives *set, const struct can_frame *frame);

/*
 * The same for drives that take SYNC for their clock: what happens in the period that ends with a
 * SYNC happens before the drives see it. False: the controller has not told all of them the same
 * period (object 1006), so time goes on by virtual_drives_step alone.
 */
bool virtual_drives_take_by_sync(struct virtual_drives *set, const struct can_frame *frame);

void virtual_drives_step(struct virtual_drives *set, uint32_t cycle_ns);

/*
 * Real time has gone by for drives that take SYNC for their clock. Their time stands still
 * meanwhile, since a controller may take as long over a cycle as it likes; but a dead one must be
 * noticed. When enabled drives have had no SYNC for patience_ns, or since the controller has left
 * for two thirds of the shortest heartbeat time they watch (object 1016), time goes on by itself
 * until the next SYNC. The last third is for their supervision and for braking.
 */
void virtual_drives_wait(struct virtual_drives *set, uint32_t waited_ns, uint64_t patience_ns);
/*
 * The controller, or another one on the bus, has left; or nobody can hear it if it does: then
 * before every wait.
 */
void virtual_drives_leave(struct virtual_drives *set);

/*
 * Time since power-on, and since when all drives are enabled (INJECT_ALWAYS: they have not been).
 */
const struct inject_clock *virtual_drives_get_clock(const struct virtual_drives *set);

/* All drives have been told the same period of SYNC (object 1006). */
bool virtual_drives_follow_sync(const struct virtual_drives *set);

#endif
