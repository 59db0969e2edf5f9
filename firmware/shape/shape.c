#include "shape/shape.h"

#include "base/assert.h"
#include "base/maths.h"

#include <stddef.h>

#define TOO_SLOW "the modes are too slow for so short a control cycle to be shaped"

/* -- the trains -- */

static bool is_mode(const struct shape_mode *mode)
{
    return mode->hz > 0.0;
}

/*
 * Where an axis accelerates by a, a mode is left behind by part a / w^2, out of the bend of a way.
 * A train pulls its way into the bend by a/2 of its spread (train.h). Equal where the spread is 2
 * part / w^2, of several modes their sum.
 */
static double wanted_spread(const struct shape_mode mode[SHAPE_MODES], double cycle_s)
{
    double spread = 0.0;

    for (unsigned n = 0; n < SHAPE_MODES; n++) {
        const double angle = 2.0 * MATHS_PI * mode[n].hz * cycle_s;

        spread += is_mode(&mode[n]) ? 2.0 * mode[n].part / (angle * angle) : 0.0;
    }
    return spread;
}

/* Half the period of the slowest mode, cycles. */
static double half_period(const struct shape_mode mode[SHAPE_MODES], double cycle_s)
{
    double cycles = 1.0;

    TAKT_ASSERT(cycle_s > 0.0);
    for (unsigned n = 0; n < SHAPE_MODES; n++) {
        if (is_mode(&mode[n])) {
            cycles = maths_max(cycles, takt_maths_round(0.5 * takt_zv_period(&mode[n], cycle_s)));
        }
    }
    return cycles;
}

/*
 * Impulses -m, 1 + 2 m, -m at distances of D add -2 m D^2 to the spread, and change neither the sum
 * nor the mean; what the modes are left with stays 0. The longer D, the less is below 0, and the
 * longer it takes.
 */
static void keep_way(struct train *t, const struct shape_mode mode[SHAPE_MODES], double cycle_s)
{
    const double distance = half_period(mode, cycle_s);
    const double excess = takt_train_spread(t) - wanted_spread(mode, cycle_s);
    const double m = excess / (2.0 * distance * distance);
    struct train keeping;

    takt_train_set_none(&keeping);
    takt_train_add(&keeping, 0.0, -m);
    takt_train_add(&keeping, distance, 1.0 + 2.0 * m);
    takt_train_add(&keeping, 2.0 * distance, -m);
    takt_train_append(t, &keeping);
}

static void make_train(const struct shape_config *config, unsigned axis, struct train *t)
{
    const struct shape_mode *mode = config->mode[axis];

    TAKT_ASSERT(axis < AXIS_COUNT);
    for (unsigned n = 0; n < SHAPE_MODES; n++) {
        struct train one;

        if (is_mode(&mode[n])) {
            config->train(&mode[n], config->cycle_s, &one);
            takt_train_append(t, &one);
        }
    }
    if (config->keeps_way && t->count > 1) {
        keep_way(t, mode, config->cycle_s);
    }
}

/* All axes are as late as the latest. */
static void align(struct shape *s)
{
    double latest = 0.0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        latest = maths_max(latest, takt_train_mean(&s->train[i]));
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        struct train delay;

        takt_train_set_none(&delay);
        takt_train_add(&delay, maths_max(0.0, latest - takt_train_mean(&s->train[i])), 1.0);
        takt_train_append(&s->train[i], &delay);
        s->cycles = takt_train_length(&s->train[i]) > s->cycles ? takt_train_length(&s->train[i])
                                                                : s->cycles;
    }
}

/* NULL: the periods of all modes are long enough, and short enough to be counted. */
static const char *check_mode(const struct shape_mode *mode, double cycle_s)
{
    if (!is_mode(mode)) {
        return NULL;
    }
    if (mode->hz * cycle_s > SHAPE_HZ_CYCLE_MAX) {
        return "a mode is too quick for the control cycle to be shaped";
    }
    return takt_zv_period(mode, cycle_s) < (double)SHAPE_CYCLES_MAX ? NULL : TOO_SLOW;
}

static const char *check_modes(const struct shape_config *config)
{
    const char *wrong = NULL;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        for (unsigned n = 0; n < SHAPE_MODES && wrong == NULL; n++) {
            wrong = check_mode(&config->mode[i][n], config->cycle_s);
        }
    }
    return wrong;
}

const char *takt_shape_init(struct shape *s, const struct shape_config *config)
{
    const char *wrong = check_modes(config);

    if (wrong != NULL) {
        return wrong;
    }
    s->cycle_s = config->cycle_s;
    s->cycles = 0;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        takt_train_set_one(&s->train[i]);
        if (i < AXIS_LINEAR_COUNT) {
            make_train(config, i, &s->train[i]);
        }
    }
    align(s);
    takt_shape_restart(s, &(const struct point){{0}});
    return s->cycles < SHAPE_CYCLES_MAX ? NULL : TOO_SLOW;
}

/* -- the cycle -- */

void takt_shape_restart(struct shape *s, const struct point *at)
{
    s->start = *at;
    s->known = 0;
    s->newest = 0;
    s->still = s->cycles;
}

/* What came in this many cycles ago. */
static const struct point *past(const struct shape *s, uint32_t cycles)
{
    return cycles < s->known ? &s->input[(s->newest - cycles) % SHAPE_CYCLES_MAX] : &s->start;
}

/* By differences, so that at rest it is what came in to the last bit. */
static double mean(const struct shape *s, unsigned axis)
{
    const struct train *t = &s->train[axis];
    const double now = past(s, 0)->at[axis];
    double away = 0.0;

    TAKT_ASSERT(axis < AXIS_COUNT && t->count > 0);
    for (uint32_t i = 0; i < t->count; i++) {
        away += t->impulse[i].weight * (past(s, t->impulse[i].cycles)->at[axis] - now);
    }
    return now + away;
}

void takt_shape_cycle(struct shape *s, struct point *set)
{
    const bool stands = point_is_same(past(s, 0), set);

    if (!stands) {
        s->still = 0;
    } else if (s->still < s->cycles) {
        s->still++;
    }
    s->newest++;
    s->known = s->known < SHAPE_CYCLES_MAX ? s->known + 1 : SHAPE_CYCLES_MAX;
    s->input[s->newest % SHAPE_CYCLES_MAX] = *set;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        set->at[i] = mean(s, i);
    }
}

bool takt_shape_is_settled(const struct shape *s)
{
    return s->still >= s->cycles;
}

const struct point *takt_shape_input(const struct shape *s)
{
    return past(s, 0);
}

/* -- limits -- */

/*
 * With n what is below 0, the rest 1 + n, a mean is at most (1 + n) of the highest and -n of the
 * lowest that comes in: by n times their distance above the highest. Over the train that distance
 * is at most what the next derivative lets it be.
 *
 *     J = j (1 + 2 n)        A = a + n min(2 a, j T)        V = v + n min(2 v, a T)
 */
static double leave(double limit, double below, double change)
{
    TAKT_ASSERT(limit >= 0.0 && below >= 0.0);
    return maths_max(limit / (1.0 + 2.0 * below), limit - below * change);
}

void takt_shape_leave(const struct shape *s, struct plan_limits *limits)
{
    const double reach_s = (double)s->cycles * s->cycle_s;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double below = takt_train_below_zero(&s->train[i]);

        limits->jerk_mm_s3[i] /= 1.0 + 2.0 * below;
        limits->acceleration_mm_s2[i] =
            leave(limits->acceleration_mm_s2[i], below, limits->jerk_mm_s3[i] * reach_s);
        limits->velocity_mm_s[i] =
            leave(limits->velocity_mm_s[i], below, limits->acceleration_mm_s2[i] * reach_s);
    }
}
