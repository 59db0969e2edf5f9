/*
 * Correction tables as bytes that can be used where they lie: coefficients and pieces as the
 * control cycle wants them, so that they take no memory beside the flash they are stored in.
 *
 *     volume: inputs, corrected (bits), turning axis, 0 | axis, points of each input, 4 of them | first, per mm of each |
 *             coefficients (float)
 *     axes:   pairs, points | input, corrected, directed, 0, first, points of each pair | knots (double) | pieces
 *
 * All numbers have 4 bytes where nothing else is said; first and points of a pair have 2, its
 * others 1.
 */
#ifndef TAKT_STORAGE_SETTINGS_TABLES_H
#define TAKT_STORAGE_SETTINGS_TABLES_H

#include "base/error.h"
#include "correction/tables.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes they take; 0: there are none. */
uint32_t takt_settings_volume_bytes(const struct grid *grid);
uint32_t takt_settings_axes_bytes(const struct axis_tables *tables);

/* Writes this number of bytes. */
void takt_settings_volume_put(const struct grid *grid, uint8_t *bytes);
void takt_settings_axes_put(const struct axis_tables *tables, uint8_t *bytes);

/*
 * Makes tables of bytes, which must outlive them and lie at a multiple of 8, and checks them by the
 * rules. NULL: good; else what is wrong.
 */
const char *takt_settings_volume_take(const uint8_t *bytes, uint32_t size,
                                      const struct table_rules *rules, struct grid *grid);
const char *takt_settings_axes_take(const uint8_t *bytes, uint32_t size,
                                    const struct table_rules *rules, struct axis_tables *tables);

#endif
