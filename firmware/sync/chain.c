#include "sync/chain.h"

#include "base/assert.h"

/* Blocks taken in at once. */
#define EXTEND_MAX 16

/* A block that can do less than the first one by no more than this part belongs to the chain. */
#define LIMIT_PART 0.9999

#define VELOCITY_PART 0.999

/* With some velocity to catch up with. */
static struct brake_limits limits_of(const struct path_block *b)
{
    return (struct brake_limits){VELOCITY_PART * (double)b->feed_limit_mm_s, (double)b->a_mm_s2,
                                 (double)b->j_mm_s3};
}

void takt_chain_begin(struct chain *c, struct path *path)
{
    TAKT_ASSERT(path->first != path->closed);
    *c = (struct chain){
        .path = path, .last = path->first, .end_mm = takt_path_length(path, path->first)};
    c->limits = limits_of(path_at(path, path->first));
}

/* May the newest block be left for the next one without a stop? */
static bool goes_on(const struct chain *c)
{
    const struct path_block *b = path_at(c->path, c->last);
    const struct path_block *next = path_at(c->path, c->last + 1);

    if (takt_path_kind(c->path, c->last) != MOVE_THREAD || b->end != JUNCTION_PASSED ||
        c->last + 1 == c->path->closed) {
        return false;
    }
    const struct brake_limits limits = limits_of(next);

    return (double)b->feed_junction_mm_s >= LIMIT_PART * c->limits.velocity_mm_s &&
           limits.velocity_mm_s >= LIMIT_PART * c->limits.velocity_mm_s &&
           limits.acceleration_mm_s2 >= LIMIT_PART * c->limits.acceleration_mm_s2 &&
           limits.jerk_mm_s3 >= LIMIT_PART * c->limits.jerk_mm_s3;
}

void takt_chain_extend(struct chain *c)
{
    for (unsigned i = 0; i < EXTEND_MAX && goes_on(c); i++) {
        c->last++;
        c->end_mm += takt_path_length(c->path, c->last);
    }
}

struct chain_leg takt_chain_first_leg(const struct chain *c, double zero_rev)
{
    const uint32_t first = c->path->first;

    return (struct chain_leg){.block = first,
                              .end_mm = takt_path_length(c->path, first),
                              .pitch_mm = takt_path_feed_rev(c->path, first),
                              .zero_rev = zero_rev};
}

bool takt_chain_next_leg(const struct chain *c, struct chain_leg *leg)
{
    if (leg->block == c->last) {
        return false;
    }
    TAKT_ASSERT(leg->pitch_mm != 0.0);
    leg->zero_rev += (leg->end_mm - leg->start_mm) / leg->pitch_mm;
    leg->block++;
    leg->start_mm = leg->end_mm;
    leg->end_mm += takt_path_length(c->path, leg->block);
    TAKT_ASSERT(leg->end_mm > leg->start_mm);
    leg->pitch_mm = takt_path_feed_rev(c->path, leg->block);
    return true;
}
