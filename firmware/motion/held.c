/*
 * Goal: to the rest of the cycle a setpoint that the hold moves looks like one that the trapezoidal
 * reference moves: it is as far ahead as it would be if the setpoint had always moved as it does
 * now, and the averages begin anew when it goes on.
 */
#include "motion/held.h"

#include "base/assert.h"
#include "motion/hold_pieces.h"
#include "motion/reference_private.h"
#include "plan/path_unit.h"

/* From where the setpoint is the trapezoidal reference goes on by itself, at the same feed. */
void takt_held_end(struct motion *m)
{
    struct reference *l = &m->reference;
    const uint64_t step = (uint64_t)(hold_way(&m->mover.beside.hold) + 0.5);
    const uint64_t at = takt_hold_start(&m->mover.beside.hold, m->path) +
                        (uint64_t)(hold_at(&m->mover.beside.hold) + 0.5);

    TAKT_ASSERT(m->held == MOTION_HELD);
    takt_reference_follow(l, at + step * ((uint64_t)l->window - 1) / 2,
                          (double)step / PATH_UNITS_PER_MM, m->setpoint);
    takt_average_start(&m->mover.average, m->path->limits.profile, l->cycles, l->at, step);
    m->lag = average_lag(&m->mover.average);
    m->held = MOTION_NOT_HELD;
}

/*
 * The trapezoidal reference is where it would be if the setpoint had always moved as it does now.
 */
static void follow_hold(struct motion *m)
{
    const struct hold *h = &m->mover.beside.hold;
    const uint64_t start = takt_hold_start(h, m->path);
    const double at = hold_at(h);
    const uint64_t ahead = start + (uint64_t)(at + 0.5 * (m->reference.window - 1.0) * hold_way(h));

    m->feed = h->moved * h->length / PATH_UNITS_PER_MM;
    takt_reference_follow(&m->reference, ahead, hold_way(h) / PATH_UNITS_PER_MM, m->setpoint);
    m->lag = h->place.rate > 0.0 ? (double)(int64_t)(ahead - start) - at : 0.0;
}

/* Where the axes stand anyway they are at rest at once, and the trapezoidal reference with them. */
static void stand(struct motion *m)
{
    struct reference *l = &m->reference;

    takt_reference_follow(l, m->setpoint, 0.0, m->setpoint);
    takt_average_start(&m->mover.average, m->path->limits.profile, l->cycles, l->at, 0);
    m->lag = 0.0;
}

/* Does the setpoint move under a ceiling that is known? */
static bool may_hold(const struct motion *m)
{
    const struct reference *l = &m->reference;

    return !reference_stands(l) && !l->here.late && reference_has_piece(l) &&
           m->feed_before[0] > 0.0 && path_at(m->path, m->path->first)->motion;
}

/*
 * What the averages' inputs leave of their memory is for the pieces of the hold: once for all that
 * it looks at in a span. False: too little.
 */
static bool has_memory(struct motion *m)
{
    struct motion_beside *beside = &m->mover.beside;
    const struct average *a = &m->mover.average;
    const size_t used = a->box[a->boxes - 1].end * (sizeof a->input[0] / sizeof(float));
    float *store = beside->store + used;

    if (used >= MOTION_STORE_MAX) {
        return false;
    }
    return (m->held == MOTION_LOOKS && beside->hold.store == store) ||
           takt_hold_prepare(&beside->hold, &m->path->limits, store, MOTION_STORE_MAX - used);
}

/* Takes over as soon as it can. */
static void begin_hold(struct motion *m)
{
    const uint64_t start = path_start(m->path, m->path->first);
    const double at = (double)(int64_t)(m->reference.at - start) - m->lag;
    const double way[] = {m->feed_before[0] * PATH_UNITS_PER_MM,
                          m->feed_before[1] * PATH_UNITS_PER_MM};

    TAKT_ASSERT(m->held != MOTION_HELD);
    m->held = may_hold(m) && has_memory(m) ? MOTION_LOOKS : MOTION_NOT_HELD;
    if (m->held == MOTION_LOOKS &&
        takt_hold_begin(&m->mover.beside.hold, m->path, &m->reference, at, way)) {
        m->held = MOTION_HELD;
    }
}

/* The setpoint is moved by the hold, or stands; or the trapezoidal reference goes on. */
bool takt_held_move(struct motion *m, bool hold)
{
    if (m->held != MOTION_HELD && !hold) {
        m->held = MOTION_NOT_HELD;
        return false;
    }
    if (m->held != MOTION_HELD) {
        begin_hold(m);
    } else if (!takt_hold_step(&m->mover.beside.hold, m->path, &m->reference, hold)) {
        takt_held_end(m);
        m->held = hold ? MOTION_LOOKS : MOTION_NOT_HELD;
    }
    if (m->held == MOTION_HELD) {
        follow_hold(m);
        return true;
    }
    if (m->held == MOTION_LOOKS && takt_hold_stands(m->path)) {
        stand(m);
        return true;
    }
    return false;
}
