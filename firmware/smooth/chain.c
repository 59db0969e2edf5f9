/* What a chain of motions takes in, and its end. */
#include "smooth/smooth.h"

#include "base/assert.h"
#include "base/maths.h"
#include "smooth/parts.h"

/* Lines are merged within this part of the tolerance at most. */
#define MERGED 0.05

void takt_smooth_init(struct smooth *s, const struct smooth_limits *limits)
{
    TAKT_ASSERT(limits->cycle_s > 0.0);
    s->limits = *limits;
    takt_smooth_reset(s);
}

void takt_smooth_reset(struct smooth *s)
{
    s->expected = 0;
    takt_smooth_end(s);
}

void takt_smooth_end(struct smooth *s)
{
    s->chain = SMOOTH_NO_CHAIN;
    s->ready = 0;
    s->taken = 0;
}

bool takt_smooth_takes(const struct move *move, const struct curve *curve)
{
    if (move->path != PATH_BLEND || !(move->tolerance_mm > 0.0)) {
        return false;
    }
    if (move->kind >= MOVE_THREAD || move->feed_rev_mm != 0.0) {
        return false;
    }
    return !takt_curve_starts_at_cusp(curve) && !takt_curve_ends_at_cusp(curve);
}

/* Axes of the machine that it moves, by bit. */
static unsigned axes_of(const struct smooth *s, const struct curve *curve)
{
    struct curve_bounds b;
    unsigned axes = 0;

    takt_curve_bound(curve, &b);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        axes |= b.first[i] > 0.0 ? 1U << i : 0U;
    }
    return axes & s->limits.axes;
}

/*
 * One interval serves all of a chain: where an axis begins to move that needs a longer one, another
 * chain begins, and that takes it for all of these axes.
 */
static bool parts(struct smooth *s, const struct curve *curve)
{
    const unsigned axes = axes_of(s, curve);

    if (takt_fill_fits(s, axes)) {
        return false;
    }
    s->expected = s->route.moved | axes;
    return true;
}

/* Is it within the same tolerance as what is open? */
static bool is_alike(const struct smooth *s, const struct move *move)
{
    return !smooth_is_open(s) ||
           (!smooth_is_finished(s) && move->tolerance_mm == s->merge.move.tolerance_mm &&
            move->merge_mm == s->merge.move.merge_mm);
}

bool takt_smooth_joins(struct smooth *s, const struct move *move, const struct curve *curve)
{
    return is_alike(s, move) && (!smooth_is_open(s) || !parts(s, curve));
}

bool takt_smooth_has_room(const struct smooth *s)
{
    return !smooth_is_open(s) || (!smooth_is_finished(s) && takt_route_has_room(&s->route));
}

/*
 * How far merged lines may leave the programmed ends: G64 Q, but the tolerance is worth more to
 * smoothing.
 */
static double merged_within(const struct move *move)
{
    return maths_min(move->merge_mm, MERGED * move->tolerance_mm);
}

/* What merging may use of the tolerance is not there for smoothing. */
static void begin(struct smooth *s, const struct move *move)
{
    const double tolerance_mm = move->tolerance_mm - merged_within(move);
    struct smooth_limits limits = s->limits;

    TAKT_ASSERT(!smooth_is_open(s) && move->tolerance_mm > 0.0);
    takt_smooth_limit(&limits);
    takt_route_init(&s->route, &limits, tolerance_mm);
    s->route.moved = s->expected;
    s->expected = 0;
    s->window.count = 0;
    s->chain = SMOOTH_GROWS;
    s->ready = 0;
    s->taken = 0;
    s->told = 0;
    s->proved = 0;
    s->exact_mm = SMOOTH_NOWHERE_MM;
    s->since = (struct worth_since){.rate = 1.0f};
    s->standing = SMOOTH_STANDS_BEFORE;
    takt_order_start(&s->order, 0.0, 0);
    s->known_mm = 0.0;
    s->merge.lines = 0;
}

/* The newest line will not grow any more. */
static void close_merge(struct smooth *s)
{
    if (s->merge.lines > 0) {
        takt_route_push(&s->route, &s->merge.move, s->merge.number, &s->merge.curve);
        s->merge.lines = 0;
    }
}

void takt_smooth_push(struct smooth *s, const struct move *move, uint32_t number,
                      const struct curve *curve)
{
    TAKT_ASSERT(takt_smooth_has_room(s) && is_alike(s, move));
    if (!smooth_is_open(s)) {
        begin(s, move);
    }
    s->route.moved |= axes_of(s, curve);
    if (takt_merge_take(&s->merge, move, number, curve, merged_within(move))) {
        return;
    }
    close_merge(s);
    takt_merge_open(&s->merge, move, number, curve);
}

bool takt_smooth_is_line(const struct smooth *s)
{
    return s->chain == SMOOTH_GROWS && s->merge.lines == 1 && s->merge.curve.kind == CURVE_LINE &&
           s->route.count == 0;
}

void takt_smooth_finish(struct smooth *s)
{
    if (smooth_is_open(s)) {
        close_merge(s);
        s->chain = SMOOTH_FINISHED;
    }
}
