#include "motion/lead.h"

#include "base/maths.h"
#include "motion/lead_private.h"

#include <string.h>

/* Long ago: more cycles than any window. */
#define LONG_AGO UINT32_C(0x7fffffff)

void lead_init(struct lead *l, enum law law, uint64_t at)
{
    memset(l, 0, sizeof(*l));
    l->law = law;
    l->at = at;
    l->span = at - 1;
    l->standing = true;
    l->released = false;
    l->landing = CEILING_NONE;
}

void lead_release(struct lead *l)
{
    l->released = true;
}

/* Is the lead point past the end of piece k? A span's end is exact, the others are where a ceiling begins. */
bool lead_has_passed(const struct lead *l, uint32_t k)
{
    const struct ceiling_piece *p = lead_piece(l, k);

    return lead_is_last_of_span(p) ? lead_is_beyond(l->at, lead_leave_of(l, k))
                                   : path_mm(l->ceiling->origin, l->at) >= p->end_mm;
}

/* -- the lowest ceiling from the setpoint to the lead point -- */

static uint16_t *low_at(struct lead *l, uint32_t i)
{
    return &l->low[(l->low_first + i) % CEILING_PIECES_MAX];
}

void lead_low_push(struct lead *l, uint32_t k)
{
    while (l->low_count > 0 &&
           lead_piece(l, *low_at(l, l->low_count - 1))->feed >= lead_piece(l, k)->feed) {
        l->low_count--;
    }
    *low_at(l, l->low_count) = (uint16_t)k;
    l->low_count++;
}

/* Forgets ceilings that the setpoint has left. */
static void low_drop(struct lead *l, uint64_t setpoint)
{
    while (l->low_count > 0 && lead_is_beyond(setpoint, lead_leave_of(l, *low_at(l, 0)))) {
        l->low_first = (l->low_first + 1) % CEILING_PIECES_MAX;
        l->low_count--;
    }
}

static double low_feed(struct lead *l)
{
    return l->low_count > 0 ? lead_piece(l, *low_at(l, 0))->feed : 0.0;
}

/* -- one cycle -- */

/* Goes on to the next joint when one has been passed. */
static void follow_landing(struct lead *l)
{
    while (l->landing != CEILING_NONE && lead_is_beyond(l->at, lead_leave_of(l, l->landing))) {
        l->landing = l->landing + 1U < l->ceiling->count ? lead_piece(l, l->landing + 1U)->landing
                                                         : CEILING_NONE;
        l->landing_feed = 0.0;
    }
    if (l->landing != CEILING_NONE) {
        const struct ceiling_piece *joint = lead_piece(l, l->landing);

        l->landing_feed = maths_min(maths_max(l->landing_feed, joint->feed), joint->feed_max);
    }
}

static void count_changes(struct lead *l, double change)
{
    l->since_plus = change > 0.0 ? 0 : l->since_plus < LONG_AGO ? l->since_plus + 1 : LONG_AGO;
    l->since_minus = change < 0.0 ? 0 : l->since_minus < LONG_AGO ? l->since_minus + 1 : LONG_AGO;
}

static void go(struct lead *l, double feed)
{
    l->at += path_units(0.5 * (l->feed + feed));
    count_changes(l, feed - l->feed);
    l->feed = feed;
}

/* Comes to rest in this cycle at a position that is less than half a cycle's way ahead. */
static void come_to_rest(struct lead *l, uint64_t position)
{
    l->at = position;
    count_changes(l, -1.0);
    l->feed = 0.0;
}

static void run_landing(struct lead *l)
{
    struct landing_run *run = &l->run;
    double feed;

    run->cycle++;
    l->at = run->start + path_units(landing_distance(run, run->cycle, &feed));
    count_changes(l, run->cycle <= run->ramp ? -1.0 : 0.0);
    l->feed = feed;
    run->active = run->cycle < run->total;
    run->over = !run->active;
}

static void slow_down(struct lead *l, const struct lead_brake *b)
{
    if (b->rest) {
        come_to_rest(l, b->rest_at);
    } else if (l->since_plus >= l->window) {
        go(l, maths_max(b->feed, l->feed - b->a));
    } else {
        go(l, l->feed);
    }
}

/* One cycle under the ceiling. */
static void run_on(struct lead *l, bool hold)
{
    struct lead_brake b = lead_brake_ahead(l);

    if (hold) {
        b.feed = 0.0;
    }
    lead_approach_landing(l, hold, &b);
    if (l->run.active) {
        run_landing(l);
        return;
    }
    if (b.rest || b.feed < l->feed - LEAD_CHANGE_MIN * b.a) {
        slow_down(l, &b);
    } else {
        go(l, hold ? l->feed : lead_speed_up(l, low_feed(l)));
    }
}

/* At the end of all that is known. What is left of the feed is rounding. */
static void wait_for_more(struct lead *l)
{
    if (l->feed > 0.0) {
        come_to_rest(l, l->at);
    } else {
        count_changes(l, 0.0);
    }
}

/* Moves on to the piece of the lead point. */
static void follow_pieces(struct lead *l)
{
    while (l->piece < l->ceiling->count && !lead_is_last_of_span(lead_piece(l, l->piece)) &&
           lead_has_passed(l, l->piece)) {
        l->piece++;
        if (l->piece < l->ceiling->count) {
            lead_low_push(l, l->piece);
        }
    }
}

/* Enters the span that begins with piece k, from a position on the path that the setpoint is at. */
static void enter_span(struct lead *l, uint32_t k, uint64_t from, struct lead_start *start)
{
    start->step = path_units(l->feed);
    l->standing = false;
    l->span = from;
    l->piece = k;
    l->cycles = lead_piece(l, k)->cycles;
    l->window = (double)law_window_cycles(l->law, l->cycles);
    l->at = from + start->step * (law_window_cycles(l->law, l->cycles) - 1) / 2;
    l->feed = (double)start->step / PATH_UNITS_PER_MM;
    l->since_plus = LONG_AGO;
    l->since_minus = LONG_AGO;
    l->low_count = 0;
    lead_low_push(l, k);
    l->landing = lead_piece(l, k)->landing;
    l->landing_feed = 0.0;
    l->run.over = false;
    start->at = l->at;
    follow_pieces(l);
}

/*
 * Leaves the stop for the span after it: with the first piece of it, since a short one may lie behind the lead point
 * already and bind the setpoint nevertheless. False: that is not known yet.
 */
static bool leave_stop(struct lead *l, struct lead_start *start)
{
    uint32_t next = 0;

    while (next < l->ceiling->count && lead_is_beyond(l->at, lead_leave_of(l, next))) {
        next++;
    }
    if (next == l->ceiling->count) {
        return false;
    }
    enter_span(l, next, l->at, start);
    return true;
}

/* Goes over from a landed joint to the span behind it. False: it is at none, or has not rested at it long enough. */
static bool leave_joint(struct lead *l, struct lead_start *start)
{
    if (!l->run.over && (l->feed != 0.0 || l->since_minus < l->window)) {
        return false;
    }
    const uint64_t joint = l->run.over ? l->run.joint : l->at;
    const uint32_t k = lead_piece_behind(l->ceiling, joint);

    if (k >= l->ceiling->count) {
        return false;
    }
    enter_span(l, k, joint, start);
    return true;
}

static bool has_stopped(const struct lead *l)
{
    return l->feed == 0.0 && l->piece < l->ceiling->count && lead_piece(l, l->piece)->stop &&
           lead_has_passed(l, l->piece);
}

/* Between two spans: may the next one be begun in this cycle? */
static bool begin_span(struct lead *l, bool hold, struct lead_start *start)
{
    if (l->standing) {
        return l->released && !hold && leave_stop(l, start);
    }
    return (l->run.over || !hold) && leave_joint(l, start);
}

bool lead_step(struct lead *l, uint64_t setpoint, bool hold, struct lead_start *start)
{
    if (l->ceiling == NULL) {
        return false;
    }
    const bool begun = begin_span(l, hold, start);

    if (l->standing) {
        return false;
    }
    low_drop(l, setpoint);
    follow_landing(l);
    if (l->run.active) {
        run_landing(l);
    } else if (l->piece < l->ceiling->count) {
        run_on(l, hold);
    } else {
        wait_for_more(l);
    }
    follow_pieces(l);
    if (has_stopped(l)) {
        l->standing = true;
        l->released = false;
    }
    return begun;
}
