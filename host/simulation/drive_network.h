/*
 * What a controller is connected to: CAN buses and the drives on them.
 *
 * Buses and drives are virtual and inside this process (virtual time: as fast as it goes), or
 * outside: then a cycle lasts until all drives have answered (simulation/lockstep.h). Either may be
 * paced by the wall clock instead.
 */
#ifndef TAKT_HOST_DRIVE_NETWORK_H
#define TAKT_HOST_DRIVE_NETWORK_H

#include "bus/bus.h"
#include "cli/status.h"
#include "config/machine_setup.h"
#include "drives/virtual_drives.h"
#include "link/link.h"
#include "simulation/bus_return.h"
#include "simulation/drive_images.h"
#include "simulation/frame_buffer.h"
#include "simulation/lockstep.h"
#include "simulation/pace.h"
#include "stepper/virtual_steppers.h"

#include <stdbool.h>
#include <stdint.h>

#define DRIVE_NETWORK_ADDRESS_MAX 511

/* A bus outside, and what has gone over it. */
struct drive_network_link {
    char address[DRIVE_NETWORK_ADDRESS_MAX + 1];
    struct link *link;
    bool is_lost; /* it has been told */
    struct bus_return way_back;
    struct lockstep lockstep;
    struct frame_bits tables;
    uint64_t frames;
    struct frame_times times;
    uint64_t busy_ns; /* intermissions included */
    unsigned bus;
    struct candump *log; /* its frames go there, too; NULL: nowhere */
};

/* It must not be moved once opened. Private but for bus and drives. */
struct drive_network {
    unsigned buses;
    struct bus bus[CAN_BUSES_MAX]; /* both: not used with outside buses */
    struct virtual_drives drives;
    struct drive_images images; /* of the drives; none: they run here alone */
    struct dictionary
        sheet[MACHINE_SETUP_DRIVES_MAX]; /* of the drives, by axis; empty: takt's own */
    struct virtual_steppers steppers;    /* inside, whatever the bus */
    const struct inject *script;         /* of faults; NULL: none */
    bool has_enabled_faults; /* those that count from the drives' being enabled are on the buses */
    bool is_outside;         /* buses and drives are not inside, but: */
    struct drive_network_link outside[CAN_BUSES_MAX];
    bool returns; /* a link that is lost is opened again */
    struct can_buses can;
    uint64_t cycles; /* ended */
    uint64_t cycle_ns;
    bool is_paced;
    struct pace pace;
    struct pace_permission permission;
};

/*
 * What the options --bus, --drives and --realtime say. Texts may be NULL: not given.
 */
struct drive_network_options {
    const char *bus;    /* bus/link.h; of several buses one after the other, with commas between */
    const char *drives; /* internal, external, or where an image of each runs: m4f, m7 */
    const char *drive_image; /* its file */
    bool is_paced;
    bool returns;    /* an outside bus that is lost is opened again; with is_paced */
    bool has_script; /* --inject is given */
    const struct inject
        *script; /* faults of the embedded bus and its drives; NULL: none. It must stay */
};

/* False after a message: the options do not go together. Touches nothing. */
bool drive_network_check_options(const struct drive_network_options *options);

/* The next of the addresses of --bus. False: there is none. */
bool drive_network_next_address(const char **list, char address[DRIVE_NETWORK_ADDRESS_MAX + 1]);
/* Buses and drives are not in this process. */
bool drive_network_is_outside(const struct drive_network_options *options);

/*
 * The drives boot, or are there. network: zeros. STATUS_DONE; else after a message, and nothing is
 * open.
 */
enum command_status drive_network_open(struct drive_network *network,
                                       const struct machine_setup *setup,
                                       const struct drive_network_options *options);
void drive_network_close(struct drive_network *network);

/* The controller's drives: it knows which frames are their answers. They must stay. */
void drive_network_watch_drives(struct drive_network *network, const struct drives *drives);

/*
 * Faults that join those of the script while drives inside run; first: the first new one of it. The
 * script must stay. False after a message: the bus can hold no more.
 */
bool drive_network_add_faults(struct drive_network *network, const struct inject *script,
                              unsigned first);

/* The controller's buses. */
struct can_buses drive_network_get_port(struct drive_network *network);
/* Its step drives. */
struct step_port drive_network_get_step_port(struct drive_network *network);

/*
 * The controller has done its part of a cycle: frames travel, drives move. False: an outside bus is
 * gone, see drive_network_get_problem; if it returns, cycles go on meanwhile.
 */
bool drive_network_end_cycle(struct drive_network *network);

/* An outside bus is gone, and not back yet. */
bool drive_network_is_lost(const struct drive_network *network);

/*
 * Where what the drives inside move stands, play and errors of screws and steps that were missed
 * included; mm, rad. Axes without a drive: 0.
 */
void drive_network_get_axes(const struct drive_network *network, const struct machine *machine,
                            struct point *at);

/* Which one, or the first of them. Only while there is one. */
unsigned drive_network_get_lost_bus(const struct drive_network *network);

/* What an outside bus, or an image of a drive, died of; NULL: it has not. */
const char *drive_network_get_problem(struct drive_network *network);

/*
 * Every frame on any bus from now on: of buses inside by frame_buffer_write, of others with the
 * time since 1970.
 */
void drive_network_log(struct drive_network *network, struct frame_buffer *frames,
                       struct candump *log);

/* For buses inside: bus_clear_responses, bus_end_responses. */
void drive_network_clear_responses(struct drive_network *network);
void drive_network_end_responses(struct drive_network *network);

/* False: faults have been put on a bus inside. */
bool drive_network_is_sound(const struct drive_network *network);

uint64_t drive_network_get_frames(const struct drive_network *network, unsigned bus);
/*
 * Percent of the cycles' time; of an outside bus: as if its frames took what the machine's bit
 * rates say.
 */
double drive_network_get_load_percent(const struct drive_network *network, unsigned bus);
/* Load of the bus that has the most. */
double drive_network_get_highest_load_percent(const struct drive_network *network);

#endif
