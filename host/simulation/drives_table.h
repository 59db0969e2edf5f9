/*
 * What the drives of a machine would not have, for people: what the start has given up and what
 * follows from that, and what helps after a fault of a drive.
 */
#ifndef TAKT_HOST_DRIVES_TABLE_H
#define TAKT_HOST_DRIVES_TABLE_H

#include "drive/drives.h"
#include "machine/machine.h"

#include <cjson/cJSON.h>
#include <stdio.h>

/* What is told of the drives of one run. */
struct drives_table {
    uint32_t given_up[AXIS_COUNT]; /* bits of enum drives_given_up */
    struct drives_load load[CAN_BUSES_MAX];
    /* of each bus */ /* percent 0: the drives have not been started */
};

void drives_table_set(struct drives_table *table, const struct drives *drives);

/* A drive of them has given it up. */
bool drives_table_has(const struct drives_table *table, enum drives_given_up what);

/* A row for everything that has been given up, nothing if nothing has. */
void drives_table_write_text(FILE *stream, const struct drives_table *table);

/* The same of bits of enum drives_given_up alone, whichever drives' they are. */
void drives_table_write_bits(FILE *stream, uint32_t given_up);

/* To standard error, once the drives are enabled. False: they are not yet. */
bool drives_table_tell(const struct drives *drives, bool is_quiet);
void drives_table_add_json(cJSON *root, const struct drives_table *table,
                           const struct machine *machine);

/* What helps after this fault; "": nothing that is known. */
const char *drives_table_remedy(const struct diagnostic *fault);

#endif
