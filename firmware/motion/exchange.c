/*
 * Ceilings go from the background to the cycle: the cycle asks for one, the background builds it in
 * the one of two that is free, and the cycle goes over to it where it may. Neither waits for the
 * other.
 */
#include "motion/exchange.h"

#include "base/assert.h"
#include "base/handoff.h"
#include "motion/motion.h"
#include "plan/path_unit.h"

/*
 * A ceiling that had no room for all blocks is made anew when the trapezoidal reference has gone
 * this part of its length.
 */
#define RENEW_PART 0.25

/* -- the background -- */

/* One of the path's two ceilings: the cycle is in one, and may be going over to the other. */
static struct ceiling *ceiling_of(const struct motion *m, unsigned which)
{
    TAKT_ASSERT(which != m->path->spare);
    return path_ceiling(m->path, which);
}

const struct ceiling_request *takt_motion_wanted(struct motion *m)
{
    const bool wanted = handoff_get_count(&m->exchange) == MOTION_CEILING_WANTED;

    TAKT_ASSERT(m->active < 2);
    m->path->spare = wanted ? 1 - m->active : PATH_NO_SPARE;
    return wanted ? &m->request : NULL;
}

uint32_t takt_motion_ahead(struct motion *m)
{
    if ((int32_t)(m->request.first - m->ahead) > 0) {
        m->ahead = m->request.first;
    }
    while (m->ahead != m->path->closed) {
        if ((int64_t)(path_end(m->path, m->ahead) - m->request.reference) > 0) {
            break;
        }
        m->ahead++;
    }
    TAKT_ASSERT((int32_t)(m->path->closed - m->ahead) >= 0);
    return m->path->closed == m->ahead ? 0 : m->path->closed - m->ahead - 1;
}

/* What is asked for, whole: a late background may have been asked anew while it took it. */
static struct ceiling_request take_request(const struct motion *m, uint32_t *restarts)
{
    struct ceiling_request request;
    uint32_t times;

    do {
        times = handoff_get_count(&m->asked);
        request = m->request;
        *restarts = m->asked_restarts;
    } while (times != handoff_get_count(&m->asked));
    return request;
}

/*
 * Over all blocks, or as far as there was room and the trapezoidal reference has not come near the
 * end of that.
 */
static bool reaches_far(const struct motion *m, const struct ceiling *c, uint64_t reference)
{
    TAKT_ASSERT(c->behind == m->made_closed || c->count > 0);
    if (c->behind == m->made_closed) {
        return m->made_closed == m->path->closed;
    }
    return path_mm(c->origin, reference) < RENEW_PART * c->end_mm[c->count - 1];
}

/*
 * The path that was asked about has been dropped since: blocks of another one may lie in its ring
 * by now.
 */
static bool is_dropped(const struct motion *m, uint32_t restarts)
{
    return restarts != handoff_get_count(&m->restarts);
}

/* Would a new ceiling be the one that is there? */
static bool is_unchanged(const struct motion *m, const struct ceiling_request *request)
{
    const struct ceiling *c = ceiling_of(m, m->active);

    return m->made.feed_ratio == request->feed_ratio &&
           m->made.rapid_ratio == request->rapid_ratio &&
           m->made.spindle_rev_s == request->spindle_rev_s && reaches_far(m, c, request->reference);
}

void takt_motion_build(struct motion *m)
{
    uint32_t restarts;
    const struct ceiling_request request = take_request(m, &restarts);

    TAKT_ASSERT(m->exchange == MOTION_CEILING_WANTED);
    m->path->spare = PATH_NO_SPARE;
    if (is_dropped(m, restarts)) {
        m->made.feed_ratio = 0.0;
    }
    if (is_dropped(m, restarts) || is_unchanged(m, &request)) {
        handoff_set_count(&m->exchange, MOTION_CEILING_FREE);
        return;
    }
    m->built_restarts = restarts;
    takt_ceiling_build(ceiling_of(m, 1 - m->active), m->path, &request);
    m->made = request;
    m->made_closed = m->path->closed;
    if (!motion_has_ceiling(m)) {
        (void)path_first(m->path); /* until the first ceiling is there, the cycle reads none */
    }
    handoff_set_count(&m->exchange, MOTION_CEILING_BUILT);
}

/* -- the cycle -- */

/* A ceiling of a path that has been dropped since is of no use. */
static void offer_ceiling(struct motion *m)
{
    TAKT_ASSERT(m->exchange == MOTION_CEILING_BUILT);
    if (m->built_restarts == m->restarts) {
        m->active = 1 - m->active;
        takt_reference_set_ceiling(&m->reference, ceiling_of(m, m->active));
    } else {
        m->made.feed_ratio = 0.0;
    }
    handoff_set_count(&m->exchange, MOTION_CEILING_FREE);
}

void takt_motion_prepare(struct motion *m)
{
    if (!motion_has_ceiling(m) && m->exchange == MOTION_CEILING_BUILT) {
        offer_ceiling(m);
    }
    (void)reference_take(&m->reference);
}

/* Where the ceiling ends that the trapezoidal reference is under. */
static uint64_t piece_leave(const struct motion *m)
{
    const struct reference_place *here = &m->reference.here;

    if (here->ceiling == NULL || here->piece >= here->ceiling->count) {
        return m->reference.at;
    }
    return path_ceiling_leave(here->ceiling, here->piece);
}

/*
 * An override asked for while the trapezoidal reference brakes waits for the next block (seed 003
 * section 2). 0 is a hold.
 */
static void ask(struct motion *m, const struct motion_operator *wanted)
{
    const uint64_t leave = piece_leave(m);
    const bool braking = m->reference.feed > 0.0 && m->reference.since_minus == 0;

    TAKT_ASSERT((int32_t)(m->path->first - m->path->kept) >= 0);
    if (!braking || leave != m->asked_leave) {
        m->request.feed_ratio =
            wanted->feed_ratio > 0.0 ? wanted->feed_ratio : m->request.feed_ratio;
        m->request.rapid_ratio =
            wanted->rapid_ratio > 0.0 ? wanted->rapid_ratio : m->request.rapid_ratio;
        if (wanted->measures && wanted->spindle_rev_s > 0.0 && m->path->has_revolution_feed) {
            m->request.spindle_rev_s = wanted->spindle_rev_s;
        }
    }
    m->asked_leave = leave;
    m->asked_restarts = m->restarts;
    m->request.first = m->path->first;
    m->request.reference = m->reference.at;
    m->request.span = m->reference.span;
    m->request.cycles = m->reference.cycles;
    m->asked++;
    handoff_set_count(&m->path->kept, m->path->first);
    handoff_set_count(&m->exchange, MOTION_CEILING_WANTED);
}

/*
 * The trapezoidal reference has not taken the last ceiling: that is free, and another one is
 * needed.
 */
static void note_refused(struct motion *m)
{
    TAKT_ASSERT(m->active < 2);
    if (m->reference.here.ceiling == path_ceiling(m->path, 1 - m->active)) {
        m->active = 1 - m->active;
        m->made.feed_ratio = 0.0;
    }
}

void takt_motion_exchange(struct motion *m, const struct motion_operator *wanted)
{
    const bool due = !motion_has_ceiling(m) || m->cycles % MOTION_EXCHANGE_CYCLES == 0;

    if (due && m->exchange == MOTION_CEILING_WANTED) {
        m->late++;
    } else if (due) {
        if (m->exchange == MOTION_CEILING_BUILT) {
            offer_ceiling(m);
        }
        m->exchange = MOTION_CEILING_ASKED;
    }
    m->busy = m->busy || m->reference.coming.ceiling != NULL;
    if (reference_take(&m->reference)) {
        return;
    }
    note_refused(m);
    if (due || m->exchange == MOTION_CEILING_ASKED) {
        ask(m, wanted);
    }
}
