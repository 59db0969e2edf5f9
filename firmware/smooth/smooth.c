#include "smooth/smooth.h"

#include "base/maths.h"
#include "smooth/interval.h"
#include "smooth/nominal.h"
#include "smooth/single.h"
#include "smooth/straight.h"

#include <assert.h>
#include <string.h>

/* Rounds of smoothing and timing a window. A chain's first one begins from nothing. */
#define ROUNDS       1
#define ROUNDS_FIRST 4

/* So many sixteenths of the window's pieces are kept each time. */
#define KEPT_SIXTEENTHS 9U
/* Lines are merged within this part of the tolerance at most. */
#define MERGED 0.05

/* How long the axes stand at both ends: a part of the rounding of changes of rate, and cycles. */
#define STANDING        1.75
#define STANDING_CYCLES 4.0

/* Smoothing aims at this part of the tolerance. */
#define AIM 0.90

/* Times that a window is slowed down because a piece leaves the tolerance. */
#define ATTEMPTS 16

/* Of what it left the tolerance by before, a slower piece leaves it by so much at most, or slower is no help. */
#define NEARER 0.95f

/* What a microcontroller is ready to give for smoothing. */
_Static_assert(sizeof(struct smooth) + sizeof(union smooth_scratch) <= 27UL * 1024UL,
               "too much memory");

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

/* How far merged lines may leave the programmed ends: G64 Q, but the tolerance is worth more to smoothing. */
static double merged_within(const struct move *move)
{
    return maths_min(move->merge_mm, MERGED * move->tolerance_mm);
}

/* Near a place where the curve stood no axis comes far; elsewhere none is to need many windows for its ramps. */
static double interval_for(const struct smooth *s, double tolerance_mm)
{
    const bool near = stall_is_near(&s->stall, s->route.tolerance_mm);

    return interval_of(&s->limits, &s->route, tolerance_mm, near ? 0 : window_capacity(&s->route));
}

/* The time between samples, and what depends on it; the window is empty. */
static void set_interval(struct smooth *s, double tolerance_mm)
{
    const double interval_s = interval_for(s, tolerance_mm);
    struct smooth_limits limits = s->limits;

    smooth_limit(&limits, s->route.tolerance_mm);
    s->moved = s->route.moved;
    judge_change(&limits, interval_s, &s->change);
    s->route.slots.change_per_s = (float)s->change.by;
    s->route.slots.rounded_per_s2 = (float)s->change.rounded;
    s->route.chord_per_bend =
        (float)(limits.cycle_s * limits.cycle_s / (8.0 * interval_s * interval_s));
    window_init(&s->window, &s->route, interval_s);
}

/* What merging may use of the tolerance is not there for smoothing. */
static void begin(struct smooth *s, const struct move *move)
{
    const double tolerance_mm = move->tolerance_mm - merged_within(move);
    struct smooth_limits limits = s->limits;

    smooth_limit(&limits, tolerance_mm);
    route_init(&s->route, &limits, tolerance_mm);
    s->window.count = 0;
    s->open = true;
    s->ready = 0;
    s->taken = 0;
    s->told = 0;
    s->proved = 0;
    s->stops = false;
    s->anew_mm = 0.0;
    s->starts = true;
    s->standing = 0;
    order_start(&s->order, 0.0, 0);
    s->known_mm = 0.0;
    s->tried_mm = 0.0;
    s->tried = 0;
    stall_start(&s->stall, tolerance_mm);
    s->merge.open = false;
}

/* Another tolerance from here on, where the axes stand. */
static void begin_anew(struct smooth *s, double tolerance_mm)
{
    struct smooth_limits limits = s->limits;

    smooth_limit(&limits, tolerance_mm);
    route_limit(&s->route, &limits, tolerance_mm);
    nominal_again(&s->route);
    set_interval(s, tolerance_mm);
    s->window.count = SMOOTH_FIXED;
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

bool smooth_is_line(const struct smooth *s)
{
    return s->open && !s->finished && s->merge.open && s->merge.curve.kind == CURVE_LINE &&
           s->merge.points == 0 && s->route.count == 0;
}

void smooth_finish(struct smooth *s)
{
    if (s->open) {
        close_merge(s);
        s->finished = true;
    }
}

/* Is the nominal feed at a place lower because the route is known no farther than so? */
static bool feels_end(const struct smooth *s, double at_mm, uint32_t element, double known_mm)
{
    const struct route_element *e = route_element(&s->route, element);
    const float ahead = (float)(known_mm - at_mm);

    return braking_way(&e->along, e->feed_mm_s, 0.0f, 0.0f) > ahead;
}

static bool last_feels_end(const struct smooth *s, double known_mm)
{
    const unsigned last = s->window.count - 1;

    return feels_end(s, s->window.at_mm[last], s->window.element[last], known_mm);
}

/* Is the end known, or no more of the route can be? */
static bool is_all_known(const struct smooth *s)
{
    return s->finished || !route_has_room(&s->route);
}

/* The route has gone on since: samples that were slow before its end only, or that end itself, are taken anew. */
static void forget_end(struct smooth *s)
{
    struct window *w = &s->window;

    if (w->count <= SMOOTH_FIXED || !(s->known_mm < route_end(&s->route))) {
        return;
    }
    w->at_end = false;
    while (w->count > SMOOTH_FIXED && last_feels_end(s, s->known_mm)) {
        w->count--;
    }
}

/* Fills the window; false when more of the route must be known first. */
static bool fill(struct smooth *s)
{
    struct window *w = &s->window;

    if (s->route.count == 0 ||
        (!is_all_known(s) && feels_end(s, s->tried_mm, s->tried, route_end(&s->route)))) {
        return false;
    }
    if (w->count == 0) {
        set_interval(s, s->merge.move.tolerance_mm);
        window_start(w, &s->route);
    }
    forget_end(s);
    const unsigned before = w->count;

    window_extend(w, &s->route);
    s->tried_mm = w->at_mm[w->count - 1];
    s->tried = w->element[w->count - 1];
    if (!is_all_known(s) && (w->at_end || last_feels_end(s, route_end(&s->route)))) {
        w->count = before;
        w->at_end = false;
        return false;
    }
    s->known_mm = route_end(&s->route);
    return true;
}

static void relax_and_locate(struct smooth *s, union smooth_scratch *scratch)
{
    relax_window(&scratch->relax, &s->window, &s->route, AIM * s->route.tolerance_mm);
    window_locate(&s->window, &s->route);
}

/* With all known of a longer route in the window, one of so many pieces is kept: the others slow down to its end. */
#define BLIND_PART 2

/* Pieces before one that leaves the tolerance that are tried again with it: what they begin with binds it. */
#define MARGIN 12

static unsigned kept_most(const struct smooth *s)
{
    return s->window.capacity * KEPT_SIXTEENTHS / 16U;
}

/* Pieces that should keep the tolerance: more than are kept, so that the next ones can do it as well. */
static unsigned wanted(const struct smooth *s)
{
    const unsigned pieces = s->window.count - 3;
    const unsigned enough = kept_most(s) + MARGIN;

    return s->window.at_end || pieces < enough ? pieces : enough;
}

static void judged(struct smooth *s, struct judge_verdict *v)
{
    judge_pieces(&s->window, &s->route, wanted(s), kept_most(s), &s->order, v);
}

/* Do so many pieces come to the end of the chain? */
static bool is_end(const struct smooth *s, unsigned pieces)
{
    return s->finished && s->window.at_end && pieces == s->window.count - 3;
}

/* Pieces to keep when so many from the first on are good. */
static unsigned kept(const struct smooth *s, unsigned good)
{
    const struct window *w = &s->window;

    if (w->at_end && !s->finished) {
        return good / BLIND_PART;
    }
    if (is_end(s, good)) {
        return good;
    }
    if (good >= kept_most(s) + MARGIN) {
        return kept_most(s);
    }
    return good > MARGIN ? good - MARGIN : 0;
}

static void keep_head(struct smooth *s)
{
    struct smooth_head *h = &s->head;
    const struct window *w = &s->window;

    const unsigned most = SMOOTH_HEAD_MAX / s->route.slots.groups;

    h->proved = s->proved + SMOOTH_FIXED < most ? s->proved : most - SMOOTH_FIXED;
    memcpy(h->origin, w->origin, sizeof h->origin);
    for (unsigned i = 0; i < most && i < w->count; i++) {
        h->at_mm[i] = w->at_mm[i];
        h->element[i] = w->element[i];
        for (unsigned g = 0; g < s->route.slots.groups; g++) {
            h->x[g * most + i] = w->x[g * w->capacity + i];
        }
    }
}

/*
 * No way on has been found in motion: what was proved the last time is gone to its end, and come to rest there. From rest,
 * inside the tolerance, every way is open again; and where there seems to be none, straight on is one.
 */
static void fall_back(struct smooth *s)
{
    const struct smooth_head *h = &s->head;
    const unsigned most = SMOOTH_HEAD_MAX / s->route.slots.groups;
    struct window *w = &s->window;

    s->ready = h->proved;
    s->proved = 0;
    s->stops = true;
    if (s->ready == 0) {
        s->ready = straight_on(w, &s->route);
        return;
    }
    memcpy(w->origin, h->origin, sizeof h->origin);
    w->count = h->proved + SMOOTH_FIXED;
    w->at_end = false;
    for (unsigned i = 0; i < w->count; i++) {
        w->at_mm[i] = h->at_mm[i];
        w->element[i] = h->element[i];
        for (unsigned g = 0; g < s->route.slots.groups; g++) {
            w->x[g * w->capacity + i] = h->x[g * most + i];
        }
    }
}

/* The curve as it is, timed once more: where it does not keep the tolerance so, it stays as it was. */
static void time_last(struct smooth *s, union smooth_scratch *scratch, struct judge_verdict *v)
{
    struct judge_verdict again;

    timing_again(&scratch->timing, &s->window, &s->route);
    window_extend(&s->window, &s->route);
    window_locate(&s->window, &s->route);
    judged(s, &again);
    if (again.good >= wanted(s)) {
        *v = again;
        return;
    }
    s->window = scratch->timing.window;
}

/*
 * Where a piece leaves the tolerance, it is slowed down: the slower, the nearer the samples are to each other and the curve to
 * them. Where that brings it no nearer the curve would only come there later and later. A corner that was left out is
 * noticed some way behind it: it is slow where all was whole.
 */
static void slow_down(struct smooth *s, union smooth_scratch *scratch, struct judge_verdict *v)
{
    float before_mm = SINGLE_INFINITY;

    judged(s, v);
    for (unsigned i = 0; i < ATTEMPTS && v->good < wanted(s); i++) {
        if (v->beyond_mm > NEARER * before_mm) {
            break;
        }
        before_mm = v->beyond_mm > 0.0f ? v->beyond_mm : SINGLE_INFINITY;
        timing_slow(&scratch->timing, &s->window, &s->route, v->whole[v->good]);
        window_extend(&s->window, &s->route);
        relax_and_locate(s, scratch);
        judged(s, v);
    }
}

/* The order goes on to the end of what is handed on; where the axes went back to the route it begins there. */
static void follow_ready(struct smooth *s, const struct judge_verdict *v)
{
    if (s->ready == v->followed && !s->stops) {
        s->order = v->order;
    } else {
        judge_order(&s->window, &s->route, s->ready, &s->order);
    }
    if (s->order.count == 0) {
        order_start(&s->order, s->window.at_mm[s->ready + 1], s->window.element[s->ready + 1]);
    }
}

/* Has an axis begun to move whose ramps are longer? */
static bool needs_other_interval(struct smooth *s)
{
    const bool more = s->moved != s->route.moved;

    s->moved = s->route.moved;
    return more && interval_for(s, s->route.tolerance_mm) > s->window.interval_s;
}

/* Must the axes rest where what was proved last ends: because no way on has been found, or for another tolerance? */
static bool does_not_go_on(struct smooth *s, const struct judge_verdict *v)
{
    const unsigned whole = v->whole[v->good];
    const bool rests = s->ready == 0 || (s->proved == 0 && !is_end(s, whole));
    const struct stall_window now = {
        .rests = rests, .ready = s->ready, .most = kept_most(s), .good = v->good, .whole = whole};
    const bool stands = stall_stands(&s->stall, &s->window, &s->route, &now);

    s->anew_mm = stands || s->head.proved > 0
                     ? stall_tolerance(&s->stall, &s->window, &s->route, s->ready, stands)
                     : 0.0;
    if (s->anew_mm == 0.0 && needs_other_interval(s)) {
        s->anew_mm = s->route.tolerance_mm;
    }
    return rests || stands || s->anew_mm > 0.0;
}

/* What comes well before a piece that leaves the tolerance is kept, the rest is tried again with the next window. */
static void smooth_window(struct smooth *s, union smooth_scratch *scratch)
{
    const bool goes_on = s->head.proved > 0;
    const unsigned rounds = goes_on ? ROUNDS : ROUNDS_FIRST;
    struct judge_verdict v;

    for (unsigned i = 0; i < rounds; i++) {
        relax_and_locate(s, scratch);
        timing_again(&scratch->timing, &s->window, &s->route);
        window_extend(&s->window, &s->route);
    }
    relax_and_locate(s, scratch);
    slow_down(s, scratch, &v);
    time_last(s, scratch, &v);
    s->ends = s->finished && s->window.at_end;
    const unsigned good = v.whole[v.good];

    s->ready = v.whole[kept(s, good)];
    s->proved = good - s->ready;
    if (does_not_go_on(s, &v)) {
        fall_back(s);
    }
    follow_ready(s, &v);
}

/* Control point of a piece; exactly the programmed end where it is that. */
static void set_control(const struct smooth *s, unsigned i, struct point *control)
{
    const struct window *w = &s->window;
    const bool end = s->ends && w->at_end && i + SMOOTH_FIXED >= w->count;
    double p[AXIS_COUNT];

    window_sample(w, &s->route, i, p);
    memset(control, 0, sizeof(*control));
    for (unsigned k = 0; k < s->route.slots.count; k++) {
        control->at[s->route.slots.axis[k]] = end ? s->route.end[k] : p[k];
    }
}

/* After a stop the curve goes on from where it can have come to, which may be before where it was thought to be. */
static uint32_t latest_told(struct smooth *s, uint32_t element)
{
    s->told = element < s->told ? s->told : element;
    return s->told;
}

static void set_piece(struct smooth *s, struct smooth_piece *piece)
{
    const struct window *w = &s->window;
    const unsigned i = s->taken;
    const uint32_t element = w->element[i + 1];
    const uint32_t told = latest_told(s, element);
    struct judge_need need;
    struct judge_rate rate;

    route_move(&s->route, told, &s->move);
    piece->move = &s->move;
    piece->number = route_element(&s->route, told)->number;
    piece->rotary = route_element(&s->route, element)->rotary;
    piece->interval_s = w->interval_s;
    for (unsigned k = 0; k < 4; k++) {
        set_control(s, i + k, &piece->control[k]);
    }
    judge_need(w, &s->route, i, &need);
    judge_rate(&need, &s->route, s->route.first + w->paced[i], &s->change, &rate);
    piece->rate.most = maths_min((double)rate.most, 1.0);
    piece->rate.programmed = (double)rate.programmed;
    piece->change.by =
        (double)judge_change_on(&need, &s->route, &s->change, (float)piece->rate.most);
    piece->change.rounded = piece->change.by / s->change.rounding_s;
    piece->stop = s->stops && s->taken + 1 == s->ready;
    piece->last = s->finished && w->at_end && i + 4 == w->count;
}

/*
 * At both ends of what begins and ends at rest by itself the axes stand for a while, and the rate of nominal time rises and
 * falls: in half of what it is rounded over, and as long again until the setpoint has come so far.
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
    s->stand_rotary = of->rotary;
    s->stand_number = of->number;
    s->stand_at = *at;
    s->standing = standing_pieces(s);
    s->leaves = leaves;
}

static void take_standing(struct smooth *s, struct smooth_piece *piece)
{
    const double change_per_s = 2.0 / s->change.rounding_s;
    const struct point at = s->stand_at;

    s->standing--;
    *piece = (struct smooth_piece){
        .move = &s->move,
        .number = s->stand_number,
        .control = {at, at, at, at},
        .interval_s = s->window.interval_s,
        .rate = {.most = 1.0, .programmed = MATHS_INFINITY},
        .change = {.by = change_per_s, .rounded = change_per_s / s->change.rounding_s},
        .rotary = s->stand_rotary,
        .last = s->standing == 0 && !s->leaves,
    };
    if (piece->last) {
        smooth_reset(s);
    }
}

/* Pieces that have been taken leave the window, elements that they have passed the route. */
static void drop_taken(struct smooth *s)
{
    window_drop(&s->window, &s->route, s->taken);
    s->taken = 0;
    s->ready = 0;
    if (s->stops) {
        window_rest(&s->window, &s->route, &s->order);
        stall_rest(&s->stall, s->window.at_mm[0]);
        s->stops = false;
        s->starts = true;
        s->proved = 0;
    }
    if (s->anew_mm > 0.0) {
        begin_anew(s, s->anew_mm);
        s->anew_mm = 0.0;
    }
    if (s->window.count > 0) {
        route_forget(&s->route, s->window.at_mm[0]);
    }
}

/* The window for the next pieces; false when more must be known first. */
static bool next_window(struct smooth *s, union smooth_scratch *scratch)
{
    drop_taken(s);
    keep_head(s);
    if (!fill(s)) {
        return false;
    }
    smooth_window(s, scratch);
    return true;
}

bool smooth_take(struct smooth *s, union smooth_scratch *scratch, struct smooth_piece *piece)
{
    if (!s->open) {
        return false;
    }
    if (s->standing > 0) {
        take_standing(s, piece);
        return true;
    }
    if (s->taken == s->ready && !next_window(s, scratch)) {
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
        stand(s, piece, &piece->control[3], false);
        piece->last = false;
    }
    return true;
}
