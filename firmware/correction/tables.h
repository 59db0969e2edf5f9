/*
 * The tables of a machine, ready for the control cycle. The caller owns them.
 */
#ifndef TAKT_CORRECTION_TABLES_H
#define TAKT_CORRECTION_TABLES_H

#include "correction/axis_tables.h"
#include "correction/grid.h"

struct correction_tables {
    struct grid volume;      /* volume.inputs is 0: none */
    struct axis_tables axes; /* axes.count is 0: none */
};

#endif
