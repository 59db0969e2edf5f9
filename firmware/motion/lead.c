#include "motion/lead.h"

#include "base/maths.h"
#include "motion/lead_private.h"

#include <string.h>

void takt_lead_init(struct lead *l, enum law law, uint64_t at)
{
    memset(l, 0, sizeof(*l));
    l->law = law;
    l->at = at;
    l->span = at - 1;
    l->known = at;
    l->halt.left = at;
    l->standing = true;
}

void takt_lead_stand(struct lead *l, uint64_t at)
{
    l->at = at;
    l->feed = 0.0;
    l->standing = true;
    l->released = false;
}

void takt_lead_release(struct lead *l)
{
    l->released = !l->abrupt;
    l->abrupt = false;
}

/* -- one cycle -- */

/* The joint that the span ends with keeps the feed that was promised for it. */
static void follow_landing(struct lead *l)
{
    const uint32_t k = lead_landing(l);

    if (k == CEILING_NONE) {
        l->landing_feed = 0.0;
        return;
    }
    l->landing_feed = lead_leave_of(l, k) == l->joint ? l->landing_feed : 0.0;
    l->landing_feed = maths_max(l->landing_feed, lead_feed(l, lead_piece(l, k)->feed_mm_s));
    l->joint = lead_leave_of(l, k);
}

/* Cycles since something: one more, or none. */
static uint32_t since(uint32_t cycles, bool again)
{
    if (again) {
        return 0;
    }
    return cycles < LEAD_LONG_AGO ? cycles + 1 : LEAD_LONG_AGO;
}

static void count_changes(struct lead *l, double change)
{
    l->since_plus = since(l->since_plus, change > 0.0);
    l->since_minus = since(l->since_minus, change < 0.0);
}

/*
 * A way in whole units. What rounding leaves counts in the next cycle: else a slow feed would be another, one below half a unit
 * never get anywhere, and a thousand cycles of braking be a hundred units too late, since each takes what rounding has given, and
 * none can brake harder for what it has taken.
 */
static uint64_t whole_way(struct lead *l, double way_mm)
{
    const double owed_mm = way_mm + l->owed_mm;
    const double whole_mm = path_whole_mm(owed_mm);

    l->owed_mm = owed_mm - whole_mm;
    return path_whole_units(whole_mm);
}

static void go(struct lead *l, double feed)
{
    l->abrupt = l->abrupt && feed == 0.0;
    l->at += whole_way(l, 0.5 * (l->feed + feed));
    count_changes(l, feed - l->feed);
    l->feed = feed;
}

/*
 * Comes to rest in this cycle at a position that is no farther ahead than a cycle's way may be. If it is there already, the last
 * way was longer by what was left of the feed, and speeding up in the very next cycle would add to that.
 */
static void come_to_rest(struct lead *l, uint64_t position)
{
    l->abrupt = l->at == position;
    l->at = position;
    l->owed_mm = 0.0;
    count_changes(l, -1.0);
    l->feed = 0.0;
}

static void run_landing(struct lead *l)
{
    struct landing_run *run = &l->run;
    double feed;

    run->cycle++;
    l->at = run->start + path_units(takt_landing_distance(run, run->cycle, &feed));
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
static void run_on(struct lead *l, uint64_t setpoint, bool hold)
{
    const double low = takt_lead_low_feed(l, setpoint);
    struct lead_brake b;

    takt_lead_brake_ahead(l, low, &b);

    if (hold) {
        b.feed = 0.0;
    }
    if (l->halt.found) {
        takt_lead_brake_to_halt(l, &b);
    } else {
        lead_approach_landing(l, hold, &b);
    }
    if (l->run.active) {
        run_landing(l);
        return;
    }
    const bool stops = b.feed == 0.0 && l->feed > 0.0; /* however little is left of the feed */

    if (b.rest || stops || b.feed < l->feed - lead_change_min(b.a, l->feed)) {
        slow_down(l, &b);
    } else {
        go(l, hold || l->here.late ? l->feed : takt_lead_speed_up(l, b.at_mm, low));
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

/* Enters the span that begins with piece k, from a position on the path that the setpoint is at. */
static void enter_span(struct lead *l, uint32_t k, uint64_t from, struct lead_start *start)
{
    start->step = path_units(l->feed);
    l->standing = false;
    l->span = from;
    l->cycles = takt_ceiling_cycles(l->here.ceiling, k);
    const uint32_t window = takt_law_window_cycles(l->law, l->cycles);

    l->window = (double)window;
    l->at = from + start->step * (window - 1) / 2;
    l->owed_mm = 0.0;
    l->feed = (double)start->step / PATH_UNITS_PER_MM;
    l->since_plus = LEAD_LONG_AGO;
    l->since_minus = LEAD_LONG_AGO;
    l->run.over = false;
    l->abrupt = false;
    start->at = l->at;
    takt_lead_enter_piece(l, k);
}

/*
 * Leaves the stop for the span after it: with the first piece of it, since a short one may lie behind the lead point
 * already and bind the setpoint nevertheless. False: that is not known yet.
 */
static bool leave_stop(struct lead *l, struct lead_start *start)
{
    for (unsigned i = 0; i < LEAD_PIECES_MAX && lead_has_piece(l); i++) {
        if (!lead_is_beyond(l->at, lead_leave_of(l, l->here.piece))) {
            enter_span(l, l->here.piece, l->at, start);
            return true;
        }
        l->here.piece++;
    }
    return false;
}

/* Is the lead point, or the setpoint that follows it, at the joint: landed in motion, or at rest for a whole window? */
static bool is_at_joint(const struct lead *l, uint64_t joint)
{
    return l->run.over ? l->run.joint == joint
                       : l->at == joint && l->feed == 0.0 && lead_has_rested(l);
}

/* Goes over from a landed joint to the span behind it. False: that is not known yet. */
static bool leave_joint(struct lead *l, struct lead_start *start)
{
    const uint32_t k = lead_landing(l);

    if (k == CEILING_NONE || k + 1 >= l->here.ceiling->count ||
        !is_at_joint(l, lead_leave_of(l, k))) {
        return false;
    }
    enter_span(l, k + 1, lead_leave_of(l, k), start);
    return true;
}

static bool has_stopped(const struct lead *l)
{
    return l->feed == 0.0 && lead_has_piece(l) && lead_piece(l, l->here.piece)->stop &&
           lead_is_beyond(l->at, lead_leave_of(l, l->here.piece));
}

/* Between two spans: may the next one be begun in this cycle? */
static bool begin_span(struct lead *l, bool hold, struct lead_start *start)
{
    if (l->standing) {
        return l->released && !hold && leave_stop(l, start);
    }
    return (l->run.over || !(hold || l->halt.found)) && leave_joint(l, start);
}

bool takt_lead_step(struct lead *l, uint64_t setpoint, bool hold, struct lead_start *start)
{
    if (l->here.ceiling == NULL) {
        return false;
    }
    const bool begun = begin_span(l, hold, start);

    if (l->standing) {
        return false;
    }
    const bool too_fast = l->halt.on && takt_lead_seek_halt(l);

    follow_landing(l);
    if (l->run.active) {
        run_landing(l);
    } else if (lead_has_piece(l)) {
        run_on(l, setpoint, hold || too_fast);
    } else {
        wait_for_more(l);
    }
    takt_lead_follow_pieces(l);
    if (has_stopped(l)) {
        l->standing = true;
        l->released = false;
        l->here.piece++;
    }
    return begun;
}
