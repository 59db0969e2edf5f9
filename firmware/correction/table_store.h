/*
 * Correction tables as bytes, as a target stores them: little-endian, with a version and a CRC-32
 * over everything.
 *
 *     "TKT1" | inputs, outputs, 0, 0 | input axes | knots of each | outputs | knots (8 bytes) | values (4 bytes) | CRC-32
 */
#ifndef TAKT_CORRECTION_TABLE_STORE_H
#define TAKT_CORRECTION_TABLE_STORE_H

#include "correction/table.h"

/* Bytes that a table takes. */
size_t takt_table_store_size(const struct table *table);

/* Writes takt_table_store_size bytes. */
void takt_table_store(const struct table *table, uint8_t *bytes);

/*
 * Reads and checks. False: *wrong says why (a wrong checksum among others), and *table holds
 * nothing of use.
 */
bool takt_table_restore(const uint8_t *bytes, size_t size, const struct table_rules *rules,
                        struct table *table, struct diagnostic *wrong);

#endif
