/*
 * The limits of the axes: no motion may leave them, not even between its ends.
 */
#ifndef TAKT_PROGRAM_TRAVEL_H
#define TAKT_PROGRAM_TRAVEL_H

#include "program/program.h"

/* Where a motion leaves the travel: mm or rad. */
struct travel_excess {
    enum axis axis;
    double value, limit;
};

/* Does a motion from start stay inside? False: *excess says where not. */
bool takt_travel_holds(const struct program_config *config, const struct point *start,
                       const struct move *m, struct travel_excess *excess);

/* Says so about a place in the text, with what the axis is named by: mm or degrees. */
void takt_travel_report(struct diagnostic *d, uint32_t line, uint32_t column,
                        const struct travel_excess *excess);

/*
 * The same for a motion from the current position; a compensated one is looked at when its way is
 * known. False: p->error names the axis and the coordinate (mm or degrees).
 */
bool takt_travel_check(struct program *p, const struct move *m);

#endif
