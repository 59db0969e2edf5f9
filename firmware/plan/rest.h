/*
 * Blocks so near to rest that the setpoint stays below their ceiling by itself: the lead point takes the feed of their
 * neighbours there. See spans.md.
 */
#ifndef TAKT_PLAN_REST_H
#define TAKT_PLAN_REST_H

#include "plan/ceiling.h"

#include <stdbool.h>
#include <stdint.h>

/* Feed ceilings of the lead point, mm/s: as the overrides are, and at their highest. */
struct rest_feeds {
    double now;
    double highest;
};

/* A span with its ends, as far as they are rests. */
struct rest_span {
    const struct path *path;
    const struct ceiling_request *request;
    uint32_t cycles; /* of the first averaging box */
    uint64_t start;
    double
        start_a; /* mm/cycle2: of all since it began there at rest; infinite: not one, or no rest */
    bool rests;  /* it ends at rest for good, */
    uint32_t end;             /* before this block */
    struct rest_feeds before; /* of the block that was asked for last */
    double before_a;
};

/*
 * May the setpoint, x_mm behind or before a rest at most, be faster than a feed? The lead point speeds up, or slows down, by
 * a at most, and its position is averaged over so many cycles first. mm and cycles.
 */
bool rest_may_exceed(double feed, double x_mm, double a, uint32_t cycles);

/* The span that the block at index is the first of, or the first that is there. */
void rest_begin(struct rest_span *r, const struct path *path, const struct ceiling_request *request,
                uint32_t index, uint32_t cycles);

/* Of a block, in the order of blocks: higher than its own where the setpoint stays below that by itself. */
struct rest_feeds rest_block_feeds(struct rest_span *r, uint32_t index);

#endif
