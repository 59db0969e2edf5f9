/*
 * Goal: on a smoothed curve the axes come to rest, and up to speed again, as quickly as they can at each place of it.
 *
 * With the place u(t) on the curve x(u), rate r = u', change q = r' and w = q', the chain rule gives for every axis
 *
 *     x''  of time:   x' q + x'' r^2                       within A
 *     x''' of time:   x' w + 3 x'' r q + x''' r^3          within J
 *
 * with their signs: an axis that the curve speeds up can be braked twice as hard, one that it slows down not at all. Each
 * cycle takes the hardest w, of a few, after which the change can still be brought back to 0 by a constant e (the ease)
 * with both kept all the way. At a constant rate that is not above that of the pieces everything is kept, and the lead
 * point (lead.h) can take over: its own condition for what lies ahead is asked for at that place. So whatever follows, the
 * way that was found last can be gone on with, by which no limit is ever broken.
 *
 *     change q |        w       e          each cycle: w, then e until q = 0
 *              |\      /|\     /
 *              | \____/ | \___/
 *              +--------+------------ time
 *
 * Setpoints are samples of x(u(t)), so their third differences are averages of its third derivative.
 *
 * Derivatives are bounded over parts of the way: with u, r and q between the values at both ends, which they pass from one
 * to the other without turning back.
 */
#include "motion/hold.h"

#include "base/maths.h"
#include "plan/path_unit.h"
#include "smooth/single.h"

/* Pieces that are read in a cycle. */
#define READ_MAX 4

/* Parts that the ease is looked at in. */
#define EASE_PARTS 4

/* The eases tried, in parts of the hardest, beside the one that is known. */
#define EASES 3
static const float ease_part[EASES] = {1.0f, 0.3f, 0.1f};

/* Where w can not be found the next one tried is so much smaller; where it was found, twice as large. */
#define STEP_LESS  0.5f
#define STEP_LEAST (1.0f / 4096.0f)

/* Where the change cannot be kept, and need not be brought to 0 yet: by this part of it. */
#define LESS_PART 0.125f

/* The rate is so near to that of the ceiling that the lead point goes on by itself. */
#define ARRIVED_PART 1e-3f

/* Where the axes hardly move: the rate changes by no more than this part of what it began with in a cycle. */
#define CHANGE_PART 0.2f

/* Blocks up to what begins at the lead point that are looked at for each state tried, at most. */
#define BLOCKS_MAX 16

/* Of these, so many are found to be fast enough in a cycle. */
#define CLEAR_MAX 8

/* After so many states in a cycle that the lead point could not go on from, no other is looked for. */
#define REFUSALS_MAX 2

/* Rounding. */
#define SLACK      1e-5f
#define REST_PART  1e-9
#define TRIAL_PART 4e-6

struct range {
    float low;
    float high;
};

static inline struct range between(float a, float b)
{
    return a < b ? (struct range){a, b} : (struct range){b, a};
}

/* By something that is not below 0. */
static inline struct range times(struct range a, struct range by)
{
    return (struct range){a.low * (a.low < 0.0f ? by.high : by.low),
                          a.high * (a.high < 0.0f ? by.low : by.high)};
}

static inline struct range plus(struct range a, struct range b)
{
    return (struct range){a.low + b.low, a.high + b.high};
}

static inline bool is_within(struct range a, float limit)
{
    return a.high <= limit && a.low >= -limit;
}

/* -- the pieces -- */

static const struct hold_piece *piece_at(const struct hold *h, uint32_t block)
{
    return &h->piece[block % HOLD_PIECES_MAX];
}

/* Of a uniform cubic B-spline: x' = (c2 - c0)/2, x'' = c0 - 2 c1 + c2 where the piece begins. */
static void read_piece(struct hold *h, const struct path *path, uint32_t block)
{
    struct hold_piece *p = &h->piece[block % HOLD_PIECES_MAX];
    struct point c[4];

    ring_control(&path->ring, block, c);
    for (unsigned i = 0; i < h->axes; i++) {
        const unsigned axis = h->axis[i];
        const double step0 = c[1].at[axis] - c[0].at[axis];
        const double step1 = c[2].at[axis] - c[1].at[axis];
        const double step2 = c[3].at[axis] - c[2].at[axis];

        p->first[i] = (float)(0.5 * (step0 + step1));
        p->second[0][i] = (float)(step1 - step0);
        p->second[1][i] = (float)(step2 - step1);
    }
}

static double length_of(const struct path *path, uint32_t block)
{
    return (double)(path_end(path, block) - path_start(path, block));
}

/* Does the block go on with the curve of the one before? */
static bool goes_on(const struct hold *h, const struct path *path, uint32_t block)
{
    return path_at(path, block)->smooth && path_at(path, block - 1)->end == JOINT_PASSED &&
           length_of(path, block) == h->length;
}

static void read_pieces(struct hold *h, const struct path *path)
{
    for (unsigned i = 0;
         i < READ_MAX && !h->whole && h->end != path->closed && h->end - h->block < HOLD_PIECES_MAX;
         i++) {
        h->whole = h->end != h->block && !goes_on(h, path, h->end);
        if (!h->whole) {
            read_piece(h, path, h->end++);
        }
    }
}

static void take_limits(struct hold *h, const struct plan_limits *limits)
{
    const double t = limits->cycle_s;

    h->axes = 0;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((limits->axes >> i & 1U) != 0) {
            h->axis[h->axes] = (uint8_t)i;
            h->velocity[h->axes] = (float)(limits->velocity_mm_s[i] * t);
            h->acceleration[h->axes] = (float)(limits->acceleration_mm_s2[i] * t * t);
            h->jerk[h->axes] = (float)(limits->jerk_mm_s3[i] * t * t * t);
            h->axes++;
        }
    }
}

/*
 * A state that is tried, in single precision: what rounding does to it is less than the bounds leave. What is gone along is
 * in double precision.
 */
struct trial {
    float at;
    float rate;
    float change;
};

/* -- what the axes need on a part of the way -- */

/* Rate, size of the change, and products of them; the sign of the change, and w by that sign. */
struct part {
    struct range rate, change;
    struct range rate2, rate3;
    struct range three_rate_change;
    float sign;
    float w;
};

static struct range size_between(float a, float b)
{
    return between(single_abs(a), single_abs(b));
}

static struct part part_of(const struct trial *a, const struct trial *b, float w)
{
    const float sign = a->change < 0.0f || b->change < 0.0f ? -1.0f : 1.0f;
    struct part p = {
        .rate = between(a->rate, b->rate),
        .change = size_between(a->change, b->change),
        .sign = sign,
        .w = sign * w,
    };
    const struct range three = {3.0f * p.rate.low, 3.0f * p.rate.high};

    p.rate2 = times(p.rate, p.rate);
    p.rate3 = times(p.rate2, p.rate);
    p.three_rate_change = times(three, p.change);
    return p;
}

static inline struct range by_sign(struct range a, float sign)
{
    return sign < 0.0f ? (struct range){-a.high, -a.low} : a;
}

/*
 * Axis i on a piece from f to g of it. Both sums by the sign of the change:
 *     x' |q| + sign x'' r^2            x' (sign w) + 3 x'' r |q| + sign x''' r^3
 */
static bool axis_can(const struct hold *h, const struct hold_piece *piece, unsigned i, float f,
                     float g, const struct part *p)
{
    const float start = piece->first[i];
    const float bend = piece->second[0][i];
    const float third = piece->second[1][i] - bend;
    const float twist = p->sign * third;
    const float sag = single_abs(third) * (g - f) * (g - f) * 0.125f;
    const struct range at =
        between(start + f * (bend + 0.5f * f * third), start + g * (bend + 0.5f * g * third));
    const struct range first = {at.low - sag, at.high + sag};
    const struct range second = between(bend + f * third, bend + g * third);
    const struct range a = plus(times(first, p->change), times(by_sign(second, p->sign), p->rate2));
    const struct range j = plus(plus(between(first.low * p->w, first.high * p->w),
                                     times((struct range){twist, twist}, p->rate3)),
                                times(second, p->three_rate_change));

    return is_within(times(first, p->rate), h->velocity[i] * (1.0f + SLACK)) &&
           is_within(a, h->acceleration[i]) && is_within(j, h->jerk[i]);
}

static bool axes_can(const struct hold *h, uint32_t block, float f, float g, const struct part *p)
{
    for (unsigned i = 0; i < h->axes; i++) {
        if (!axis_can(h, piece_at(h, block), i, f, g, p)) {
            return false;
        }
    }
    return true;
}

/* From one state to another by w, on pieces that are known, and not back. */
static bool can_go(const struct hold *h, const struct trial *a, const struct trial *b, float w)
{
    const uint32_t first = (uint32_t)a->at;
    const uint32_t last = (uint32_t)b->at;
    const struct part p = part_of(a, b, w);

    if (b->at < a->at || last >= h->end - h->block) {
        return false;
    }
    for (uint32_t i = first; i <= last; i++) {
        const float f = i == first ? a->at - (float)i : 0.0f;
        const float g = i == last ? b->at - (float)i : 1.0f;

        if (!axes_can(h, h->block + i, f, g, &p)) {
            return false;
        }
    }
    return true;
}

/* -- the way on -- */

/* u + r t + q t^2/2 + w t^3/6 */
static void advance(struct hold_state *s, double w, double t)
{
    s->at += t * (s->rate + t * (0.5 * s->change + t * w * (1.0 / 6.0)));
    s->rate = maths_max(0.0, s->rate + t * (s->change + 0.5 * t * w));
    s->change += t * w;
}

static void try_advance(struct trial *s, float w, float t)
{
    s->at += t * (s->rate + t * (0.5f * s->change + t * w * (1.0f / 6.0f)));
    s->rate = single_max(0.0f, s->rate + t * (s->change + 0.5f * t * w));
    s->change += t * w;
}

/* The highest rate on a block, whatever the overrides are: pieces a cycle. */
static float top_rate(const struct hold *h, const struct path *path, uint32_t block)
{
    return (float)path_block_top(path_at(path, block)) * h->per_mm_s * (1.0f + SLACK);
}

/* Does the curve end before a block? */
static bool is_behind(const struct path *path, uint32_t block)
{
    return block == path->closed || path_at(path, block - 1)->end == JOINT_STOP;
}

/* Goes on past the blocks that are not too fast for the present rate: braking they stay so. */
static void pass_clear(struct hold *h, const struct path *path)
{
    const float rate = (float)h->place.rate;

    if (h->place.change > 0.0 || (int32_t)(h->clear - h->block) < 0) {
        h->clear = h->block;
    }
    for (unsigned i = 0; i < CLEAR_MAX && !(h->place.change > 0.0) &&
                         (h->clear == h->block || !is_behind(path, h->clear)) &&
                         top_rate(h, path, h->clear) >= rate;
         i++) {
        h->clear++;
    }
}

/*
 * Is the rate of a lead point at a place not above the highest of what it has come to, from the setpoint on? A block from S
 * on begins for it at S - c b, b half the window and a margin. Pieces.
 */
static bool tops_allow(const struct hold *h, const struct path *path, const struct lead *l,
                       const struct trial *s, float ahead)
{
    const float b = (float)(0.5 * (l->window - 1.0) + CEILING_MARGIN_CYCLES);

    for (uint32_t i = 0; i < BLOCKS_MAX; i++) {
        const uint32_t block = h->clear + i;
        const float gap = (float)(block - h->block) - ahead;

        if (gap >= s->rate * b || (block != h->block && is_behind(path, block))) {
            return true;
        }
        const float top = top_rate(h, path, block);

        if (s->rate > top && gap < top * b) {
            return false;
        }
    }
    return false;
}

/*
 * The lead point of a setpoint that moves at a constant rate is half the window before it. It takes over at the end of the
 * cycle in which the change comes to 0, and keeps its feed in the next one (lead_follow). To stop it may be faster than the
 * overrides ask for.
 */
static bool lead_can_take(const struct hold *h, const struct path *path, const struct lead *l,
                          const struct trial *s, bool stop)
{
    const double rate = (double)s->rate * (1.0 + TRIAL_PART);
    const double ahead = (double)s->at + 0.5 * (l->window + 3.0) * rate;
    const uint64_t at = path_start(path, h->block) + (uint64_t)(ahead * h->length);

    return (!stop || tops_allow(h, path, l, s, (float)ahead)) &&
           lead_could_be(l, at, rate * h->length / PATH_UNITS_PER_MM, stop);
}

/* Is the change brought to 0 by e within all limits, at a rate and place from which the lead point could go on? */
static bool can_ease(struct hold *h, const struct path *path, const struct lead *l, struct trial s,
                     float e, bool stop)
{
    const float w = s.change < 0.0f ? e : -e;

    if (s.change != 0.0f) {
        const float t = single_abs(s.change) / (e * (float)EASE_PARTS);

        for (unsigned i = 0; i < EASE_PARTS; i++) {
            const struct trial from = s;

            try_advance(&s, w, t);
            if (i + 1 == EASE_PARTS) {
                s.change = 0.0f;
            }
            if (!can_go(h, &from, &s, w)) {
                return false;
            }
        }
    }
    if (h->refusals < REFUSALS_MAX && lead_can_take(h, path, l, &s, stop)) {
        return true;
    }
    h->refusals++;
    return false;
}

/* So hard that braking ends at rest at the latest: r = q^2/2e. */
static float least_ease(const struct trial *s)
{
    return s->change < 0.0f ? s->change * s->change / (2.0f * s->rate) : 0.0f;
}

/*
 * An ease for what follows this state: the one that is known, or for what is tried first another, each cycle the next of
 * them. 0: none was found.
 */
static float find_ease(struct hold *h, const struct path *path, const struct lead *l,
                       const struct trial *s, float hardest, bool stop, bool first)
{
    const float least = least_ease(s);
    const float known = (float)h->ease;
    const float other = single_max(least, ease_part[h->turn % EASES] * hardest);

    if (known > least && can_ease(h, path, l, *s, known, stop)) {
        return known;
    }
    return first && other <= hardest && can_ease(h, path, l, *s, other, stop) ? other : 0.0f;
}

/* w by which one axis alone would use all of its acceleration, or of its jerk, from no change; limited where none moves. */
static float hardest_step(const struct hold *h)
{
    const struct hold_piece *p = piece_at(h, h->block);
    const float f = (float)h->place.at;
    float hardest = CHANGE_PART * (float)h->top;

    for (unsigned i = 0; i < h->axes; i++) {
        const float third = p->second[1][i] - p->second[0][i];
        const float first = p->first[i] + f * (p->second[0][i] + 0.5f * f * third);
        const float most = single_min(h->jerk[i], h->acceleration[i]);

        hardest = most < hardest * single_abs(first) ? most / single_abs(first) : hardest;
    }
    return hardest;
}

/* Goes on by w if there is an ease behind it. In one direction in a cycle: the bounds need it. */
static bool try_step(struct hold *h, const struct path *path, const struct lead *l, float w,
                     float hardest, bool stop, bool first)
{
    const struct trial here = {(float)h->place.at, (float)h->place.rate, (float)h->place.change};
    const bool turns = w * here.change < 0.0f && single_abs(w) > single_abs(here.change);
    const double by = turns ? -h->place.change : (double)w;
    struct hold_state place = h->place;

    if (here.rate == 0.0f && !(w > 0.0f)) {
        return false;
    }
    advance(&place, by, 1.0);
    const struct trial next = {(float)place.at, (float)place.rate, (float)place.change};

    if (!can_go(h, &here, &next, (float)by)) {
        return false;
    }
    const float e = find_ease(h, path, l, &next, hardest, stop, first);

    if (!(e > 0.0f)) {
        return false;
    }
    h->moved = place.at - h->place.at;
    h->place = place;
    h->ease = (double)e;
    return true;
}

/* The change goes to 0 by the ease that was found last. */
static void go_on_easing(struct hold *h)
{
    const double w = h->place.change < 0.0 ? h->ease : -h->ease;
    const double t = maths_min(1.0, maths_abs(h->place.change) / h->ease);
    const double from = h->place.at;

    advance(&h->place, w, t);
    if (t < 1.0 || maths_abs(h->place.change) < REST_PART * h->ease) {
        h->place.change = 0.0;
        h->place.rate = h->place.rate < REST_PART * h->top ? 0.0 : h->place.rate;
    }
    advance(&h->place, 0.0, 1.0 - t);
    h->moved = h->place.at - from;
}

/*
 * True: it has gone on by a w of the direction wanted, or at the change it has. To rest in two cycles, one of w and one of
 * the ease that takes back all of the change: q + w = -2 (r + q + w/2).
 */
static bool find_step(struct hold *h, const struct path *path, const struct lead *l, bool stop)
{
    const float hardest = hardest_step(h);
    const float wanted = stop ? -hardest : hardest;
    const float rate = (float)h->place.rate;
    const float change = (float)h->place.change;

    h->turn++;
    h->refusals = 0;
    if (stop && rate <= 2.0f * hardest &&
        try_step(h, path, l, -rate - 1.5f * change, hardest, stop, true)) {
        return true;
    }
    for (unsigned i = 0; i < 2; i++) {
        if (try_step(h, path, l, h->step * wanted, hardest, stop, i == 0)) {
            h->step = i == 0 ? single_min(1.0f, 2.0f * h->step) : h->step;
            return true;
        }
        h->step = single_max(STEP_LEAST, STEP_LESS * h->step);
    }
    return (wanted * change >= 0.0f && try_step(h, path, l, 0.0f, hardest, stop, h->ease == 0.0)) ||
           try_step(h, path, l, -LESS_PART * change, hardest, stop, h->ease == 0.0);
}

/* Is it at the rate that the lead point may have here, or nearly? */
static bool has_arrived(const struct hold *h, const struct path *path, const struct lead *l)
{
    const struct trial faster = {.at = (float)h->place.at,
                                 .rate = (float)h->place.rate * (1.0f + ARRIVED_PART)};

    return h->place.change == 0.0 && h->place.rate > 0.0 &&
           !lead_can_take(h, path, l, &faster, false);
}

/* Counts from the start of the block that the setpoint is in. */
static void pass_blocks(struct hold *h)
{
    while (h->place.at >= 1.0 && h->block + 1 != h->end) {
        h->place.at -= 1.0;
        h->block++;
    }
}

bool hold_step(struct hold *h, const struct path *path, const struct lead *l, bool stop)
{
    read_pieces(h, path);
    h->clear = stop == h->stops ? h->clear : h->block;
    pass_clear(h, path);
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
        if (h->place.change == 0.0) {
            return false;
        }
        go_on_easing(h);
    }
    pass_blocks(h);
    return true;
}

/* The pieces ahead, from the path's first block on; those that are known stay. */
static void look_ahead(struct hold *h, const struct path *path, bool anew)
{
    if (anew || (int32_t)(h->end - path->first) <= 0) {
        take_limits(h, &path->limits);
        h->end = path->first;
        h->whole = false;
        h->length = length_of(path, path->first);
        h->per_mm_s = (float)(path->limits.cycle_s * PATH_UNITS_PER_MM / h->length);
        h->clear = path->first;
        h->step = 1.0f;
    }
    h->block = path->first;
    read_pieces(h, path);
}

/* The last three places lie on u + r t + q t^2/2. Where that turns back within the last cycle, they are nearly at rest. */
bool hold_begin(struct hold *h, const struct path *path, const struct lead *l, double at,
                const double way[2], bool anew)
{
    look_ahead(h, path, anew);
    h->place.at = at / h->length;
    h->place.change = (way[0] - way[1]) / h->length;
    h->place.rate = way[0] / h->length + 0.5 * h->place.change;
    h->ease = 0.0;
    h->stops = true;
    h->top = maths_max(h->place.rate, (double)top_rate(h, path, h->block));
    pass_clear(h, path);
    return h->place.rate >= 0.0 && find_step(h, path, l, true);
}
