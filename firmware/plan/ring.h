/*
 * The blocks of the path, as small as they can be: for each one the limits that ceilings are made
 * of, and a record of its move and curve (record.h) in a ring of bytes.
 *
 * The background writes blocks, and reads their limits; the control cycle reads all of them.
 */
#ifndef TAKT_PLAN_RING_H
#define TAKT_PLAN_RING_H

#include "plan/block.h"
#include "plan/record.h"
#include "plan/scale.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Blocks in the ring: the look-ahead of 256, those between the setpoint and the trapezoidal
 * reference that runs ahead of it (firmware/motion), both ends included, and RECORD_BEFORE that
 * have been passed.
 */
#define PATH_BLOCKS_MAX 320

/* Bytes of all records: 32 of a line of three axes or a piece of a smoothed curve, 48 of an arc. */
#define PATH_BYTES_MAX 11264

/* Records begin at multiples of this. */
#define PATH_BYTES_STEP 4

/*
 * Different modes that may be in the ring at once: one for each block that is not closed, at least
 * (path.h).
 */
#define PATH_MODES_MAX 28

/*
 * Limits of a block, of single precision and never above the exact ones. All of them are the
 * background's: the cycle reads them only.
 */
struct path_block {
    uint64_t start;          /* path position, path units (path_unit.h) */
    float feed_program_mm_s; /* as programmed; infinite for a rapid */
    float feed_limit_mm_s;   /* never exceeded, whatever is programmed and the override */
    float a_mm_s2; /* along the path, what curvature and jerk budget leave at the highest feed */
    float j_mm_s3;
    float feed_junction_mm_s; /* highest feed at which the junction at the end may be passed */
    unsigned record : 12;     /* where it is, in PATH_BYTES_STEP */
    unsigned
        cycles : 9; /* averaging window of the span that begins here, as planned last; 0: not yet */
    unsigned cycles_known : 1; /* found with all of the span known */
    unsigned end : 2;          /* enum junction_kind */
    unsigned motion : 1;       /* else a wait, the axes stand */
    unsigned rapid : 1;
    unsigned continues : 1;      /* another piece of the same move follows */
    unsigned rotary : 1;         /* no linear axis moves: programmed feeds count rad */
    unsigned may_feed : 1;       /* obeys the feed override */
    unsigned may_hold : 1;       /* and the operator's hold */
    unsigned per_revolution : 1; /* the feed follows the spindle */
    unsigned smooth : 1;         /* a piece of a smoothed curve */
};

/*
 * How much of a block has been read: nothing, its head, all numbers, half of an arc's curve, the
 * whole curve, all.
 */
enum view_state { VIEW_EMPTY, VIEW_BEGUN, VIEW_TAKEN, VIEW_CURVED, VIEW_FINISHED, VIEW_READ };

/* A block as it is executed. */
struct path_view {
    enum view_state state;
    uint32_t index;
    const uint8_t *from; /* what of its record has not been read yet */
    struct block block;
};

struct path_ring {
    struct path_block block[PATH_BLOCKS_MAX];
    struct record_modes modes[PATH_MODES_MAX];
    uint32_t modes_used[PATH_MODES_MAX]; /* the newest block of these modes, plus 1; 0: none yet */
    unsigned modes_newest;
    struct record_chain chain;
    struct scale scale; /* of the machine */
    uint32_t place;     /* of the next record, in bytes */
    uint8_t byte[PATH_BYTES_MAX];
    struct path_view
        view[2]; /* of blocks of even and of odd numbers: the oldest and the one behind it */
};

/*
 * Room for one more block, whose record has size bytes at most? Blocks kept <= index < pushed are
 * kept.
 */
bool takt_ring_has_room(const struct path_ring *r, uint32_t kept, uint32_t pushed, uint32_t size);

/*
 * Writes block b, the one of number pushed. Needs room. control: of a piece of a smoothed curve,
 * else NULL.
 */
void takt_ring_push(struct path_ring *r, uint32_t kept, uint32_t pushed, const struct block *b,
                    const struct point control[4]);

/* Notes limits of a block: of feed, acceleration and jerk; and of its end. */
void takt_ring_limit(struct path_ring *r, uint32_t index, const struct block *b);
void takt_ring_join(struct path_ring *r, uint32_t index, const struct block *b);

/* The window of the span that begins with a block; known: found with all of it known. */
void takt_ring_promise(struct path_ring *r, uint32_t index, uint32_t cycles, bool known);

static inline const struct path_block *ring_at(const struct path_ring *r, uint32_t index)
{
    return &r->block[index % PATH_BLOCKS_MAX];
}

static inline const uint8_t *ring_record(const struct path_ring *r, uint32_t index)
{
    return &r->byte[(size_t)ring_at(r, index)->record * PATH_BYTES_STEP];
}

/* The move of a block, but for its feed: that is 0. */
void takt_ring_read_move(const struct path_ring *r, uint32_t index, struct move *move);

/* Is a block ready to be executed? */
static inline bool ring_is_read(const struct path_ring *r, uint32_t index)
{
    const struct path_view *view = &r->view[index % 2];

    return view->state == VIEW_READ && view->index == index;
}

/*
 * Makes it so: limits, move and curve. Control cycle alone. end: its end on the path, path units.
 */
const struct block *takt_ring_read(struct path_ring *r, uint32_t index, uint64_t end);
/* The next part of that, for a cycle that has no time for all: five at most. */
void takt_ring_prepare(struct path_ring *r, uint32_t index, uint64_t end);

/* The control points of a block that is a piece of a smoothed curve. */
void takt_ring_control(const struct path_ring *r, uint32_t index, struct point control[4]);

/* The highest feed whatever the override, mm/s. */
double takt_path_block_top(const struct path_block *b);

#endif
