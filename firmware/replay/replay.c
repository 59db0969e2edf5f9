#include "replay/replay.h"

#include "base/maths.h"
#include "motion/handover.h"

#include <string.h>

/* A section's start and the axes may differ by rounding to quanta. */
#define START_MAX_MM 1e-6

/* More than these need not be there to go on: the ring holds no more. */
#define BRAKE_INTERVALS_MAX (INTAKE_INTERVALS_MAX - 2 * REPLAY_RECORD_INTERVALS)

/* Blocks that one cycle passes at most. */
#define PASS_MAX 64

void replay_init(struct replay *r, const struct replay_source *source)
{
    memset(r, 0, sizeof(*r));
    intake_open(&r->intake, source);
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
    const struct replay_header *h = &r->intake.header;

    r->quantum_mm = 1.0;
    for (uint32_t i = 0; i < h->quantum_bits; i++) {
        r->quantum_mm *= 0.5;
    }
    r->step = 1.0 / (double)h->step_cycles;
    rate_init(&r->rate, limits, h->kept);
    r->brake_intervals = (uint32_t)maths_min(maths_ceil(rate_brake_cycles(&r->rate) * r->step) + 2,
                                             BRAKE_INTERVALS_MAX);
}

void replay_read(struct replay *r, const struct plan_limits *limits)
{
    intake_read(&r->intake);
    if (r->intake.has_header && r->step == 0.0) {
        begin_intake(r, limits);
    }
    if (r->intake.fault != REPLAY_GOOD) {
        fail(r, TAKT_ERROR_PLAN_DAMAGED);
    }
}

void replay_prepare(struct move *move)
{
    if (move_is_motion(move) && move->path == PATH_BLEND) {
        move->path = PATH_EXACT;
    }
}

/* -- the curve -- */

/* The next interval's last control point, by the third difference c3' - 3 c3 + 3 c2 - c1. */
static void shift(struct replay *r)
{
    const int16_t *third = r->intake.third[r->intake.intervals_taken % INTAKE_INTERVALS_MAX];

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const int64_t c1 = r->control[1][i];
        const int64_t c2 = r->control[2][i];
        const int64_t c3 = r->control[3][i];

        r->control[0][i] = c1;
        r->control[1][i] = c2;
        r->control[2][i] = c3;
        r->control[3][i] = third[i] + 3 * (c3 - c2) + c1;
    }
    r->intake.intervals_taken++;
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

static void take_end(struct replay *r)
{
    struct intake *s = &r->intake;

    r->has_end = r->blocks + 1 < r->section.blocks && s->ends_taken != s->ends_came;
    if (r->has_end) {
        r->end += s->end[s->ends_taken % INTAKE_ENDS_MAX];
        s->ends_taken++;
    }
}

static bool starts_at(const struct replay *r, const struct point *at)
{
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (maths_abs((double)r->section.start[i] * r->quantum_mm - at->at[i]) > START_MAX_MM) {
            return false;
        }
    }
    return true;
}

/* The stream holds enough to begin with, or all there is of the section. */
static bool has_begin(const struct replay *r)
{
    const struct intake *s = &r->intake;
    const uint32_t held = s->intervals_came - s->intervals_taken;

    return s->sections_came != s->sections_taken && held > 0 &&
           (!intake_has_room(s) ||
            held >= maths_min(s->section[s->sections_taken % INTAKE_SECTIONS_MAX].intervals,
                              r->brake_intervals));
}

/* The axes stand where the section begins: at whatever rate, for nothing moves yet. */
static void begin_section(struct replay *r, const struct motion *m)
{
    struct intake *s = &r->intake;

    r->section = s->section[s->sections_taken % INTAKE_SECTIONS_MAX];
    s->sections_taken++;
    for (int k = 1; k < 4; k++) {
        memcpy(r->control[k], r->section.start, sizeof(r->control[k]));
    }
    r->begun = true;
    r->interval = 0;
    r->taken = 0;
    r->part = 0.0;
    r->blocks = 0;
    r->end = 0;
    take_end(r);
    shift(r);
    if (r->section.first_block != path_at(m->path, m->path->first)->number ||
        !starts_at(r, &m->at)) {
        fail(r, TAKT_ERROR_PLAN_STRAYED);
        r->begun = false;
    }
}

/* -- the operator -- */

/* The rate as the operator wants it in this block. */
static double wanted_rate(const struct replay *r, const struct block *b,
                          const struct motion_operator *wanted)
{
    const double compiled = 0.01 * (double)r->intake.header.ceiling_percent;
    const unsigned may = b->move.overrides;
    double ratio = 1.0;

    if (wanted->stop || r->alarm.code != TAKT_OK || (wanted->hold && (may & OVERRIDE_HOLD) != 0)) {
        return 0.0;
    }
    if (b->move.kind == MOVE_RAPID) {
        ratio = wanted->rapid_ratio;
    } else if ((may & OVERRIDE_FEED) != 0) {
        ratio = wanted->feed_ratio;
    }
    return maths_clamp(ratio / compiled, 0.0, 1.0);
}

/* Nothing must be driven that could not be come to rest on: the stream is late. */
static bool is_starving(const struct replay *r)
{
    const struct intake *s = &r->intake;
    const uint32_t held = s->intervals_came - s->intervals_taken;

    return r->taken + held < r->section.intervals && held < r->brake_intervals &&
           intake_has_room(s);
}

/* -- the cycle -- */

/*
 * True: the section's end has been reached. Where nothing more is known, in spite of is_starving, the axes stand at once.
 */
static bool advance(struct replay *r, double rate)
{
    r->part += rate_step(&r->rate, rate) * r->step;
    while (r->part >= 1.0) {
        r->interval++;
        if (r->interval == r->section.intervals) {
            return true;
        }
        if (r->intake.intervals_taken == r->intake.intervals_came) {
            r->interval--;
            r->part = 1.0;
            rate_set(&r->rate, 0.0);
            fail(r, TAKT_ERROR_PROGRAM_STARVED);
            return false;
        }
        r->part -= 1.0;
        shift(r);
    }
    return false;
}

/* All pieces of the oldest motion but, of the section's last one, the piece that ends it. */
static void pass_motion(struct motion *m)
{
    bool more = true;

    for (unsigned i = 0; i < PASS_MAX && more; i++) {
        more = path_at(m->path, m->path->first)->continues;
        handover_pass_block(m);
    }
}

/* Blocks whose ends have been passed, as far as the path knows what follows. */
static void pass_blocks(struct replay *r, struct motion *m, bool ended)
{
    const double here = ((double)r->interval + r->part) * REPLAY_END_PARTS;

    for (unsigned i = 0; i < PASS_MAX || ended; i++) {
        if (r->blocks + 1 >= r->section.blocks || m->path->first + 1 == m->path->closed ||
            (!ended && (!r->has_end || here < (double)r->end))) {
            break;
        }
        pass_motion(m);
        r->blocks++;
        take_end(r);
    }
}

static double distance(const struct point *a, const struct point *b)
{
    double sum = 0.0;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        sum += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    }
    return maths_sqrt(sum);
}

/* All blocks have been passed but the last one, and it ends where the curve does. */
static bool ends_well(const struct replay *r, const struct motion *m)
{
    struct point at = m->at;

    point_at(r, &at);
    return r->blocks + 1 == r->section.blocks &&
           distance(&at, &path_at(m->path, m->path->first)->curve.end) <= START_MAX_MM;
}

static void end_section(struct replay *r, struct motion *m, struct point *at)
{
    r->part = 1.0;
    if (ends_well(r, m)) {
        *at = path_at(m->path, m->path->first)->curve.end;
    } else {
        fail(r, TAKT_ERROR_PLAN_STRAYED);
    }
    r->begun = false;
}

/* The rate until the next section begins is what the operator wants: nothing moves yet. */
static void drive(struct replay *r, struct motion *m, double rate, struct cycle_record *record)
{
    const struct point before = m->at;
    struct point at = m->at;
    bool ended;

    ended = advance(r, rate);
    pass_blocks(r, m, ended);
    if (ended) {
        end_section(r, m, &at);
    } else {
        point_at(r, &at);
    }
    handover_add_cycle(m, &at, distance(&before, &at) / m->cycle_s, ended, record);
    record->override_percent = r->rate.now * (double)r->intake.header.ceiling_percent;
    if (ended && r->alarm.code == TAKT_OK) {
        handover_end(m);
    }
}

static void stand(struct motion *m, struct cycle_record *record)
{
    const struct point at = m->at;

    handover_add_cycle(m, &at, 0.0, false, record);
}

/* The axes stand, and may not go on. */
static bool has_failed(const struct replay *r)
{
    return r->alarm.code != TAKT_OK && (!r->begun || rate_rests(&r->rate));
}

enum replay_result replay_cycle(struct replay *r, struct motion *m,
                                const struct motion_operator *wanted, struct cycle_record *record)
{
    double rate = wanted_rate(r, path_at(m->path, m->path->first), wanted);

    if (has_failed(r)) {
        return REPLAY_FAILED;
    }
    if (!r->begun) {
        if (wanted->wait || rate == 0.0 || !has_begin(r)) {
            r->starved += has_begin(r) ? 0 : 1;
            stand(m, record);
            return REPLAY_CYCLE;
        }
        begin_section(r, m);
        rate_set(&r->rate, rate);
        if (!r->begun) {
            return REPLAY_FAILED;
        }
    }
    if (is_starving(r)) {
        r->starved++;
        rate = 0.0;
    }
    drive(r, m, rate, record);
    return REPLAY_CYCLE;
}
