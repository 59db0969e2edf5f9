/*
 * Goal: the highest feed at every joint from which the rest of the window can be stopped, found in time linear in
 * blocks.
 *
 * Backward pass. When a block is pushed, the plan of the blocks before it ended in a stop at the end of the newest. The
 * newest now may be entered at some feed, so the joint before it may be passed, and so on back until a joint's feed
 * does not change: from there on the plan stands. Limits of blocks never fall after they were planned (block.h), so
 * feeds only rise, and what has been taken stays possible.
 *
 * Forward pass. At window_take: the end feed is what the start feed reaches within the block; it is fixed then, and only
 * then.
 */
#include "plan/window.h"

#include "base/maths.h"
#include "plan/diagram.h"
#include "plan/joint.h"

#include <assert.h>
#include <string.h>

void window_init(struct window *w, const struct plan_limits *limits, uint32_t capacity,
                 const struct point *start)
{
    assert(capacity >= 1 && capacity <= WINDOW_BLOCKS_MAX);
    memset(w, 0, sizeof(*w));
    w->limits = *limits;
    w->capacity = capacity;
    w->end = *start;
    w->taken = *start;
    w->phase_s = limits->cycle_s;
}

static struct block *window_at(struct window *w, uint32_t index)
{
    return &w->block[(w->first + index) % WINDOW_BLOCKS_MAX];
}

bool window_has_room(const struct window *w)
{
    return w->count < w->capacity;
}

bool window_is_empty(const struct window *w)
{
    return w->count == 0;
}

bool window_is_ready(const struct window *w)
{
    return w->count == w->capacity || (w->finished && w->count > 0);
}

/* Feed at the start of the block at index, as planned. */
static double planned_start(struct window *w, uint32_t index)
{
    return index == 0 ? w->feed_mm_s : window_at(w, index - 1)->feed_end_mm_s;
}

/* Highest feed at the end of the block at index that its joint and the next block allow. */
static double allowed_end(struct window *w, uint32_t index)
{
    const struct block *b = window_at(w, index);
    const struct block *next = window_at(w, index + 1);
    double feed = maths_min(b->feed_joint_mm_s, maths_min(b->feed_max_mm_s, next->feed_max_mm_s));

    return maths_min(feed, block_start_feed(next));
}

/* From the newest joint back to the first whose feed stays. The two newest have new limits: always done. */
static void plan_backward(struct window *w)
{
    const uint32_t newest = w->count - 1;

    for (uint32_t i = newest; i-- > 0;) {
        struct block *b = window_at(w, i);
        const double feed = b->end == JOINT_STOP ? 0.0 : allowed_end(w, i);

        if (feed == b->feed_end_mm_s && i + 2 < newest) {
            return;
        }
        b->feed_end_mm_s = feed;
    }
}

static void window_close(struct window *w)
{
    if (w->newest_is_motion) {
        joint_stop(window_at(w, w->count - 1));
        plan_backward(w);
    }
    w->newest_is_motion = false;
}

static void push_wait(struct window *w, const struct move *move)
{
    window_close(w);
    block_set_wait(window_at(w, w->count), move);
    window_at(w, w->count)->number = w->motions;
    w->count++;
}

static void push_motion(struct window *w, const struct move *move, const struct curve *curve)
{
    struct block *b = window_at(w, w->count);

    block_set_motion(b, move, curve, &w->limits);
    b->number = w->motions;
    if (w->newest_is_motion) {
        const uint32_t before = w->count - 1;

        joint_form(window_at(w, before), &w->newest, b, curve, planned_start(w, before),
                   &w->limits);
    }
    w->count++;
    w->newest = *curve;
    w->newest_is_motion = true;
    w->end = move->end;
    plan_backward(w);
}

void window_push(struct window *w, const struct move *move)
{
    struct curve curve;

    assert(window_has_room(w) && !w->finished);
    if (!move_is_motion(move)) {
        push_wait(w, move);
        return;
    }
    w->motions++;
    if (move_curve(move, &w->end, &curve)) {
        push_motion(w, move, &curve);
    }
    if (move->kind == MOVE_PROBE || move->kind == MOVE_TAP) {
        window_close(w);
    }
}

void window_finish(struct window *w)
{
    window_close(w);
    w->finished = true;
}

/*
 * An event takes no cycle. But one cycle passes only so many segments (motion.h), so of many events in a row some rest
 * for a cycle.
 */
static void take_wait(struct window *w, const struct block *b, struct segment *segment)
{
    segment->end = JOINT_STOP;
    segment->first_s = w->limits.cycle_s;
    if (b->move.kind == MOVE_DWELL) {
        segment->cycles = diagram_wait(b->move.dwell_s, w->limits.cycle_s);
    }
    if (segment->cycles == 0 && w->instant == WINDOW_INSTANT_MAX && b->move.kind != MOVE_END) {
        segment->cycles = 1;
    }
    w->instant = segment->cycles == 0 ? w->instant + 1 : 0;
}

/* The governor to show: a block that never reaches its ceiling is governed by its ramps. */
static enum governor shown_governor(const struct block *b, const struct diagram *d)
{
    if (d->feed_cruise_mm_s < b->feed_max_mm_s * (1.0 - 1e-9)) {
        return GOVERNOR_RAMP;
    }
    return block_governor(b);
}

static void take_motion(struct window *w, const struct block *b, struct segment *segment)
{
    const double cycle_s = w->limits.cycle_s;
    const double end_mm_s = block_end_feed(b, w->feed_mm_s);
    struct diagram d = diagram_fastest(b, w->feed_mm_s, end_mm_s);
    struct diagram_cycles cycles;

    segment->end = end_mm_s > 0.0 ? b->end : JOINT_STOP;
    segment->governor = shown_governor(b, &d);
    if (segment->end == JOINT_REDUCED && !diagram_land(b, &d, w->phase_s, cycle_s)) {
        segment->end = JOINT_STOP;
    }
    diagram_expand(b, &d, &segment->profile);
    cycles = segment->end == JOINT_PASSED
                 ? diagram_pass(segment->profile.duration_s, w->phase_s, cycle_s)
                 : diagram_rest(segment->profile.duration_s, w->phase_s, cycle_s);
    segment->cycles = cycles.count;
    segment->first_s = cycles.first_s;
    w->phase_s = cycles.next_s;
    w->feed_mm_s = d.feed_end_mm_s;
    move_curve(&b->move, &w->taken, &segment->curve);
    w->taken = b->move.end;
    w->instant = 0; /* a wait comes only after a stop, and a stop has a cycle */
}

void window_take(struct window *w, struct segment *segment)
{
    const struct block *b = window_at(w, 0);

    assert(window_is_ready(w));
    memset(segment, 0, sizeof(*segment));
    segment->move = b->move;
    segment->block = b->number;
    if (move_is_motion(&b->move)) {
        take_motion(w, b, segment);
    } else {
        take_wait(w, b, segment);
    }
    w->first = (w->first + 1) % WINDOW_BLOCKS_MAX;
    w->count--;
    if (w->count == 0) {
        w->newest_is_motion = false;
    }
}
