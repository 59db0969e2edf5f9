/*
 * Goal: every motion in which it can still come to rest ends at rest, exactly at its end, whenever
 * that is asked for and taken back (single block).
 *
 * The ceilings know nothing of it: in them the motion is passed. The trapezoidal reference alone
 * halts, as in a hold, but at the next end E of a motion in its span, if it can come to rest there:
 *
 *     w^2 <= 2 a (E - s - w k)
 *
 * with k the cycles until it may brake, a the lowest acceleration of the piece that it is in, of
 * the motion's blocks and of the junction that ends the span. It speeds up only so far that this
 * holds when it may brake again, and takes on the acceleration of what is behind E only if it holds
 * with that; until then it keeps the one it had (reference_place.c). Wherever a hold keeps the
 * limits so does a halt: no window, junction or promise of a ceiling depends on the operator's
 * switch.
 *
 * Too fast for the next end it slows down as in a hold, and so on until there is one that it can
 * rest at. If that end is a junction which has to be landed on in motion, the next one is in the
 * span behind. The ceiling's own stops need nothing.
 *
 *     feed |  ___                          ends of motions |, the trapezoidal reference at s: the first two are too near, it halts
 *          |     \_                        at E
 *          |       |\_|_____
 *          +-----s-+--+-----\E------------> position
 *
 * Rejected: stops in the ceilings, from a block on that is far enough when one is asked for.
 * Another window of the span before, a junction landed on in between, where the trapezoidal
 * reference is set half a window ahead, or less acceleration behind it brought the trapezoidal
 * reference to such a stop too fast: 25 times the acceleration, and back on the path. Windows that
 * a stop had made were promised to spans that were none when it was taken back.
 */
#include "base/assert.h"
#include "motion/reference_private.h"

#include "base/maths.h"
#include "plan/path.h"
#include "plan/span.h"

/*
 * Blocks that are gone on by in a cycle, at most: twice what the trapezoidal reference can pass in
 * it (plan/block.c).
 */
#define BLOCKS_MAX 16

bool takt_reference_has_halted(const struct reference *l)
{
    return reference_halts(l) && l->feed == 0.0 && l->at == l->halt.end;
}

void takt_reference_leave_halt(struct reference *l)
{
    TAKT_ASSERT(takt_reference_has_halted(l));
    l->halt.left = l->halt.end;
    l->halt.state = reference_seeks(l) ? REFERENCE_SEEKS : REFERENCE_PASSES;
}

/* Cycles until it may brake. */
static double waiting(const struct reference *l)
{
    return maths_max(0.0, l->window - (double)l->since_plus);
}

/* By how much feed squared is below what it may be; < 0: it is above. */
static double spare_feed_squared(const struct reference *l, double a)
{
    return 2.0 * a * (path_mm(l->at, l->halt.end) - l->feed * waiting(l)) - maths_square(l->feed);
}

bool takt_reference_can_halt(const struct reference *l, double a)
{
    return spare_feed_squared(l, a) >= REFERENCE_FEED_SQUARED_SLACK * maths_square(l->feed);
}

/*
 * Rounding, and a last cycle of braking that is a little harder, take back no end that has been
 * found.
 */
static bool keeps_halt(const struct reference *l, double a)
{
    return spare_feed_squared(l, a) >= -REFERENCE_FEED_SQUARED_SLACK * maths_square(l->feed) -
                                           2.0 * REFERENCE_REST_PART * maths_square(a);
}

/* What the end itself and the place that it is in allow. */
static double free_acceleration(const struct reference *l)
{
    return reference_has_piece(l) ? maths_min(l->halt.a, reference_acceleration(l)) : l->halt.a;
}

/*
 * Not harder than the junction behind allows: it can be rested at too when the halt is taken back
 * (can_rest_before).
 */
static double junction_acceleration(const struct reference *l)
{
    const uint32_t landing = reference_landing(l);
    const double a = free_acceleration(l);

    return landing == CEILING_NONE
               ? a
               : maths_min(a, (double)reference_piece(l, landing)->acceleration);
}

/*
 * A junction that came into view since the end was found may allow less than what it takes to rest
 * there, w^2 / 2 (E - s - w k). The end is kept, and not taken back.
 */
static bool is_bound(const struct reference *l)
{
    return reference_halts(l) && l->feed > 0.0 && !keeps_halt(l, junction_acceleration(l)) &&
           keeps_halt(l, free_acceleration(l));
}

double takt_reference_halt_acceleration(const struct reference *l)
{
    const double gap = path_mm(l->at, l->halt.end) - l->feed * waiting(l);

    TAKT_ASSERT(l->halt.span == l->span || reference_halts(l)); /* one that binds is kept */
    return is_bound(l) ? maths_min(free_acceleration(l), 0.5 * maths_square(l->feed) / gap)
                       : junction_acceleration(l);
}

static bool can_rest(const struct reference *l)
{
    const double a = takt_reference_halt_acceleration(l);

    return l->feed == 0.0 || takt_reference_can_halt(l, a) ||
           (reference_halts(l) && keeps_halt(l, a));
}

void takt_reference_end_blocks(struct reference *l, bool on)
{
    l->halt.span = l->span - 1; /* the next end is looked for anew */
    if (on) {
        l->halt.state = reference_halts(l) ? REFERENCE_HALTS : REFERENCE_SEEKS;
    } else {
        l->halt.state = is_bound(l) ? REFERENCE_HALTS_ONCE : REFERENCE_PASSES;
    }
}

/* The block begins a motion, or goes on with that of the one before. */
static void look_at(struct reference *l, const struct path *path, uint32_t block, bool begins)
{
    const double a = takt_ceiling_block_acceleration(path, block, l->cycles);

    TAKT_ASSERT(path_at(path, block)->motion);
    l->halt.block = block;
    l->halt.end = path_end(path, block);
    l->halt.a = begins ? a : maths_min(l->halt.a, a);
    TAKT_ASSERT(l->halt.a > 0.0);
}

/* From the setpoint's block on, or the one behind if that ends where the span starts. */
static void begin(struct reference *l, const struct path *path)
{
    const bool before = reference_is_beyond(l->span, path_end(path, path->first));

    l->halt.span = l->span;
    look_at(l, path, before ? path->first + 1 : path->first, true);
}

/* Does the block end a motion, ahead, and has not been left? */
static bool is_end_ahead(const struct reference *l, const struct path *path)
{
    const struct reference_halt *h = &l->halt;

    return !path_at(path, h->block)->continues && reference_is_beyond(h->end, l->at) &&
           !reference_is_beyond(h->left, h->end);
}

/* Is it the last one of the span, or of all that is known? */
static bool is_last(const struct ceiling *c, uint32_t block)
{
    return takt_span_stops(c->path, block) || takt_span_lands(c->path, block) ||
           block + 1 == c->first + c->piece[c->count - 1].leave;
}

/* Goes on to the next end of a motion, in its span. False: none is known. */
static bool find_end(struct reference *l, const struct ceiling *c)
{
    const bool passed = (int32_t)(l->halt.block - c->path->first) < 0;

    TAKT_ASSERT(c->count > 0); /* it is in a span */
    if (passed || l->halt.span != l->span) {
        begin(l, c->path);
    }
    for (unsigned i = 0; i < BLOCKS_MAX && !is_end_ahead(l, c->path); i++) {
        if (is_last(c, l->halt.block)) {
            return false;
        }
        look_at(l, c->path, l->halt.block + 1, !path_at(c->path, l->halt.block)->continues);
    }
    return is_end_ahead(l, c->path) && !takt_span_stops(c->path, l->halt.block);
}

bool takt_reference_seek_halt(struct reference *l)
{
    struct reference_halt *h = &l->halt;
    const uint64_t end = h->end;

    if (l->run.phase == LANDING_ACTIVE || !find_end(l, l->here.ceiling)) {
        h->state = REFERENCE_SEEKS;
        return false;
    }
    h->state = h->end == end ? h->state : REFERENCE_SEEKS;
    h->state = can_rest(l) ? REFERENCE_HALTS : REFERENCE_SEEKS;
    return h->state == REFERENCE_SEEKS;
}
