#include "optimum.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* Halvings of an interval until it is as narrow as rounding. */
#define HALVINGS 50

/* -- one move -- */

/*
 * T = F/a + a/j for a ramp of F, 2 sqrt(F/j) where full acceleration is not reached; it covers F
 * T / 2.
 */
static double ramp_time(const struct optimum_move *m, double feed)
{
    const double a = m->acceleration;

    return feed * m->jerk >= a * a ? feed / a + a / m->jerk : 2.0 * sqrt(feed / m->jerk);
}

double optimum_single(const struct optimum_move *m)
{
    double low = 0.0;
    double high = m->feed;

    if (high * ramp_time(m, high) <= m->length) {
        return ramp_time(m, high) + m->length / high;
    }
    for (int i = 0; i < HALVINGS; i++) {
        const double feed = 0.5 * (low + high);

        *(feed * ramp_time(m, feed) <= m->length ? &low : &high) = feed;
    }
    return 2.0 * ramp_time(m, low);
}

/* On the way: where it is, after how long, and the highest feed so far. */
struct at {
    double time, way, feed, acceleration, peak;
};

/* Rounding of feeds. */
#define ROUNDING 1e-9

double optimum_level(const struct optimum_move *m)
{
    return m->level_feed > m->feed ? m->level_feed : m->feed;
}

static void go_on(struct at *p, double time, double jerk)
{
    const double a = p->acceleration;

    if (a > 0.0 && a + time * jerk < 0.0) {
        p->peak = fmax(p->peak, p->feed - 0.5 * a * a / jerk);
    }
    p->way += time * (p->feed + time * (a / 2.0 + time * jerk / 6.0));
    p->feed += time * (a + time * jerk / 2.0);
    p->acceleration = a + time * jerk;
    p->time += time;
    p->peak = fmax(p->peak, p->feed);
}

/* Jerk of one sign until acceleration is at its limit, and that kept, for a time in all. */
static void push(struct at *p, const struct optimum_move *m, double sign, double time)
{
    const double until = (m->acceleration - sign * p->acceleration) / m->jerk;
    const double first = fmin(time, fmax(until, 0.0));

    go_on(p, first, sign * m->jerk);
    go_on(p, time - first, 0.0);
}

/*
 * The fastest change to another state, whatever its way: jerk of one sign, acceleration kept if it
 * is at its limit, jerk of the other sign. With peak acceleration p: p^2 = s j
 * dv + (a0^2 + a1^2) / 2, s the first sign.
 */
static void change(struct at *p, const struct optimum_move *m, const struct optimum_state *to)
{
    const double a0 = p->acceleration;
    const double a1 = to->acceleration;
    const double rise = to->feed - p->feed;
    const double straight = (a1 > a0 ? 1.0 : -1.0) * (a1 * a1 - a0 * a0) / (2.0 * m->jerk);
    const double sign = rise >= straight ? 1.0 : -1.0;
    const double square = sign * m->jerk * rise + 0.5 * (a0 * a0 + a1 * a1);
    const double peak = sqrt(fmax(square, 0.0));
    const double top = fmin(peak, m->acceleration);
    const double kept = (square - top * top) / (m->jerk * top);

    go_on(p, fmax(0.0, (top - sign * a0) / m->jerk), sign * m->jerk);
    go_on(p, peak > m->acceleration ? kept : 0.0, 0.0);
    go_on(p, fmax(0.0, (top - sign * a1) / m->jerk), -sign * m->jerk);
}

/* After jerk of one sign for a time: is it bound to pass the highest feed, or rest? */
static bool is_too_far(const struct optimum_move *m, const struct at *p, double sign)
{
    const double levelled = p->feed + sign * p->acceleration * p->acceleration / (2.0 * m->jerk);

    if (sign * p->acceleration <= 0.0) {
        return false;
    }
    return sign > 0.0 ? levelled > optimum_level(m) : levelled < 0.0;
}

static struct at pushed(const struct optimum_move *m, const struct optimum_state *from, double sign,
                        double time)
{
    struct at p = {0.0, 0.0, from->feed, from->acceleration, 0.0};

    push(&p, m, sign, time);
    return p;
}

/* The longest push that levels off within the limits. */
static double push_max(const struct optimum_move *m, const struct optimum_state *from, double sign)
{
    double low = 0.0;
    double high = 2.0 * m->acceleration / m->jerk + 2.0 * optimum_level(m) / m->acceleration;

    for (int i = 0; i < HALVINGS; i++) {
        const double time = 0.5 * (low + high);
        const struct at p = pushed(m, from, sign, time);

        *(is_too_far(m, &p, sign) ? &high : &low) = time;
    }
    return low;
}

static struct at pushed_and_changed(const struct optimum_move *m, const struct optimum_state *from,
                                    const struct optimum_state *to, double sign, double time)
{
    struct at p = pushed(m, from, sign, time);

    change(&p, m, to);
    return p;
}

/*
 * Jerk changes its sign twice at most: it is +, -, + where the way is longer than that of the
 * fastest change of state, -, +, - where it is shorter. The longer the first phase, the longer
 * (shorter) the way. What is left of it at the longest one is gone at the highest feed.
 */
static double between(const struct optimum_move *m, const struct optimum_state *from,
                      const struct optimum_state *to)
{
    const double sign = pushed_and_changed(m, from, to, 1.0, 0.0).way < m->length ? 1.0 : -1.0;
    double low = 0.0;
    double high = push_max(m, from, sign);
    const struct at most = pushed_and_changed(m, from, to, sign, high);
    const double rest = sign * (m->length - most.way);

    if (rest > 0.0) {
        return sign > 0.0 && m->level_feed == 0.0 ? most.time + rest / m->feed : HUGE_VAL;
    }
    for (int i = 0; i < HALVINGS; i++) {
        const double time = 0.5 * (low + high);
        const struct at p = pushed_and_changed(m, from, to, sign, time);

        *(sign * (m->length - p.way) > 0.0 ? &low : &high) = time;
    }
    const struct at end = pushed_and_changed(m, from, to, sign, high);

    return end.peak <= m->feed * (1.0 + ROUNDING) ? end.time : HUGE_VAL;
}

double optimum_between(const struct optimum_move *m, const struct optimum_state *from,
                       const struct optimum_state *to)
{
    struct optimum_move alone = *m;

    alone.level_feed = 0.0;
    const double within = optimum_may_be(&alone, from) && optimum_may_be(&alone, to)
                              ? between(&alone, from, to)
                              : HUGE_VAL;

    return m->level_feed > 0.0 ? fmin(within, between(m, from, to)) : within;
}

/* -- the end of a move by its phases -- */

/* The longest first part of a way with a property that it loses once. */
struct stretch {
    const struct optimum_move *move;
    double sign;
    double most; /* time after which it levels off */
};

/* Jerk of one sign for a time, and where it has led to the highest feed (or rest), that kept. */
static void push_levelled(struct at *p, const struct stretch *s, double time)
{
    const double first = fmin(time, s->most);

    push(p, s->move, s->sign, first);
    const double level = fmin(time - first, fabs(p->acceleration) / s->move->jerk);

    go_on(p, level, -s->sign * s->move->jerk);
    go_on(p, time - first - level, 0.0);
}

/* The same, ending with the move. */
static void go_phase(struct at *p, const struct optimum_move *m, double sign, double time)
{
    const struct optimum_state from = {p->feed, p->acceleration};
    const struct stretch s = {m, sign, push_max(m, &from, sign)};
    const struct at start = *p;
    double low = 0.0;
    double high = time;

    push_levelled(p, &s, time);
    if (p->way <= m->length) {
        return;
    }
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);

        *p = start;
        push_levelled(p, &s, middle);
        *(p->way > m->length ? &high : &low) = middle;
    }
}

bool optimum_pass(const struct optimum_move *m, const struct optimum_phases *phases,
                  struct optimum_state *state, double *time)
{
    struct at p = {0.0, 0.0, state->feed, state->acceleration, 0.0};
    double sign = phases->first_sign;

    for (int i = 0; i < 3 && p.way < m->length * (1.0 - 1e-12); i++) {
        go_phase(&p, m, sign, i < 2 ? phases->time[i] : phases->time_max);
        sign = -sign;
    }
    *state = (struct optimum_state){p.feed, p.acceleration};
    *time = p.time;
    return p.way > m->length * (1.0 - 1e-9) && p.peak <= m->feed * (1.0 + ROUNDING);
}

bool optimum_may_be(const struct optimum_move *m, const struct optimum_state *state)
{
    const struct at p = {0.0, 0.0, state->feed, state->acceleration, 0.0};
    const struct at before = {0.0, 0.0, state->feed, -state->acceleration, 0.0};

    return state->feed <= m->feed && !is_too_far(m, &p, 1.0) && !is_too_far(m, &before, 1.0) &&
           !is_too_far(m, &p, -1.0) && !is_too_far(m, &before, -1.0);
}
