/*
 * The path ahead: a ring of blocks. The background appends, the control cycle passes them.
 *
 *     push -> [ block | block | ... | block ] -> pass
 *
 * Only the background writes blocks, and count; only the cycle moves first. A block is closed, and
 * seen by others, when the junctions at its end and near it are known: what is there has been
 * pushed, or nothing will be.
 */
#ifndef TAKT_PLAN_PATH_H
#define TAKT_PLAN_PATH_H

#include "plan/block.h"
#include "plan/ceiling.h"
#include "plan/jerk_budget.h"
#include "plan/limits.h"
#include "plan/ring.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What smoothing computes with, where the one ceiling is not; as long as that. */
union path_spare {
    union smooth_scratch scratch;
    struct ceiling ceiling;
};

/*
 * Two ceilings at the ends of one area. All that the one in use leaves is free while there is no
 * other, and more than a ceiling where smoothing needs it:
 *
 *     | ceiling 0 |         spare         |
 *     |         spare         | ceiling 1 |
 */
union path_area {
    struct {
        struct ceiling ceiling;
        union path_spare spare;
    } low;
    struct {
        union path_spare spare;
        struct ceiling ceiling;
    } high;
};

#define PATH_NO_SPARE 2U

struct path {
    struct plan_limits limits;
    uint32_t first; /* blocks passed so far: the oldest one's number in the ring, modulo its size */
    uint32_t kept;  /* <= first: the oldest that must not be overwritten yet */
    uint32_t pushed;  /* blocks appended so far */
    uint32_t closed;  /* blocks so far whose limits are settled: first <= closed <= pushed */
    uint32_t motions; /* pushed so far: the number of the newest */
    bool finished;
    bool has_revolution_feed; /* a feed per revolution has been pushed */
    struct point end;         /* where everything pushed ends */
    /*
     * where the chain is kept belongs to somebody else, who moves the linear axes: nothing is
     * smoothed, and the axes stand where motion of rotary axes begins or ceases
     */
    bool lent;
    bool has_next;  /* a move that is not part of that chain waits until it has been taken: split */
    double unit_mm; /* path for a second of nominal time of a smoothed curve */
    struct move split;     /* a motion of several pieces that have not all found room yet, */
    uint32_t split_number; /* its number, */
    struct point from;     /* where it starts, */
    double length_mm;      /* its length */
    double split_mm;       /* and how much of that is in the ring */
    uint64_t position;     /* likewise, on the path */
    struct block
        edge[2]; /* the newest block, whose end may still change, and the one before or behind it */
    struct jerk_budget_block open[JERK_BUDGET_BLOCKS_MAX]; /* those that are not closed */
    struct path_ring ring;
    struct smooth smooth; /* motions that are not in the ring yet: a chain being smoothed */
    union path_area area; /* of the ceiling in use and the next one */
    /*
     * the one of them that is no ceiling: motions are smoothed as long as there is one;
     * PATH_NO_SPARE
     */
    unsigned spare;
};

/* start: where the machine stands. */
void takt_path_init(struct path *p, const struct plan_limits *limits, const struct point *start);
/*
 * Memory for something else that moves the linear axes, at a multiple of 8, in a path that smooths
 * nothing from here on: no move of PATH_BLEND comes before it is initialised again. Before anything
 * is pushed. size: of that, PATH_LENT_MAX at most.
 */
#define PATH_LENT_MAX (offsetof(struct smooth, change) - offsetof(struct smooth, route))
void *takt_path_lend(struct path *p, size_t size);
/* Room for one more move? */
bool takt_path_has_room(const struct path *p);
/*
 * How many blocks there should be ahead where this many are asked for: pieces of a smoothed chain
 * are not blocks of the program, and are needed to brake on; a compiled program passes blocks
 * whether they are known or not.
 */
uint32_t takt_path_look_ahead(const struct path *p, uint32_t blocks);
/* Appends the next move; a motion without length is counted and dropped. Needs room. */
void takt_path_push(struct path *p, const struct move *move);
/* Background: appends pieces of a long motion that had no room before. */
void takt_path_go_on(struct path *p);
/* No more moves will come. Needs room: what waits to be joined to the next one is appended. */
void takt_path_finish(struct path *p);
/* Forgets every block: the axes have come to rest at a point, and what comes next starts there. */
void takt_path_restart(struct path *p, const struct point *at, uint64_t position);
/* Limits of the block with a number kept <= index < pushed. */
static inline const struct path_block *path_at(const struct path *p, uint32_t index)
{
    return ring_at(&p->ring, index);
}
/*
 * Path position of its start, index == pushed: where the next one will start; of its end; and its
 * length, mm.
 */
static inline uint64_t path_start(const struct path *p, uint32_t index)
{
    return index == p->pushed ? p->position : path_at(p, index)->start;
}
static inline uint64_t path_end(const struct path *p, uint32_t index)
{
    return path_start(p, index + 1);
}
double takt_path_length(const struct path *p, uint32_t index);
/* Ceiling 0 or 1. */
static inline struct ceiling *path_ceiling(struct path *p, unsigned which)
{
    return which == 0 ? &p->area.low.ceiling : &p->area.high.ceiling;
}
/*
 * A block of a ceiling. Those before the oldest that is kept may have been overwritten: that one
 * stands for them.
 */
static inline uint32_t path_of_ceiling(const struct ceiling *c, unsigned block)
{
    const uint32_t kept = c->path->kept;
    const uint32_t index = c->first + block;

    return (int32_t)(index - kept) < 0 ? kept : index;
}
/* Control cycle: where on the path the setpoint leaves what piece k < count is made of. */
static inline uint64_t path_ceiling_leave(const struct ceiling *c, uint32_t k)
{
    return path_start(c->path, path_of_ceiling(c, c->piece[k].leave));
}
/* Kind of its move, and its feed per revolution, 0: none. */
enum move_kind takt_path_kind(const struct path *p, uint32_t index);
double takt_path_feed_rev(const struct path *p, uint32_t index);
/* Its move, but for its feed: that is 0. */
void takt_path_read_move(const struct path *p, uint32_t index, struct move *move);
/*
 * Control cycle: the whole block as it is executed, valid until the one two further on or two
 * before is read. Of what its limits are made of only feed_cap_mm_s and cap are filled.
 */
static inline const struct block *path_read(struct path *p, uint32_t index)
{
    return ring_is_read(&p->ring, index) ? &p->ring.view[index % 2].block
                                         : takt_ring_read(&p->ring, index, path_end(p, index));
}
/* Control cycle: a step towards that, of a block that is closed; five make it ready. */
static inline void path_prepare(struct path *p, uint32_t index)
{
    if (!ring_is_read(&p->ring, index)) {
        takt_ring_prepare(&p->ring, index, path_end(p, index));
    }
}
/* Control cycle: likewise the oldest one. */
static inline const struct block *path_first(struct path *p)
{
    return path_read(p, p->first);
}
/* The oldest block has been passed. */
void takt_path_pass(struct path *p);

#endif
