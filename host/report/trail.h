/*
 * The tool path in space, thinned to the points that shape it.
 *
 * A point is kept where the path leaves a straight strip of tolerance_mm about the ray from the
 * point kept before, turns back along it, changes between rapid and feed, changes its line, or
 * changes its feed by more than feed_ratio. When TRAIL_POINTS_MAX are kept, the tolerances double
 * and the kept points are thinned once more (lines then no longer count). Memory is bounded, the
 * result depends on the points alone.
 *
 * The idea of the strip is Reumann and Witkam's (1974); here the ray must also be followed
 * forwards.
 */
#ifndef TAKT_REPORT_TRAIL_H
#define TAKT_REPORT_TRAIL_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>

#define TRAIL_POINTS_MAX 49152

struct trail_point {
    double at_mm[AXIS_LINEAR_COUNT];
    double feed_mm_s;
    uint32_t cycle;
    uint32_t line; /* of the way that leads to this point */
    bool rapid;    /* that way is a rapid */
};

/* The strip between the point kept last and the newest one. */
struct trail_strip {
    struct trail_point newest;
    double direction[AXIS_LINEAR_COUNT]; /* unit vector; valid when reach_mm > 0 */
    double reach_mm; /* farthest along the direction; 0: still within tolerance of its start */
    bool is_used;    /* newest is another point than the one kept last */
};

struct trail {
    double tolerance_mm;
    double feed_ratio;      /* of the larger feed */
    double feed_floor_mm_s; /* differences below it never count */
    bool keep_lines;
    uint32_t count;
    struct trail_point *kept; /* [TRAIL_POINTS_MAX] */
    struct trail_strip strip;
};

/*
 * feed_max_mm_s: of the machine; it scales feed_floor_mm_s. False: out of memory. trail_close frees
 * it.
 */
bool trail_open(struct trail *t, double feed_max_mm_s);
void trail_close(struct trail *t);

void trail_add(struct trail *t, const struct trail_point *point);
/* Keeps the newest point too, so that the trail ends where the path does. Adding may go on. */
void trail_finish(struct trail *t);

/* No point that was added is farther from the trail than this. */
double trail_get_error_mm(const struct trail *t);

#endif
