/*
 * The path ahead: a ring of blocks. The background appends, the control cycle passes them.
 *
 *     push -> [ block | block | ... | block ] -> pass
 *
 * Only the background writes blocks, and count; only the cycle moves first. A block is seen by others when its end is
 * known: what joins it has been pushed, or nothing will.
 */
#ifndef TAKT_PLAN_PATH_H
#define TAKT_PLAN_PATH_H

#include "plan/block.h"
#include "plan/limits.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Blocks in the ring: the look-ahead, and those between the setpoint and the lead point that runs ahead of it
 * (firmware/motion), both ends included.
 */
#define PATH_BLOCKS_MAX 512

struct path {
    struct plan_limits limits;
    uint32_t first; /* blocks passed so far: the oldest one's number in the ring, modulo its size */
    uint32_t kept;  /* <= first: the oldest that must not be overwritten yet */
    uint32_t pushed;  /* blocks appended so far */
    uint32_t closed;  /* blocks so far whose end is known: first <= closed <= pushed */
    uint32_t motions; /* pushed so far: the number of the newest */
    bool finished;
    bool has_revolution_feed; /* a feed per revolution has been pushed */
    struct point end;         /* where everything pushed ends */
    struct smooth smooth;     /* motions that are not in the ring yet: a chain being smoothed */
    bool has_next; /* a move that is not part of that chain waits until it has been taken */
    struct move next;
    bool smoothing;     /* the newest block is a piece of a chain that goes on */
    double unit_mm;     /* path for a second of nominal time of a smoothed curve */
    struct move split;  /* a motion of several pieces that have not all found room yet */
    struct curve whole; /* its curve */
    double split_mm;    /* how much of it is in the ring; the length of whole: all */
    uint64_t position;  /* likewise, on the path */
    struct block block[PATH_BLOCKS_MAX];
};

/* start: where the machine stands. */
void path_init(struct path *p, const struct plan_limits *limits, const struct point *start);
/* Room for one more move? */
bool path_has_room(const struct path *p);
/* Appends the next move; a motion without length is counted and dropped. Needs room. */
void path_push(struct path *p, const struct move *move);
/* Background: appends pieces of a long motion that had no room before. */
void path_go_on(struct path *p);
/* No more moves will come. */
void path_finish(struct path *p);
/* Forgets every block: the axes have come to rest at a point, and what comes next starts there. */
void path_restart(struct path *p, const struct point *at, uint64_t position);
/* The block with a number first <= index < pushed. */
const struct block *path_at(const struct path *p, uint32_t index);
/* Background: the averaging window that a span beginning with this block was planned with. */
void path_promise(struct path *p, uint32_t index, uint32_t cycles);
/* The oldest block has been passed. */
void path_pass(struct path *p);

#endif
