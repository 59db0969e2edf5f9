#include "motion/reference.h"

#include "base/assert.h"
#include "base/maths.h"
#include "motion/reference_private.h"

#include <string.h>

void takt_reference_init(struct reference *l, enum ramp_profile profile, uint64_t at)
{
    memset(l, 0, sizeof(*l));
    l->profile = profile;
    l->at = at;
    l->span = at - 1;
    l->known = at;
    l->halt.left = at;
    takt_reference_end_blocks(l, false);
    l->phase = REFERENCE_STANDS;
}

void takt_reference_stand(struct reference *l, uint64_t at)
{
    TAKT_ASSERT(l->run.phase != LANDING_ACTIVE);
    l->at = at;
    l->feed = 0.0;
    l->phase = REFERENCE_STANDS;
}

void takt_reference_release(struct reference *l)
{
    l->phase = l->since_minus < 0 ? REFERENCE_STANDS : REFERENCE_LEAVES;
    l->since_minus = l->since_minus < 0 ? 0 : l->since_minus;
}

/* -- one cycle -- */

/* The junction that the span ends with keeps the feed that was promised for it. */
static void follow_landing(struct reference *l)
{
    const uint32_t k = reference_landing(l);

    if (k == CEILING_NONE) {
        l->landing_feed = 0.0;
        return;
    }
    l->landing_feed = reference_leave_of(l, k) == l->junction ? l->landing_feed : 0.0;
    l->landing_feed =
        maths_max(l->landing_feed, reference_feed(l, reference_piece(l, k)->feed_mm_s));
    l->junction = reference_leave_of(l, k);
}

/* Cycles since something: one more, or none. */
static int32_t since(int32_t cycles, bool again)
{
    if (again) {
        return 0;
    }
    return cycles < REFERENCE_LONG_AGO ? cycles + 1 : REFERENCE_LONG_AGO;
}

static void count_changes(struct reference *l, double change)
{
    l->since_plus = since(l->since_plus, change > 0.0);
    l->since_minus = since(l->since_minus, change < 0.0);
}

/*
 * A way in whole units. What rounding leaves counts in the next cycle: else a slow feed would be
 * another, one below half a unit never get anywhere, and a thousand cycles of braking be a hundred
 * units too late, since each takes what rounding has given, and none can brake harder for what it
 * has taken.
 */
static uint64_t whole_way(struct reference *l, double way_mm)
{
    const double owed_mm = way_mm + l->owed_mm;
    const double whole_mm = path_whole_mm(owed_mm);

    l->owed_mm = owed_mm - whole_mm;
    return path_whole_units(whole_mm);
}

static void go(struct reference *l, double feed)
{
    l->at += whole_way(l, 0.5 * (l->feed + feed));
    count_changes(l, feed - l->feed);
    l->feed = feed;
}

/*
 * Comes to rest in this cycle at a position that is no farther ahead than a cycle's way may be. If
 * it is there already, the last way was longer by what was left of the feed, and speeding up in the
 * very next cycle would add to that.
 */
static void come_to_rest(struct reference *l, uint64_t position)
{
    const bool abrupt = l->at == position;

    l->at = position;
    l->owed_mm = 0.0;
    count_changes(l, -1.0);
    l->since_minus -= abrupt ? 1 : 0;
    l->feed = 0.0;
}

static void run_landing(struct reference *l)
{
    struct landing_run *run = &l->run;
    double feed;

    TAKT_ASSERT(run->cycle < run->total);
    run->cycle++;
    l->at = run->start + path_units(takt_landing_distance(run, run->cycle, &feed));
    count_changes(l, run->cycle <= run->ramp ? -1.0 : 0.0);
    l->feed = feed;
    run->phase = run->cycle < run->total ? LANDING_ACTIVE : LANDING_OVER;
}

static void slow_down(struct reference *l, const struct reference_brake *b)
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
static void run_on(struct reference *l, uint64_t setpoint, bool hold)
{
    const double low = takt_reference_low_feed(l, setpoint);
    struct reference_brake b;

    takt_reference_brake_ahead(l, low, &b);

    if (hold) {
        b.feed = 0.0;
    }
    if (reference_halts(l)) {
        takt_reference_brake_to_halt(l, &b);
    } else {
        reference_approach_landing(l, hold, &b);
    }
    if (l->run.phase == LANDING_ACTIVE) {
        run_landing(l);
        return;
    }
    const bool stops = b.feed == 0.0 && l->feed > 0.0; /* however little is left of the feed */

    if (b.rest || stops || b.feed < l->feed - reference_change_min(b.a, l->feed)) {
        slow_down(l, &b);
    } else {
        go(l, hold || l->here.late ? l->feed : takt_reference_speed_up(l, b.at_mm, low));
    }
}

/* At the end of all that is known. What is left of the feed is rounding. */
static void wait_for_more(struct reference *l)
{
    if (l->feed > 0.0) {
        come_to_rest(l, l->at);
    } else {
        count_changes(l, 0.0);
    }
}

/* Enters the span that begins with piece k, from a position on the path that the setpoint is at. */
static void enter_span(struct reference *l, uint32_t k, uint64_t from,
                       struct reference_start *start)
{
    TAKT_ASSERT(l->feed >= 0.0);
    start->step = path_units(l->feed);
    l->phase = REFERENCE_RUNS;
    l->span = from;
    l->cycles = takt_ceiling_cycles(l->here.ceiling, k);
    TAKT_ASSERT(l->cycles >= 1 && l->cycles <= takt_ramp_profile_cycles_max(l->profile));
    const uint32_t window = takt_ramp_profile_window_cycles(l->profile, l->cycles);

    l->window = (double)window;
    l->at = from + start->step * (window - 1) / 2;
    l->owed_mm = 0.0;
    l->feed = (double)start->step / PATH_UNITS_PER_MM;
    l->since_plus = REFERENCE_LONG_AGO;
    l->since_minus = REFERENCE_LONG_AGO;
    l->run.phase = LANDING_NONE;
    start->at = l->at;
    takt_reference_enter_piece(l, k);
}

/*
 * Leaves the stop for the span after it: with the first piece of it, since a short one may lie
 * behind the trapezoidal reference already and bind the setpoint nevertheless. False: that is not
 * known yet.
 */
static bool leave_stop(struct reference *l, struct reference_start *start)
{
    TAKT_ASSERT(reference_stands(l) && l->feed == 0.0);
    for (unsigned i = 0; i < REFERENCE_PIECES_MAX && reference_has_piece(l); i++) {
        if (!reference_is_beyond(l->at, reference_leave_of(l, l->here.piece))) {
            enter_span(l, l->here.piece, l->at, start);
            return true;
        }
        l->here.piece++;
    }
    return false;
}

/*
 * Is the trapezoidal reference, or the setpoint that follows it, at the junction: landed in motion,
 * or at rest for a whole window?
 */
static bool is_at_junction(const struct reference *l, uint64_t junction)
{
    return l->run.phase == LANDING_OVER
               ? l->run.junction == junction
               : l->at == junction && l->feed == 0.0 && reference_has_rested(l);
}

/* Goes over from a landed junction to the span behind it. False: that is not known yet. */
static bool leave_junction(struct reference *l, struct reference_start *start)
{
    const uint32_t k = reference_landing(l);

    if (k == CEILING_NONE || k + 1 >= l->here.ceiling->count ||
        !is_at_junction(l, reference_leave_of(l, k))) {
        return false;
    }
    enter_span(l, k + 1, reference_leave_of(l, k), start);
    return true;
}

static bool has_stopped(const struct reference *l)
{
    return l->feed == 0.0 && reference_has_piece(l) &&
           reference_piece(l, l->here.piece)->end == CEILING_STOPS &&
           reference_is_beyond(l->at, reference_leave_of(l, l->here.piece));
}

/* Between two spans: may the next one be begun in this cycle? */
static bool begin_span(struct reference *l, bool hold, struct reference_start *start)
{
    if (reference_stands(l)) {
        return l->phase == REFERENCE_LEAVES && !hold && leave_stop(l, start);
    }
    return (l->run.phase == LANDING_OVER || !(hold || reference_halts(l))) &&
           leave_junction(l, start);
}

bool takt_reference_step(struct reference *l, uint64_t setpoint, bool hold,
                         struct reference_start *start)
{
    if (l->here.ceiling == NULL) {
        return false;
    }
    const bool begun = begin_span(l, hold, start);

    if (reference_stands(l)) {
        return false;
    }
    const bool too_fast = reference_seeks(l) && takt_reference_seek_halt(l);

    follow_landing(l);
    if (l->run.phase == LANDING_ACTIVE) {
        run_landing(l);
    } else if (reference_has_piece(l)) {
        run_on(l, setpoint, hold || too_fast);
    } else {
        wait_for_more(l);
    }
    takt_reference_follow_pieces(l);
    if (has_stopped(l)) {
        l->phase = REFERENCE_STANDS;
        l->here.piece++;
    }
    return begun;
}
