/*
 * Blocks of a thread that are run without a stop between: where each begins on the line, and at
 * which angle.
 */
#ifndef TAKT_SYNC_CHAIN_H
#define TAKT_SYNC_CHAIN_H

#include "plan/path.h"
#include "sync/brake.h"

#include <stdbool.h>
#include <stdint.h>

/* One block: pitch (angle - zero) beyond its start. */
struct chain_leg {
    uint32_t block;
    double start_mm; /* from the start of the chain */
    double end_mm;
    double pitch_mm;
    double zero_rev;
};

struct chain {
    struct path *path;
    struct brake_limits limits; /* of its first block: the others can do as much */
    uint32_t last;              /* the newest block that belongs to it */
    double end_mm;              /* where that ends */
};

/* The path's oldest block begins a chain. */
void takt_chain_begin(struct chain *c, struct path *path);

/* Takes in blocks that have come since. A few each time. */
void takt_chain_extend(struct chain *c);

struct chain_leg takt_chain_first_leg(const struct chain *c, double zero_rev);

/* The leg behind this one, where the thread goes on in phase. False: the chain ends with it. */
bool takt_chain_next_leg(const struct chain *c, struct chain_leg *leg);

#endif
