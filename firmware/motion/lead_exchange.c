/*
 * A new ceiling for a lead point that is on its way: is it for the span that has been begun, and can everything in it be
 * met from where the lead point will be when it may brake?
 */
#include "motion/lead_private.h"

#include "base/maths.h"

#include <stddef.h>

/* The next joint to land on in this span: not before the lead point, and behind no stop. */
static uint16_t first_landing(const struct lead *l, const struct ceiling *c)
{
    for (uint32_t k = 0; k < c->count; k++) {
        const struct ceiling_piece *p = &c->piece[k];

        if (!lead_is_beyond(l->at, c->origin + (uint64_t)p->leave) && (p->landed || p->stop)) {
            return p->landed ? (uint16_t)k : CEILING_NONE;
        }
    }
    return CEILING_NONE;
}

/* The piece of the lead point, and the lowest ceiling up to it. */
static void find_piece(struct lead *l, uint64_t setpoint)
{
    l->piece = 0;
    l->low_count = 0;
    while (l->piece < l->ceiling->count && lead_has_passed(l, l->piece)) {
        if (!lead_is_beyond(setpoint, lead_leave_of(l, l->piece))) {
            lead_low_push(l, l->piece);
        }
        l->piece++;
    }
    if (l->piece < l->ceiling->count) {
        lead_low_push(l, l->piece);
    }
}

/* A stop that was not known for one when the lead point came to rest at it. */
static bool stands_at_stop(const struct lead *l, const struct ceiling *c)
{
    for (uint32_t k = 0; k < c->count; k++) {
        if (c->piece[k].stop && c->origin + (uint64_t)c->piece[k].leave == l->at) {
            return true;
        }
    }
    return false;
}

uint32_t lead_piece_behind(const struct ceiling *c, uint64_t joint)
{
    for (uint32_t k = 0; k < c->count; k++) {
        if (c->piece[k].landed && c->origin + (uint64_t)c->piece[k].leave == joint) {
            return k + 1;
        }
    }
    return c->count;
}

/* Has the lead point come to rest at a landed joint? */
static bool is_between_spans(const struct lead *l, const struct ceiling *c)
{
    return l->feed == 0.0 && lead_piece_behind(c, l->at) < c->count;
}

/* Was a ceiling made for the window that the lead point's span has? At the end of a landing no matter. */
static bool has_same_window(const struct lead *l, const struct ceiling *c)
{
    for (uint32_t k = 0; k < c->count; k++) {
        if (!lead_is_beyond(l->at, c->origin + (uint64_t)c->piece[k].leave)) {
            return c->piece[k].cycles == l->cycles || l->run.active || l->run.over ||
                   is_between_spans(l, c);
        }
    }
    return true;
}

/*
 * Where the lead point will be when it may brake: at the end of a landing, in the next span, or when its feed has been
 * kept for a window. Position from the ceiling's origin, mm, and feed.
 */
static double brake_position(const struct lead *l, const struct ceiling *c, double *feed)
{
    if (l->run.active || l->run.over) {
        const uint32_t k = lead_piece_behind(c, l->run.joint);
        const uint32_t cycles = k < c->count ? c->piece[k].cycles : 1;

        *feed = l->run.feed_end;
        return path_mm(c->origin, l->run.joint) +
               0.5 * *feed * ((double)law_window_cycles(l->law, cycles) - 1.0);
    }
    *feed = l->feed;
    return path_mm(c->origin, l->at) + l->feed * maths_max(0.0, l->window - l->since_plus);
}

/* Can what is ahead in this ceiling be met, whatever the overrides are? What is new in it may ask for too much. */
static bool can_follow(const struct lead *l, const struct ceiling *c)
{
    const bool lands = l->run.active || l->run.over;
    const double s = path_mm(c->origin, lands ? l->run.joint : l->at);
    double w;
    const double x = brake_position(l, c, &w);
    const double energy = w * w * (1.0 - LEAD_ENERGY_SLACK);

    for (uint32_t k = 0; k < c->count; k++) {
        const struct ceiling_piece *p = &c->piece[k];

        if (p->end_mm >= x) {
            return energy <= p->end_energy_max + 2.0 * p->acceleration * (p->end_mm - x);
        }
        if (p->end_mm > s && energy > p->end_energy_max) {
            return false;
        }
    }
    return w == 0.0;
}

/*
 * Does a block that was not known before ask for less than what the lead point has done already on the way to it? Only
 * a short window shows it so late. No harm when the averages hold nothing but rest.
 */
static bool is_late(const struct lead *l, const struct ceiling *c)
{
    const struct ceiling *old = l->ceiling;
    const bool rests = l->feed == 0.0 && l->since_minus >= l->window;

    if (old == NULL || old->count == 0 || l->piece >= old->count || rests || l->run.active ||
        l->run.over) {
        return false;
    }
    const struct ceiling_piece *had = &old->piece[l->piece];
    const uint64_t known = lead_leave_of(l, old->count - 1);
    const double s = path_mm(c->origin, l->at);

    for (uint32_t k = 0; k < c->count && (k == 0 || c->piece[k - 1].end_mm < s); k++) {
        const struct ceiling_piece *p = &c->piece[k];

        if ((int64_t)(c->origin + (uint64_t)p->leave - known) > 0 &&
            (p->acceleration < had->acceleration || p->feed_max < had->feed_max)) {
            return true;
        }
    }
    return false;
}

/*
 * Can the next joint be landed on when the feed has been kept for a window? A joint that was the end of all that was
 * known may be too near for it by now: the old ceiling then comes to rest there. Above the joint's feed, and before the
 * joint's piece, the ceiling brings the lead point down in time.
 */
static bool can_land(const struct lead *l, const struct ceiling *c)
{
    const uint32_t k = first_landing(l, c);

    if (l->run.active || l->run.over || k + 1 >= c->count || l->feed == 0.0) {
        return true;
    }
    const struct ceiling_piece *joint = &c->piece[k];
    const bool before = k > 0 && path_mm(c->origin, l->at) < c->piece[k - 1].end_mm;
    const double wait = maths_max(0.0, l->window - l->since_plus);
    const struct landing_case landing = {
        .gap_mm = path_mm(l->at, c->origin + (uint64_t)joint->leave) - wait * l->feed,
        .feed = l->feed,
        .feed_max = joint->feed,
        .acceleration = joint->acceleration,
        .window = l->window,
    };
    struct landing_run run;

    return (before && l->feed > joint->feed) || landing_solve(&landing, &run);
}

bool lead_set_ceiling(struct lead *l, const struct ceiling *ceiling, uint64_t setpoint)
{
    const uint64_t joint = l->landing != CEILING_NONE ? lead_leave_of(l, l->landing) : l->at;

    if (!l->standing && stands_at_stop(l, ceiling)) {
        l->standing = true;
        l->released = false;
    }
    if (!l->standing && (!has_same_window(l, ceiling) || is_late(l, ceiling) ||
                         !can_follow(l, ceiling) || !can_land(l, ceiling))) {
        return false;
    }
    l->ceiling = ceiling;
    find_piece(l, setpoint);
    l->landing = first_landing(l, ceiling);
    if (l->landing == CEILING_NONE || lead_leave_of(l, l->landing) != joint) {
        l->landing_feed = 0.0;
    }
    return true;
}
