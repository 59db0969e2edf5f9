/*
 * Goal: to the rest of the cycle a setpoint that the hold moves looks like one that the trapezoidal reference moves: it is as far ahead
 * as it would be if the setpoint had always moved as it does now, and the averages begin anew when it goes on.
 */
#include "motion/held.h"

#include "base/assert.h"
#include "plan/path_unit.h"

/* From where the setpoint is the trapezoidal reference goes on by itself, at the same feed. */
void takt_held_end(struct motion *m)
{
    struct reference *l = &m->reference;
    const uint64_t step = (uint64_t)(hold_way(&m->mover.beside.hold) + 0.5);
    const uint64_t at = path_start(m->path, m->mover.beside.hold.block) +
                        (uint64_t)(hold_at(&m->mover.beside.hold) + 0.5);

    TAKT_ASSERT(m->holds);
    takt_reference_follow(l, at + step * ((uint64_t)l->window - 1) / 2,
                          (double)step / PATH_UNITS_PER_MM, m->setpoint);
    takt_average_start(&m->mover.average, m->path->limits.profile, l->cycles, l->at, step);
    m->lag = average_lag(&m->mover.average);
    m->holds = false;
}

/* The trapezoidal reference is where it would be if the setpoint had always moved as it does now. */
static void follow_hold(struct motion *m)
{
    const struct hold *h = &m->mover.beside.hold;
    const uint64_t start = path_start(m->path, h->block);
    const double at = hold_at(h);
    const uint64_t ahead = start + (uint64_t)(at + 0.5 * (m->reference.window - 1.0) * hold_way(h));

    m->feed = h->moved * h->length / PATH_UNITS_PER_MM;
    takt_reference_follow(&m->reference, ahead, hold_way(h) / PATH_UNITS_PER_MM, m->setpoint);
    m->lag = h->place.rate > 0.0 ? (double)(int64_t)(ahead - start) - at : 0.0;
}

/* Is the setpoint on a smoothed curve, and moved by the trapezoidal reference through a short window? */
static bool may_hold(const struct motion *m)
{
    const struct reference *l = &m->reference;
    const struct average *a = &m->mover.average;

    return !l->standing && !l->run.active && !l->here.late && m->feed_before[0] > 0.0 &&
           path_at(m->path, m->path->first)->smooth &&
           a->box[a->boxes - 1].end <= MOTION_INPUTS_MAX;
}

/* Takes over as soon as it can. */
static void begin_hold(struct motion *m)
{
    const uint64_t start = path_start(m->path, m->path->first);
    const double at = (double)(int64_t)(m->reference.at - start) - m->lag;
    const double way[] = {m->feed_before[0] * PATH_UNITS_PER_MM,
                          m->feed_before[1] * PATH_UNITS_PER_MM};
    const bool anew = !m->looks;

    TAKT_ASSERT(!m->holds);
    m->looks = may_hold(m);
    m->holds =
        m->looks && takt_hold_begin(&m->mover.beside.hold, m->path, &m->reference, at, way, anew);
}

/* The setpoint is moved by the hold, or the trapezoidal reference goes on. */
bool takt_held_move(struct motion *m, bool hold)
{
    m->looks = m->looks && hold;
    if (m->holds && !takt_hold_step(&m->mover.beside.hold, m->path, &m->reference, hold)) {
        takt_held_end(m);
    } else if (!m->holds && hold) {
        begin_hold(m);
    }
    if (m->holds) {
        follow_hold(m);
    }
    return m->holds;
}
