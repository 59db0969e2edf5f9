/*
 * The tables of a machine, ready for the control cycle. The caller owns them.
 */
#ifndef TAKT_CORRECTION_TABLES_H
#define TAKT_CORRECTION_TABLES_H

#include "correction/axis_tables.h"
#include "correction/geometry.h"
#include "correction/grid.h"

struct correction_tables {
    struct grid volume;      /* volume.inputs is 0: none */
    struct axis_tables axes; /* axes.count is 0: none */
    const struct geometry
        *geometry; /* errors of units; NULL: none. Where memory is short, a volume made of them */
};

#endif
