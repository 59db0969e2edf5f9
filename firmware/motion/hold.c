/*
 * Goal: on a curve the axes come to rest, and up to speed again, as quickly as they can at each
 * place of it.
 *
 * With the place u(t) on the curve x(u), rate r = u', change q = r' and w = q', the chain rule
 * gives for every axis
 *
 *     x''  of time:   x' q + x'' r^2                       within A
 *     x''' of time:   x' w + 3 x'' r q + x''' r^3          within J
 *
 * with their signs: an axis that the curve speeds up can be braked twice as hard, one that it slows
 * down not at all. Each cycle takes the hardest w, of a few, after which there is still a way on
 * with both kept all along it, and goes along that way if there is none. There are two such ways:
 *
 *     to rest        the change goes by -e to -c, stays there, and goes by e to 0 as the rate does
 *     taken over     the change goes by e to 0. At a constant rate that is not above that of the
 *                    pieces everything is kept, and the trapezoidal reference can take over: its own
 *                    condition for what lies ahead is asked for there
 *
 * The first needs the pieces as far as the setpoint comes, the second few of them, and is all that
 * a start has. So whatever follows, the way that was found last can be gone on with, by which no
 * limit is ever broken.
 *
 *     change q |\        w       e          each cycle: w, then the rest of the way found last
 *              | \      /|\     /
 *            0 +--\----/-+-\---/-------- time
 *              |   \__/  |  \_/
 *
 * Setpoints are samples of x(u(t)), so their third differences are averages of its third
 * derivative.
 */
#include "motion/hold.h"

#include "base/assert.h"
#include "base/maths.h"
#include "motion/hold_axes.h"
#include "motion/hold_pieces.h"
#include "plan/path_unit.h"
#include "smooth/single.h"

/*
 * The eases and the peaks tried, in parts of the hardest that all pieces allow, beside those that
 * are known: each with each.
 */
#define EASES 3
#define PEAKS 3
static const float ease_part[EASES] = {0.85f, 0.4f, 0.15f};
static const float peak_part[PEAKS] = {0.9f, 0.6f, 0.3f};

/* Where a w can not be the next one tried is so much smaller; where it can, so much larger. */
#define STEP_LESS  0.85f
#define STEP_MORE  4.0f
#define STEP_LEAST (1.0f / 4096.0f)

/* Where the change cannot be kept, and need not be brought to 0 yet: by this part of it. */
#define LESS_PART 0.125f

/* The rate is so near to that of the ceiling that the trapezoidal reference goes on by itself. */
#define ARRIVED_PART 1e-3f

/*
 * Blocks up to what begins at the trapezoidal reference that are looked at for each state tried, at
 * most.
 */
#define BLOCKS_MAX 16

/* How many of these are found to be fast enough in a cycle, at most. */
#define CLEAR_MAX 8

/*
 * After this many states in a cycle that the trapezoidal reference could not go on from, no other
 * is looked for.
 */
#define REFUSALS_MAX 2

/* Rounding. */
#define TOP_SLACK  1e-5f
#define REST_PART  1e-9
#define TRIAL_PART 4e-6f

/* -- the way on -- */

/* u + r t + q t^2/2 + w t^3/6 */
static void advance(struct hold_state *s, double w, double t)
{
    TAKT_ASSERT(t >= 0.0);
    s->at += t * (s->rate + t * (0.5 * s->change + t * w * (1.0 / 6.0)));
    s->rate = maths_max(0.0, s->rate + t * (s->change + 0.5 * t * w));
    s->change += t * w;
}

/* The same for one cycle, with the same bits: products cost 40 instructions each on a Cortex-M4. */
static void advance_cycle(struct hold_state *s, double w)
{
    s->at += s->rate + (0.5 * s->change + w * (1.0 / 6.0));
    s->rate = maths_max(0.0, s->rate + (s->change + 0.5 * w));
    s->change += w;
}

/* Goes on past the pieces that are fast enough for all rates to come. */
static void pass_clear(struct hold *h, const struct path *path)
{
    if (h->most > h->clear_rate || (int32_t)(h->clear - h->here) < 0) {
        h->clear = h->here;
    }
    h->clear_rate = h->most;
    for (unsigned i = 0;
         i < CLEAR_MAX && (h->clear == h->here || !takt_hold_is_behind(h, path, h->clear)) &&
         takt_hold_top(h, path, h->clear) >= h->most;
         i++) {
        h->clear++;
    }
}

/*
 * Is the rate of a trapezoidal reference at a place not above the highest of what it has come to,
 * from the setpoint on? A block from S on begins for it at S - c b, b half the window and a margin.
 * Pieces.
 */
static bool tops_allow(const struct hold *h, const struct path *path, const struct reference *l,
                       const struct hold_trial *s, float ahead)
{
    const float b = (float)(0.5 * (l->window - 1.0) + CEILING_MARGIN_CYCLES);

    TAKT_ASSERT((int32_t)(h->clear - h->here) >= 0);
    for (uint32_t i = 0; i < BLOCKS_MAX; i++) {
        const uint32_t piece = h->clear + i;
        const float gap = (float)(piece - h->here) - ahead;

        if (gap >= s->rate * b || (piece != h->here && takt_hold_is_behind(h, path, piece))) {
            return true;
        }
        const float top = takt_hold_top(h, path, piece);

        if (s->rate > top && gap < top * b) {
            return false;
        }
    }
    return false;
}

/*
 * The trapezoidal reference of a setpoint that moves at a constant rate is half the window before
 * it. It takes over at the end of the cycle in which the change comes to 0, and keeps its feed in
 * the next one (takt_reference_follow). To stop it may be faster than the overrides ask for.
 */
static bool reference_can_take(struct hold *h, const struct path *path, const struct reference *l,
                               const struct hold_trial *s, bool stop)
{
    const float rate = s->rate * (1.0f + TRIAL_PART);
    const float ahead = s->at + 0.5f * (float)(l->window + 3.0) * rate;

    if (stop && !tops_allow(h, path, l, s, ahead)) {
        return false;
    }
    const uint64_t at = takt_hold_start(h, path) + (uint64_t)((double)ahead * h->length);
    const double feed = (double)rate * h->length / PATH_UNITS_PER_MM;

    h->looked += HOLD_LOOKED_BY_REFERENCE;
    return (hold_is_smooth(h) ||
            takt_reference_could_rest(l, at, feed, path_end(path, h->within))) &&
           takt_reference_could_be(l, at, feed, stop);
}

/*
 * To come to rest the change goes to 0 at no higher a rate than it would have if nothing better was
 * found, r + q^2/2e: where the axes could be far faster than the feed, a softer ease would exceed
 * that. It takes over from a trapezoidal reference that has that rate already, half a window ahead.
 */
static float highest_rate(const struct hold *h, const struct reference *l)
{
    const float rate = (float)h->place.rate;
    const float change = (float)h->place.change;
    const float ease = (float)h->ending.ease;
    float most = rate;

    if (change > 0.0f && ease > 0.0f) {
        most += change * change / (2.0f * ease);
    } else if (change > 0.0f) {
        most = single_max(rate, (float)(l->feed * PATH_UNITS_PER_MM / h->length));
    }
    return most * (1.0f + TOP_SLACK);
}

/* Does a change above 0 go there? */
static bool can_turn(struct hold *h, struct hold_trial *s, float e)
{
    return s->change <= 0.0f || (takt_hold_can_change(h, s, 0.0f, -e) && s->rate <= h->most);
}

/* So hard that braking ends at rest at the latest: r = q^2/2e. */
static float least_ease(const struct hold_trial *s)
{
    return s->change < 0.0f ? s->change * s->change / (2.0f * s->rate) : 0.0f;
}

/*
 * To rest: the change goes by -e to -c, stays there, and goes to 0 by e from a rate of c^2/2e on.
 * c is so great that it need not stay there if that is less than a peak: from q it goes to 0 at
 * r + q |q|/2e, and of that to c and back takes c^2/e.
 */
static bool can_rest(struct hold *h, struct hold_trial s, float e, float peak,
                     struct hold_ending *ending)
{
    const float most = single_sqrt(e * s.rate + 0.5f * s.change * s.change);
    const float c = single_max(single_min(peak, most), -s.change);

    ending->ease = (double)e;
    ending->peak = (double)c;
    if (!can_turn(h, &s, e) || (-s.change < c && !takt_hold_can_change(h, &s, -c, -e))) {
        return false;
    }
    const float stays = (s.rate - c * c / (2.0f * e)) / c;

    return (!(stays > 0.0f) || takt_hold_can_pass(h, &s, 0.0f, stays)) &&
           takt_hold_can_change(h, &s, 0.0f, e);
}

/*
 * The change goes to 0 by e, at a rate and place from which the trapezoidal reference could go on.
 */
static bool can_ease(struct hold *h, const struct path *path, const struct reference *l,
                     struct hold_trial s, float e, bool stop, struct hold_ending *ending)
{
    ending->ease = (double)e;
    ending->peak = 0.0;
    if (h->refusals >= REFUSALS_MAX ||
        !(s.change < 0.0f ? takt_hold_can_change(h, &s, 0.0f, e) : can_turn(h, &s, e))) {
        return false;
    }
    if (reference_can_take(h, path, l, &s, stop)) {
        return true;
    }
    h->refusals++;
    return false;
}

/* The peak of the way that is known; infinite: there is none. */
static float known_peak(const struct hold *h)
{
    return h->ending.peak > 0.0                            ? (float)h->ending.peak
           : h->ending.ease > 0.0 && h->place.change < 0.0 ? -(float)h->place.change
                                                           : SINGLE_INFINITY;
}

/*
 * How what follows this state ends: as it is known, or for what is tried first in another way, each
 * cycle the next of them. To stop it ends at rest, or where the trapezoidal reference could go on,
 * otherwise there. False: no way was found.
 */
static bool find_ending(struct hold *h, const struct path *path, const struct reference *l,
                        const struct hold_trial *s, bool stop, bool first,
                        struct hold_ending *ending)
{
    if (s->rate == 0.0f && s->change < 0.0f) {
        return false; /* no ease is hard enough */
    }
    const float least = least_ease(s);
    const float known = (float)h->ending.ease;

    if (stop && known > 0.0f && can_rest(h, *s, single_max(least, known), known_peak(h), ending)) {
        return true;
    }
    if (!first) {
        return known > least && can_ease(h, path, l, *s, known, stop, ending);
    }
    const struct hold_ending hardest = takt_hold_hardest(h);
    const float other = single_max(least, ease_part[h->turn % EASES] * (float)hardest.ease);
    const float peak = peak_part[h->turn / EASES % PEAKS] * (float)hardest.peak;

    return (stop && can_rest(h, *s, other, peak, ending)) ||
           (known > least && can_ease(h, path, l, *s, known, stop, ending)) ||
           can_ease(h, path, l, *s, other, stop, ending);
}

/* One cycle by w; false: the rate would turn back within it. */
static bool go_by(struct hold *h, double w)
{
    struct hold_state place = h->place;

    advance_cycle(&place, w);
    if (place.at < h->place.at) {
        return false;
    }
    h->moved = place.at - h->place.at;
    h->place = place;
    return true;
}

/*
 * Goes on by w if there is an ease behind it. In one direction in a cycle: the bounds need it. That
 * is tried in single precision.
 */
static bool try_step(struct hold *h, const struct path *path, const struct reference *l, float w,
                     bool stop, bool first)
{
    const struct hold_trial here = {(float)h->place.at, (float)h->place.rate,
                                    (float)h->place.change};
    const bool turns = w * here.change < 0.0f && single_abs(w) > single_abs(here.change);
    const float by = turns ? -here.change : w;
    struct hold_trial next = here;
    struct hold_ending ending;

    takt_hold_try(&next, by, 1.0f);
    if ((here.rate == 0.0f && !(w > 0.0f)) || next.rate > h->most ||
        !takt_hold_can_go(h, &here, &next, by) ||
        !find_ending(h, path, l, &next, stop, first, &ending) ||
        !go_by(h, turns ? -h->place.change : (double)w)) {
        return false;
    }
    h->ending = ending;
    return true;
}

/* The change goes to another one by w for the time that is left of the cycle. What is left then. */
static double go_to(struct hold *h, double to, double w, double left)
{
    const double t = maths_min(left, (to - h->place.change) / w);

    TAKT_ASSERT(w != 0.0 && left >= 0.0);
    advance(&h->place, w, t);
    h->place.change = t < left || maths_abs(to - h->place.change) < REST_PART * maths_abs(w)
                          ? to
                          : h->place.change;
    TAKT_ASSERT(t >= 0.0);
    return left - t;
}

/* The change stays until the rate is that from which it goes to 0 by e. What is left then. */
static double stay(struct hold *h, double e, double left)
{
    const double change = h->place.change;
    const double stays = (h->place.rate - change * change / (2.0 * e)) / -change;
    const double t = maths_clamp(stays, 0.0, left);

    TAKT_ASSERT(change < 0.0);
    advance(&h->place, 0.0, t);
    return left - t;
}

/* As what was found last ends. */
static void go_on_ending(struct hold *h)
{
    const double e = h->ending.ease;
    const double from = h->place.at;
    double left = 1.0;

    TAKT_ASSERT(e > 0.0);
    if (h->place.change > -h->ending.peak && h->ending.peak > 0.0) {
        left = go_to(h, -h->ending.peak, -e, left);
    }
    if (h->ending.peak > 0.0 && left > 0.0) {
        left = stay(h, e, left);
    }
    h->ending.peak = left > 0.0 ? 0.0 : h->ending.peak;
    if (h->place.change != 0.0) {
        left = go_to(h, 0.0, h->place.change < 0.0 ? e : -e, left);
    }
    h->place.rate = h->place.rate < REST_PART * h->top ? 0.0 : h->place.rate;
    advance(&h->place, 0.0, left);
    h->moved = h->place.at - from;
}

/* Before a way is looked for: how fast it may get. */
static void begin_search(struct hold *h, const struct path *path, const struct reference *l,
                         bool stop)
{
    h->turn++;
    h->refusals = 0;
    h->most = stop ? highest_rate(h, l) : SINGLE_INFINITY;
    if (stop) {
        pass_clear(h, path);
    }
}

/*
 * True: it has gone on by a w of the direction wanted, or at the change it has. To rest in two
 * cycles, one of w and one of the ease that takes back all of the change: q + w = -2 (r + q + w/2).
 */
static bool find_step(struct hold *h, const struct path *path, const struct reference *l, bool stop)
{
    const struct range w = takt_hold_steps(h);
    const float wanted = stop ? single_min(w.low, 0.0f) : single_max(w.high, 0.0f);
    const float rate = (float)h->place.rate;
    const float change = (float)h->place.change;

    begin_search(h, path, l, stop);
    if (stop && rate <= 2.0f * w.high && try_step(h, path, l, -rate - 1.5f * change, stop, true)) {
        return true;
    }
    for (unsigned i = 0; i < 2; i++) {
        if (try_step(h, path, l, h->step * wanted, stop, i == 0)) {
            h->step = i == 0 ? single_min(1.0f, STEP_MORE * h->step) : h->step;
            return true;
        }
        h->step = single_max(STEP_LEAST, STEP_LESS * h->step);
    }
    return (wanted * change >= 0.0f && try_step(h, path, l, 0.0f, stop, h->ending.ease == 0.0)) ||
           try_step(h, path, l, -LESS_PART * change, stop, h->ending.ease == 0.0);
}

/*
 * Does it have a change, or must it still brake: it may be too fast for the trapezoidal reference.
 */
static bool is_changing(const struct hold *h)
{
    return h->place.change != 0.0 || h->ending.peak > 0.0;
}

/* Is it at the rate that the trapezoidal reference may have here, or nearly? */
static bool has_arrived(struct hold *h, const struct path *path, const struct reference *l)
{
    const struct hold_trial faster = {.at = (float)h->place.at,
                                      .rate = (float)h->place.rate * (1.0f + ARRIVED_PART)};

    return !is_changing(h) && h->place.rate > 0.0 &&
           !reference_can_take(h, path, l, &faster, false);
}

/* Counts from the start of the block that the setpoint is in. */
static void pass_blocks(struct hold *h)
{
    TAKT_ASSERT((int32_t)(h->end - h->here) > 0 && h->place.at >= 0.0);
    while (h->place.at >= 1.0 && h->here + 1 != h->end) {
        h->place.at -= 1.0;
        h->here++;
    }
}

bool takt_hold_step(struct hold *h, struct path *path, const struct reference *l, bool stop)
{
    TAKT_ASSERT(h->place.rate >= 0.0 && h->length > 0.0);
    takt_hold_read(h, path);
    h->step = stop == h->stops ? h->step : 1.0f;
    h->stops = stop;
    if (stop && h->place.rate == 0.0) {
        h->moved = 0.0;
        return true;
    }
    if (!stop && has_arrived(h, path, l)) {
        return false;
    }
    if (!find_step(h, path, l, stop)) {
        if (!is_changing(h)) {
            return false;
        }
        go_on_ending(h);
    }
    pass_blocks(h);
    return true;
}

/*
 * The last three places lie on u + r t + q t^2/2. Where that has turned back already the axes are
 * as good as at rest.
 */
bool takt_hold_begin(struct hold *h, struct path *path, const struct reference *l, double at,
                     const double way[2])
{
    const double fastest = maths_max(way[0], l->feed * PATH_UNITS_PER_MM);

    if (!takt_hold_look(h, path, at, fastest)) {
        return false;
    }
    h->step = 1.0f;
    h->place.change = (way[0] - way[1]) / h->length;
    h->place.rate = way[0] / h->length + 0.5 * h->place.change;
    h->ending.ease = 0.0;
    h->stops = true;
    h->top = maths_max(h->place.rate, (double)takt_hold_top(h, path, h->here));
    return h->place.rate > 0.0 && find_step(h, path, l, true);
}
