/*
 * What a controller must know of its machine before it may move it, as bytes: limits, drives, bus,
 * correction and its tables. `takt machine --pack` makes them, a target stores them.
 *
 *     "TKM1" | size | CRC-32 of what follows | version | records
 *     record: number, axis (2 bytes each) | bytes (4) | value, filled up to a multiple of 8
 *
 * Little-endian. Numbers are unsigned of 4 bytes or IEEE-754 doubles. A record of a number this
 * version does not know is an error; one that is missing leaves the default. Tables are stored
 * ready for use, as settings_tables.h says.
 */
#ifndef TAKT_STORAGE_SETTINGS_H
#define TAKT_STORAGE_SETTINGS_H

#include "base/error.h"
#include "canopen/concise_dcf.h"
#include "correction/correction.h"
#include "correction/tables.h"
#include "machine/machine.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SETTINGS_VERSION    1U
#define SETTINGS_HEAD_BYTES 16U

/* More than any settings take without tables. */
#define SETTINGS_BYTES_MIN 8192U

/*
 * Writes settings to bytes, room of them; tables: NULL: none; dcf: of MACHINE_NODES_MAX drives, as
 * of struct controller_config; NULL: none. Returns their size; 0: they do not fit.
 */
size_t takt_settings_pack(const struct machine *machine, const struct correction_tables *tables,
                          const struct concise_dcf *dcf, uint8_t *bytes, size_t room);

/*
 * Reads and checks all of it: checksum, records, ranges, the machine as a whole, the tables,
 * configurations of drives. bytes: at a multiple of 8; *tables and dcf, of MACHINE_NODES_MAX
 * drives, point into them afterwards, so they must outlive these; dcf: NULL: they are checked
 * alone. False: *wrong says why, and neither holds anything of use.
 */
bool takt_settings_read(const uint8_t *bytes, size_t size, struct machine *machine,
                        struct correction_tables *tables, struct concise_dcf *dcf,
                        struct diagnostic *wrong);

/*
 * Do the corrections leave the axes enough to move? *scratch is overwritten. False: *wrong says
 * which axis.
 */
bool takt_settings_check_share(const struct machine *machine,
                               const struct correction_tables *tables, struct correction *scratch,
                               struct diagnostic *wrong);

#endif
