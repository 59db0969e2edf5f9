/*
 * Goal: the highest feed of the lead point everywhere, from which the rest of the window can be met and stopped, in
 * time linear in blocks. How the pieces lie against the blocks, and why limits then hold for the setpoint, is in
 * spans.md.
 *
 * Forward: one piece for each ceiling, shifted by half the averaging window times its feed. Backward: the feed at the
 * end of each piece, by constant deceleration: u = min(c^2, u_next + 2 a L).
 */
#include "plan/ceiling.h"

#include "base/maths.h"
#include "plan/path_unit.h"
#include "plan/span.h"

/*
 * Between being asked for and being taken a ceiling grows so many cycles old at most (MOTION_EXCHANGE_CYCLES and the
 * cycles of taking it).
 */
#define AGE_CYCLES 64.0

/* Lower accelerations of blocks left behind, that the setpoint still has to keep: at most so many at once. */
#define HEADS_MAX 16

/* A joint feed that the lead point reaches from rest in this many cycles is not worth passing: it comes to rest. */
#define PASS_WORTH 2.0

struct head {
    double a;
    double end_mm;
};

struct builder {
    struct ceiling *c;
    struct path *path;
    const struct ceiling_request *request;
    double cycle_s;
    uint32_t cycles; /* of the first box, in the span being laid */
    double behind;   /* cycles that the setpoint follows behind the lead point, with the margin */
    double begin_mm; /* where the newest ceiling begins */
    unsigned overrides; /* of the block being laid, */
    double feed_max;    /* and its highest feed whatever they are, mm/cycle */
    double fastest;     /* the highest of those laid so far */
    double gentlest;    /* and the lowest acceleration */
    int64_t start;      /* path units from the origin: of what is being laid */
    unsigned heads;
    struct head head[HEADS_MAX]; /* both rising */
};

/* As programmed, or so much per revolution as it turns now. */
static double program_feed(const struct path *path, uint32_t index,
                           const struct ceiling_request *request)
{
    const struct path_block *b = path_at(path, index);
    const double measured =
        b->per_revolution ? path_feed_rev(path, index) * request->spindle_rev_s : 0.0;

    return measured > 0.0 ? measured : (double)b->feed_program_mm_s;
}

double ceiling_block_feed(const struct path *path, uint32_t index,
                          const struct ceiling_request *request)
{
    const struct path_block *b = path_at(path, index);
    const double ratio = b->rapid ? request->rapid_ratio : b->may_feed ? request->feed_ratio : 1.0;
    const double program = program_feed(path, index, request);
    const double top = path_block_top(b);

    if (b->rapid || (request->proportional && ratio < 1.0)) {
        return ratio * maths_min(program, top);
    }
    return maths_min(ratio * program, top);
}

bool ceiling_stops(const struct ceiling_request *request, const struct path *path, uint32_t index)
{
    const struct path_block *b = path_at(path, index);

    return b->end == JOINT_STOP ||
           (request->stops && !b->continues && (int32_t)(index - request->stops_from) >= 0);
}

/*
 * Could the lead point not come to rest before a place any more when this ceiling is taken? By then it has gone on at its
 * feed, which it keeps for a window before it brakes: w t + w^2 / 2 a.
 */
static bool is_near(const struct builder *s, uint64_t at)
{
    const double cycles = AGE_CYCLES + 2.0 * s->behind + 0.5 * s->fastest / s->gentlest;

    return path_mm(s->request->lead, at) <= s->fastest * cycles;
}

/*
 * The window of a span is a promise to a lead point that has begun it, or may begin it or land at its start under the
 * ceiling made before; to others it is found anew until all of the span is known.
 */
static struct span_window find_window(const struct builder *s, uint32_t index)
{
    const struct ceiling_request *request = s->request;
    const struct path_block *b = path_at(s->path, index);
    const bool inside = index == request->first && (int64_t)(request->lead - b->start) > 0;

    if (inside || (int64_t)(request->span - b->start) >= 0) {
        return (struct span_window){request->cycles, b->cycles_known};
    }
    if (b->cycles > 0 && (b->cycles_known || is_near(s, b->start))) {
        return (struct span_window){b->cycles, b->cycles_known};
    }
    return span_window(s->path, request, index);
}

static uint32_t promise_window(struct builder *s, uint32_t index)
{
    const struct span_window window = find_window(s, index);

    path_promise(s->path, index, window.cycles, window.known);
    return window.cycles;
}

/* The span that begins with the block at index. */
static void begin_span(struct builder *s, uint32_t index)
{
    const uint64_t start = path_at(s->path, index)->start;

    s->cycles = promise_window(s, index);
    s->behind = 0.5 * ((double)law_window_cycles(s->path->limits.law, s->cycles) - 1.0) +
                CEILING_MARGIN_CYCLES;
    s->begin_mm = path_mm(s->c->origin, start);
    s->heads = 0;
}

static struct ceiling_piece *append(struct builder *s, double end_mm, double feed, double a,
                                    int64_t leave)
{
    struct ceiling_piece *p = &s->c->piece[s->c->count++];

    *p = (struct ceiling_piece){
        .end_mm = end_mm,
        .feed = feed,
        .feed_max = maths_max(feed, s->feed_max),
        .acceleration = a,
        .start = s->start,
        .leave = leave,
        .cycles = (uint16_t)s->cycles,
        .landing = CEILING_NONE,
        .overrides = (uint16_t)s->overrides,
    };
    return p;
}

/*
 * Of the pieces from k on, those that nothing is left of go, or a cycle would come to more than it looks at: all but the
 * first of a ceiling, which still binds until the setpoint has left it.
 */
static void drop_empty(struct ceiling *c, uint32_t k)
{
    uint32_t kept = k;

    for (; k < c->count; k++) {
        const double begin_mm = kept > 0 ? c->piece[kept - 1].end_mm : 0.0;

        if (c->piece[k].opens || c->piece[k].end_mm > begin_mm) {
            c->piece[kept++] = c->piece[k];
        }
    }
    c->count = kept;
}

/*
 * A ceiling begins where the lead point is when the setpoint, following at that feed, reaches at_mm. What lay there
 * ends there; never before the beginning of the ceiling before it, since a faster one behind a slower cannot bind
 * earlier.
 */
static void begin_ceiling(struct builder *s, double at_mm, double lead_mm)
{
    s->begin_mm = maths_max(s->begin_mm, at_mm - lead_mm);
    uint32_t k = s->c->count;

    for (; k > 0 && s->c->piece[k - 1].end_mm > s->begin_mm; k--) {
        s->c->piece[k - 1].end_mm = s->begin_mm;
    }
    drop_empty(s->c, k);
}

/* mm/cycle2: A tau^2, and the jerk J over the first box: J tau^3 N. */
static double block_acceleration(const struct builder *s, const struct path_block *b)
{
    const double t = s->cycle_s;

    return maths_min((double)b->a_mm_s2 * t * t,
                     (double)b->j_mm_s3 * t * t * t * (double)s->cycles);
}

/*
 * The setpoint may be in a block of less acceleration until the lead point is at end_mm, by the block's highest feed:
 * another override must not take back what was said. Forgets what that implies.
 */
static void add_head(struct builder *s, double a, double end_mm)
{
    unsigned kept = 0;

    for (unsigned i = 0; i < s->heads; i++) {
        if (s->head[i].a < a && s->head[i].end_mm > s->begin_mm) {
            s->head[kept++] = s->head[i];
        }
    }
    if (kept > 0 && s->head[kept - 1].end_mm >= end_mm) {
        s->heads = kept;
        return;
    }
    if (kept == HEADS_MAX) {
        kept--;
        a = s->head[kept].a;
    }
    s->head[kept] = (struct head){a, end_mm};
    s->heads = kept + 1;
}

/* The pieces of one ceiling up to end_mm: first those where a block left behind asks for less acceleration. */
static void append_pieces(struct builder *s, double end_mm, double feed, double a, int64_t leave)
{
    const uint32_t first = s->c->count;
    double at_mm = s->begin_mm;

    for (unsigned i = 0; i < s->heads; i++) {
        if (s->head[i].a < a && s->head[i].end_mm > at_mm && at_mm < end_mm) {
            at_mm = maths_min(s->head[i].end_mm, end_mm);
            append(s, at_mm, feed, s->head[i].a, leave);
        }
    }
    if (at_mm < end_mm) {
        append(s, end_mm, feed, a, leave);
    }
    if (first < s->c->count) {
        s->c->piece[first].opens = true;
    }
}

/* May the block be joined to the newest piece: the same ceiling, and nothing between? */
static bool continues(const struct builder *s, double feed, double a)
{
    if (s->c->count == 0 || s->heads != 1 || s->head[0].a != a) {
        return false;
    }
    const struct ceiling_piece *last = &s->c->piece[s->c->count - 1];

    return !last->stop && !last->landed && last->feed == feed && last->feed_max == s->feed_max &&
           last->acceleration == a && last->overrides == s->overrides;
}

static unsigned block_overrides(const struct path_block *b)
{
    const unsigned follows = b->per_revolution ? CEILING_SPINDLE : 0U;
    const unsigned hold = (b->may_hold ? OVERRIDE_HOLD : 0U) | follows;

    return b->rapid ? hold | CEILING_RAPID : hold | (b->may_feed ? OVERRIDE_FEED : 0U);
}

static void lay_block(struct builder *s, uint32_t index)
{
    const struct path_block *b = path_at(s->path, index);
    const double feed = ceiling_block_feed(s->path, index, s->request) * s->cycle_s;
    const double a = block_acceleration(s, b);
    const double start_mm = path_mm(s->c->origin, b->start);
    const uint64_t end = path_end(s->path, index);
    const int64_t leave = (int64_t)(end - s->c->origin);
    const double end_mm = path_mm(s->c->origin, end);

    s->overrides = block_overrides(b);
    s->feed_max = path_block_top(b) * s->cycle_s;
    const double reach_mm = end_mm + s->feed_max * s->behind;

    s->fastest = maths_max(s->fastest, s->feed_max);
    s->gentlest = maths_min(s->gentlest, a);
    s->start = (int64_t)(b->start - s->c->origin);
    if (continues(s, feed, a)) {
        s->c->piece[s->c->count - 1].end_mm = end_mm;
        s->c->piece[s->c->count - 1].leave = leave;
    } else {
        begin_ceiling(s, start_mm, feed * s->behind);
        append_pieces(s, end_mm, feed, a, leave);
    }
    add_head(s, a, reach_mm);
}

/*
 * Cycles of slowing down within which a landing at feed w can make up for any fraction of a cycle's way: with
 * n (n + N + 1) a >= 2 w (motion/landing.h).
 */
static double landing_ramp(double feed, double a, double window)
{
    const double half = 0.5 * (window + 1.0);

    return maths_sqrt(half * half + 2.0 * feed / a) - half + 1.0;
}

/*
 * A joint that is landed: the lead point passes it at constant feed for a whole window, so that a setpoint can be put
 * on it; before that it makes up for the fraction of a cycle's way that is missing, and for the cycle in which it comes
 * into the piece. Two such joints need room between.
 */
static void lay_landed_joint(struct builder *s, uint32_t index)
{
    const struct path_block *b = path_at(s->path, index);
    const struct path_block *next = path_at(s->path, index + 1);
    const double a = maths_min(block_acceleration(s, b), block_acceleration(s, next));
    const double window = 2.0 * (s->behind - CEILING_MARGIN_CYCLES) + 1.0;
    const double wider =
        maths_max(window, law_window_cycles(s->path->limits.law, promise_window(s, index + 1)));
    const double shorter_mm =
        maths_min(path_length(s->path, index), path_length(s->path, index + 1));
    const uint64_t end = path_end(s->path, index);
    const double end_mm = path_mm(s->c->origin, end);
    double feed = (double)b->feed_joint_mm_s * s->cycle_s;

    feed = maths_min(feed, shorter_mm / (wider + 4.0 + landing_ramp(feed, a, wider)));
    feed = feed < PASS_WORTH * a ? 0.0 : feed;
    begin_ceiling(s, end_mm, feed * (0.5 * (window + 1.0) + landing_ramp(feed, a, window) + 1.0));
    s->feed_max = 0.0;
    s->start = (int64_t)(end - s->c->origin);
    struct ceiling_piece *p = append(s, end_mm, feed, a, s->start);

    p->opens = true;
    p->landed = true;
}

/* Lays the blocks from the ring into pieces. Room for the pieces of one block more is kept. */
static void lay_blocks(struct builder *s)
{
    const uint32_t room = CEILING_PIECES_MAX - HEADS_MAX - 2;
    bool fresh = true;
    uint32_t i = s->request->first;

    for (; i != s->path->closed && s->c->count < room; i++) {
        if (!path_at(s->path, i)->motion) {
            continue;
        }
        if (fresh) {
            begin_span(s, i);
        }
        lay_block(s, i);
        const bool stops = ceiling_stops(s->request, s->path, i);

        fresh = stops || span_lands(s->path, i);
        if (stops) {
            s->c->piece[s->c->count - 1].stop = true;
        } else if (fresh) {
            lay_landed_joint(s, i);
        }
    }
    s->c->complete = i == s->path->closed;
}

/* Feed^2 at the beginning of a piece from which its end can be met at this energy: u = min(c^2, u_end + 2 a L). */
static double begin_energy(const struct ceiling *c, uint32_t k, double feed, double end_energy)
{
    const struct ceiling_piece *p = &c->piece[k];
    const double begin_mm = k == 0 ? 0.0 : c->piece[k - 1].end_mm;

    return maths_min(feed * feed, end_energy + 2.0 * p->acceleration * (p->end_mm - begin_mm));
}

/* Ceiling of a piece, and feed squared at its end: as the overrides are, or at their highest. */
static double feed_of(const struct ceiling_piece *p, bool highest)
{
    return highest ? p->feed_max : p->feed;
}

static double energy_of(const struct ceiling_piece *p, bool highest)
{
    return highest ? p->end_energy_max : p->end_energy;
}

/*
 * The feed up to feed at which the lead point, when the setpoint is on a landed joint, in piece k, can go on and meet
 * what follows: it is then half the next span's window ahead, at x; by the pieces up to there w is no more than their
 * ceilings, and w^2 <= u + 2 a (x_end - x).
 */
static double landed_feed(const struct ceiling *c, uint32_t k, enum law law, double feed,
                          bool highest)
{
    const double start_mm = c->piece[k].end_mm;
    uint32_t i = k + 1;

    if (i == c->count) {
        return feed;
    }
    const double cycles = 0.5 * (double)law_window_cycles(law, c->piece[i].cycles) + 1.0;
    const double hold_mm = start_mm + feed * cycles;

    while (i < c->count && c->piece[i].end_mm < hold_mm) {
        feed = maths_min(feed, feed_of(&c->piece[i], highest));
        feed = maths_min(feed, maths_sqrt(energy_of(&c->piece[i], highest)));
        i++;
    }
    if (i < c->count) {
        const struct ceiling_piece *p = &c->piece[i];
        const double m = p->acceleration * cycles;
        const double energy =
            energy_of(p, highest) + 2.0 * p->acceleration * (p->end_mm - start_mm);

        feed = maths_min(feed, feed_of(p, highest));
        feed = maths_min(feed, maths_sqrt(m * m + maths_max(0.0, energy)) - m);
    }
    return feed;
}

/*
 * Feed squared at the end of piece k from which what is behind it can be met at the highest overrides: at worst by coming
 * to rest where the setpoint comes to it. A ceiling that begins earlier because it is higher asks for no more than that.
 */
static double highest_energy(const struct ceiling *c, uint32_t k, double energy)
{
    const struct ceiling_piece *p = &c->piece[k];

    if (k + 1 == c->count || !c->piece[k + 1].opens) {
        return energy;
    }
    const double start_mm = (double)c->piece[k + 1].start / PATH_UNITS_PER_MM;

    return maths_max(energy, 2.0 * p->acceleration * (start_mm - p->end_mm));
}

/* What lies between a piece and the joint that the span ends with. */
static void note_way(struct ceiling *c, uint32_t k)
{
    struct ceiling_piece *p = &c->piece[k];

    if (p->landing == CEILING_NONE || k + 1U >= p->landing) {
        p->way_energy = (float)MATHS_INFINITY;
        p->way_energy_max = (float)MATHS_INFINITY;
        return;
    }
    p->way_energy = (float)maths_min(p->end_energy, (double)p[1].way_energy);
    p->way_energy_max = (float)maths_min(p->end_energy_max, (double)p[1].way_energy_max);
}

static void plan_backward(struct ceiling *c, enum law law)
{
    double energy = 0.0;
    double energy_max = 0.0;
    uint16_t landing = CEILING_NONE;
    bool open = true;

    c->open_from = c->count;
    for (uint32_t k = c->count; k-- > 0;) {
        struct ceiling_piece *p = &c->piece[k];

        if (p->stop) {
            energy = 0.0;
            energy_max = 0.0;
            landing = CEILING_NONE;
        }
        open = open && !p->stop && (!p->landed || k + 1 == c->count);
        c->open_from = open ? k : c->open_from;
        p->end_energy = energy;
        p->end_energy_max = p->stop ? 0.0 : highest_energy(c, k, energy_max);
        if (p->landed) {
            p->feed_max = landed_feed(c, k, law, p->feed, true);
            p->feed = landed_feed(c, k, law, p->feed, false);
            landing = (uint16_t)k;
        }
        p->landing = landing;
        note_way(c, k);
        energy = begin_energy(c, k, p->feed, p->end_energy);
        energy_max = begin_energy(c, k, p->feed_max, p->end_energy_max);
    }
}

void ceiling_build(struct ceiling *c, struct path *path, const struct ceiling_request *request)
{
    struct builder s = {.c = c,
                        .path = path,
                        .request = request,
                        .cycle_s = path->limits.cycle_s,
                        .gentlest = MATHS_INFINITY};

    c->count = 0;
    c->origin =
        request->first == path->pushed ? path->position : path_at(path, request->first)->start;
    lay_blocks(&s);
    plan_backward(c, path->limits.law);
}
