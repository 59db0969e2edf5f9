/*
 * Goal: a new ceiling never asks for what cannot be done any more.
 *
 * While the lead point is in a piece it may slow down by that piece's acceleration, and what lies ahead could be met from
 * there when the piece was come to. A new ceiling may show something slow, or with a low acceleration, where only the end
 * of what was known had been: or begin it earlier, since a higher ceiling c begins c b before its block, b half the window
 * and a margin. The lead point does not come to such a piece where it begins, but where that can do no harm: with its
 * block from S on, at
 *
 *     w b <= S - s
 *
 * for then all that the averages hold when the setpoint comes to S is that piece's. Until then it stays in the piece it
 * is in and slows down as hard as that one allows: at worst to rest at S, which is what it was promised.
 */
#include "motion/lead_private.h"

#include "base/maths.h"

#include <stddef.h>

/* Rounding of ceilings and accelerations. */
#define SLACK 1e-9

/* -- the lowest ceiling from the setpoint to the lead point -- */

static struct lead_low *low_at(struct lead_place *p, uint32_t i)
{
    return &p->low[(p->low_first + i) % LEAD_LOW_MAX];
}

static float low_feed_mm_s(struct lead_place *p, uint32_t i)
{
    return p->ceiling->piece[low_at(p, i)->feed].feed_mm_s;
}

static void find_lowest(struct lead_place *p)
{
    p->low_feed = ceiling_feed(p->ceiling, low_feed_mm_s(p, 0));
    p->low_leave = ceiling_leave(p->ceiling, low_at(p, 0)->leave);
}

/* Where there is no room for one more the last two become one: the lower feed until the later place. */
static void low_push(struct lead_place *p, uint32_t k)
{
    const float feed_mm_s = p->ceiling->piece[k].feed_mm_s;

    while (p->low_count > 0 && low_feed_mm_s(p, p->low_count - 1) >= feed_mm_s) {
        p->low_count--;
    }
    if (p->low_count == LEAD_LOW_MAX) {
        low_at(p, p->low_count - 1)->leave = (uint16_t)k;
        return;
    }
    *low_at(p, p->low_count) = (struct lead_low){(uint16_t)k, (uint16_t)k};
    p->low_count++;
    if (p->low_count == 1) {
        find_lowest(p);
    }
}

double lead_low_feed(struct lead *l, uint64_t setpoint)
{
    struct lead_place *p = &l->here;

    while (p->low_count > 0 && lead_is_beyond(setpoint, p->low_leave)) {
        p->low_first = (p->low_first + 1) % LEAD_LOW_MAX;
        p->low_count--;
        if (p->low_count > 0) {
            find_lowest(p);
        }
    }
    return p->low_count > 0 ? p->low_feed : 0.0;
}

/* -- from piece to piece -- */

/* Is the lead point past the end of piece k? A span's end is exact, the others are where a ceiling begins. */
static bool has_passed(const struct lead *l, const struct ceiling *c, uint32_t k)
{
    return lead_is_last_of_span(&c->piece[k]) ? lead_is_beyond(l->at, ceiling_leave(c, k))
                                              : path_mm(c->origin, l->at) >= c->end_mm[k];
}

/* Where the lead point may brake at the earliest: its feed has then been kept for a window. mm from the origin */
static double brake_position(const struct lead *l, const struct ceiling *c)
{
    const double wait = maths_max(0.0, l->window - (double)l->since_plus);

    return path_mm(c->origin, l->at) + l->feed * wait;
}

/* Can what lies ahead be met by braking at this feed squared from x on, in piece k? highest: at the highest overrides. */
static bool can_meet(const struct ceiling *c, uint32_t k, double x, double energy, bool highest)
{
    for (uint32_t i = 0; i < LEAD_PIECES_MAX; i++) {
        const struct ceiling_piece *p = &c->piece[k + i];
        const double end_energy =
            lead_square(ceiling_feed(c, highest ? p->end_feed_max_mm_s : p->end_feed_mm_s));
        const bool last = lead_is_last_of_span(p) || k + i + 1 == c->count;

        if (c->end_mm[k + i] >= x || last) {
            return energy <= end_energy + 2.0 * (double)p->acceleration * (c->end_mm[k + i] - x);
        }
        if (energy > end_energy) {
            return false;
        }
    }
    return true; /* so many pieces within a window: what ends the last one counts for those behind */
}

/* Without rounding. */
static double energy_of(const struct lead *l)
{
    return l->feed * l->feed * (1.0 - LEAD_ENERGY_SLACK);
}

/* Can what lies ahead be met at the highest overrides if the lead point comes to piece k here? */
static bool can_follow(const struct lead *l, const struct ceiling *c, uint32_t k)
{
    return can_meet(c, k, brake_position(l, c), energy_of(l), true);
}

/* Likewise from piece k to next, before that begins: until there it brakes as the pieces allow that it leaves. */
static bool can_follow_early(const struct lead *l, const struct ceiling *c, uint32_t k,
                             uint32_t next)
{
    const double begin_mm = c->end_mm[next - 1];
    const double x = brake_position(l, c);
    double a = l->here.early_a;

    for (uint32_t i = k; i < next; i++) {
        a = maths_min(a, (double)c->piece[i].acceleration);
    }
    return x < begin_mm ? can_meet(c, next, begin_mm, energy_of(l) - 2.0 * a * (begin_mm - x), true)
                        : can_meet(c, next, x, energy_of(l), true);
}

/* Does a piece allow whatever the averages may hold from the one before? */
static bool is_no_lower(const struct lead *l, const struct ceiling *c, uint32_t k)
{
    const struct ceiling_piece *had = &c->piece[k - 1];
    const struct ceiling_piece *p = &c->piece[k];
    const double feed_max = ceiling_feed(c, p->feed_max_mm_s) * (1.0 + SLACK);
    const bool kept = l->feed <= feed_max && l->since_minus >= l->window;

    return (had->feed_max_mm_s <= p->feed_max_mm_s || kept) && p->acceleration >= had->acceleration;
}

/*
 * Has the lead point come past the end of piece k in this cycle, with a feed from which everything behind can be met? A
 * ceiling taken in between may begin the next piece, of less acceleration, so early that it is too fast there.
 */
static bool is_as_planned(const struct lead *l, const struct ceiling *c, uint32_t k)
{
    const double energy = lead_square(ceiling_feed(c, c->piece[k].end_feed_mm_s));

    return path_mm(c->origin, l->before) < c->end_mm[k] &&
           l->feed * l->feed <= energy * (1.0 + LEAD_ENERGY_SLACK) &&
           can_meet(c, k + 1, brake_position(l, c), energy_of(l), false);
}

/* From piece k to the next, past its end. */
static bool may_enter(const struct lead *l, const struct ceiling *c, uint32_t k)
{
    const struct ceiling_piece *p = &c->piece[k + 1];
    const uint64_t start = ceiling_start(c, k + 1);

    if (!p->opens || l->feed == 0.0 || lead_is_beyond(l->entered, start)) {
        return true;
    }
    if (l->halt.found && lead_is_beyond(start, l->halt.end) &&
        !lead_can_halt(l, (double)p->acceleration)) {
        return false;
    }
    if (is_no_lower(l, c, k + 1) || is_as_planned(l, c, k)) {
        return true;
    }
    return l->feed * lead_entry_cycles(l) <= path_mm(l->at, start) &&
           l->feed <= ceiling_feed(c, p->feed_max_mm_s) * (1.0 + SLACK) && can_follow(l, c, k + 1);
}

/* The next piece, behind k, that something begins with; 0: there is none in this span. */
static uint32_t next_opening(const struct ceiling *c, uint32_t k)
{
    for (uint32_t i = 0; i < LEAD_PIECES_MAX && !lead_is_last_of_span(&c->piece[k]); i++) {
        k++;
        if (k == c->count) {
            return 0;
        }
        if (c->piece[k].opens) {
            return k;
        }
    }
    return 0;
}

/*
 * A lead point that cannot come down to the next ceiling where that begins, because it was lowered just now, has to come
 * to it earlier: at w b = S - s, as long as what follows can be met from there at the highest overrides.
 */
static bool must_enter(const struct lead *l, const struct ceiling *c, uint32_t k)
{
    const uint32_t next = next_opening(c, k);
    const double w = l->feed;

    if (next == 0) {
        return false;
    }
    const struct ceiling_piece *p = &c->piece[next];
    const double end = ceiling_feed(c, c->piece[next - 1].end_feed_mm_s);
    const double gap_mm = c->end_mm[next - 1] - brake_position(l, c);

    return ceiling_feed(c, p->feed_mm_s) < w && w <= ceiling_feed(c, p->feed_max_mm_s) &&
           w * (lead_entry_cycles(l) + 1.0) >= path_mm(l->at, ceiling_start(c, next)) &&
           w * w * (1.0 - LEAD_ENERGY_SLACK) >
               end * end + 2.0 * (double)c->piece[k].acceleration * gap_mm &&
           can_follow_early(l, c, k, next);
}

/* Comes to the piece behind that which the lead point is in, if it is there. False: it stays. */
static bool go_on(struct lead *l, struct lead_place *p)
{
    const struct ceiling *c = p->ceiling;
    const uint32_t k = p->piece;

    if (lead_is_last_of_span(&c->piece[k])) {
        return false;
    }
    const bool passed = has_passed(l, c, k);

    if (k + 1 == c->count) {
        p->piece += passed ? 1 : 0;
        return false;
    }
    if (!passed && !must_enter(l, c, k)) {
        return false;
    }
    p->late = !may_enter(l, c, k);
    if (p->late) {
        return false;
    }
    p->early_a = passed ? MATHS_INFINITY : maths_min(p->early_a, (double)c->piece[k].acceleration);
    p->piece++;
    low_push(p, p->piece);
    return true;
}

/* What begins for the setpoint at the piece of the lead point has been come to. */
static void note_entry(struct lead *l)
{
    if (lead_has_piece(l)) {
        const uint64_t start = ceiling_start(l->here.ceiling, l->here.piece);

        l->entered = lead_is_beyond(start, l->entered) ? start : l->entered;
    }
}

void lead_follow_pieces(struct lead *l)
{
    l->here.late = false;
    if (l->here.early_a != MATHS_INFINITY && lead_has_piece(l) && l->here.piece > 0 &&
        has_passed(l, l->here.ceiling, l->here.piece - 1)) {
        l->here.early_a = MATHS_INFINITY;
    }
    for (unsigned i = 0; i < LEAD_PIECES_MAX && lead_has_piece(l); i++) {
        if (!go_on(l, &l->here)) {
            return;
        }
        note_entry(l);
    }
}

void lead_enter_piece(struct lead *l, uint32_t k)
{
    l->here.piece = k;
    l->here.low_count = 0;
    l->here.early_a = MATHS_INFINITY;
    low_push(&l->here, k);
    l->entered = l->span;
    lead_follow_pieces(l);
}

/* -- a setpoint that is moved by others -- */

/* The lowest feed of what the setpoint has not left yet. */
static double low_feed_now(const struct lead *l, bool highest)
{
    const struct lead_place *p = &l->here;

    if (p->low_count == 0) {
        return MATHS_INFINITY;
    }
    return highest ? lead_feed(l, lead_piece(l, p->low[p->low_first % LEAD_LOW_MAX].feed)->feed_max_mm_s)
                   : p->low_feed;
}

bool lead_could_be(const struct lead *l, uint64_t at, double feed, bool highest)
{
    const struct ceiling *c = l->here.ceiling;
    const double x = path_mm(c->origin, at);

    if (feed > low_feed_now(l, highest)) {
        return false;
    }
    for (uint32_t k = l->here.piece, i = 0; k < c->count && i < LEAD_PIECES_MAX; k++, i++) {
        const struct ceiling_piece *p = &c->piece[k];

        if (feed > ceiling_feed(c, highest ? p->feed_max_mm_s : p->feed_mm_s)) {
            return false;
        }
        if (x <= c->end_mm[k] || lead_is_last_of_span(p)) {
            return x <= c->end_mm[k] && can_meet(c, k, x, lead_square(feed), highest);
        }
    }
    return false;
}

double lead_top_feed(const struct lead *l)
{
    return lead_has_piece(l) ? lead_feed(l, lead_piece(l, l->here.piece)->feed_max_mm_s) : 0.0;
}

void lead_follow(struct lead *l, uint64_t at, double feed, uint64_t setpoint)
{
    struct lead_place *p = &l->here;
    const struct ceiling *c = p->ceiling;
    const double x = path_mm(c->origin, at);

    l->before = l->at;
    l->at = at;
    l->feed = feed;
    l->owed = 0.0;
    l->abrupt = false;
    l->since_plus = l->since_minus = (uint32_t)l->window - 1;
    for (unsigned i = 0; i < LEAD_PIECES_MAX && p->piece > 0 && x < c->end_mm[p->piece - 1]; i++) {
        p->piece--;
    }
    for (unsigned i = 0; i < LEAD_PIECES_MAX && p->piece + 1 < c->count && x >= c->end_mm[p->piece] &&
                         !lead_is_last_of_span(&c->piece[p->piece]);
         i++) {
        p->piece++;
        low_push(p, p->piece);
    }
    p->late = false;
    p->early_a = MATHS_INFINITY;
    note_entry(l);
    (void)lead_low_feed(l, setpoint);
}

/* -- a new ceiling -- */

void lead_set_ceiling(struct lead *l, const struct ceiling *ceiling)
{
    l->coming.ceiling = ceiling;
    l->coming.piece = 0;
    l->coming.low_count = 0;
    l->coming.early_a = MATHS_INFINITY;
}

/* Goes on by one piece in search of the lead point. False: that one is its own. */
static bool search(struct lead *l)
{
    struct lead_place *p = &l->coming;

    if (p->piece == p->ceiling->count) {
        return false;
    }
    const uint64_t leave = ceiling_leave(p->ceiling, p->piece);

    if (lead_is_beyond(l->standing ? l->at : l->span, leave)) {
        p->piece++;
        p->low_count = 0;
        return true;
    }
    if (l->standing) {
        return false;
    }
    if (p->low_count == 0) {
        low_push(p, p->piece);
    }
    return go_on(l, p);
}

/* From now on the lead point is in the ceiling that came. Of the list what is used. */
static void take_place(struct lead *l)
{
    struct lead_place *from = &l->coming;
    struct lead_place *to = &l->here;

    to->ceiling = from->ceiling;
    to->piece = from->piece;
    to->late = from->late;
    to->early_a = from->early_a;
    to->low_first = 0;
    to->low_count = from->low_count;
    for (uint32_t i = 0; i < from->low_count; i++) {
        to->low[i] = *low_at(from, i);
    }
    to->low_feed = from->low_feed;
    to->low_leave = from->low_leave;
    from->ceiling = NULL;
}

bool lead_find_place(struct lead *l)
{
    unsigned looked = 0;

    l->coming.late = false;
    while (looked < LEAD_PIECES_MAX && search(l)) {
        looked++;
    }
    if (looked == LEAD_PIECES_MAX) {
        return true;
    }
    take_place(l);
    note_entry(l);
    return false;
}
