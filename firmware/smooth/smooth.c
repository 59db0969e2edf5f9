#include "smooth/smooth.h"

#include "base/maths.h"

#include <assert.h>
#include <string.h>

/* Rounds of smoothing and timing a window, and iterations of each; a chain's first window begins from nothing. */
#define ROUNDS       1
#define ROUNDS_FIRST 4
#define ITERATIONS   24

/* Lines are merged within this part of the tolerance at most. */
#define MERGED 0.05

/* How long the axes stand at both ends: a part of the rounding of changes of rate, and cycles. */
#define STANDING        1.75
#define STANDING_CYCLES 4.0

/* Smoothing aims at this part of the tolerance. */
#define AIM 0.90

/* Times that a window is slowed down because a piece leaves the tolerance. */
#define ATTEMPTS 16

/* Part of the tolerance that the chords between setpoints may take, for each axis. */
#define CHORD_PART 0.1

/* Nominal time between samples, as a part of the time in which the jerk crosses the tolerance, cbrt(P/J). */
#define INTERVAL_PART 0.7

void smooth_init(struct smooth *s, const struct smooth_limits *limits)
{
    s->limits = *limits;
    smooth_reset(s);
}

void smooth_reset(struct smooth *s)
{
    s->open = false;
    s->finished = false;
    s->ready = 0;
    s->taken = 0;
}

bool smooth_takes(const struct move *move, const struct curve *curve)
{
    if (move->path != PATH_BLEND || !(move->tolerance_mm > 0.0)) {
        return false;
    }
    if (move->kind >= MOVE_THREAD || move->feed_rev_mm != 0.0) {
        return false;
    }
    return !curve_starts_at_cusp(curve) && !curve_ends_at_cusp(curve);
}

bool smooth_joins(const struct smooth *s, const struct move *move)
{
    return !s->open || (!s->finished && move->tolerance_mm == s->merge.move.tolerance_mm &&
                        move->merge_mm == s->merge.move.merge_mm);
}

bool smooth_has_room(const struct smooth *s)
{
    return !s->open || (!s->finished && route_has_room(&s->route));
}

/* cbrt(P/J) of the axis with the most jerk, at least a cycle, at most a quarter of the longest A/J. */
static double interval_of(const struct smooth_limits *limits, double tolerance_mm)
{
    double jerk = 0.0;
    double ramp = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes >> i & 1U) != 0) {
            jerk = maths_max(jerk, limits->jerk_mm_s3[i]);
            ramp = maths_max(ramp, limits->acceleration_mm_s2[i] / limits->jerk_mm_s3[i]);
        }
    }
    const double interval = INTERVAL_PART * maths_cbrt(tolerance_mm / jerk);

    return maths_max(limits->cycle_s, maths_min(interval, 0.25 * ramp));
}

/* How far merged lines may leave the programmed ends: G64 Q, but the tolerance is worth more to smoothing. */
static double merged_within(const struct move *move)
{
    return maths_min(move->merge_mm, MERGED * move->tolerance_mm);
}

/*
 * A chord of one cycle leaves the curve by A cycle^2/8 at most: where that is much of the tolerance, less acceleration is
 * used.
 */
static void limit_chord(struct smooth_limits *limits, double tolerance_mm)
{
    const double t = limits->cycle_s * limits->cycle_s / 8.0;
    double square = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double weight = smooth_weight(i);

        limits->acceleration_mm_s2[i] =
            maths_min(limits->acceleration_mm_s2[i], CHORD_PART * tolerance_mm / (weight * t));
        if ((limits->axes >> i & 1U) != 0) {
            square +=
                limits->acceleration_mm_s2[i] * limits->acceleration_mm_s2[i] * weight * weight;
        }
    }
    limits->chord_mm = maths_sqrt(square) * t;
}

/* What merging may use of the tolerance is not there for smoothing. */
static void begin(struct smooth *s, const struct move *move)
{
    const double tolerance_mm = move->tolerance_mm - merged_within(move);
    struct smooth_limits limits = s->limits;

    limit_chord(&limits, tolerance_mm);
    route_init(&s->route, &limits, tolerance_mm);
    s->open = true;
    s->ready = 0;
    s->taken = 0;
    s->proved = 0;
    s->stops = false;
    s->starts = true;
    s->standing = 0;
    judge_change(&s->route.limits, &s->change);
    s->merge.open = false;
    s->window.count = 0;
    s->window.interval_s = interval_of(&limits, move->tolerance_mm);
}

/* The newest line will not grow any more. */
static void close_merge(struct smooth *s)
{
    if (s->merge.open) {
        route_push(&s->route, &s->merge.move, s->merge.number, &s->merge.curve);
        s->merge.open = false;
    }
}

void smooth_push(struct smooth *s, const struct move *move, uint32_t number,
                 const struct curve *curve)
{
    assert(smooth_has_room(s) && smooth_joins(s, move));
    if (!s->open) {
        begin(s, move);
    }
    if (merge_take(&s->merge, move, number, curve, merged_within(move))) {
        return;
    }
    close_merge(s);
    merge_open(&s->merge, move, number, curve);
}

void smooth_finish(struct smooth *s)
{
    if (s->open) {
        close_merge(s);
        s->finished = true;
    }
}

/* Is the end known, or so far away that the nominal feed does not feel it yet? */
static bool is_far_sighted(const struct smooth *s)
{
    const struct window *w = &s->window;
    const struct route_element *e = route_element(&s->route, w->element[w->count - 1]);
    const double ahead = route_end(&s->route) - w->at_mm[w->count - 1];

    if (s->finished || !route_has_room(&s->route)) {
        return true;
    }
    return !w->at_end && e->feed_mm_s * e->feed_mm_s <= 2.0 * e->along_mm_s2 * ahead;
}

/* Fills the window; false when more of the route must be known first. */
static bool fill(struct smooth *s)
{
    struct window *w = &s->window;

    if (s->route.count == 0) {
        return false;
    }
    if (w->count == 0) {
        window_start(w, &s->route);
    }
    /* The route's end was in the window, and it has gone on since. */
    if (w->at_end && w->at_mm[w->count - 1] < route_end(&s->route)) {
        w->count = SMOOTH_FIXED;
        w->at_end = false;
    }
    const unsigned before = w->count;

    window_extend(w, &s->route);
    if (!is_far_sighted(s)) {
        w->count = before;
        w->at_end = false;
        return false;
    }
    return true;
}

static void relax_and_locate(struct smooth *s)
{
    relax_window(&s->relax, &s->window, &s->route, AIM * s->route.tolerance_mm, ITERATIONS);
    window_locate(&s->window, &s->route);
}

/* With all known of a longer route in the window, one of so many pieces is kept: the others slow down to its end. */
#define BLIND_PART 2

/* Pieces before one that leaves the tolerance that are tried again with it: what they begin with binds it. */
#define MARGIN 12

/* Pieces that should keep the tolerance: more than are kept, so that the next ones can do it as well. */
static unsigned wanted(const struct smooth *s)
{
    const unsigned pieces = s->window.count - 3;

    return s->window.at_end || pieces < SMOOTH_SAMPLES_KEPT + MARGIN ? pieces
                                                                     : SMOOTH_SAMPLES_KEPT + MARGIN;
}

static unsigned judged(const struct smooth *s)
{
    return judge_pieces(&s->window, &s->route, wanted(s));
}

/* Pieces to keep when so many from the first on are good. */
static unsigned kept(const struct smooth *s, unsigned good)
{
    const struct window *w = &s->window;

    if (w->at_end && !s->finished) {
        return (good + BLIND_PART - 1) / BLIND_PART;
    }
    if (w->at_end && good == w->count - 3) {
        return good;
    }
    if (good >= SMOOTH_SAMPLES_KEPT + MARGIN) {
        return SMOOTH_SAMPLES_KEPT;
    }
    return good > MARGIN ? good - MARGIN : 0;
}

/*
 * No way on has been found in motion: what was proved the last time is gone to its end, and come to rest there. From rest,
 * inside the tolerance, every way is open again.
 */
static void fall_back(struct smooth *s)
{
    s->ready = s->before_proved;
    s->proved = 0;
    s->stops = s->ready > 0;
    if (s->stops) {
        s->window = s->before;
    } else {
        s->ready = 1;
    }
}

/*
 * Where a piece leaves the tolerance, it is slowed down: the slower, the nearer the samples are to each other and the
 * curve to them. What comes well before it is kept, the rest is tried again with the next window.
 */
static void smooth_window(struct smooth *s)
{
    const unsigned rounds = s->proved > 0 ? ROUNDS : ROUNDS_FIRST;
    unsigned good = 0;

    s->before = s->window;
    s->before_proved = s->proved;
    for (unsigned i = 0; i < rounds; i++) {
        relax_and_locate(s);
        timing_again(&s->timing, &s->window, &s->route, &s->change);
        window_extend(&s->window, &s->route);
    }
    relax_and_locate(s);
    good = judged(s);
    for (unsigned i = 0; i < ATTEMPTS && good < wanted(s); i++) {
        timing_slow(&s->timing, &s->window, good);
        window_extend(&s->window, &s->route);
        relax_and_locate(s);
        good = judged(s);
    }
    s->ready = kept(s, good);
    s->proved = good - s->ready;
    if (s->ready == 0) {
        fall_back(s);
    }
}

static void set_piece(const struct smooth *s, struct smooth_piece *piece)
{
    const struct window *w = &s->window;
    const unsigned i = s->taken;
    const struct route_element *e = route_element(&s->route, w->element[i + 1]);
    struct judge_need need;

    piece->move = &e->move;
    piece->number = e->number;
    piece->interval_s = w->interval_s;
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        for (unsigned k = 0; k < 4; k++) {
            piece->control[k].at[axis] = w->x[axis][i + k];
        }
    }
    judge_need(w, &s->route, i, &need);
    judge_rate(&need, e, &s->route.limits, &s->change, &piece->rate);
    piece->change = s->change;
    piece->rate.most = maths_min(piece->rate.most, 1.0);
    piece->stop = s->stops && s->taken + 1 == s->ready;
    piece->last = s->finished && w->at_end && i + 4 == w->count;
}

/*
 * At both ends of what begins and ends at rest by itself the axes stand for a while, and the rate of nominal time rises and falls: in half
 * of what it is rounded over, and as long again until the setpoint has come so far.
 */
static unsigned standing_pieces(const struct smooth *s)
{
    const double needed_s = STANDING * s->change.rounding_s + STANDING_CYCLES * s->limits.cycle_s;

    return (unsigned)(needed_s / s->window.interval_s) + 1;
}

/* at: where the axes stand; of: the piece before or behind. */
static void stand(struct smooth *s, const struct smooth_piece *of, const struct point *at,
                  bool leaves)
{
    s->stand = *of;
    s->stand.stop = false;
    s->stand.last = false;
    s->stand.rate.most = 1.0;
    s->stand.rate.programmed = MATHS_INFINITY;
    s->stand.change.by = 2.0 / s->change.rounding_s;
    s->stand.change.rounded = s->stand.change.by / s->change.rounding_s;
    for (unsigned i = 0; i < 4; i++) {
        s->stand.control[i] = *at;
    }
    s->standing = standing_pieces(s);
    s->leaves = leaves;
}

static void take_standing(struct smooth *s, struct smooth_piece *piece)
{
    *piece = s->stand;
    s->standing--;
    if (s->standing > 0 || s->leaves) {
        return;
    }
    piece->last = true;
    smooth_reset(s);
}

/* The window for the next pieces; false when more must be known first. */
static bool next_window(struct smooth *s)
{
    window_drop(&s->window, s->taken);
    s->taken = 0;
    s->ready = 0;
    if (s->stops) {
        window_rest(&s->window);
        s->stops = false;
        s->starts = true;
    }
    if (s->window.count > 0) {
        route_forget(&s->route, s->window.at_mm[0]);
    }
    if (!fill(s)) {
        return false;
    }
    smooth_window(s);
    return true;
}

bool smooth_take(struct smooth *s, struct smooth_piece *piece)
{
    if (!s->open) {
        return false;
    }
    if (s->standing > 0) {
        take_standing(s, piece);
        return true;
    }
    if (s->taken == s->ready && !next_window(s)) {
        return false;
    }
    set_piece(s, piece);
    if (s->starts) {
        s->starts = false;
        stand(s, piece, &piece->control[0], true);
        take_standing(s, piece);
        return true;
    }
    s->taken++;
    if (piece->last) {
        const struct smooth_piece end = *piece;

        stand(s, &end, &end.control[3], false);
        piece->last = false;
    }
    return true;
}
