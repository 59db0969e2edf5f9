/*
 * Improved: what leads is whatever steps most often just here, the arc, max(|a|, |b|) steps a
 * radian, or the straight axis with the largest increment. It steps at every tick; everything else
 * follows the place it has come to. That place is an angle, not the leading coordinate of the arc:
 * in proportion to the latter a straight axis would be off by 4.2 % of its travel in an octant.
 *
 * Plain: as the plain line, with the plain arc as one of the axes. What has the longer way leads,
 * the arc with R sweep steps or the straight axis. One axis steps at a tick: whichever is behind
 * the place of what leads, else that one. So the point keeps to its circle as the plain arc does,
 * and nothing gets farther than a step from its place.
 */
#include "step/evaluate_helix.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* How the distance of two ticks differs from the even one: see set_due. */
#define PACE_GAIN       0.1
#define PACE_ROOM       0.005
#define PACE_ROOM_HELIX 0.5

/*
 * Steps by which the leading straight axis may be behind the arc's point, or that behind it, along
 * the arc.
 */
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
    return maths_clamp(takt_evaluate_arc_angle(&h->arc) / h->arc.sweep_rad, 0.0, 1.0);
}

/* Steps of the arc on the whole way, if it made them as often as here. */
static double arc_steps(const struct evaluate_helix *h)
{
    return takt_evaluate_arc_rate(&h->arc) * h->arc.radius * h->arc.sweep_rad;
}

/* Part of the way that one step of the arc makes here; that of the leading straight axis. */
static double arc_spacing(const struct evaluate_helix *h)
{
    TAKT_ASSERT(h->arc.radius > 0.0 && h->arc.sweep_rad > 0.0);
    return 1.0 / arc_steps(h);
}

static double straight_spacing(const struct evaluate_helix *h)
{
    return 1.0 / (double)h->size[h->leading];
}

/*
 * Which of both has the smaller step here? Where they are nearly equal, either can fall behind the
 * other, because the arc makes 0.7 to 1.4 steps of its way at a tick: then the one that is behind
 * goes on alone.
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

    (void)takt_evaluate_arc_next(&h->arc, &arc);
    h->arc_done = h->arc.straight && h->arc.rest.left == 0;
    for (unsigned i = 0; i < 2; i++) {
        const unsigned axis = 1U << h->plane[i];

        tick->axes |= (uint8_t)(evaluate_has(arc.axes, i) ? axis : 0U);
        tick->direction |= (uint8_t)(evaluate_has(arc.direction, i) ? axis : 0U);
    }
}

static void step_straight(struct evaluate_helix *h, unsigned axis, struct evaluate_tick *tick)
{
    TAKT_ASSERT(axis < AXIS_COUNT && h->done[axis] < h->size[axis]);
    h->done[axis]++;
    tick->axes |= (uint8_t)(1U << axis);
    tick->direction |= (uint8_t)(h->direction & 1U << axis);
}

/*
 * Straight axes that are more than half a step behind the place step; the last tick brings all to
 * their end.
 */
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
 * Halfway to the next tick: at is the place that has been reached, spacing its part of the way. A
 * lattice point is up to a step before or behind its place on the arc, and ticks that went after it
 * would come in bursts. So the distance from one tick to the next is the even one, and goes after
 * the lattice by a part of what it is off, PACE_GAIN, at most by PACE_ROOM of itself. Where arc and
 * straight axes take turns there are more ticks than either has steps: there the room is wider.
 */
static void pace(struct evaluate_helix *h, double at, double spacing)
{
    const double off = at - 0.5 * spacing - h->due;
    const double room = (h->size[h->leading] > 0 ? PACE_ROOM_HELIX : PACE_ROOM) * spacing;

    if (at >= 1.0) {
        h->due = 1.0;
        return;
    }
    h->due += spacing + maths_clamp(PACE_GAIN * off, -room, room);
    h->due = maths_min(h->due, 1.0);
}

static void pace_improved(struct evaluate_helix *h)
{
    const bool arc = arc_leads(h);
    const double spacing = arc ? arc_spacing(h) : straight_spacing(h);

    pace(h, arc ? arc_progress(h) : (double)h->done[h->leading] * spacing, spacing);
}

/* Every step of any axis is a tick: the place is the part of all of them that has been made. */
static void pace_plain(struct evaluate_helix *h)
{
    double all = arc_steps(h);
    double made = arc_progress(h) * all;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        all += (double)h->size[i];
        made += (double)h->done[i];
    }
    pace(h, all > 0.0 ? made / all : 1.0, 1.0 / all);
}

static void set_due(struct evaluate_helix *h)
{
    if (h->form == EVALUATE_PLAIN) {
        pace_plain(h);
    } else {
        pace_improved(h);
    }
}

void takt_evaluate_helix_begin(struct evaluate_helix *h, const struct evaluate_arc_config *arc,
                               const unsigned plane[2], const int64_t delta[AXIS_COUNT])
{
    TAKT_ASSERT(plane[0] < AXIS_COUNT && plane[1] < AXIS_COUNT && plane[0] != plane[1]);
    memset(h, 0, sizeof(*h));
    h->form = arc->form;
    h->plane[0] = plane[0];
    h->plane[1] = plane[1];
    set_straight(h, delta);
    takt_evaluate_arc_begin(&h->arc, arc);
    h->arc_done = h->arc.straight && h->arc.rest.left == 0;
    h->due = arc_leads(h) ? -0.5 * arc_spacing(h) : 0.0;
    set_due(h);
}

static bool next_improved(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    double progress;

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
    return true;
}

/* The leader of the plain form: the place it has come to, and its steps on the whole way. */
struct leader {
    unsigned axis; /* AXIS_COUNT: the arc */
    double place;
    double steps;
};

static struct leader find_leader(const struct evaluate_helix *h)
{
    const unsigned i = h->leading;
    const double arc = h->arc.radius * h->arc.sweep_rad;

    if (arc >= (double)h->size[i]) {
        return (struct leader){AXIS_COUNT, arc_progress(h), arc};
    }
    return (struct leader){i, (double)h->done[i] / (double)h->size[i], (double)h->size[i]};
}

/*
 * With r steps for one of the leader's, and a step taken as soon as the lag is above t, the lag
 * stays above t - 1 and at most t + r: evenly on both sides, (1 + r) / 2 <= 1, with
 * t = (1 - r) / 2.
 */
static bool is_behind(double lag, double steps, const struct leader *leader)
{
    return lag > 0.5 * (1.0 - steps / leader->steps);
}

/* A straight axis that is behind the leader; AXIS_COUNT: none is. */
static unsigned straight_behind(const struct evaluate_helix *h, const struct leader *leader)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double size = (double)h->size[i];

        if (i != leader->axis && h->done[i] < h->size[i] &&
            is_behind(size * leader->place - (double)h->done[i], size, leader)) {
            return i;
        }
    }
    return AXIS_COUNT;
}

/* At the end of the leader's way the arc makes the rest of its own. */
static bool arc_is_behind(const struct evaluate_helix *h, const struct leader *leader)
{
    const double steps = h->arc.radius * h->arc.sweep_rad;
    const double lag = (leader->place - arc_progress(h)) * steps;

    return !h->arc_done && (is_behind(lag, steps, leader) || leader->place >= 1.0);
}

static bool next_plain(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    const struct leader leader = find_leader(h);
    const bool arc = leader.axis == AXIS_COUNT;
    const unsigned behind = straight_behind(h, &leader);

    if (behind < AXIS_COUNT) {
        step_straight(h, behind, tick);
    } else if (arc ? !h->arc_done : arc_is_behind(h, &leader)) {
        step_arc(h, tick);
    } else if (!arc && h->done[leader.axis] < h->size[leader.axis]) {
        step_straight(h, leader.axis, tick);
    } else {
        return false;
    }
    return true;
}

bool takt_evaluate_helix_next(struct evaluate_helix *h, struct evaluate_tick *tick)
{
    *tick = (struct evaluate_tick){0};
    if (!(h->form == EVALUATE_PLAIN ? next_plain(h, tick) : next_improved(h, tick))) {
        return false;
    }
    set_due(h);
    return true;
}

double takt_evaluate_helix_due(const struct evaluate_helix *h)
{
    return h->due;
}
