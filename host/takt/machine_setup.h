/*
 * The virtual machine a command works with: what a machine file says.
 */
#ifndef TAKT_HOST_MACHINE_SETUP_H
#define TAKT_HOST_MACHINE_SETUP_H

#include "controller/machine.h"
#include "drives/drive_plant.h"

#include <stdbool.h>

#define MACHINE_SETUP_PATH_MAX 511

struct machine_setup {
    struct machine machine;
    char tool_table[MACHINE_SETUP_PATH_MAX + 1];     /* empty: none */
    char parameter_file[MACHINE_SETUP_PATH_MAX + 1]; /* empty: none */
    struct drive_plant_config drive[AXIS_COUNT];     /* of each axis */
};

/* The built-in machine. Axes it does not have hold what they get when a file or --set adds them. */
void machine_setup_set_default(struct machine_setup *setup);

/*
 * What single values cannot show: order of travel ends, nodes used twice, positions beyond 32 bits, a bus that cannot
 * carry the cycle. NULL: good; else what is wrong, valid until the next call.
 */
const char *machine_setup_check(const struct machine_setup *setup);

/* Bus load with worst-case stuffing of a cycle's frames, percent. */
double machine_setup_predict_load_percent(const struct machine *machine);

#endif
