/*
 * The optimiser on one section, from rest to rest: rounds of steps on windows of the trajectory,
 * then repair of what is not legal yet.
 *
 * A round cuts the trajectory into windows whose first and last three control points stay, so that
 * they join without a stop and may be worked on at the same time; the next round cuts it elsewhere.
 * The result does not depend on the number of cores.
 */
#ifndef TAKT_HOST_AHEAD_SOLVER_H
#define TAKT_HOST_AHEAD_SOLVER_H

#include "ahead/limits.h"
#include "ahead/path.h"
#include "ahead/trail.h"

#include <stdbool.h>
#include <stddef.h>

/* Rounds of one section, at most. */
#define SOLVER_ROUNDS 40

enum solver_result {
    SOLVER_DONE,
    SOLVER_STOPPED, /* as asked */
    SOLVER_MEMORY,
    SOLVER_STUCK /* what is left is not legal; solver_stuck_mm says where */
};

struct solver;

/* Memory for so many cores. NULL: out of memory. */
struct solver *solver_new(unsigned workers, const struct ahead_modes *modes);
void solver_free(struct solver *s);

/*
 * Improves a trajectory along a path until it is legal; longest: the intervals beyond which it is
 * of no use, and the solver gives up (SOLVER_STUCK). Progress is told from 0 to 1 now and then, by
 * one thread; false from it stops the work. progress may be NULL.
 */
enum solver_result solver_run(struct solver *s, const struct ahead_path *path,
                              const struct ahead_limits *limits, struct trail *trail,
                              size_t longest, bool (*progress)(void *context, double part),
                              void *context);

/* After SOLVER_STUCK: the place along the path that is farthest beyond what it has to keep. */
double solver_stuck_mm(const struct solver *s);

#endif
