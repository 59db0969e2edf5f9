#include "replay/replay.h"

#include "base/assert.h"
#include "base/maths.h"
#include "motion/handover.h"

#include <string.h>

/* A section's start and the axes may differ by this, and by rounding to quanta. */
#define START_MAX_MM 1e-6

/* Blocks that one cycle passes at most. */
#define PASS_MAX 64

void takt_replay_init(struct replay *r, struct intake *intake, const struct replay_source *source)
{
    memset(r, 0, sizeof(*r));
    r->intake = intake;
    takt_intake_open(r->intake, source);
}

static void fail(struct replay *r, enum takt_error code)
{
    if (r->alarm.code == TAKT_OK) {
        r->alarm.code = code;
    }
}

/* What follows from the header. */
static void begin_intake(struct replay *r, const struct plan_limits *limits)
{
    const struct replay_header *h = &r->intake->header;

    r->quantum_mm = 1.0;
    for (uint32_t i = 0; i < h->quantum_bits; i++) {
        r->quantum_mm *= 0.5;
    }
    r->step = 1.0 / (double)h->step_cycles;
    takt_rate_init(&r->rate, limits, h->kept);
    r->highest = r->intake->source.is_lost != NULL
                     ? takt_rate_highest(&r->rate, REPLAY_BRAKE_INTERVALS_MAX / r->step)
                     : 1.0;
    r->brake_intervals =
        (uint32_t)maths_min(takt_maths_ceil(takt_rate_brake_cycles(&r->rate) * r->step) + 2,
                            REPLAY_BRAKE_INTERVALS_MAX);
}

void takt_replay_read(struct replay *r, const struct plan_limits *limits)
{
    takt_intake_read(r->intake);
    if (r->intake->next != INTAKE_HEADER && r->step == 0.0) {
        begin_intake(r, limits);
    }
    if (r->intake->fault != REPLAY_GOOD || (r->intake->source.is_lost != NULL &&
                                            r->intake->source.is_lost(r->intake->source.context))) {
        fail(r, TAKT_ERROR_PLAN_DAMAGED);
    }
}

void takt_replay_prepare(struct move *move)
{
    if (move_is_motion(move) && move->path == PATH_BLEND) {
        move->path = PATH_EXACT;
    }
}

/* -- the curve -- */

/* The next interval's last control point, by the third difference c3' - 3 c3 + 3 c2 - c1. */
static void shift(struct replay *r)
{
    const int16_t *third = r->intake->third[r->intake->intervals_taken % INTAKE_INTERVALS_MAX];

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const int64_t c1 = r->control[1][i];
        const int64_t c2 = r->control[2][i];
        const int64_t c3 = r->control[3][i];

        r->control[0][i] = c1;
        r->control[1][i] = c2;
        r->control[2][i] = c3;
        r->control[3][i] = third[i] + 3 * (c3 - c2) + c1;
    }
    r->intake->intervals_taken++;
    r->taken++;
}

/* Uniform cubic B-spline, from the second control point, so that no digits are lost. */
static void point_at(const struct replay *r, struct point *at)
{
    const double f = r->part;
    const double g = 1.0 - f;
    const double w0 = g * g * g / 6.0;
    const double w2 = (4.0 + g * g * (3.0 * g - 6.0)) / 6.0;
    const double w3 = f * f * f / 6.0;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const int64_t c1 = r->control[1][i];
        const double off = w0 * (double)(r->control[0][i] - c1) +
                           w2 * (double)(r->control[2][i] - c1) +
                           w3 * (double)(r->control[3][i] - c1);

        at->at[i] = (double)c1 * r->quantum_mm + off * r->quantum_mm;
    }
}

/* -- sections -- */

/* Is it known where the block ends? The last one of a section ends with that, and is not told. */
static bool has_end(const struct replay *r)
{
    return r->blocks + 1 < r->section.blocks && r->intake->ends_taken != r->intake->ends_came;
}

static uint64_t end_of(const struct replay *r)
{
    TAKT_ASSERT(has_end(r));
    return r->begin + r->intake->end[r->intake->ends_taken % INTAKE_ENDS_MAX];
}

static void end_block(struct replay *r)
{
    if (has_end(r)) {
        r->begin = end_of(r);
        r->intake->ends_taken++;
    }
    r->blocks++;
}

static bool starts_at(const struct replay *r, const struct point *at)
{
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (maths_abs((double)r->section.start[i] * r->quantum_mm - at->at[i]) >
            START_MAX_MM + 0.5 * r->quantum_mm) {
            return false;
        }
    }
    return true;
}

/* The stream holds enough to begin with, or all there is of the section. */
static bool has_begin(const struct replay *r)
{
    const struct intake *s = r->intake;
    const uint32_t held = s->intervals_came - s->intervals_taken;

    return s->sections_came != s->sections_taken && held > 0 &&
           (!takt_intake_has_room(s) ||
            held >= maths_min(s->section[s->sections_taken % INTAKE_SECTIONS_MAX].intervals,
                              r->brake_intervals));
}

/* The axes stand where the section begins: at whatever rate, for nothing moves yet. */
static void begin_section(struct replay *r, const struct motion *m)
{
    struct intake *s = r->intake;

    r->section = s->section[s->sections_taken % INTAKE_SECTIONS_MAX];
    s->sections_taken++;
    for (int k = 1; k < 4; k++) {
        memcpy(r->control[k], r->section.start, sizeof(r->control[k]));
    }
    r->state = REPLAY_RUNS;
    r->interval = 0;
    r->taken = 0;
    r->part = 0.0;
    r->blocks = 0;
    r->begin = 0;
    shift(r);
    if (r->section.first_block != path_first(m->path)->number || !starts_at(r, &m->at)) {
        fail(r, TAKT_ERROR_PLAN_STRAYED);
        r->state = REPLAY_BETWEEN;
    }
}

/* -- the operator -- */

/* The rate as the operator wants it in this block. */
static double wanted_rate(const struct replay *r, const struct block *b,
                          const struct motion_operator *wanted)
{
    const double compiled = 0.01 * (double)r->intake->header.ceiling_percent;
    const unsigned may = b->move.overrides;
    double ratio = 1.0;

    if (r->alarm.code != TAKT_OK || motion_is_held(wanted, (may & OVERRIDE_HOLD) != 0)) {
        return 0.0;
    }
    if (b->move.kind == MOVE_RAPID) {
        ratio = wanted->rapid_ratio;
    } else if ((may & OVERRIDE_FEED) != 0) {
        ratio = wanted->feed_ratio;
    }
    return maths_clamp(ratio / compiled, 0.0, r->highest);
}

/* Nothing must be driven on which it could not come to rest: the stream is late. */
static bool is_starving(const struct replay *r)
{
    const struct intake *s = r->intake;
    const uint32_t held = s->intervals_came - s->intervals_taken;

    return r->taken + held < r->section.intervals && held < r->brake_intervals &&
           takt_intake_has_room(s);
}

/* -- single block -- */

/* From here to a place, in cycles of the curve. */
static double way_to(const struct replay *r, uint64_t end)
{
    return ((double)end / REPLAY_END_PARTS - (double)r->interval - r->part) / r->step;
}

/*
 * The first end of a block, but the section's, that can be braked for: it is known if its intervals
 * have come.
 */
static void find_stop(struct replay *r)
{
    const struct intake *s = r->intake;
    const double way = takt_halt_way(&r->rate);
    const uint64_t from = (uint64_t)takt_maths_ceil(
        ((double)r->interval + r->part + way * r->step) * REPLAY_END_PARTS);
    uint32_t left = r->section.blocks - r->blocks - 1;

    if (!has_end(r)) {
        return;
    }
    uint64_t end = end_of(r);

    for (uint32_t i = s->ends_taken + 1; end < from && i != s->ends_came && left > 1; i++, left--) {
        end += s->end[i % INTAKE_ENDS_MAX];
    }
    if (end >= from && end < (uint64_t)r->section.intervals * REPLAY_END_PARTS) {
        r->state = REPLAY_STOP_AHEAD;
        r->stop_end = end;
        r->halt = (struct halt){0};
    }
}

/* The cycle leads to the stop or towards it; without one, as slowly as the next one needs. */
static double step_to_stop(struct replay *r, double rate)
{
    const double to = maths_min(rate, HALT_RATE);

    if (r->state == REPLAY_RUNS && takt_halt_is_possible(&r->rate)) {
        find_stop(r);
    }
    if (r->state != REPLAY_STOP_AHEAD) {
        return takt_rate_step(&r->rate, to);
    }
    const double way = maths_max(way_to(r, r->stop_end), 0.0);
    const double here = takt_halt_step(&r->halt, &r->rate, to, way);

    if (here == way && rate_rests(&r->rate)) {
        r->state = REPLAY_STOP_REACHED;
    }
    return here;
}

/*
 * Nothing of the curve moves where a section begins: at once at the rate, if the first stop can
 * then be braked for.
 */
static void begin_rate(struct replay *r, double rate, bool single_block)
{
    takt_rate_set(&r->rate, single_block ? maths_min(rate, HALT_RATE) : rate);
    if (single_block && has_end(r) && takt_halt_way(&r->rate) > way_to(r, end_of(r))) {
        takt_rate_set(&r->rate, 0.0);
    }
}

/* -- the cycle -- */

/*
 * True: the section's end has been reached. Where nothing more is known, in spite of is_starving,
 * the axes stand at once.
 */
static bool advance(struct replay *r, double rate, bool single_block)
{
    const double way = single_block ? step_to_stop(r, rate) : takt_rate_step(&r->rate, rate);

    r->part += way * r->step;
    if (r->state == REPLAY_STOP_REACHED) { /* at the stop, whatever rounding says */
        r->part = (double)r->stop_end / REPLAY_END_PARTS - (double)r->interval;
    }
    while (r->part >= 1.0) {
        r->interval++;
        if (r->interval == r->section.intervals) {
            return true;
        }
        if (r->intake->intervals_taken == r->intake->intervals_came) {
            r->interval--;
            r->part = 1.0;
            takt_rate_set(&r->rate, 0.0);
            fail(r, TAKT_ERROR_PROGRAM_STARVED);
            return false;
        }
        r->part -= 1.0;
        shift(r);
    }
    return false;
}

/* Is what follows the oldest block no motion, or nothing? Then the program is another one. */
static bool is_cut_short(const struct path *p)
{
    const uint32_t next = p->first + 1;

    return next == p->closed ? p->finished : !path_at(p, next)->motion;
}

/* Passes a block if a motion is known behind it, and not too many have been passed yet. */
static bool pass_one(struct motion *m, unsigned *left)
{
    const uint32_t next = m->path->first + 1;

    if (*left == 0 || next == m->path->closed || !path_at(m->path, next)->motion) {
        return false;
    }
    takt_handover_pass_block(m);
    --*left;
    return true;
}

/* The pieces of the oldest motion but the one that ends it. False: some are left. */
static bool pass_pieces(struct motion *m, unsigned *left)
{
    while (path_at(m->path, m->path->first)->continues) {
        if (!pass_one(m, left)) {
            return false;
        }
    }
    return true;
}

/*
 * Blocks whose ends have been passed, as far as the path knows what follows; at the section's end
 * all but its last piece. False: some are left.
 */
static bool pass_blocks(struct replay *r, struct motion *m, bool ended)
{
    const double here = ((double)r->interval + r->part) * REPLAY_END_PARTS;
    unsigned left = PASS_MAX;

    while (ended || (has_end(r) && here >= (double)end_of(r))) {
        if (!pass_pieces(m, &left)) {
            return false;
        }
        if (r->blocks + 1 >= r->section.blocks) {
            return true;
        }
        if (!pass_one(m, &left)) {
            return false;
        }
        end_block(r);
    }
    return true;
}

/*
 * All blocks have been passed but the last one, and it ends where the curve does, but for half a
 * quantum of each axis.
 */
static bool ends_well(const struct replay *r, const struct motion *m)
{
    struct point at = m->at;

    point_at(r, &at);
    return r->blocks + 1 == r->section.blocks &&
           point_distance(&at, &path_first(m->path)->curve.end, AXIS_LINEAR_COUNT) <=
               START_MAX_MM + r->quantum_mm;
}

static void end_section(struct replay *r, struct motion *m, struct point *at)
{
    if (ends_well(r, m)) {
        *at = path_first(m->path)->curve.end;
    } else {
        fail(r, TAKT_ERROR_PLAN_STRAYED);
    }
    r->state = REPLAY_BETWEEN;
}

/* Has all of the curve been gone along? */
static bool is_over(const struct replay *r)
{
    return r->interval == r->section.intervals;
}

/* At the end of the curve the axes stand until all blocks have been passed. */
static void drive(struct replay *r, struct motion *m, double rate, bool single_block,
                  struct cycle_record *record)
{
    const struct point before = m->at;
    const bool over = is_over(r) || advance(r, rate, single_block);
    const bool passed = r->state == REPLAY_STOP_REACHED || pass_blocks(r, m, over);
    const bool ended = over && (passed || is_cut_short(m->path));
    struct point at = m->at;

    r->part = over ? 1.0 : r->part;
    if (ended) {
        end_section(r, m, &at);
    } else {
        point_at(r, &at);
    }
    if (over && !ended) {
        takt_rate_set(&r->rate, 0.0);
        r->waits = true;
    }
    takt_handover_add_cycle(m, &at, point_distance(&before, &at, AXIS_LINEAR_COUNT) / m->cycle_s,
                            ended, record);
    record->override_percent = r->rate.now * (double)r->intake->header.ceiling_percent;
    if (ended && r->alarm.code == TAKT_OK) {
        takt_handover_end(m);
    }
}

static void stand(struct motion *m, struct cycle_record *record)
{
    const struct point at = m->at;

    takt_handover_add_cycle(m, &at, 0.0, false, record);
}

/* A cycle at the end of a single block, from which the operator may go on once it is told. */
static bool stands_at_stop(struct replay *r, struct motion *m, double rate,
                           const struct motion_operator *wanted, struct cycle_record *record)
{
    const struct point at = m->at;

    if (r->state < REPLAY_STOP_REACHED) {
        return false;
    }
    if (r->state == REPLAY_STOP_TOLD && rate > 0.0 && !wanted->wait) {
        r->state = REPLAY_RUNS;
        (void)pass_blocks(r, m, false);
        return false;
    }
    takt_handover_add_cycle(m, &at, 0.0, r->state == REPLAY_STOP_REACHED, record);
    r->state = REPLAY_STOP_TOLD;
    return true;
}

/* The axes stand, and may not go on. */
static bool has_failed(const struct replay *r)
{
    return r->alarm.code != TAKT_OK && (r->state == REPLAY_BETWEEN || rate_rests(&r->rate));
}

enum replay_result takt_replay_cycle(struct replay *r, struct motion *m,
                                     const struct motion_operator *wanted,
                                     struct cycle_record *record)
{
    double rate = wanted_rate(r, path_first(m->path), wanted);

    if (has_failed(r)) {
        return REPLAY_FAILED;
    }
    r->waits = false;
    if (r->state == REPLAY_BETWEEN) {
        if (wanted->wait || rate == 0.0 || !has_begin(r) || !takt_motion_rests(m)) {
            r->waits = r->intake->sections_taken > 0 && rate > 0.0 && !has_begin(r);
            r->starved += r->waits ? 1 : 0;
            stand(m, record);
            return REPLAY_CYCLE;
        }
        begin_section(r, m);
        begin_rate(r, rate, wanted->single_block);
        if (r->state == REPLAY_BETWEEN) {
            return REPLAY_FAILED;
        }
    }
    if (stands_at_stop(r, m, rate, wanted, record)) {
        return REPLAY_CYCLE;
    }
    if (is_starving(r)) {
        r->starved++;
        r->waits = rate > 0.0 && rate_rests(&r->rate);
        rate = 0.0;
    }
    if (!wanted->single_block) {
        r->state = REPLAY_RUNS;
    }
    drive(r, m, rate, wanted->single_block, record);
    return REPLAY_CYCLE;
}
