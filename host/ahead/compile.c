#include "ahead/compile.h"

#include "ahead/exact.h"
#include "ahead/guess.h"
#include "base/fnv.h"
#include "base/maths.h"
#include "convex/vector.h"
#include "replay/replay.h"

#include <string.h>

/*
 * Exact path: the axes stop where the direction changes by more than this, and stay within so much
 * of an increment.
 */
#define EXACT_CHANGE 1e-6
#define EXACT_PART   0.5

/*
 * A section of which less than this part of its time, or so many knots, could be won is not
 * optimised.
 */
#define WORTH_PART  0.001
#define WORTH_KNOTS 2

/* With the whole tolerance, a half and so on. */
#define TRIES 4

static uint64_t add_number(uint64_t digest, uint64_t number)
{
    return takt_fnv_add_double(digest, (double)number);
}

uint64_t compile_digest(uint64_t digest, const struct move *m)
{
    digest = add_number(digest, (uint64_t)m->kind);
    if (!move_is_motion(m))
        return takt_fnv_add_double(digest, m->dwell_s);
    for (int i = 0; i < AXIS_COUNT; i++)
        digest = takt_fnv_add_double(digest, m->end.at[i]);
    digest = takt_fnv_add_double(digest, m->feed_mm_s);
    digest = add_number(digest, (uint64_t)m->path);
    digest = takt_fnv_add_double(digest, m->tolerance_mm);
    digest = add_number(digest, (uint64_t)m->plane);
    digest = add_number(digest, m->turns);
    digest = takt_fnv_add_double(digest, m->centre_mm[0]);
    digest = takt_fnv_add_double(digest, m->centre_mm[1]);
    digest = takt_fnv_add_double(digest, m->base_radius_mm);
    if (m->kind != MOVE_SPLINE)
        return digest;
    digest = takt_fnv_add_double(digest, m->curvature_1_mm[1]);
    return takt_fnv_add_double(digest, m->spline_mm);
}

/* The time in which the axes cross the smallest tolerance; 0: nothing is blended. */
static double crossing_s(const struct compile_config *config)
{
    const struct plan_limits *of = &config->limits;
    double least_s = MATHS_INFINITY;

    if (!(config->tolerance_part > 0))
        return 0;
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if ((of->axes & (1U << i)) != 0)
            least_s = maths_min(
                least_s, maths_max(takt_maths_cbrt(config->tolerance_mm / of->jerk_mm_s3[i]),
                                   maths_sqrt(config->tolerance_mm / of->acceleration_mm_s2[i])));
    }
    return least_s;
}

/* Knots so far apart that a controller that is fed while it runs holds what it brakes on. */
static double braking_cycles(const struct compile_config *config)
{
    struct rate rate;

    takt_rate_init(&rate, &config->limits, 1 - COMPILE_RESERVE_KEPT);
    return takt_maths_ceil(takt_rate_brake_cycles(&rate) / REPLAY_BRAKE_INTERVALS_MAX);
}

/* Third differences of an axis's control points: J h^3 at most, 2 A h^2 and 4 V h. */
static double largest_third(const struct plan_limits *of, int axis, double step_s)
{
    const double by_jerk = of->jerk_mm_s3[axis] * step_s * step_s * step_s;
    const double by_acceleration = 2 * of->acceleration_mm_s2[axis] * step_s * step_s;
    const double by_velocity = 4 * of->velocity_mm_s[axis] * step_s;

    return maths_min(by_jerk, maths_min(by_acceleration, by_velocity));
}

/* Bits of the quantum with knots so far apart: for the axis whose third differences are largest. */
static uint32_t quantum_bits(const struct plan_limits *of, double step_s)
{
    double third_mm = 0;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if ((of->axes & (1U << i)) != 0)
            third_mm = maths_max(third_mm, largest_third(of, i, step_s));
    }
    return encoder_quantum_bits(third_mm);
}

static double quantum_mm(const struct plan_limits *of, double step_s)
{
    return 1 / (double)(UINT64_C(1) << quantum_bits(of, step_s));
}

/* J tau^3 of the axis that has the least. */
static double least_jerk_mm(const struct plan_limits *of)
{
    double least = MATHS_INFINITY;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if ((of->axes & (1U << i)) != 0)
            least = maths_min(least, of->jerk_mm_s3[i]);
    }
    return least * of->cycle_s * of->cycle_s * of->cycle_s;
}

/*
 * At the ends of sections setpoints go from whole quanta to where blocks end: no axis may see that
 * as jerk.
 */
static uint32_t fine_cycles(const struct plan_limits *of, uint32_t cycles)
{
    while (cycles > 1 &&
           quantum_mm(of, cycles * of->cycle_s) > COMPILE_QUANTUM_PART * least_jerk_mm(of))
        cycles--;
    return cycles;
}

/* Knots no farther apart than this. */
static double most_cycles(const struct compile_config *config, double cycle_s)
{
    const double by_size = maths_max(takt_maths_ceil(COMPILE_STEP_S / cycle_s - 1e-9), 1);
    const double by_modes = modes_step_s(&config->vibration) / cycle_s;

    return by_size <= by_modes ? by_size : maths_max((double)(uint32_t)by_modes, 1);
}

static uint32_t step_cycles(const struct compile_config *config)
{
    const double cycle_s = 1e-6 * config->cycle_us;
    const double most = most_cycles(config, cycle_s);
    const double wanted =
        (double)(uint32_t)(maths_min(crossing_s(config), 1) / (COMPILE_CROSSING_KNOTS * cycle_s));

    return fine_cycles(&config->limits,
                       (uint32_t)maths_clamp(maths_max(wanted, braking_cycles(config)), 1, most));
}

/*
 * Rounding of control points to quanta changes third differences by four of them at most. The
 * reserve but for what is kept for the rate is for that; what it takes more is left out of the
 * jerk, of which half remains.
 */
static double usable_jerk(const struct compile *c, double jerk_mm_s3)
{
    const double step_s = c->limits.step_s;
    const double rounding = 4 * quantum_mm(&c->config.limits, step_s) / (step_s * step_s * step_s);
    const double least = maths_min((1 - COMPILE_RESERVE) * jerk_mm_s3,
                                   (1 - COMPILE_RESERVE_KEPT) * jerk_mm_s3 - rounding);

    return maths_max(least, 0.5 * jerk_mm_s3);
}

/* What the optimiser may use of the machine. */
static void set_limits(struct compile *c)
{
    const struct plan_limits *of = &c->config.limits;

    c->step_cycles = step_cycles(&c->config);
    c->limits.cycle_s = 1e-6 * c->config.cycle_us;
    c->limits.step_s = (double)c->step_cycles * c->limits.cycle_s;
    modes_init(&c->limits.modes, &c->config.vibration, c->limits.step_s, c->limits.cycle_s);
    c->exact = *of;
    c->exact.cycle_s = c->limits.step_s;
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        c->limits.velocity_mm_s[i] = COMPILE_SPEED_PART * of->velocity_mm_s[i];
        c->limits.acceleration_mm_s2[i] = (1 - COMPILE_RESERVE) * of->acceleration_mm_s2[i];
        c->limits.jerk_mm_s3[i] = usable_jerk(c, of->jerk_mm_s3[i]);
        c->exact.velocity_mm_s[i] = c->limits.velocity_mm_s[i];
        c->exact.acceleration_mm_s2[i] = c->limits.acceleration_mm_s2[i];
        c->exact.jerk_mm_s3[i] = c->limits.jerk_mm_s3[i];
        if ((of->axes & (1U << i)) == 0) { /* it never moves: any limit will do */
            c->limits.velocity_mm_s[i] = 1;
            c->limits.acceleration_mm_s2[i] = 1;
            c->limits.jerk_mm_s3[i] = 1;
        }
    }
}

static struct replay_header header_of(const struct compile *c)
{
    const struct plan_limits *of = &c->config.limits;
    struct replay_header h = {
        .cycle_us = c->config.cycle_us,
        .step_cycles = c->step_cycles,
        .ceiling_percent = c->config.ceiling_percent,
        .text_size = c->config.text_size,
        .text_crc = c->config.text_crc,
        .kept = 1 - COMPILE_RESERVE_KEPT,
    };

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if ((of->axes & (1U << i)) == 0)
            continue;
        h.velocity_mm_s[i] = of->velocity_mm_s[i];
        h.acceleration_mm_s2[i] = of->acceleration_mm_s2[i];
        h.jerk_mm_s3[i] = of->jerk_mm_s3[i];
    }
    h.quantum_bits = quantum_bits(of, c->limits.step_s);
    return h;
}

enum compile_result compile_begin(struct compile *c, const struct compile_config *config,
                                  const struct point *start, FILE *stream)
{
    struct replay_header header;

    memset(c, 0, sizeof *c);
    c->config = *config;
    c->at = *start;
    c->digest = FNV_START;
    ahead_path_init(&c->path);
    set_limits(c);
    header = header_of(c);
    encoder_begin(&c->encoder, stream, &header);
    c->solver = solver_new(config->workers, &c->limits.modes);
    return c->solver != NULL ? COMPILE_DONE : COMPILE_MEMORY;
}

void compile_free(struct compile *c)
{
    solver_free(c->solver);
    ahead_path_free(&c->path);
}

/* Progress of all the work: finished sections by their blocks. */
static bool tell_progress(void *context, double part)
{
    const struct compile *c = context;
    const double all = maths_max(c->config.blocks, c->blocks);
    const double done = c->solved + part * (double)(c->blocks - c->solved);

    return c->config.progress == NULL ||
           c->config.progress(c->config.context, done / maths_max(all, 1), c->time_s);
}

static enum compile_result try_once(struct compile *c, const struct trail *exact,
                                    struct trail *trail, bool *stuck)
{
    /* On the exact path the tool swings: no time is too long. */
    const size_t longest = c->limits.modes.count > 0 ? SIZE_MAX : exact->intervals;

    *stuck = false;
    if (!guess_trail(&c->path, &c->limits, trail))
        return COMPILE_MEMORY;
    switch (solver_run(c->solver, &c->path, &c->limits, trail, longest, tell_progress, c)) {
    case SOLVER_DONE:
        return COMPILE_DONE;
    case SOLVER_STOPPED:
        return COMPILE_STOPPED;
    case SOLVER_MEMORY:
        return COMPILE_MEMORY;
    case SOLVER_STUCK:
        *stuck = true;
        break;
    }
    return COMPILE_DONE;
}

static void narrow(struct ahead_path *path)
{
    for (size_t k = 0; k < path->count; k++)
        path->element[k].tolerance_mm *= 0.5;
}

/*
 * Optimised, or where that finds nothing better the exact path, which is lent and given back. Where
 * a tolerance is too wide for its path, so that nothing legal is found, half of it may do.
 */
static enum compile_result optimise(struct compile *c, struct trail *exact)
{
    struct trail trail = {0};
    enum compile_result result = COMPILE_DONE;
    bool stuck = true;

    for (int tries = 0; tries < TRIES && stuck && result == COMPILE_DONE; tries++) {
        result = try_once(c, exact, &trail, &stuck);
        if (result != COMPILE_DONE || stuck)
            trail_free(&trail);
        if (stuck)
            narrow(&c->path);
    }
    if (result == COMPILE_DONE && !stuck) {
        trail_free(exact);
        *exact = trail;
    }
    return result;
}

/* Can more be won than the knots at both ends? */
static bool is_worth_it(const struct compile *c, const struct trail *exact)
{
    const double least_s = exact_least_s(&c->path, &c->exact);
    const double exact_s = (double)(exact->intervals - TRAIL_ENDS) * c->limits.step_s;

    return c->limits.modes.count > 0 ||
           exact_s > (1 + WORTH_PART) * least_s + WORTH_KNOTS * c->limits.step_s;
}

/* The section on its exact path, within every limit. */
static bool drive_exactly(struct compile *c, struct trail *trail)
{
    if (!exact_trail(&c->path, &c->exact, c->config.stops, trail, &c->wrong.line))
        return false;
    if (c->config.stops || exact_is_legal(trail, &c->exact))
        return true;
    trail_free(trail);
    return exact_trail(&c->path, &c->exact, true, trail, &c->wrong.line);
}

static enum compile_result not_driven(struct compile *c)
{
    c->wrong.why = "the axes do not go on here, and nothing explains it: a fault of the planner";
    return c->wrong.line != 0 ? COMPILE_UNFIT : COMPILE_MEMORY;
}

/* Plans and writes what has been collected. */
static enum compile_result end_section(struct compile *c)
{
    enum compile_result result;
    struct trail trail = {0};

    if (c->path.count == 0)
        return COMPILE_DONE;
    if (!drive_exactly(c, &trail))
        return not_driven(c);
    result =
        c->config.tolerance_part > 0 && is_worth_it(c, &trail) ? optimise(c, &trail) : COMPILE_DONE;
    if (result == COMPILE_DONE) {
        c->time_s += (double)trail.intervals * c->limits.step_s;
        encoder_add(&c->encoder, &c->path, &trail);
        result = c->encoder.failed ? COMPILE_UNWRITTEN : COMPILE_DONE;
    }
    trail_free(&trail);
    ahead_path_clear(&c->path);
    c->solved = c->blocks;
    return result;
}

static enum compile_result unfit(struct compile *c, const struct move *move, const char *why)
{
    c->wrong.line = move->line;
    c->wrong.why = why;
    return COMPILE_UNFIT;
}

static bool turns_rotary(const struct move *move, const struct point *from)
{
    for (int i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        if (move->end.at[i] != from->at[i])
            return true;
    }
    return false;
}

/* NULL: it can be compiled. */
static const char *why_unfit(const struct move *move)
{
    if (move->feed_rev_mm != 0)
        return "feed per revolution follows the spindle and cannot be planned ahead";
    if (move->kind == MOVE_PROBE)
        return "what follows a probing move cannot be planned ahead";
    return NULL;
}

static bool is_exact(const struct move *move)
{
    return move->path != PATH_BLEND || !(move->tolerance_mm > 0);
}

/*
 * Is the junction between the last element collected and a curve passed without a change of
 * direction?
 */
static bool is_tangent(const struct compile *c, const struct curve *next)
{
    const struct curve *last = &c->path.element[c->path.count - 1].curve;
    struct point in;
    struct point out;

    takt_curve_tangent(last, last->length_mm, &in);
    takt_curve_tangent(next, 0, &out);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (maths_abs(in.at[i] - out.at[i]) > EXACT_CHANGE)
            return false;
    }
    return true;
}

/* An exact stop, or a junction that may not be rounded. */
static bool begins_section(const struct compile *c, const struct ahead_element *e)
{
    if (c->path.count == 0)
        return false;
    const struct ahead_element *last = &c->path.element[c->path.count - 1];

    return last->stop || ((e->exact || last->exact) && !is_tangent(c, &e->curve));
}

/*
 * Where the tolerance changes, both neighbours keep the smaller one: what is near to both is in
 * either's.
 */
static void share_tolerance(struct compile *c, struct ahead_element *e)
{
    const double own_mm = e->tolerance_mm;

    if (c->path.count > 0) {
        struct ahead_element *last = &c->path.element[c->path.count - 1];

        e->tolerance_mm = maths_min(own_mm, c->tolerance_mm);
        last->tolerance_mm = maths_min(last->tolerance_mm, own_mm);
    }
    c->tolerance_mm = own_mm;
}

static struct ahead_shape shape_of(const struct move *move)
{
    return (struct ahead_shape){
        .kind = move->kind,
        .plane = move->plane,
        .turns = move->turns,
        .heading_rad = {move->heading_rad[0], move->heading_rad[1]},
        .curvature_1_mm = {move->curvature_1_mm[0], move->curvature_1_mm[1]},
        .spline_mm = move->spline_mm};
}

static enum compile_result add_motion(struct compile *c, const struct move *move)
{
    const char *why = why_unfit(move);
    const double part = c->config.tolerance_part > 0 ? c->config.tolerance_part : 1;
    struct ahead_element e = {.line = move->line, .shape = shape_of(move)};
    enum compile_result result = COMPILE_DONE;

    c->blocks++;
    if (why != NULL)
        return unfit(c, move, why);
    if (!takt_move_curve(move, &c->at, &e.curve))
        return COMPILE_DONE;
    if (turns_rotary(move, &c->at)) /* left to the planner on board, from rest to rest */
        return end_section(c);
    e.block = c->blocks;
    e.exact = is_exact(move);
    e.stop = move->path == PATH_EXACT_STOP;
    e.tolerance_mm =
        e.exact ? EXACT_PART * c->config.limits.chord_error_max_mm : part * move->tolerance_mm;
    e.feed_mm_s = move->kind == MOVE_RAPID ? MATHS_INFINITY
                                           : 0.01 * c->config.ceiling_percent * move->feed_mm_s;
    if (begins_section(c, &e))
        result = end_section(c);
    share_tolerance(c, &e);
    if (result == COMPILE_DONE && !ahead_path_add(&c->path, &e))
        result = COMPILE_MEMORY;
    return result;
}

enum compile_result compile_add(struct compile *c, const struct move *move)
{
    enum compile_result result;

    c->digest = compile_digest(c->digest, move);
    if (!move_is_motion(move))
        return end_section(c);
    result = add_motion(c, move);
    c->at = move->end;
    return result;
}

enum compile_result compile_end(struct compile *c)
{
    const enum compile_result result = end_section(c);

    if (result != COMPILE_DONE)
        return result;
    return encoder_end(&c->encoder, c->digest) ? COMPILE_DONE : COMPILE_UNWRITTEN;
}
