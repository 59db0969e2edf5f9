#include "sync/chain.h"

/* Blocks taken in at once. */
#define EXTEND_MAX 16

/* A block that can do less than the first one by no more than this part belongs to the chain. */
#define LIMIT_PART 0.9999

#define VELOCITY_PART 0.999

static double joint_feed(const struct block *b)
{
    return b->feed_joint_mm_s;
}

/* With some velocity to catch up with. */
static struct brake_limits limits_of(const struct block *b)
{
    return (struct brake_limits){VELOCITY_PART * b->feed_cap_mm_s, b->a_mm_s2, b->j_mm_s3};
}

void chain_begin(struct chain *c, const struct path *path)
{
    const struct block *b = path_at(path, path->first);

    *c = (struct chain){.path = path, .last = path->first, .end_mm = b->length_mm};
    c->limits = limits_of(b);
}

/* May the newest block be left for the next one without a stop? */
static bool goes_on(const struct chain *c)
{
    const struct block *b = path_at(c->path, c->last);
    const struct block *next = path_at(c->path, c->last + 1);

    if (b->move.kind != MOVE_THREAD || b->end != JOINT_PASSED || c->last + 1 == c->path->closed) {
        return false;
    }
    const struct brake_limits limits = limits_of(next);

    return joint_feed(b) >= LIMIT_PART * c->limits.velocity_mm_s &&
           limits.velocity_mm_s >= LIMIT_PART * c->limits.velocity_mm_s &&
           limits.acceleration_mm_s2 >= LIMIT_PART * c->limits.acceleration_mm_s2 &&
           limits.jerk_mm_s3 >= LIMIT_PART * c->limits.jerk_mm_s3;
}

void chain_extend(struct chain *c)
{
    for (unsigned i = 0; i < EXTEND_MAX && goes_on(c); i++) {
        c->last++;
        c->end_mm += path_at(c->path, c->last)->length_mm;
    }
}

struct chain_leg chain_first_leg(const struct chain *c, double zero_rev)
{
    const struct block *b = path_at(c->path, c->path->first);

    return (struct chain_leg){.block = c->path->first,
                              .end_mm = b->length_mm,
                              .pitch_mm = b->move.feed_rev_mm,
                              .zero_rev = zero_rev};
}

bool chain_next_leg(const struct chain *c, struct chain_leg *leg)
{
    if (leg->block == c->last) {
        return false;
    }
    leg->zero_rev += (leg->end_mm - leg->start_mm) / leg->pitch_mm;
    leg->block++;
    const struct block *b = path_at(c->path, leg->block);

    leg->start_mm = leg->end_mm;
    leg->end_mm += b->length_mm;
    leg->pitch_mm = b->move.feed_rev_mm;
    return true;
}
