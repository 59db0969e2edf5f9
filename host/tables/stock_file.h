/*
 * The file of --stock: the top of the material, a table over X and Y in machine coordinates. '#'
 * begins a comment.
 *
 *     0   50   100      X of the columns, rising
 *     0   2.0  2.5  1.8     Y of a row, rising, and the top at each X
 *     40  2.2  3.9  2.0
 */
#ifndef TAKT_HOST_STOCK_FILE_H
#define TAKT_HOST_STOCK_FILE_H

#include "spindle/stock.h"

#include <stdbool.h>

/* path NULL: no stock. False after a message; nothing is kept then. */
bool stock_file_load(struct stock *stock, const char *path);
void stock_file_free(struct stock *stock);

#endif
