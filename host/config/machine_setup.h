/*
 * The virtual machine a command works with: what a machine file says.
 */
#ifndef TAKT_HOST_MACHINE_SETUP_H
#define TAKT_HOST_MACHINE_SETUP_H

#include "bus/frame_bits.h"
#include "config/chain_text.h"
#include "deviation/deviation.h"
#include "drives/drive_plant.h"
#include "machine/machine.h"
#include "spindle/virtual_spindle.h"
#include "stepper/virtual_steppers.h"
#include "translation/codes.h"
#include "vibration/vibration.h"

#include <stdbool.h>

#define MACHINE_SETUP_PATH_MAX 511

/* How `takt serve` lets panels in. */
struct panel_setup {
    char listen[MACHINE_SETUP_PATH_MAX + 1]; /* HOST:PORT; empty: not on TCP */
    char allow[MACHINE_SETUP_PATH_MAX + 1];  /* addresses, separated by commas; empty: everybody */
    uint32_t password;                       /* 0: none */
};

/* A virtual drive: its motor, and what it is like on the bus. */
struct machine_drive {
    struct drive_plant_config plant;
    char eds[MACHINE_SETUP_PATH_MAX + 1]; /* its data sheet; empty: takt's own drive */
    char
        dcf[MACHINE_SETUP_PATH_MAX + 1]; /* what it is set up by, real or virtual; empty: nothing */
    uint32_t boot_ms;
    uint32_t sdo_ms;
};

/* Index of the second drive of the first gantry; behind it those of the others. */
#define MACHINE_SECOND_DRIVE     AXIS_COUNT
#define MACHINE_SETUP_DRIVES_MAX (AXIS_COUNT + MACHINE_GANTRIES_MAX)

/*
 * What the controller is told of its machine's geometry (correction/geometry.h), beside the errors
 * of units.
 */
struct geometry_setup {
    double tool_mm[AXIS_LINEAR_COUNT];
    double centre_mm[AXIS_LINEAR_COUNT];
    double squareness_rad[AXIS_LINEAR_COUNT];
};

struct machine_setup {
    struct machine machine;
    char tool_table[MACHINE_SETUP_PATH_MAX + 1];     /* empty: none */
    char parameter_file[MACHINE_SETUP_PATH_MAX + 1]; /* empty: none */
    char volume_table[MACHINE_SETUP_PATH_MAX + 1];   /* correction tables; empty: none */
    char axis_table[AXIS_COUNT][MACHINE_SETUP_PATH_MAX + 1];
    char unit_table[AXIS_COUNT][MACHINE_SETUP_PATH_MAX + 1];
    char chain[CHAIN_TEXT_MAX]; /* of units, from the part to the tool; empty: see chain_text.h */
    struct geometry_setup known_geometry;
    struct deviation_config geometry;  /* how the virtual machine differs from a perfect one */
    struct vibration_config vibration; /* and how it swings */
    uint32_t shaper;                   /* enum shaper: what the controller does about that */
    struct machine_drive
        drive[MACHINE_SETUP_DRIVES_MAX]; /* of each axis, and the second ones of gantries */
    struct virtual_stepper_config stepper[AXIS_COUNT]; /* of each axis, if it has a step drive */
    struct virtual_spindle_config spindle;             /* see machine_setup_get_spindle */
    struct panel_setup panel;
    struct dialect_codes codes; /* what becomes of codes that takt does not know */
    uint32_t drives_stay_on; /* 1: an ordered end leaves drives "switched on", else they are off */
};

/* The built-in machine. Axes it does not have hold what they get when a file or --set adds them. */
void machine_setup_set_default(struct machine_setup *setup);

/*
 * What single values cannot show: order of travel ends, nodes used twice, positions beyond 32 bits,
 * a bus that cannot carry the cycle. NULL: good; else what is wrong, valid until the next call.
 */
const char *machine_setup_check(const struct machine_setup *setup);

/* The machine's chain. NULL: good; else what is wrong with it. */
const char *machine_setup_chain(const struct machine_setup *setup, struct unit_chain *chain);

/* The virtual spindle: its highest speed is the machine's. */
struct virtual_spindle_config machine_setup_get_spindle(const struct machine_setup *setup);

/* Bit rates of every bus. */
struct frame_rates machine_setup_get_rates(const struct machine *machine);

/* Load of a bus with worst-case stuffing of a cycle's frames, percent. */
double machine_setup_predict_load_percent(const struct machine *machine, unsigned bus);

#endif
