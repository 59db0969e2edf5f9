/*
 * What a table over one axis says between its points.
 */
#ifndef TAKT_HOST_CORRECTION_CURVE_H
#define TAKT_HOST_CORRECTION_CURVE_H

#include "correction/table.h"

#include <stdbool.h>

/*
 * The controller reads a smooth curve through the points. Where some stand far closer than others
 * the curve may swing out between those many times as far as any point. False after a message: it
 * leaves the values of its column by more than they span, and by more than 1 um or 1 urad.
 * table has passed takt_table_check; tables over several axes have even steps, and are good.
 */
bool correction_curve_check(const struct table *table, const char *path);

#endif
