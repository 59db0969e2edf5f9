/*
 * With v the velocity, a the acceleration, A and J the limits: v + a|a|/(2J) is the velocity that
 * is left when the acceleration has been brought to 0. Its sign says which way to brake. Taken
 * positive (else everything is mirrored), the deceleration rises to d, may be kept, and falls to 0:
 *
 *     jerk  -J for (a + d)/J,   0 for t,   +J for d/J
 *     v + a^2/(2J) = d^2/J + d t,   d = sqrt(J v + a^2/2) and t = 0 if that is not above A, else d = A
 */
#include "sync/brake.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Halvings of a cycle: below the rounding of positions. */
#define HALVINGS 56

struct brake_state takt_brake_advance(const struct brake_state *s, double j, double t)
{
    return (struct brake_state){
        .x_mm = s->x_mm + t * (s->v_mm_s + t * (0.5 * s->a_mm_s2 + t * j / 6.0)),
        .v_mm_s = s->v_mm_s + t * (s->a_mm_s2 + 0.5 * t * j),
        .a_mm_s2 = s->a_mm_s2 + t * j,
    };
}

static double velocity_left(const struct brake_state *s, double jerk)
{
    return s->v_mm_s + 0.5 * s->a_mm_s2 * maths_abs(s->a_mm_s2) / jerk;
}

static void plan(struct brake *b, const struct brake_state *s, const struct brake_limits *limits)
{
    const double jerk = limits->jerk_mm_s3;
    const double sense = velocity_left(s, jerk) >= 0.0 ? 1.0 : -1.0;
    const double v = sense * s->v_mm_s;
    const double a = sense * s->a_mm_s2;
    const double peak = maths_sqrt(maths_max(0.0, jerk * v + 0.5 * a * a));
    const double d = maths_max(-a, maths_min(peak, limits->acceleration_mm_s2));
    const double kept = d > 0.0 ? (v + 0.5 * a * a / jerk - d * d / jerk) / d : 0.0;

    TAKT_ASSERT(jerk > 0.0 && limits->acceleration_mm_s2 > 0.0);
    memset(b, 0, sizeof(*b));
    b->from = *s;
    b->jerk_mm_s3[1] = -sense * jerk;
    b->time_s[1] = maths_max(0.0, (a + d) / jerk);
    b->time_s[2] = maths_max(0.0, kept);
    b->jerk_mm_s3[3] = sense * jerk;
    b->time_s[3] = d / jerk;
}

static double rest_position(const struct brake *b)
{
    struct brake_state s = b->from;

    for (unsigned i = 0; i < BRAKE_PHASES; i++) {
        s = takt_brake_advance(&s, b->jerk_mm_s3[i], b->time_s[i]);
    }
    return s.x_mm;
}

/* Brakes harder than its velocity asks for: it turns round when v + a t + J t^2/2 = 0. */
static double turning_position(const struct brake_state *s, double jerk)
{
    const double a = s->a_mm_s2;
    const double root = maths_sqrt(maths_max(0.0, a * a - 2.0 * jerk * s->v_mm_s));
    const double time_s = 2.0 * s->v_mm_s / (root - a);

    TAKT_ASSERT(s->v_mm_s > 0.0 && jerk > 0.0);
    return takt_brake_advance(s, jerk, time_s).x_mm;
}

double takt_brake_reach(const struct brake_state *s, const struct brake_limits *limits)
{
    struct brake b;

    if (s->v_mm_s > 0.0 && velocity_left(s, limits->jerk_mm_s3) < 0.0) {
        return turning_position(s, limits->jerk_mm_s3);
    }
    plan(&b, s, limits);
    return maths_max(s->x_mm, rest_position(&b));
}

void takt_brake_begin(struct brake *b, const struct brake_state *s,
                      const struct brake_limits *limits)
{
    plan(b, s, limits);
    b->end_mm = rest_position(b);
}

void takt_brake_begin_at(struct brake *b, const struct brake_state *s,
                         const struct brake_limits *limits, double jerk_mm_s3, double time_s,
                         double end_mm)
{
    double low_s = 0.0;
    double high_s = time_s;

    TAKT_ASSERT(time_s > 0.0);
    for (int i = 0; i < HALVINGS; i++) {
        const double middle_s = 0.5 * (low_s + high_s);
        const struct brake_state later = takt_brake_advance(s, jerk_mm_s3, middle_s);

        if (takt_brake_reach(&later, limits) <= end_mm) {
            low_s = middle_s;
        } else {
            high_s = middle_s;
        }
    }
    const struct brake_state later = takt_brake_advance(s, jerk_mm_s3, low_s);

    plan(b, &later, limits);
    b->from = *s;
    b->jerk_mm_s3[0] = jerk_mm_s3;
    b->time_s[0] = low_s;
    b->end_mm = end_mm;
}

void takt_brake_step(struct brake *b, double cycle_s, struct brake_state *s)
{
    double left_s = b->passed_s + cycle_s;

    TAKT_ASSERT(b->phase <= BRAKE_PHASES);
    while (b->phase < BRAKE_PHASES && left_s >= b->time_s[b->phase]) {
        left_s -= b->time_s[b->phase];
        b->from = takt_brake_advance(&b->from, b->jerk_mm_s3[b->phase], b->time_s[b->phase]);
        b->phase++;
    }
    b->passed_s = left_s;
    *s = brake_is_over(b) ? (struct brake_state){.x_mm = b->end_mm}
                          : takt_brake_advance(&b->from, b->jerk_mm_s3[b->phase], left_s);
}
