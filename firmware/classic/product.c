#include "classic/product.h"

#include "base/maths.h"
#include "classic/s_curve.h"
#include "motion/handover.h"
#include "plan/ceiling.h"

#include <string.h>

/* Blocks that one cycle passes at most. */
#define PASS_MAX 64

/* Less than this part of a cycle is rounding. */
#define CYCLE_SLACK 1e-6

void takt_product_init(struct product *p, const struct product_config *config)
{
    memset(p, 0, sizeof(*p));
    p->config = *config;
    p->override.now = 1.0;
    p->override.to = 1.0;
    p->limiter = 1.0;
}

static const struct block *first_block(const struct motion *m)
{
    return path_first(m->path);
}

/* -- the diagram of a block -- */

static struct diagram_limits limits_of(const struct path *path, uint32_t index)
{
    const struct path_block *b = path_at(path, index);
    const struct ceiling_request as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};

    return (struct diagram_limits){.length_mm = takt_path_length(path, index),
                                   .feed_mm_s =
                                       takt_ceiling_block_feed(path, index, &as_programmed),
                                   .a_mm_s2 = (double)b->a_mm_s2,
                                   .j_mm_s3 = (double)b->j_mm_s3};
}

/* The highest feed at the end of a block when the next one may begin with a feed. */
static double end_feed(const struct path *path, uint32_t index, double next_start_mm_s)
{
    const struct path_block *b = path_at(path, index);
    const double junction_mm_s = b->end == JUNCTION_STOP ? 0.0 : (double)b->feed_junction_mm_s;

    if (!path_at(path, index + 1)->motion) {
        return 0.0;
    }
    return maths_min(maths_min(junction_mm_s, next_start_mm_s), limits_of(path, index).feed_mm_s);
}

/* The feed at the end of the oldest block from which the rest can still be stopped (look-ahead). */
static double plan_end(const struct path *path)
{
    double start_mm_s = 0.0;

    for (uint32_t k = path->closed - 1; k != path->first; k--) {
        const bool is_last = k == path->closed - 1;

        if (path_at(path, k)->motion) {
            const struct diagram_limits limits = limits_of(path, k);

            start_mm_s = takt_diagram_reach(&limits, is_last ? 0.0 : end_feed(path, k, start_mm_s));
        }
    }
    return path->closed - 1 == path->first ? 0.0 : end_feed(path, path->first, start_mm_s);
}

static void begin_block(struct product *p, const struct motion *m, double start_mm_s)
{
    const struct diagram_limits limits = limits_of(m->path, m->path->first);
    const double end_mm_s = maths_min(plan_end(m->path), takt_diagram_reach(&limits, start_mm_s));

    takt_diagram_set(&p->diagram, &limits, start_mm_s, end_mm_s, p->config.cycle_s);
    p->moves = true;
    p->way_mm = 0.0;
}

/* -- the factors -- */

/* What the operator wants of this block. */
static double wanted_ratio(const struct block *b, const struct motion_operator *wanted)
{
    const unsigned may = b->move.overrides;

    if (motion_is_held(wanted, (may & OVERRIDE_HOLD) != 0)) {
        return 0.0;
    }
    if (b->move.kind == MOVE_RAPID) {
        return wanted->rapid_ratio;
    }
    return (may & OVERRIDE_FEED) != 0 ? wanted->feed_ratio : 1.0;
}

/* %Fz stands still while a block brakes. A stop is none of it, nor is what follows one. */
static bool is_locked(const struct product *p)
{
    return takt_diagram_brakes(&p->diagram, p->time_s) && p->override.to > 0.0 &&
           p->override.from > 0.0;
}

/* %Fz: an S-curve whose acceleration and jerk, at the diagram's feed, are the block's. */
static void follow_override(struct product *p, const struct block *b, double to)
{
    struct product_override *o = &p->override;
    const double feed_mm_s = p->diagram.kl * p->diagram.cruise_mm_s;

    if ((o->total_s == 0.0 && o->now != to) || (to == 0.0 && o->to > 0.0)) {
        o->from = o->now;
        o->to = to;
        o->time_s = 0.0;
        o->total_s = takt_s_curve_time(maths_abs(to - o->now), b->a_mm_s2 / feed_mm_s,
                                       b->j_mm_s3 / feed_mm_s, &o->round);
    }
    if (o->total_s == 0.0 || is_locked(p)) {
        return;
    }
    o->time_s = maths_min(o->time_s + p->config.cycle_s, o->total_s);
    o->now = o->from + (o->to - o->from) * takt_s_curve(o->time_s / o->total_s, o->round);
    if (o->time_s == o->total_s) {
        o->now = o->to;
        o->total_s = 0.0;
    }
}

/*
 * K, found in this cycle for the next one, of what the axes' velocities would have been without it.
 */
static void limit_axes(struct product *p, const struct motion *m, const struct point *at)
{
    struct point velocity;

    for (int i = 0; i < AXIS_COUNT; i++) {
        velocity.at[i] = (at->at[i] - m->at.at[i]) / (p->config.cycle_s * p->limiter);
    }
    p->limiter = takt_limiter_factor(p->config.limiter, &velocity, m->path->limits.velocity_mm_s,
                                     p->config.band_percent);
}

/* Without a limiter of the source: the block's own ceiling, in this cycle. */
static void keep_ceiling(struct product *p, const struct block *b)
{
    const double feed_mm_s = takt_diagram_feed(&p->diagram, p->time_s) * p->override.now;

    if (p->config.limiter == LIMITER_CEILING) {
        p->limiter = feed_mm_s > b->feed_max_mm_s ? b->feed_max_mm_s / feed_mm_s : 1.0;
    }
}

/* -- the cycle -- */

/* The oldest block ends at rest, or where nothing more is known. */
static bool is_last(const struct motion *m)
{
    const struct path *path = m->path;

    return first_block(m)->end == JUNCTION_STOP || path->first + 1 == path->closed ||
           !path_at(path, path->first + 1)->motion;
}

/*
 * Goes on in the diagram, and over into the next ones; returns the way. *landed: the cycle ends
 * with a block. *rests: at the end of one that is not passed.
 */
static double go(struct product *p, struct motion *m, bool *landed, bool *rests)
{
    const double slack_s = CYCLE_SLACK * p->config.cycle_s;
    double way_mm = -p->way_mm;

    p->time_s += p->config.cycle_s * p->override.now * p->limiter;
    for (unsigned passed = 0; passed < PASS_MAX; passed++) {
        const double left_s = takt_diagram_time(&p->diagram) - p->time_s;

        *landed = left_s <= slack_s && (left_s >= -slack_s || is_last(m));
        *rests = *landed && is_last(m);
        if (*landed || left_s > 0.0) {
            break;
        }
        way_mm += first_block(m)->length_mm;
        takt_handover_pass_block(m);
        begin_block(p, m, p->diagram.end_mm_s);
        p->time_s = -left_s;
    }
    p->way_mm = *landed ? first_block(m)->length_mm : takt_diagram_way(&p->diagram, p->time_s);
    return way_mm + p->way_mm;
}

static void point_at(const struct product *p, const struct motion *m, bool landed, struct point *at)
{
    const struct block *b = first_block(m);

    if (landed) {
        *at = b->curve.end;
    } else {
        *at = m->at;
        takt_curve_point(&b->curve, maths_clamp(p->way_mm, 0.0, b->length_mm) * b->scale, at);
    }
}

/* The cycle before this one has ended a block: on to the next one. */
static void leave_landed(struct product *p, struct motion *m)
{
    if (p->landed) {
        takt_handover_pass_block(m);
        begin_block(p, m, p->diagram.end_mm_s);
        p->time_s = 0.0;
        p->landed = false;
    }
}

/*
 * May the stop be left? Not in the cycle that has passed something there, which may be waited for.
 */
static bool may_leave(const struct motion *m, const struct motion_operator *wanted)
{
    return m->passed_first == m->path->first && !wanted->wait &&
           wanted_ratio(first_block(m), wanted) > 0.0;
}

static void leave_stop(struct product *p, struct motion *m, const struct motion_operator *wanted)
{
    begin_block(p, m, 0.0);
    p->time_s = 0.0;
    p->limiter = 1.0;
    p->override.now = wanted_ratio(first_block(m), wanted);
    p->override.total_s = 0.0;
}

static void stand(struct product *p, struct motion *m, struct cycle_record *record)
{
    const struct point at = m->at;

    takt_handover_add_cycle(m, &at, 0.0, false, record);
    record->override_percent = 100.0 * p->override.now;
}

static void move(struct product *p, struct motion *m, const struct motion_operator *wanted,
                 struct cycle_record *record)
{
    struct point at;
    bool landed = false;
    bool rests = false;

    leave_landed(p, m);
    follow_override(p, first_block(m), wanted_ratio(first_block(m), wanted));
    keep_ceiling(p, first_block(m));
    const double limiter = p->limiter;
    const double way_mm = go(p, m, &landed, &rests);

    point_at(p, m, landed, &at);
    limit_axes(p, m, &at);
    takt_handover_add_cycle(m, &at, way_mm / p->config.cycle_s * first_block(m)->scale, landed,
                            record);
    record->override_percent = 100.0 * p->override.now;
    record->limiter = limiter;
    p->landed = landed && !rests;
    if (rests) {
        p->moves = false;
        takt_handover_end(m);
    }
}

void takt_product_cycle(struct product *p, struct motion *m, const struct motion_operator *wanted,
                        struct cycle_record *record)
{
    if (!p->moves && may_leave(m, wanted)) {
        leave_stop(p, m, wanted);
    }
    if (p->moves) {
        move(p, m, wanted, record);
    } else {
        stand(p, m, record);
    }
}
