/*
 * With a piece from c0 to c3 of a uniform cubic B-spline its derivatives by the piece are
 * x' = (c2 - c0)/2 and x'' = c0 - 2 c1 + c2 where it begins.
 */
#include "motion/hold_pieces.h"

#include "base/assert.h"
#include "base/maths.h"
#include "motion/hold_axes.h"
#include "plan/path_unit.h"
#include "smooth/single.h"

#include <string.h>

/* Pieces that are read in a cycle, of a smoothed curve, and parts of a line or an arc. */
#define READ_MAX  4
#define PARTS_MAX 3

/*
 * One of so many parts of an arc is computed, the others are turned on from it: by rounding they
 * come to be 1e-6 too long.
 */
#define COMPUTED_EVERY 16

/* Rounding. */
#define TOP_SLACK 1e-5f

/*
 * A part is this part of the way in which the axes come to rest, or of an arc's radius where that
 * is less: README.md.
 */
#define PART_OF_WAY    0.5
#define PART_OF_RADIUS 0.08

/* An arc whose radius changes by more than this part of it is none. */
#define ROUND 1e-3

/* The setpoint has been on an arc for so many cycles: third differences reach so far. */
#define CLEAR_CYCLES 3.0

/* Parts shorter than this are none, path units; nor are there more on a block. */
#define LENGTH_LEAST 16.0
#define COUNT_MAX    1e9

static float top_of(const struct hold *h, const struct path *path, uint32_t block)
{
    return (float)takt_path_block_top(path_at(path, block)) * h->per_mm_s * (1.0f + TOP_SLACK);
}

float takt_hold_top(const struct hold *h, const struct path *path, uint32_t piece)
{
    if (!hold_is_smooth(h)) {
        return h->part_top;
    }
    return piece - h->here < h->end - h->here ? hold_piece(h, piece)[3 * (size_t)h->axes]
                                              : top_of(h, path, piece);
}

static double length_of(const struct path *path, uint32_t block)
{
    return (double)(path_end(path, block) - path_start(path, block));
}

uint64_t takt_hold_start(const struct hold *h, const struct path *path)
{
    return hold_is_smooth(h)
               ? path_start(path, h->here)
               : path_start(path, h->within) + (uint64_t)((double)h->here * h->length);
}

bool takt_hold_is_behind(const struct hold *h, const struct path *path, uint32_t piece)
{
    if (!hold_is_smooth(h)) {
        return piece >= h->parts;
    }
    return piece == path->closed || path_at(path, piece - 1)->end == JUNCTION_STOP;
}

/* Where piece k is, or is to be. */
static float *piece_at(struct hold *h, uint32_t k)
{
    return h->store + (k % h->pieces) * hold_stride(h->axes);
}

/* -- of a smoothed curve -- */

static void read_smooth(struct hold *h, const struct path *path)
{
    float *p = piece_at(h, h->end);
    struct point c[4];

    TAKT_ASSERT(ring_at(&path->ring, h->end)->smooth && h->axes <= AXIS_COUNT);
    takt_ring_control(&path->ring, h->end, c);
    for (unsigned i = 0; i < h->axes; i++) {
        const unsigned axis = h->axis[i];
        const double step0 = c[1].at[axis] - c[0].at[axis];
        const double step1 = c[2].at[axis] - c[1].at[axis];
        const double step2 = c[3].at[axis] - c[2].at[axis];

        p[i] = 0.5f * (float)(step0 + step1);
        p[h->axes + i] = (float)(step1 - step0);
        p[2 * h->axes + i] = (float)(step2 - step1);
    }
    p[3 * (size_t)h->axes] = top_of(h, path, h->end);
}

/* Does the block go on with the curve of the one before? */
static bool goes_on(const struct hold *h, const struct path *path, uint32_t block)
{
    return path_at(path, block)->smooth && path_at(path, block - 1)->end == JUNCTION_PASSED &&
           length_of(path, block) == h->length;
}

/* -- of a line or an arc -- */

/*
 * Where part k begins: s dx/ds, and s^2 d2x/ds2, on a circle about c that turns by w on a part w^2
 * (c - x). They stand where that part will, and the second one is that of the end of the part
 * before.
 */
static void compute_start(struct hold *h, struct path *path, uint32_t k)
{
    const struct block *b = path_read(path, h->within);
    const struct curve *c = &b->curve;
    const double part = h->length / PATH_UNITS_PER_MM * b->scale;
    float *p = piece_at(h, k);
    struct point x;
    struct point t;

    takt_curve_point_and_tangent(c, (double)k * part, &x, &t);
    for (unsigned i = 0; i < h->axes; i++) {
        p[i] = (float)(t.at[h->axis[i]] * part);
        p[h->axes + i] = 0.0f;
    }
    p[3 * (size_t)h->axes] = h->part_top;
    if (c->kind == CURVE_ARC) {
        const double turn = c->arc.sweep_rad * part / c->length_mm;

        for (unsigned i = 0; i < 2; i++) {
            const double from_mm = x.at[h->axis[h->plane[i]]];

            p[h->axes + h->plane[i]] = (float)((c->arc.centre_mm[i] - from_mm) * turn * turn);
        }
    }
}

static void turn(const struct hold *h, float v[])
{
    const float a = v[h->plane[0]];
    const float b = v[h->plane[1]];

    v[h->plane[0]] = h->turn_cos * a - h->turn_sin * b;
    v[h->plane[1]] = h->turn_cos * b + (h->plane[0] == h->plane[1] ? 0.0f : h->turn_sin * a);
}

/* As the part before begins, but turned. */
static void turn_start(struct hold *h, uint32_t k)
{
    float *p = piece_at(h, k);

    memcpy(p, piece_at(h, k - 1), hold_stride(h->axes) * sizeof(float));
    turn(h, p);
    turn(h, p + h->axes);
}

static void read_part(struct hold *h, struct path *path)
{
    float *p = piece_at(h, h->end);

    if (h->end == h->here) {
        compute_start(h, path, h->end);
    }
    if ((h->end + 1) % COMPUTED_EVERY == 0) {
        compute_start(h, path, h->end + 1);
    } else {
        turn_start(h, h->end + 1);
    }
    memcpy(p + 2 * (size_t)h->axes, piece_at(h, h->end + 1) + h->axes, h->axes * sizeof(float));
}

/*
 * The way to rest at this feed, mm a cycle: v/2 (v/a + a/J) of the axis that takes longest,
 * a^2 <= v J.
 */
static float way_to_rest(const struct hold *h, const struct curve *c, float feed_mm)
{
    float way = 0.0f;

    for (unsigned i = 0; i < h->axes; i++) {
        const unsigned axis = h->axis[i];
        const bool turns = c->kind == CURVE_ARC && (axis == c->arc.first || axis == c->arc.second);
        const float v = turns ? feed_mm : feed_mm * single_abs((float)c->slope.at[axis]);
        const float j = h->jerk[i];
        const float a = single_min(h->acceleration[i], single_sqrt(v * j));

        way = v > 0.0f ? single_max(way, 0.5f * feed_mm * (v / a + a / j)) : way;
    }
    return way;
}

/* 0: a line. */
static double curvature_of(const struct curve *c)
{
    return c->kind == CURVE_ARC ? 1.0 / c->arc.radius_start_mm : 0.0;
}

static void set_turn(struct hold *h, const struct curve *c, double length_mm)
{
    const bool bent = c->kind == CURVE_ARC;
    double sine = 0.0;
    double cosine = 1.0;

    h->plane[0] = h->plane[1] = 0;
    for (unsigned i = 0; bent && i < h->axes; i++) {
        h->plane[0] = h->axis[i] == c->arc.first ? (uint8_t)i : h->plane[0];
        h->plane[1] = h->axis[i] == c->arc.second ? (uint8_t)i : h->plane[1];
    }
    if (bent) {
        takt_maths_sincos(c->arc.sweep_rad * length_mm / c->length_mm, &sine, &cosine);
    }
    h->turn_sin = (float)sine;
    h->turn_cos = (float)cosine;
}

/*
 * A part s of a circle that turns by w: its second derivative is w^3 s/8 at most off the line
 * between those at both ends, its third one w^3 s/2 off their difference. Where the radius changes
 * by d over an angle t it moves outwards too, 2 w^2 d/t and 3 w^3 d/t, and turns by up to d/2R more
 * or less, w^2 d and 3/2 w^3 d.
 */
static void set_off(struct hold *h, const struct curve *c, double length_mm, double turn)
{
    const double square = turn * turn;
    double widens = 0.0;

    if (c->kind == CURVE_ARC) {
        widens = maths_abs(c->arc.radius_change_mm) * (0.5 + 1.0 / maths_abs(c->arc.sweep_rad));
    }
    h->off_second = (float)(square * (0.125 * turn * length_mm + 2.0 * widens));
    h->off_third = (float)(square * turn * (0.5 * length_mm + 3.0 * widens));
}

/* Parts of what lies ahead on a line or an arc; false: it is neither. */
static bool begin_parts(struct hold *h, struct path *path, double way)
{
    const struct block *b = path_read(path, h->within);
    const struct curve *c = &b->curve;
    const bool round = c->kind == CURVE_ARC &&
                       maths_abs(c->arc.radius_change_mm) <= ROUND * c->arc.radius_start_mm;

    if (!round && c->kind != CURVE_LINE) {
        return false;
    }
    const double mm = b->scale / PATH_UNITS_PER_MM; /* of a path unit */
    const double curvature = curvature_of(c);
    const double part = PART_OF_WAY * (double)way_to_rest(h, c, (float)(way * mm));
    const double most = part * curvature > PART_OF_RADIUS ? PART_OF_RADIUS / curvature : part;

    h->length = maths_max((double)(int64_t)(most / mm), (double)b->length / COUNT_MAX);
    set_turn(h, c, h->length * mm);
    set_off(h, c, h->length * mm, h->length * mm * curvature);
    return h->length >= LENGTH_LEAST;
}

/* -- all of them -- */

bool takt_hold_stands(const struct path *path)
{
    const uint32_t first = path->first;
    struct point c[4];

    if (!path_at(path, first)->smooth ||
        (first + 1 != path->closed && length_of(path, first + 1) == length_of(path, first))) {
        return false; /* pieces of a curve are as long as the next one */
    }
    takt_ring_control(&path->ring, first, c);
    return point_is_same(&c[0], &c[1]) && point_is_same(&c[1], &c[2]) &&
           point_is_same(&c[2], &c[3]);
}

/* Is there another piece of the curve? Of a smoothed one it may not be known yet. */
static bool has_next(const struct hold *h, const struct path *path)
{
    if (!hold_is_smooth(h)) {
        return h->end < h->parts;
    }
    return h->end != path->closed && (h->end == h->here || goes_on(h, path, h->end));
}

/* More of a smoothed curve where none are known yet, or as many as it passes and some more. */
static unsigned at_once(const struct hold *h)
{
    const float wanted = 2.0f + (float)h->place.rate;

    return !hold_is_smooth(h)                               ? PARTS_MAX
           : h->end == h->here || wanted >= (float)READ_MAX ? READ_MAX
                                                            : (unsigned)wanted;
}

/* Behind parts of a line or an arc lies where the next one begins. */
void takt_hold_read(struct hold *h, struct path *path)
{
    const unsigned most = hold_is_smooth(h) ? h->pieces : h->pieces - 1;
    const unsigned once = at_once(h);

    TAKT_ASSERT(h->end - h->here <= most);
    h->looked = 0;
    for (unsigned i = 0; i < once && h->end - h->here < most && has_next(h, path); i++) {
        if (hold_is_smooth(h)) {
            read_smooth(h, path);
        } else {
            read_part(h, path);
        }
        takt_hold_bound(h, piece_at(h, h->end));
        h->looked += HOLD_LOOKED_BY_READING;
        h->end++;
    }
}

bool takt_hold_prepare(struct hold *h, const struct plan_limits *limits, float *store,
                       size_t floats)
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
    const size_t room = floats / hold_stride(h->axes);

    h->store = store;
    h->pieces = room < HOLD_PIECES_MAX ? (unsigned)room : HOLD_PIECES_MAX;
    h->length = 0.0;
    return room >= HOLD_PIECES_MIN;
}

/*
 * Does the curve go on with pieces as long as the first, or end there? Where it stands before it
 * begins they are not.
 */
static bool is_even(const struct hold *h, const struct path *path)
{
    const uint32_t first = path->first;

    return path_at(path, first)->end == JUNCTION_STOP ||
           (first + 1 != path->closed && length_of(path, first + 1) == h->length);
}

static bool begin(struct hold *h, struct path *path, double way)
{
    const bool smooth = path_at(path, path->first)->smooth;

    h->within = path->first;
    h->off_second = 0.0f;
    h->off_third = 0.0f;
    h->length = smooth ? length_of(path, path->first) : 0.0;
    if (smooth ? !is_even(h, path) : !begin_parts(h, path, way)) {
        return false;
    }
    TAKT_ASSERT(h->length > 0.0);
    h->per_mm_s = (float)(path->limits.cycle_s * PATH_UNITS_PER_MM / h->length);
    h->parts = smooth ? 0 : (uint32_t)(length_of(path, h->within) / h->length);
    h->part_top = top_of(h, path, h->within);
    return smooth || h->parts > 0;
}

bool takt_hold_look(struct hold *h, struct path *path, double at, double way)
{
    const bool smooth = path_at(path, path->first)->smooth;
    const bool other = h->length == 0.0 || hold_is_smooth(h) != smooth ||
                       (smooth ? (int32_t)(h->end - path->first) <= 0 : h->within != path->first);

    if (other && ((!smooth && at < CLEAR_CYCLES * way) || !begin(h, path, way))) {
        h->length = 0.0;
        return false;
    }
    h->place.at = at / h->length;
    h->place.rate = way / h->length;
    h->here = smooth ? path->first : (uint32_t)h->place.at;
    h->place.at -= smooth ? 0.0 : (double)h->here;
    if (other || (int32_t)(h->end - h->here) <= 0) {
        h->end = h->here;
        h->clear_rate = 0.0f;
    }
    takt_hold_read(h, path);
    return !other && h->end != h->here;
}
