/*
 * What leads is whatever steps most often just here: the arc, max(|a|, |b|) steps a radian, or the straight axis with the
 * largest increment. It steps at every tick; everything else follows the place it has come to. That place is an angle,
 * not the leading coordinate of the arc: in proportion to the latter a straight axis would be off by 4.2 % of its travel
 * in an octant.
 *
 * The plain form makes the same steps one after another; without a straight axis it is the plain arc.
 */
#include "step/evaluate_helix.h"

#include "base/maths.h"

#include <string.h>

/* How the distance of two ticks differs from the even one: see set_due. */
#define PACE_GAIN       0.1
#define PACE_ROOM       0.005
#define PACE_ROOM_HELIX 0.5

/* Steps by which the leading straight axis may be behind the arc's point, or that behind it, along the arc. */
#define BEHIND_MAX 0.8

static void set_straight(struct evaluate_helix *h, const int64_t delta[AXIS_COUNT])
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (i == h->plane[0] || i == h->plane[1]) {
            continue;
        }
        h->size[i] = evaluate_size(delta[i]);
        h->direction |= (uint8_t)(delta[i] < 0 ? 1U << i : 0U);
        if (h->size[i] > h->size[h->leading]) {
            h->leading = i;
        }
    }
}

/* Part of the way done by the arc, as far as its own point tells. */
static double arc_progress(const struct evaluate_helix *h)
{
    if (h->arc_done || h->arc.sweep_rad <= 0.0) {
        return 1.0;
    }
    return maths_clamp(evaluate_arc_angle(&h->arc) / h->arc.sweep_rad, 0.0, 1.0);
}

/* Part of the way that one step of the arc makes here; that of the leading straight axis. */
static double arc_spacing(const struct evaluate_helix *h)
{
    return 1.0 / (evaluate_arc_rate(&h->arc) * h->arc.radius * h->arc.sweep_rad);
}

static double straight_spacing(const struct evaluate_helix *h)
{
    return 1.0 / (double)h->size[h->leading];
}

/*
 * Which of both has the smaller step here? Where they are nearly equal, either can fall behind the other, because the arc
 * makes 0.7 to 1.4 steps of its way at a tick: then the one that is behind goes on alone.
 */
static bool arc_leads(const struct evaluate_helix *h)
{
    const unsigned i = h->leading;

    if (h->arc_done || h->done[i] == h->size[i]) {
        return !h->arc_done;
    }
    const double ahead = arc_progress(h) - (double)h->done[i] * straight_spacing(h);

    if (ahead * (double)h->size[i] > BEHIND_MAX) {
        return false;
    }
    if (-ahead * h->arc.sweep_rad * h->arc.radius > BEHIND_MAX) {
        return true;
    }
    return arc_spacing(h) <= straight_spacing(h);
}

static void step_arc(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    struct evaluate_tick arc;

    (void)evaluate_arc_next(&h->arc, &arc);
    h->arc_done = h->arc.straight && h->arc.rest.left == 0;
    for (unsigned i = 0; i < 2; i++) {
        const unsigned axis = 1U << h->plane[i];

        tick->axes |= (uint8_t)(evaluate_has(arc.axes, i) ? axis : 0U);
        tick->direction |= (uint8_t)(evaluate_has(arc.direction, i) ? axis : 0U);
    }
}

static void step_straight(struct evaluate_helix *h, unsigned axis, struct evaluate_tick *tick)
{
    h->done[axis]++;
    tick->axes |= (uint8_t)(1U << axis);
    tick->direction |= (uint8_t)(h->direction & 1U << axis);
}

/* Straight axes that are more than half a step behind the place step; the last tick brings all to their end. */
static void follow(struct evaluate_helix *h, double progress, struct evaluate_tick *tick)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const bool stepped = evaluate_has(tick->axes, i);

        if (!stepped && h->done[i] < h->size[i] &&
            (double)h->size[i] * progress - (double)h->done[i] > 0.5) {
            step_straight(h, i, tick);
        }
    }
}

/*
 * Halfway to the next step of what leads. A lattice point is up to a step before or behind its place on the arc, and ticks
 * that went after it would come in bursts. So the distance from one tick to the next is the even one, and goes after the
 * lattice by a part of what it is off, PACE_GAIN, at most by PACE_ROOM of itself. Where arc and straight axes take turns
 * at leading there are more ticks than either has steps: there the room is wider.
 */
static void set_due(struct evaluate_helix *h)
{
    const bool arc = arc_leads(h);
    const double spacing = arc ? arc_spacing(h) : straight_spacing(h);
    const double at = arc ? arc_progress(h) : (double)h->done[h->leading] * spacing;
    const double off = at - 0.5 * spacing - h->group_due;
    const double room = (h->size[h->leading] > 0 ? PACE_ROOM_HELIX : PACE_ROOM) * spacing;

    if (at >= 1.0) {
        h->group_due = 1.0;
        return;
    }
    h->group_due += spacing + maths_clamp(PACE_GAIN * off, -room, room);
    h->group_due = maths_min(h->group_due, 1.0);
}

void evaluate_helix_begin(struct evaluate_helix *h, const struct evaluate_arc_config *arc,
                          const unsigned plane[2], const int64_t delta[AXIS_COUNT])
{
    struct evaluate_arc_config inside = *arc;

    memset(h, 0, sizeof(*h));
    h->form = arc->form;
    h->plane[0] = plane[0];
    h->plane[1] = plane[1];
    set_straight(h, delta);
    if (h->size[h->leading] > 0) {
        inside.form = EVALUATE_IMPROVED;
    }
    evaluate_arc_begin(&h->arc, &inside);
    h->arc_done = h->arc.straight && h->arc.rest.left == 0;
    h->group_due = arc_leads(h) ? -0.5 * arc_spacing(h) : 0.0;
    set_due(h);
    h->due = h->group_due;
}

static double count_axes(unsigned mask)
{
    double count = 0.0;

    for (; mask != 0U; mask &= mask - 1U) {
        count += 1.0;
    }
    return count;
}

/* Plain form: the lowest axis of a group now, the others at the next ticks, evenly until the next group is due. */
static void take_one(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    const uint8_t lowest = (uint8_t)(h->queued.axes & (0U - h->queued.axes));

    tick->axes = lowest;
    tick->direction = h->queued.direction & lowest;
    h->queued.axes = (uint8_t)(h->queued.axes & ~lowest);
    h->due = h->queued.axes != 0U ? h->due + h->gap : h->group_due;
}

static bool next_together(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    double progress;

    *tick = (struct evaluate_tick){0};
    if (arc_leads(h)) {
        step_arc(h, tick);
        progress = arc_progress(h);
    } else if (h->done[h->leading] < h->size[h->leading]) {
        step_straight(h, h->leading, tick);
        progress = (double)h->done[h->leading] * straight_spacing(h);
        if (!h->arc_done && arc_progress(h) + 0.5 * arc_spacing(h) <= progress) {
            step_arc(h, tick);
        }
    } else {
        return false;
    }
    follow(h, progress, tick);
    set_due(h);
    return true;
}

static bool next_plain(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    if (h->queued.axes == 0U) {
        if (!next_together(h, &h->queued)) {
            *tick = (struct evaluate_tick){0};
            return false;
        }
        h->gap = (h->group_due - h->due) / count_axes(h->queued.axes);
    }
    take_one(h, tick);
    return true;
}

bool evaluate_helix_next(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    if (h->form == EVALUATE_PLAIN) {
        return next_plain(h, tick);
    }
    const bool any = next_together(h, tick);

    h->due = h->group_due;
    return any;
}

double evaluate_helix_due(const struct evaluate_helix *h)
{
    return h->due;
}
