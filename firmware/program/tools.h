/*
 * The tool table as the interpreter reads it.
 */
#ifndef TAKT_PROGRAM_TOOLS_H
#define TAKT_PROGRAM_TOOLS_H

#include "base/point.h"

#include <stddef.h>
#include <stdint.h>

struct tool {
    uint32_t number;      /* T and H words name it; one of the table alone */
    uint32_t orientation; /* of a lathe tool: 0 to 9 */
    struct point offset;  /* G43 adds it to the work offset: mm, rad. The length is its Z */
    double diameter_mm;
    double front_angle_deg, back_angle_deg; /* of a lathe tool */
};

/* The caller owns the tools; any order. */
struct tool_table {
    const struct tool *tools;
    size_t count;
};

/* NULL when there is no such tool, or table is NULL. */
const struct tool *takt_tool_table_find(const struct tool_table *table, uint32_t number);

#endif
