/*
 * Can this machine work? What single values, each in its range, do not show.
 */
#ifndef TAKT_MACHINE_CHECK_H
#define TAKT_MACHINE_CHECK_H

#include "base/error.h"
#include "drive/drives.h"
#include "machine/machine.h"

#include <stdbool.h>

/*
 * Order of travel ends, positions beyond the drives' 32 bits, limits below the rounding of
 * setpoints, step rates, nodes used twice, forms of interpolation and feed that this build does not
 * have, a bus that cannot carry the cycle. False: *wrong says why.
 */
bool takt_machine_check(const struct machine *machine, struct diagnostic *wrong);

/* What a cycle takes of a bus at worst. True: that bus carries it. */
bool takt_machine_predict_load(const struct machine *machine, unsigned bus,
                               struct drives_load *load);

#endif
