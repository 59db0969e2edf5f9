/*
 * Goal: in each cycle the highest feed from which everything ahead can still be met.
 *
 * With w the feed, s the position, a the acceleration of the piece, N the averaging window in
 * cycles:
 *
 *     speeding up to w'    it must then be possible to keep w' for N cycles and brake:   w'^2 <= B(s' + N w')
 *     keeping w            the next cycle must be able to brake:                         w^2  <= B(s + w)
 *     braking to w'        by a at most, otherwise as above without N
 *
 * B(x) = u + 2 a (x_end - x) is feed squared from which the piece's end can be met (ceiling.h). A
 * ceiling that the setpoint has not left yet, and every one up to s' + N w', binds w' as well.
 */
#include "base/assert.h"
#include "motion/reference_private.h"

#include "base/maths.h"
#include "motion/landing.h"

/* Pieces that are looked through for speeding up; no faster than reaches over them. */
#define AHEAD_PIECES_MAX 64

/* Cycles beside two windows within which a landing is looked into. */
#define LANDING_CYCLES 64.0

/*
 * Cycles that a feed can be kept before braking to the end of what is known: more comes in that
 * time.
 */
#define OPEN_CYCLES 16.0

/* Halvings in search of a feed to land from. */
#define LANDING_TRIES 5

/* Rounding of positions as doubles, path units. */
#define END_UNITS 64.0

/* -- braking -- */

/*
 * Feed at the end of a piece: 0 at a junction where the axes only come to rest, whatever follows.
 */
static double end_feed(const struct reference *l, const struct ceiling_piece *p)
{
    return p->feed_mm_s == 0.0F ? 0.0 : reference_feed(l, p->end_feed_mm_s);
}

/* A place ahead, how hard it is braked for, and the feed there. */
struct place {
    double gap_mm;
    double a;
    double feed;
};

/* Highest feed at the end of the cycle at which the place can be met from there. */
static double feed_to_meet(const struct place *p, double w)
{
    const double a = p->a;
    const double root = 0.25 * a * a - a * w + maths_square(p->feed) + 2.0 * a * p->gap_mm;
    const double v = root > 0.0 ? maths_sqrt(root) - 0.5 * a : -1.0;

    return p->gap_mm < 0.5 * (w + v) || v < 0.0 ? p->feed : v;
}

/*
 * So far away, (w + a)^2 <= 2 a gap, that feed_to_meet is above w and nothing has to be done for it
 * in this cycle.
 */
static bool is_far(const struct place *p, double w)
{
    return maths_square(w + p->a) * (1.0 + REFERENCE_FEED_SQUARED_SLACK) <= 2.0 * p->a * p->gap_mm;
}

/*
 * The longest way of a cycle that the ceilings allow in all of the pieces that have been braked
 * for.
 */
static double cycle_way(const struct reference *l, const struct reference_brake *b)
{
    double way_mm = b->low;

    for (uint32_t i = 0; i < b->pieces; i++) {
        const struct ceiling_piece *p = reference_piece(l, l->here.piece + i);

        if (p->feed_mm_s > 0.0F) {
            way_mm = maths_min(way_mm, reference_feed(l, p->feed_mm_s));
        }
    }
    return maths_max(way_mm, l->feed);
}

/*
 * Brakes for it. True: it is to stop there in this cycle, a little early perhaps, so that no feed
 * is left that is lost in the rounding of positions; but not by a longer way than a cycle may have,
 * where the axes could do much more.
 */
static bool brake_for(const struct reference *l, const struct place *p, struct reference_brake *b)
{
    const double feed = feed_to_meet(p, l->feed);

    b->a = maths_max(b->a, p->a);
    b->feed = maths_min(b->feed, feed);
    return p->feed == 0.0 && feed < maths_max(REFERENCE_REST_PART * p->a, l->feed - p->a) &&
           l->feed < p->a * (1.0 + 2.0 * REFERENCE_REST_PART) && p->gap_mm <= cycle_way(l, b);
}

static void rest_at(const struct reference *l, uint64_t position, struct reference_brake *b)
{
    b->rest_at = position;
    b->rest = l->feed > 0.0 || l->at != position;
}

/* Brakes to come to rest at a position, by a at most. */
static void brake_to_rest(const struct reference *l, uint64_t position, double a,
                          struct reference_brake *b)
{
    const struct place place = {.gap_mm = path_mm(l->at, position), .a = a};

    if (brake_for(l, &place, b)) {
        rest_at(l, position, b);
    }
}

void takt_reference_brake_to_halt(const struct reference *l, struct reference_brake *b)
{
    brake_to_rest(l, l->halt.end, takt_reference_halt_acceleration(l), b);
}

/* Where it stops at the end of piece k: the end of its block exactly, if that is where it ends. */
static uint64_t rest_position(const struct reference *l, uint32_t k)
{
    const uint64_t end = l->here.ceiling->origin + path_units(reference_end_mm(l, k));
    const uint64_t leave = reference_leave_of(l, k);
    const bool same = maths_abs((double)(int64_t)(end - leave)) <= END_UNITS;

    TAKT_ASSERT(k < l->here.ceiling->count);
    return reference_piece(l, k)->end == CEILING_STOPS || same ? leave : end;
}

/* Brakes for what piece k ends in. */
static void brake_for_piece(const struct reference *l, uint32_t k, double gap_mm,
                            struct reference_brake *b)
{
    const struct ceiling_piece *p = reference_piece(l, k);
    struct place place = {.gap_mm = gap_mm, .a = (double)p->acceleration};

    if (is_far(&place, l->feed)) {
        b->a = maths_max(b->a, place.a);
        return;
    }
    place.feed = end_feed(l, p);
    if (brake_for(l, &place, b)) {
        rest_at(l, rest_position(l, k), b);
    }
}

/*
 * Too fast for what begins here: slows down until that does no harm, v e <= S - s - (w + v)/2, and
 * what follows can be met (reference_place.c), and comes to rest at S at the latest.
 */
static void brake_late(const struct reference *l, struct reference_brake *b)
{
    const double gap_mm = path_mm(l->at, l->here.late_start);
    const double harmless = (gap_mm - 0.5 * l->feed) / (reference_entry_cycles(l) + 0.5);

    b->feed = harmless < l->feed ? maths_min(b->feed, maths_max(0.0, harmless)) : 0.0;
    if (gap_mm >= 0.0) {
        brake_to_rest(l, l->here.late_start, b->a, b);
    }
}

/* Does the span go on beyond what is known? */
static bool is_open(const struct reference *l)
{
    return l->here.piece >= l->here.ceiling->open_from;
}

/*
 * The highest feed v up to top that can be kept for K cycles and then be braked from to the end of
 * what is known: v K + v^2 / 2a <= x_end - x, x = s + (w + v)/2. So it is neared ever slower, and
 * not stopped at as long as more comes in time.
 */
static double feed_to_wait(const struct reference *l, double top)
{
    const struct ceiling *c = l->here.ceiling;
    const double a = reference_acceleration(l);
    const double m = a * (OPEN_CYCLES + 0.5);
    const double gap_mm = c->end_mm[c->count - 1] - path_mm(c->origin, l->at) - 0.5 * l->feed;

    TAKT_ASSERT(l->here.ceiling->count > 0);
    if (top * top <= 2.0 * (a * gap_mm - m * top)) {
        return top;
    }
    return gap_mm > 0.0 ? maths_min(top, maths_sqrt(m * m + 2.0 * a * gap_mm) - m) : 0.0;
}

void takt_reference_brake_ahead(const struct reference *l, double low, struct reference_brake *b)
{
    const double s = path_mm(l->here.ceiling->origin, l->at);

    b->at_mm = s;
    b->feed = maths_min(l->feed, low);
    b->low = low;
    b->pieces = 0;
    b->a = reference_acceleration(l);
    b->rest = false;
    if (l->here.late) {
        brake_late(l, b);
    }
    for (uint32_t k = l->here.piece; !b->rest; k++) {
        const struct ceiling_piece *p = reference_piece(l, k);
        const double gap_mm = reference_end_mm(l, k) - s;

        b->pieces = k - l->here.piece + 1;
        if (!l->here.late || p->end == CEILING_STOPS) {
            brake_for_piece(l, k, gap_mm, b);
        }
        if (reference_is_last_of_span(p) || gap_mm >= l->feed || k + 1 == l->here.ceiling->count ||
            k == l->here.piece + REFERENCE_PIECES_MAX) {
            break;
        }
    }
    if (!b->rest && is_open(l)) {
        b->feed = maths_min(b->feed, feed_to_wait(l, l->feed));
    }
}

/* -- landing -- */

/* At a junction behind which nothing is known it only comes to rest: the ceiling ends with it. */
static bool has_landing(const struct reference *l)
{
    const uint32_t k = reference_landing(l);

    return k != CEILING_NONE && k + 1 < l->here.ceiling->count;
}

static double landing_gap(const struct reference *l)
{
    return path_mm(l->at, l->junction);
}

/*
 * How hard the trapezoidal reference may slow down on its way to the junction: above its feed as in
 * the piece that it is in.
 */
static double landing_acceleration(const struct reference *l, double feed)
{
    const double here = reference_acceleration(l);

    return feed > l->landing_feed
               ? here
               : maths_min(here, (double)reference_piece(l, reference_landing(l))->acceleration);
}

static bool landing_from(const struct reference *l, double gap_mm, double feed, double feed_max,
                         struct landing_run *run)
{
    const struct landing_case landing = {
        .gap_mm = gap_mm,
        .feed = feed,
        .feed_max = feed_max,
        .acceleration = landing_acceleration(l, feed),
        .window = l->window,
    };

    return takt_landing_solve(&landing, run);
}

/*
 * A junction that cannot be landed on in motion any more, because of a hold close to it, is a stop:
 * how hard to brake.
 */
static double stop_acceleration(const struct reference *l)
{
    return landing_acceleration(l, 0.0);
}

/*
 * After speeding up to v: can the next landed junction be met in motion when v has been kept for a
 * window? A feed above the junction's comes down to it in time by the ceiling.
 */
static bool can_land_later(const struct reference *l, double v)
{
    const double gap_mm = landing_gap(l) - 0.5 * (l->feed + v) - (l->window + 1.0) * v;
    struct landing_run run;

    return v > l->landing_feed || landing_from(l, gap_mm, v, l->landing_feed, &run);
}

/*
 * The highest feed up to v from which the next landed junction can be met: in motion, else at rest.
 */
static double feed_to_land(const struct reference *l, double v)
{
    double low = l->feed;
    double high = v;

    TAKT_ASSERT(v >= l->feed);
    if (!has_landing(l) || can_land_later(l, v)) {
        return v;
    }
    for (int i = 0; i < LANDING_TRIES; i++) {
        const double middle = 0.5 * (low + high);

        if (can_land_later(l, middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    if (low > l->feed) {
        return low;
    }
    const double a = stop_acceleration(l);
    const double m = a * (l->window + 1.5);
    const double root = m * m + 2.0 * a * (landing_gap(l) - 0.5 * l->feed);

    return root > 0.0 ? maths_min(v, maths_sqrt(root) - m) : l->feed;
}

/* Farther away than this a junction can be landed on at this feed. */
static double landing_reach(const struct reference *l)
{
    const double a = landing_acceleration(l, l->feed);

    return l->feed * (0.5 * l->feed / a + 2.0 * l->window + LANDING_CYCLES);
}

/* Does nothing before the junction ask for less than the present feed? */
static bool is_way_free(const struct reference *l)
{
    const struct ceiling_piece *p = reference_piece(l, l->here.piece);

    if (l->here.piece + 1 >= p->landing) {
        return true;
    }
    while (!p->lowest) {
        p++;
    }
    const double feed = reference_feed(l, p->end_feed_mm_s);

    return maths_square(feed) >= maths_square(l->feed) * (1.0 - REFERENCE_FEED_SQUARED_SLACK);
}

/* The feed at the end of this cycle if nothing else but braking happens. */
static double braked_feed(const struct reference *l, const struct reference_brake *b)
{
    return b->rest ? 0.0 : maths_max(maths_min(b->feed, l->feed), l->feed - b->a);
}

/* Could the junction still be landed on when this cycle does nothing else but brake? */
static bool can_land_after(const struct reference *l, const struct reference_brake *b,
                           double gap_mm)
{
    const double feed = braked_feed(l, b);
    struct landing_run later;

    return landing_from(l, gap_mm - 0.5 * (l->feed + feed), feed, l->landing_feed, &later);
}

/* Braking from now on, does the trapezoidal reference come to rest before the junction? */
static bool can_rest_before(const struct reference *l, double gap_mm)
{
    return l->feed * l->feed <= 2.0 * stop_acceleration(l) * gap_mm;
}

/* A junction that cannot be landed on any more, nor come down to by the ceiling, is a stop. */
static bool must_stop(const struct reference *l)
{
    return l->here.piece >= reference_landing(l) || l->feed <= l->landing_feed;
}

/*
 * Begins to land when it could not be done any more a cycle later, and no ceiling lies between.
 * Where it cannot be done at all, or a hold can still be obeyed before the junction, the junction
 * becomes a stop.
 */
void takt_reference_consider_landing(struct reference *l, bool hold, struct reference_brake *b)
{
    if (!has_landing(l)) {
        return;
    }
    const double gap_mm = landing_gap(l);

    if (gap_mm > landing_reach(l) || can_land_after(l, b, gap_mm)) {
        return;
    }
    l->run = (struct landing_run){.start = l->at, .junction = l->junction};
    if (!hold || !can_rest_before(l, gap_mm)) {
        const bool lands =
            landing_from(l, gap_mm, l->feed, l->landing_feed, &l->run) && is_way_free(l);

        l->run.phase = lands ? LANDING_ACTIVE : LANDING_NONE;
    }
    if (l->run.phase != LANDING_ACTIVE && (hold || (must_stop(l) && is_way_free(l)))) {
        brake_to_rest(l, l->junction, stop_acceleration(l), b);
    }
}

/* -- speeding up -- */

/*
 * The highest feed v up to top that can be kept for a window and braked from to where it halts: as
 * in a piece.
 */
static double feed_to_halt(const struct reference *l, double top)
{
    const double a = takt_reference_halt_acceleration(l);
    const double m = a * (l->window + 0.5);
    const double root = m * m + 2.0 * a * (path_mm(l->at, l->halt.end) - 0.5 * l->feed);

    TAKT_ASSERT(reference_halts(l));
    return root > 0.0 ? maths_min(top, maths_sqrt(root) - m) : 0.0;
}

/*
 * Highest feed v with v^2 <= u + 2 a (x_end - x), x = s + (w + v)/2 + N v: what a piece's end asks
 * for.
 */
static double feed_in_piece(const struct reference *l, const struct ceiling_piece *p, double gap_mm)
{
    const double a = (double)p->acceleration;
    const double m = a * (l->window + 0.5);
    const double root =
        m * m + maths_square(reference_feed(l, p->end_feed_mm_s)) + 2.0 * a * gap_mm;

    return root > 0.0 ? maths_sqrt(root) - m : 0.0;
}

/*
 * The highest feed up to top that can be kept for a window with everything met that is ahead then.
 * Going on from piece to piece: at its end the feed for x = end is allowed, or the answer lies in
 * it.
 */
static double feed_to_keep(const struct reference *l, double s, double top, double low)
{
    const double way = l->window + 0.5;

    for (uint32_t k = l->here.piece; k < l->here.ceiling->count; k++) {
        const struct ceiling_piece *p = reference_piece(l, k);
        const double gap_mm = reference_end_mm(l, k) - s - 0.5 * l->feed;

        low = maths_min(low, reference_feed(l, p->feed_mm_s));
        top = maths_min(top, low);
        if (reference_is_last_of_span(p) || gap_mm >= top * way ||
            gap_mm > reference_feed(l, p->end_feed_mm_s) * way || k + 1 == l->here.ceiling->count) {
            return maths_min(top, feed_in_piece(l, p, gap_mm));
        }
        if (k - l->here.piece >= AHEAD_PIECES_MAX) {
            return gap_mm / way;
        }
    }
    return 0.0;
}

double takt_reference_speed_up(const struct reference *l, double at_mm, double low)
{
    const double a = reference_acceleration(l);

    if (!reference_has_rested(l) || low <= l->feed * (1.0 + 1e-12)) {
        return l->feed;
    }
    const double top = is_open(l) ? feed_to_wait(l, l->feed + a) : l->feed + a;
    const double kept = feed_to_keep(l, at_mm, top, low);
    const double v = reference_halts(l) ? feed_to_halt(l, kept) : kept;

    return v > l->feed + reference_change_min(a, v) ? maths_max(l->feed, feed_to_land(l, v))
                                                    : l->feed;
}
