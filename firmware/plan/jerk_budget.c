/*
 * Goal: wherever three cycles fall, the junctions in them take no more of the jerk limit than each
 * block in them has left to junctions.
 *
 * A junction and a block fall into the same three cycles only if what lies between them is passed
 * in less. So a block leaves the largest jerk_budget_junction (junction.c) of the junctions at its
 * ends and of those that are nearer to it than that, with the blocks between at their highest feed.
 * It is closed, and seen by others, when so much has been pushed behind it that no further junction
 * is near.
 *
 * A walk back has few steps: a block lasts at least an eighth of a cycle (block.c).
 *
 * Rejected: the largest budget for each block beside a short one, whatever its junctions. That
 * needs no walk, but halves the jerk of ramps beside every short block of a straight line.
 */
#include "plan/jerk_budget.h"

#include "base/assert.h"
#include "base/handoff.h"
#include "base/maths.h"
#include "plan/junction.h"
#include "plan/path.h"

#include <string.h>

static struct jerk_budget_block *open_block(struct path *p, uint32_t index)
{
    return &p->open[index % JERK_BUDGET_BLOCKS_MAX];
}

void takt_jerk_budget_note(struct path *p, uint32_t index, const struct block *b)
{
    struct jerk_budget_block *o = open_block(p, index);

    TAKT_ASSERT(index - p->closed < JERK_BUDGET_BLOCKS_MAX);
    o->shape = b->shape;
    o->feed_program_mm_s = b->feed_program_mm_s;
    o->feed_cap_mm_s = b->feed_cap_mm_s;
    o->cap = b->cap;
    o->jerk_budget_junction = b->jerk_budget_junction;
    o->least_s = b->length_mm > 0.0 ? b->length_mm / takt_block_top_feed(b) : 0.0;
    TAKT_ASSERT(o->least_s >= 0.0 && o->jerk_budget_junction >= 0.0 &&
                o->jerk_budget_junction <= BLOCK_JERK_BUDGET_MAX);
    takt_ring_limit(&p->ring, index, b);
    takt_ring_join(&p->ring, index, b);
}

void takt_jerk_budget_begin(struct path *p, uint32_t index, const struct block *b)
{
    open_block(p, index)->jerk_budget_near = 0.0;
    takt_jerk_budget_note(p, index, b);
}

/* The limits of a block with the jerk budget it leaves. */
static void settle(struct path *p, uint32_t index)
{
    const struct jerk_budget_block *o = open_block(p, index);
    struct block b;

    TAKT_ASSERT(o->jerk_budget_near >= 0.0 && o->jerk_budget_near <= BLOCK_JERK_BUDGET_MAX);
    memset(&b, 0, sizeof(b));
    b.shape = o->shape;
    b.feed_program_mm_s = o->feed_program_mm_s;
    b.feed_cap_mm_s = o->feed_cap_mm_s;
    b.cap = o->cap;
    takt_block_set_jerk_budget(&b, o->jerk_budget_near);
    takt_ring_limit(&p->ring, index, &b);
}

/* Closes the blocks before this one. */
static void close_until(struct path *p, uint32_t end)
{
    TAKT_ASSERT((int32_t)(end - p->closed) >= 0 && (int32_t)(p->pushed - end) >= 0);
    while (p->closed != end) {
        settle(p, p->closed);
        handoff_set_count(&p->closed, p->closed + 1U);
    }
}

/* The first block behind whose start the path is not known for so long. */
static uint32_t settled_end(struct path *p, double near_s)
{
    uint32_t i = p->pushed - 1;
    double time_s = open_block(p, i)->least_s;

    TAKT_ASSERT(p->closed != p->pushed);
    while (i != p->closed && time_s < near_s) {
        i--;
        time_s += open_block(p, i)->least_s;
    }
    return i;
}

void takt_jerk_budget_spread(struct path *p)
{
    const double near_s = JUNCTION_CYCLES_NEAR * p->limits.cycle_s;
    const double jerk_budget = open_block(p, p->pushed - 2)->jerk_budget_junction;
    struct jerk_budget_block *newest = open_block(p, p->pushed - 1);
    double time_s = 0.0;

    TAKT_ASSERT(p->pushed - p->closed >= 2);
    if (path_at(p, p->pushed - 2)->end == JUNCTION_STOP) {
        close_until(p, p->pushed - 1);
        return;
    }
    for (uint32_t i = p->pushed - 1; i != p->closed && time_s < near_s; i--) {
        struct jerk_budget_block *o = open_block(p, i - 1);

        o->jerk_budget_near = maths_max(o->jerk_budget_near, jerk_budget);
        newest->jerk_budget_near = maths_max(newest->jerk_budget_near, o->jerk_budget_junction);
        time_s += o->least_s;
    }
    close_until(p, settled_end(p, near_s));
    TAKT_ASSERT(p->pushed - p->closed < JERK_BUDGET_BLOCKS_MAX);
}

void takt_jerk_budget_close(struct path *p)
{
    close_until(p, p->pushed);
}
