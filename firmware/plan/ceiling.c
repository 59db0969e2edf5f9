/*
 * Goal: the highest feed of the trapezoidal reference everywhere, from which the rest of the window
 * can be met and stopped, in time linear in blocks. How the pieces lie against the blocks, and why
 * limits then hold for the setpoint, is in spans.md.
 *
 * Forward: one piece for each ceiling, shifted by half the averaging window times its feed; and
 * where a block's acceleration is lower than what lies there, that from half the window times its
 * highest feed before it on. Backward (ceiling_backward.c): the feed at the end of each piece, by
 * constant deceleration: u = min(c^2, u_next + 2 a L).
 */
#include "plan/ceiling.h"

#include "base/assert.h"
#include "base/maths.h"
#include "plan/ceiling_backward.h"
#include "plan/path.h"
#include "plan/path_unit.h"
#include "plan/span.h"

_Static_assert(CEILING_PIECES_MAX < CEILING_NONE, "pieces fit into ceiling_piece.landing");
_Static_assert(PATH_BLOCKS_MAX < 1 << 9, "blocks fit into ceiling_piece.start");
_Static_assert(sizeof(struct ceiling_piece) == 20, "no padding");

/*
 * Between being asked for and being taken a ceiling grows this many cycles old at most
 * (MOTION_EXCHANGE_CYCLES and the cycles of taking it).
 */
#define AGE_CYCLES 64.0

/*
 * Lower accelerations of blocks left behind, that the setpoint still has to keep: at most this many
 * at once.
 */
#define TRAILING_MAX 16

/*
 * A junction feed that the trapezoidal reference reaches from rest in this many cycles is not worth
 * passing: it comes to rest.
 */
#define PASS_WORTH 2.0

struct trailing_limit {
    double a;
    double end_mm;
};

struct builder {
    struct ceiling *c;
    struct path *path;
    const struct ceiling_request *request;
    double cycle_s;
    uint32_t cycles; /* of the first box, in the span being laid */
    /* cycles that the setpoint follows behind the trapezoidal reference, with the margin */
    double behind;
    double begin_mm; /* where the newest ceiling begins, */
    /* and where it would at the highest override: its acceleration counts from there on */
    double early_mm;
    double fastest;  /* the highest feed of those laid so far */
    double gentlest; /* and the lowest acceleration */
    uint32_t start;  /* block that begins what is being laid */
    unsigned trailing_count;
    struct trailing_limit trailing[TRAILING_MAX]; /* both rising */
};

/* As programmed, or so much per revolution as it turns now. */
static double program_feed(const struct path *path, uint32_t index,
                           const struct ceiling_request *request)
{
    const struct path_block *b = path_at(path, index);
    const double measured =
        b->per_revolution ? takt_path_feed_rev(path, index) * request->spindle_rev_s : 0.0;

    return measured > 0.0 ? measured : (double)b->feed_program_mm_s;
}

double takt_ceiling_block_feed(const struct path *path, uint32_t index,
                               const struct ceiling_request *request)
{
    const struct path_block *b = path_at(path, index);
    const double ratio = b->rapid ? request->rapid_ratio : b->may_feed ? request->feed_ratio : 1.0;
    const double program = program_feed(path, index, request);
    const double top = takt_path_block_top(b);

    if (b->rapid || (request->proportional && ratio < 1.0)) {
        return ratio * maths_min(program, top);
    }
    return maths_min(ratio * program, top);
}

double takt_ceiling_block_acceleration(const struct path *path, uint32_t index, uint32_t cycles)
{
    const struct path_block *b = path_at(path, index);
    const double t = path->limits.cycle_s;
    const double a =
        maths_min((double)b->a_mm_s2 * (t * t), (double)b->j_mm_s3 * (t * t * t * (double)cycles));

    return (double)takt_maths_float_below(a);
}

/*
 * Could the trapezoidal reference not come to rest before a place any more when this ceiling is
 * taken? By then it has gone on at its feed, which it keeps for a window before it brakes: w
 * t + w^2 / 2 a.
 */
static bool is_near(const struct builder *s, uint64_t at)
{
    const double cycles = AGE_CYCLES + 2.0 * s->behind + 0.5 * s->fastest / s->gentlest;

    return path_mm(s->request->reference, at) <= s->fastest * cycles;
}

/*
 * The window of a span is a promise to a trapezoidal reference that has begun it, or may begin it
 * or land at its start under the ceiling made before; to others it is found anew until all of the
 * span is known.
 */
static uint32_t promise_window(struct builder *s, uint32_t index)
{
    const struct ceiling_request *request = s->request;
    const struct path_block *b = path_at(s->path, index);
    const bool inside = index == request->first && (int64_t)(request->reference - b->start) > 0;
    bool known = b->cycles_known;
    uint32_t cycles = b->cycles;

    if (inside || (int64_t)(request->span - b->start) >= 0) {
        cycles = request->cycles;
    } else if (cycles == 0 || !(known || is_near(s, b->start))) {
        cycles = takt_span_window(s->path, request, index, &known);
    }
    TAKT_ASSERT(cycles <= takt_ramp_profile_cycles_max(s->path->limits.profile));
    takt_ring_promise(&s->path->ring, index, cycles, known);
    return cycles;
}

/* The span that begins with the block at index. */
static void begin_span(struct builder *s, uint32_t index)
{
    const uint64_t start = path_at(s->path, index)->start;

    s->cycles = promise_window(s, index);
    s->behind =
        0.5 * ((double)takt_ramp_profile_window_cycles(s->path->limits.profile, s->cycles) - 1.0) +
        CEILING_MARGIN_CYCLES;
    s->begin_mm = path_mm(s->c->origin, start);
    s->early_mm = s->begin_mm;
    s->trailing_count = 0;
}

/* Blocks from the first on, as pieces count them. */
static unsigned since(const struct builder *s, uint32_t index)
{
    TAKT_ASSERT(index - s->c->first < CEILING_NONE);
    return index - s->c->first;
}

/* leave: the block behind. */
static struct ceiling_piece *append(struct builder *s, double end_mm, float feed_mm_s, double a,
                                    uint32_t leave)
{
    struct ceiling_piece *p = &s->c->piece[s->c->count];

    TAKT_ASSERT(s->c->count < CEILING_PIECES_MAX && a >= 0.0 && feed_mm_s >= 0.0F);
    *p = (struct ceiling_piece){
        .feed_mm_s = feed_mm_s,
        .acceleration = (float)a,
        .start = since(s, s->start) & 0x1ffU,
        .leave = since(s, leave) & 0x1ffU,
        .landing = CEILING_NONE,
    };
    s->c->end_mm[s->c->count++] = end_mm;
    return p;
}

/*
 * Drops the pieces from k on that nothing is left of, or a cycle would come to more than it looks
 * at: all but the first of a ceiling, which still binds until the setpoint has left it.
 */
static void drop_empty(struct ceiling *c, uint32_t k)
{
    uint32_t kept = k;

    for (; k < c->count; k++) {
        const double begin_mm = kept > 0 ? c->end_mm[kept - 1] : 0.0;

        if (c->piece[k].opens || c->end_mm[k] > begin_mm) {
            c->end_mm[kept] = c->end_mm[k];
            c->piece[kept++] = c->piece[k];
        }
    }
    c->count = kept;
}

/*
 * A ceiling begins where the trapezoidal reference is when the setpoint, following at that feed,
 * reaches at_mm. What lay there ends there; never before the beginning of the ceiling before it,
 * since a faster one behind a slower cannot bind earlier.
 */
static void begin_ceiling(struct builder *s, double at_mm, double reference_mm)
{
    s->begin_mm = maths_max(s->begin_mm, at_mm - path_whole_mm(reference_mm));
    uint32_t k = s->c->count;

    for (; k > 0 && s->c->end_mm[k - 1] > s->begin_mm; k--) {
        s->c->end_mm[k - 1] = s->begin_mm;
    }
    drop_empty(s->c, k);
}

/* Divides piece k at a place in it. */
static void divide(struct ceiling *c, uint32_t k, double at_mm)
{
    TAKT_ASSERT(k < c->count && c->count < CEILING_PIECES_MAX);
    for (uint32_t i = c->count++; i > k; i--) {
        c->end_mm[i] = c->end_mm[i - 1];
        c->piece[i] = c->piece[i - 1];
    }
    c->end_mm[k] = at_mm;
    c->piece[k + 1].opens = true;
}

/*
 * What has been laid from a place on allows no more than the block being laid. It begins with a
 * piece of its own, if need be behind one without length: a trapezoidal reference may have to stay
 * in what was there before (motion/reference_place.c).
 */
static void lower(struct builder *s, double from_mm, double top_mm_s, double a)
{
    struct ceiling *c = s->c;

    for (uint32_t k = c->count; k-- > 0 && c->end_mm[k] > from_mm;) {
        if ((double)c->piece[k].acceleration <= a &&
            (double)takt_ceiling_top_feed(c, k) <= top_mm_s) {
            continue;
        }
        if ((k > 0 ? c->end_mm[k - 1] : 0.0) <= from_mm) {
            divide(c, k++, from_mm);
        }
        c->piece[k].acceleration = (float)maths_min(a, (double)c->piece[k].acceleration);
        c->piece[k].start = since(s, s->start) & 0x1ffU;
    }
}

/*
 * The setpoint may be in a block of less acceleration until the trapezoidal reference is at end_mm,
 * by the block's highest feed: another override must not take back what was said. Forgets what that
 * implies.
 */
static void add_trailing(struct builder *s, double a, double end_mm)
{
    unsigned kept = 0;

    TAKT_ASSERT(a >= 0.0 && s->trailing_count <= TRAILING_MAX);
    for (unsigned i = 0; i < s->trailing_count; i++) {
        if (s->trailing[i].a < a && s->trailing[i].end_mm > s->begin_mm) {
            s->trailing[kept++] = s->trailing[i];
        }
    }
    if (kept > 0 && s->trailing[kept - 1].end_mm >= end_mm) {
        s->trailing_count = kept;
        return;
    }
    if (kept == TRAILING_MAX) {
        kept--;
        a = s->trailing[kept].a;
    }
    s->trailing[kept] = (struct trailing_limit){a, end_mm};
    s->trailing_count = kept + 1;
}

/*
 * The pieces of one ceiling up to end_mm: first those where a block left behind asks for less
 * acceleration.
 */
static void append_pieces(struct builder *s, double end_mm, float feed_mm_s, double a,
                          uint32_t leave)
{
    const uint32_t first = s->c->count;
    double at_mm = s->begin_mm;

    for (unsigned i = 0; i < s->trailing_count; i++) {
        if (s->trailing[i].a < a && s->trailing[i].end_mm > at_mm && at_mm < end_mm) {
            at_mm = maths_min(s->trailing[i].end_mm, end_mm);
            append(s, at_mm, feed_mm_s, s->trailing[i].a, leave);
        }
    }
    if (at_mm < end_mm) {
        append(s, end_mm, feed_mm_s, a, leave);
    }
    if (first < s->c->count) {
        s->c->piece[first].opens = true;
    }
}

static unsigned block_overrides(const struct path_block *b)
{
    const unsigned follows = b->per_revolution ? CEILING_SPINDLE : 0U;
    const unsigned hold = (b->may_hold ? CEILING_HOLD : 0U) | follows;

    return b->rapid ? hold | CEILING_RAPID : hold | (b->may_feed ? CEILING_FEED : 0U);
}

/* May the block be joined to the newest piece: the same ceiling, and nothing between? */
static bool continues(const struct builder *s, const struct path_block *b, float feed_mm_s,
                      double a)
{
    if (s->c->count == 0 || s->trailing_count != 1 || s->trailing[0].a != a) {
        return false;
    }
    const struct ceiling_piece *last = &s->c->piece[s->c->count - 1];

    return last->end == CEILING_GOES_ON && last->feed_mm_s == feed_mm_s &&
           (double)last->acceleration == a &&
           (double)takt_ceiling_top_feed(s->c, s->c->count - 1) <= takt_path_block_top(b) &&
           takt_ceiling_overrides(s->c, s->c->count - 1) == block_overrides(b);
}

static void lay_block(struct builder *s, uint32_t index)
{
    const struct path_block *b = path_at(s->path, index);
    const float feed_mm_s =
        takt_maths_float_below(takt_ceiling_block_feed(s->path, index, s->request));
    const double top = takt_path_block_top(b) * s->cycle_s;
    const double a = takt_ceiling_block_acceleration(s->path, index, s->cycles);
    const double start_mm = path_mm(s->c->origin, b->start);
    const double end_mm = path_mm(s->c->origin, path_end(s->path, index));
    const double behind_mm = path_whole_mm(top * s->behind);
    TAKT_ASSERT(a >= 0.0 && end_mm > start_mm);

    s->fastest = maths_max(s->fastest, top);
    s->gentlest = maths_min(s->gentlest, a);
    s->start = index;
    if (continues(s, b, feed_mm_s, a)) {
        s->c->end_mm[s->c->count - 1] = end_mm;
        s->c->piece[s->c->count - 1].leave = since(s, index + 1) & 0x1ffU;
    } else {
        s->early_mm = maths_max(s->early_mm, start_mm - behind_mm);
        begin_ceiling(s, start_mm, ceiling_feed(s->c, feed_mm_s) * s->behind);
        lower(s, s->early_mm, takt_path_block_top(b), a);
        append_pieces(s, end_mm, feed_mm_s, a, index + 1);
    }
    add_trailing(s, a, end_mm + behind_mm);
}

/*
 * Cycles of slowing down within which a landing at feed w can make up for any fraction of a cycle's
 * way: with n (n + N + 1) a >= 2 w (motion/landing.h).
 */
static double landing_ramp(double feed, double a, double window)
{
    const double half = 0.5 * (window + 1.0);

    return maths_sqrt(half * half + 2.0 * feed / a) - half + 1.0;
}

/*
 * A junction that is landed: the trapezoidal reference passes it at constant feed for a whole
 * window, so that a setpoint can be put on it; before that it makes up for the fraction of a
 * cycle's way that is missing, and for the cycle in which it comes into the piece. Two such
 * junctions need room between.
 */
static void lay_landed_junction(struct builder *s, uint32_t index)
{
    const struct path_block *b = path_at(s->path, index);
    const double a = maths_min(takt_ceiling_block_acceleration(s->path, index, s->cycles),
                               takt_ceiling_block_acceleration(s->path, index + 1, s->cycles));
    const double window = 2.0 * (s->behind - CEILING_MARGIN_CYCLES) + 1.0;
    const double wider =
        maths_max(window, takt_ramp_profile_window_cycles(s->path->limits.profile,
                                                          promise_window(s, index + 1)));
    const double shorter_mm =
        maths_min(takt_path_length(s->path, index), takt_path_length(s->path, index + 1));
    const double end_mm = path_mm(s->c->origin, path_end(s->path, index));
    double feed = (double)b->feed_junction_mm_s * s->cycle_s;

    TAKT_ASSERT(path_at(s->path, index + 1)->motion);
    feed = maths_min(feed, shorter_mm / (wider + 4.0 + landing_ramp(feed, a, wider)));
    feed = feed < PASS_WORTH * a ? 0.0 : feed;
    begin_ceiling(s, end_mm, feed * (0.5 * (window + 1.0) + landing_ramp(feed, a, window) + 1.0));
    s->start = index + 1;
    struct ceiling_piece *p =
        append(s, end_mm, takt_maths_float_below(feed / s->cycle_s), a, index + 1);

    p->opens = true;
    p->end = CEILING_LANDS;
}

/*
 * For one block more: a piece for each trailing limit and one without, one of lower acceleration
 * before, and a landed junction.
 */
static bool has_room(const struct builder *s)
{
    return s->c->count + s->trailing_count + 3U <= CEILING_PIECES_MAX;
}

/* Lays the blocks from the ring into pieces. */
static void lay_blocks(struct builder *s)
{
    bool fresh = true;
    uint32_t i = s->request->first;

    for (; i != s->path->closed && has_room(s); i++) {
        if (!path_at(s->path, i)->motion) {
            continue;
        }
        if (fresh) {
            begin_span(s, i);
        }
        lay_block(s, i);
        const bool stops = takt_span_stops(s->path, i);

        fresh = stops || takt_span_lands(s->path, i);
        if (stops) {
            s->c->piece[s->c->count - 1].end = CEILING_STOPS;
        } else if (fresh) {
            lay_landed_junction(s, i);
        }
    }
    s->c->behind = i;
}

void takt_ceiling_build(struct ceiling *c, struct path *path, const struct ceiling_request *request)
{
    const double t = path->limits.cycle_s;
    struct builder s = {
        .c = c, .path = path, .request = request, .cycle_s = t, .gentlest = MATHS_INFINITY};

    TAKT_ASSERT(request->feed_ratio > 0.0 && request->feed_ratio <= BLOCK_OVERRIDE_MAX);
    TAKT_ASSERT(request->rapid_ratio > 0.0 && request->rapid_ratio <= 1.0 &&
                request->spindle_rev_s >= 0.0);
    TAKT_ASSERT((int32_t)(path->closed - request->first) >= 0);
    c->path = path;
    c->cycle_s = t;
    c->first = request->first;
    c->origin = path_start(path, request->first);
    c->count = 0;
    lay_blocks(&s);
    takt_ceiling_plan_backward(c, path->limits.profile);
}

uint64_t takt_ceiling_start(const struct ceiling *c, uint32_t k)
{
    TAKT_ASSERT(k < c->count);
    return path_start(c->path, path_of_ceiling(c, c->piece[k].start));
}

float takt_ceiling_top_feed(const struct ceiling *c, uint32_t k)
{
    const struct ceiling_piece *p = &c->piece[k];

    return p->end == CEILING_LANDS ? p->feed_mm_s
                                   : takt_maths_float_below(takt_path_block_top(
                                         path_at(c->path, path_of_ceiling(c, p->start))));
}

unsigned takt_ceiling_overrides(const struct ceiling *c, uint32_t k)
{
    return block_overrides(path_at(c->path, path_of_ceiling(c, c->piece[k].leave - 1U)));
}

uint32_t takt_ceiling_cycles(const struct ceiling *c, uint32_t k)
{
    return path_at(c->path, path_of_ceiling(c, c->piece[k].start))->cycles;
}
