/*
 * The feed diagram of one block: ramp, cruise, ramp; and its landing on a control cycle.
 */
#ifndef TAKT_PLAN_DIAGRAM_H
#define TAKT_PLAN_DIAGRAM_H

#include "plan/block.h"
#include "plan/profile.h"

#include <stdbool.h>
#include <stdint.h>

/* A diagram in three feeds: enough to know its time; profile_append makes the pieces. */
struct diagram {
    double feed_start_mm_s;
    double feed_cruise_mm_s;
    double feed_end_mm_s;
};

/* The cycles of a segment: cycle i is first_s + i * cycle after its start. */
struct diagram_cycles {
    uint64_t count;
    double first_s;
    double next_s; /* from the segment's end to the next cycle after it, 0 <= next <= cycle */
};

/*
 * The fastest diagram of b between two feeds, both reachable within the block. The cruise feed is feed_max or, in a
 * short block, what its ramps reach.
 */
struct diagram diagram_fastest(const struct block *b, double start_mm_s, double end_mm_s);

/* Seconds from start to end of b. */
double diagram_duration(const struct block *b, const struct diagram *d);

/*
 * Passes b: nothing is changed, the end lies between two cycles. phase_s: from the start of b to the first cycle,
 * 0 <= phase <= cycle.
 */
struct diagram_cycles diagram_pass(double duration_s, double phase_s, double cycle_s);

/* Whole cycles of a wait, rounded up. */
uint64_t diagram_wait(double duration_s, double cycle_s);

/* Comes to rest: the end is held until the next cycle. */
struct diagram_cycles diagram_rest(double duration_s, double phase_s, double cycle_s);

/*
 * Lands d in motion on a cycle, by lowering the cruise feed and then the end feed. False when not even an end feed of
 * 0 takes long enough: d is then the diagram that ends at rest.
 */
bool diagram_land(const struct block *b, struct diagram *d, double phase_s, double cycle_s);

/* The pieces of d over b. */
void diagram_expand(const struct block *b, const struct diagram *d, struct profile *p);

#endif
