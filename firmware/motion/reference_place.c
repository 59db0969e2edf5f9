/*
 * Goal: a new ceiling never asks for what cannot be done any more.
 *
 * Where the trapezoidal reference may brake how hard is the same under every override
 * (plan/ceiling.h). So whatever the override, it can do what it could do under the one before:
 * brake as hard as its place allows, and be no faster anywhere than then. It is in the piece that
 * lies where it is, however fast it is.
 *
 * But a new ceiling may also show something slow, or with a low acceleration, where only the end of
 * what was known had been. The trapezoidal reference that is too fast for that is late: it keeps
 * the acceleration it had, and brakes, until it does no harm. With the block from S on that is when
 * what it begins there can be met, and
 *
 *     w b <= S - s
 *
 * b half the window and a margin: for then all that the averages hold when the setpoint comes to S
 * is that block's. At worst it comes to rest at S, which is what it was promised.
 */
#include "base/assert.h"
#include "motion/reference_private.h"

#include "base/maths.h"

#include <stddef.h>

/* -- the lowest ceiling from the setpoint to the trapezoidal reference -- */

static struct reference_low *low_at(struct reference_place *p, uint32_t i)
{
    return &p->low[(p->low_first + i) % REFERENCE_LOW_MAX];
}

static float low_feed_mm_s(struct reference_place *p, uint32_t i)
{
    return p->ceiling->piece[low_at(p, i)->feed].feed_mm_s;
}

static void find_lowest(struct reference_place *p)
{
    p->low_feed = ceiling_feed(p->ceiling, low_feed_mm_s(p, 0));
    p->low_leave = path_ceiling_leave(p->ceiling, low_at(p, 0)->leave);
}

/*
 * Where there is no room for one more the last two become one: the lower feed until the later
 * place.
 */
static void low_push(struct reference_place *p, uint32_t k)
{
    const float feed_mm_s = p->ceiling->piece[k].feed_mm_s;

    while (p->low_count > 0 && low_feed_mm_s(p, p->low_count - 1) >= feed_mm_s) {
        p->low_count--;
    }
    if (p->low_count == REFERENCE_LOW_MAX) {
        low_at(p, p->low_count - 1)->leave = (uint16_t)k;
        return;
    }
    *low_at(p, p->low_count) = (struct reference_low){(uint16_t)k, (uint16_t)k};
    p->low_count++;
    if (p->low_count == 1) {
        find_lowest(p);
    }
}

double takt_reference_low_feed(struct reference *l, uint64_t setpoint)
{
    struct reference_place *p = &l->here;

    while (p->low_count > 0 && reference_is_beyond(setpoint, p->low_leave)) {
        p->low_first = (p->low_first + 1) % REFERENCE_LOW_MAX;
        p->low_count--;
        if (p->low_count > 0) {
            find_lowest(p);
        }
    }
    return p->low_count > 0 ? p->low_feed : 0.0;
}

/* -- from piece to piece -- */

/*
 * Is the trapezoidal reference past the end of piece k? A span's end is exact, the others are where
 * a ceiling begins.
 */
static bool has_passed(const struct reference *l, const struct ceiling *c, uint32_t k)
{
    return reference_is_last_of_span(&c->piece[k])
               ? reference_is_beyond(l->at, path_ceiling_leave(c, k))
               : path_mm(c->origin, l->at) >= c->end_mm[k];
}

/*
 * Where the trapezoidal reference may brake at the earliest: its feed has then been kept for a
 * window. mm from the origin; in whole units, or what is asked for there would depend, in the last
 * bit, on what it is counted from.
 */
static double brake_position(const struct reference *l, const struct ceiling *c)
{
    const double wait = maths_max(0.0, l->window - (double)l->since_plus);

    return path_mm(c->origin, l->at) + path_whole_mm(l->feed * wait);
}

/* A feed of its pieces, squared. */
static double feed_squared_of(const struct ceiling *c, float feed_mm_s)
{
    return maths_square(ceiling_feed(c, feed_mm_s));
}

/*
 * Can what lies ahead be met at this feed squared, which is braked from at x at the earliest, from
 * piece k on? highest: at the highest overrides.
 */
static bool can_meet(const struct ceiling *c, uint32_t k, double x, double feed_squared,
                     bool highest)
{
    for (uint32_t i = k; i < k + REFERENCE_PIECES_MAX; i++) {
        const struct ceiling_piece *p = &c->piece[i];
        const double top = feed_squared_of(c, highest ? takt_ceiling_top_feed(c, i) : p->feed_mm_s);
        const double end = feed_squared_of(c, highest ? p->end_feed_max_mm_s : p->end_feed_mm_s);
        const bool last = reference_is_last_of_span(p) || i + 1 == c->count;

        if (feed_squared > top) {
            return false;
        }
        if (c->end_mm[i] >= x || last) {
            return feed_squared <= end + 2.0 * (double)p->acceleration * (c->end_mm[i] - x);
        }
        if (feed_squared > end) {
            return false;
        }
    }
    /* this many pieces within a window: what ends the last one counts for those behind */
    return true;
}

/*
 * Can the trapezoidal reference in piece k do what the ceiling asks for from here on, but for
 * rounding?
 */
static bool can_follow(const struct reference *l, const struct ceiling *c, uint32_t k, bool highest)
{
    return can_meet(c, k, brake_position(l, c),
                    maths_square(l->feed) * (1.0 - REFERENCE_FEED_SQUARED_SLACK), highest);
}

/* Does a piece allow whatever the averages may hold from the one before? */
static bool is_no_lower(const struct ceiling *c, uint32_t k)
{
    const struct ceiling_piece *had = &c->piece[k - 1];
    const struct ceiling_piece *p = &c->piece[k];

    return had->feed_mm_s <= p->feed_mm_s && p->acceleration >= had->acceleration;
}

/*
 * Does it halt before a place, and could not with the acceleration of piece k, which starts there
 * for the setpoint?
 */
static bool halts_before(const struct reference *l, const struct ceiling *c, uint32_t k,
                         uint64_t start)
{
    return reference_halts(l) && reference_is_beyond(start, l->halt.end) &&
           !takt_reference_can_halt(l, (double)c->piece[k].acceleration);
}

/*
 * May the trapezoidal reference come to what begins with piece k and starts at a place for the
 * setpoint?
 */
static bool may_enter(const struct reference *l, const struct ceiling *c, uint32_t k,
                      uint64_t start)
{
    if (l->feed == 0.0 || reference_is_beyond(l->entered, start)) {
        return true;
    }
    return !halts_before(l, c, k, start) &&
           (!reference_is_beyond(start, l->known) || is_no_lower(c, k));
}

static uint64_t nearer(const struct reference *l, uint64_t one, uint64_t other)
{
    return path_mm(l->at, one) < path_mm(l->at, other) ? one : other;
}

/* Comes to piece k. What it is too fast for is new to it until it no longer is. */
static void come_to(struct reference *l, struct reference_place *p, uint32_t k)
{
    const struct ceiling *c = p->ceiling;

    p->piece = k;
    if (!c->piece[k].opens) {
        return;
    }
    const uint64_t start = takt_ceiling_start(c, k);

    if (may_enter(l, c, k, start)) {
        l->entered = reference_is_beyond(start, l->entered) ? start : l->entered;
        return;
    }
    p->late_start = p->late ? nearer(l, p->late_start, start) : start;
    p->late_a = p->late ? p->late_a : (double)c->piece[k - 1].acceleration;
    p->late = true;
    l->follows = false;
    l->known = nearer(l, l->known, start);
}

/*
 * Comes to the piece behind that which the trapezoidal reference is in, if it is there. False: it
 * stays.
 */
static bool go_on(struct reference *l, struct reference_place *p)
{
    const struct ceiling *c = p->ceiling;
    const uint32_t k = p->piece;

    if (reference_is_last_of_span(&c->piece[k]) || !has_passed(l, c, k)) {
        return false;
    }
    if (k + 1 == c->count) {
        p->piece++;
        return false;
    }
    come_to(l, p, k + 1);
    low_push(p, k + 1);
    return true;
}

/* Would what begins here do no harm any more? */
static bool is_harmless(const struct reference *l)
{
    const struct reference_place *p = &l->here;

    TAKT_ASSERT(p->late);
    return l->feed == 0.0 ||
           (l->feed * reference_entry_cycles(l) <= path_mm(l->at, p->late_start) &&
            can_follow(l, p->ceiling, p->piece, false) &&
            !halts_before(l, p->ceiling, p->piece, p->late_start));
}

/*
 * Once it can do all that the ceiling asks for it can do so under any override, as far as is known
 * now.
 */
static void note_following(struct reference *l)
{
    const uint64_t end = reference_leave_of(l, l->here.ceiling->count - 1);

    TAKT_ASSERT(l->here.ceiling->count > 0);
    l->follows = true;
    l->known = reference_is_beyond(end, l->known) ? end : l->known;
    l->landing_feed = 0.0;
}

static void note_known(struct reference *l)
{
    struct reference_place *p = &l->here;

    if (l->follows || !reference_has_piece(l)) {
        return;
    }
    if (p->late && is_harmless(l)) {
        p->late = false;
        l->entered = reference_is_beyond(p->late_start, l->entered) ? p->late_start : l->entered;
    }
    if (!p->late && can_follow(l, p->ceiling, p->piece, false)) {
        note_following(l);
    }
}

static void go_through_pieces(struct reference *l)
{
    for (unsigned i = 0; i < REFERENCE_PIECES_MAX && reference_has_piece(l) && go_on(l, &l->here);
         i++) {
    }
}

void takt_reference_follow_pieces(struct reference *l)
{
    go_through_pieces(l);
    note_known(l);
}

void takt_reference_enter_piece(struct reference *l, uint32_t k)
{
    l->here.piece = k;
    l->here.low_count = 0;
    l->here.late = false;
    low_push(&l->here, k);
    l->entered = l->span;
    go_through_pieces(l);
}

/* -- a setpoint that is moved by others -- */

bool takt_reference_could_be(const struct reference *l, uint64_t at, double feed, bool highest)
{
    const struct ceiling *c = l->here.ceiling;
    const double x = path_mm(c->origin, at);
    uint32_t k = l->here.piece;

    TAKT_ASSERT(feed >= 0.0 && c != NULL);
    if (!highest && l->here.low_count > 0 && feed > l->here.low_feed) {
        return false;
    }
    for (uint32_t i = 0; i < REFERENCE_PIECES_MAX && k < c->count && x > c->end_mm[k]; i++, k++) {
        const float top_mm_s = highest ? takt_ceiling_top_feed(c, k) : c->piece[k].feed_mm_s;

        if (reference_is_last_of_span(&c->piece[k]) || feed > ceiling_feed(c, top_mm_s)) {
            return false;
        }
    }
    return k < c->count && x <= c->end_mm[k] && can_meet(c, k, x, feed * feed, highest);
}

/* It keeps its feed for a cycle first; third differences reach over some more. */
#define REST_LATER_CYCLES 4.0

bool takt_reference_could_rest(const struct reference *l, uint64_t at, double feed, uint64_t end)
{
    const struct ceiling *c = l->here.ceiling;
    const double gap_mm = path_mm(at, end) - REST_LATER_CYCLES * feed;
    const double end_mm = path_mm(c->origin, end);
    double a = MATHS_INFINITY;

    for (uint32_t k = l->here.piece; k < l->here.piece + REFERENCE_PIECES_MAX && k < c->count;
         k++) {
        a = maths_min(a, (double)c->piece[k].acceleration);
        if (feed * feed > 2.0 * a * gap_mm) {
            return false;
        }
        if (c->end_mm[k] >= end_mm || reference_is_last_of_span(&c->piece[k])) {
            return true;
        }
    }
    return false;
}

/*
 * What binds from the setpoint on to piece k, in its span: that of further pieces, where it has
 * been, does not.
 */
static void low_anew(struct reference_place *p, uint32_t k, uint64_t setpoint)
{
    uint32_t first = k;

    while (first > 0 && k - first < REFERENCE_PIECES_MAX &&
           !reference_is_last_of_span(&p->ceiling->piece[first - 1]) &&
           !reference_is_beyond(setpoint, path_ceiling_leave(p->ceiling, first - 1))) {
        first--;
    }
    p->low_count = 0;
    for (uint32_t i = first; i <= k; i++) {
        low_push(p, i);
    }
}

/* The piece that lies where it is, whatever it has been in. */
static void find_piece(struct reference_place *p, double x, uint64_t setpoint)
{
    const struct ceiling *c = p->ceiling;
    const uint32_t before = p->piece;

    for (unsigned i = 0; i < REFERENCE_PIECES_MAX && p->piece > 0 && x < c->end_mm[p->piece - 1];
         i++) {
        p->piece--;
    }
    if (p->piece != before) {
        low_anew(p, p->piece, setpoint);
    }
    for (unsigned i = 0;
         i < REFERENCE_PIECES_MAX && p->piece + 1 < c->count && x >= c->end_mm[p->piece] &&
         !reference_is_last_of_span(&c->piece[p->piece]);
         i++) {
        p->piece++;
        low_push(p, p->piece);
    }
}

void takt_reference_follow(struct reference *l, uint64_t at, double feed, uint64_t setpoint)
{
    struct reference_place *p = &l->here;

    l->at = at;
    l->feed = feed;
    l->owed_mm = 0.0;
    l->run.phase = l->run.phase == LANDING_ACTIVE ? LANDING_NONE : l->run.phase;
    l->since_plus = l->since_minus = (int32_t)l->window - 1;
    find_piece(p, path_mm(p->ceiling->origin, at), setpoint);
    const uint64_t start = takt_ceiling_start(p->ceiling, p->piece);

    p->late = false;
    l->entered = reference_is_beyond(start, l->entered) ? start : l->entered;
    note_following(l);
    (void)takt_reference_low_feed(l, setpoint);
}

/* -- a new ceiling -- */

void takt_reference_set_ceiling(struct reference *l, const struct ceiling *ceiling)
{
    l->coming.ceiling = ceiling;
    l->coming.piece = 0;
    l->coming.low_count = 0;
    l->coming.late = false;
}

/* Goes on by one piece in search of the trapezoidal reference. False: that one is its own. */
static bool search(struct reference *l)
{
    struct reference_place *p = &l->coming;

    if (p->piece == p->ceiling->count) {
        return false;
    }
    const uint64_t leave = path_ceiling_leave(p->ceiling, p->piece);

    if (reference_is_beyond(reference_stands(l) ? l->at : l->span, leave)) {
        p->piece++;
        p->low_count = 0;
        return true;
    }
    if (reference_stands(l)) {
        return false;
    }
    if (p->low_count == 0) {
        low_push(p, p->piece);
    }
    return go_on(l, p);
}

/*
 * Does the ceiling ask for what cannot be done, whatever the override? It had too few pieces to
 * reach as far as the one before; or less acceleration came into view. Then that one goes on, until
 * the trapezoidal reference is slow enough.
 */
static bool is_refused(const struct reference *l)
{
    const struct reference_place *p = &l->coming;

    return l->feed > 0.0 && l->here.ceiling != NULL &&
           (p->piece == p->ceiling->count || !can_follow(l, p->ceiling, p->piece, true));
}

/*
 * From now on the trapezoidal reference is in the ceiling that came. Of the list what is used. If
 * it is late it keeps the acceleration that the ceiling before had here: by that it can come to
 * rest in time. The new one's may be less even before what it is late for.
 */
static void take_place(struct reference *l)
{
    struct reference_place *from = &l->coming;
    struct reference_place *to = &l->here;

    to->late_a = reference_has_piece(l) ? reference_acceleration(l) : from->late_a;
    to->ceiling = from->ceiling;
    to->piece = from->piece;
    to->late = from->late;
    to->late_start = from->late_start;
    to->low_first = 0;
    to->low_count = from->low_count;
    for (uint32_t i = 0; i < from->low_count; i++) {
        to->low[i] = *low_at(from, i);
    }
    to->low_feed = from->low_feed;
    to->low_leave = from->low_leave;
    from->ceiling = NULL;
}

bool takt_reference_find_place(struct reference *l)
{
    unsigned looked = 0;

    while (looked < REFERENCE_PIECES_MAX && search(l)) {
        looked++;
    }
    if (looked == REFERENCE_PIECES_MAX) {
        return true;
    }
    const struct reference_place *p = &l->coming;
    const bool follows = p->piece < p->ceiling->count && can_follow(l, p->ceiling, p->piece, false);

    if (!follows && is_refused(l)) {
        l->coming.ceiling = NULL;
        return false;
    }
    take_place(l);
    l->follows = false;
    if (follows && !l->here.late) {
        note_following(l);
    }
    return false;
}
