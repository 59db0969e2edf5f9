/*
 * The law, with e the target less the point:
 *
 *     velocity      v* = v_target + k_x e            no more than the acceleration and the jerk can
 *                                                    settle: VELOCITY_PART of A / k_v, and of
 *                                                    JERK_PART J / k_v^2
 *     acceleration  a* = a_target + k_v (v* - v)     within its limit
 *     jerk          j  = j_target + k_a (a* - a)     within its limit
 *
 * Within limits each step asks no more of the next than that can do. Without, the jerk being
 * constant in a cycle, all three poles are exp(-bandwidth cycle): with c = 1 - that, per cycle,
 *
 *     k_a = 3 c - 3/2 c^2 + 1/3 c^3,   k_v k_a = 3 c^2 - c^3,   k_x k_v k_a = c^3
 *
 * The bound by the jerk keeps a large e from swinging for ever. At its limit the jerk acts as if it
 * were multiplied by some q < 1, and the bounded v* - v_target by some r; both are stable together
 * while r < 9 q. A swing of w rad/s would last where q = w^2 / 3 k_v^2 and r = 9 q, with v* bounded
 * by J / (w k_v): above some sqrt(3) J / k_v^2 (describing functions). Without, slow taps that turn
 * back at once swung all the way out.
 *
 * Rejected: to bound v* - v_target by (J e^2)^(1/3) and a* - a_target by (J (v* - v))^(1/2), what
 * the jerk can take back. It settles a large e sooner, but is up to three times as far off after a
 * step of the spindle's acceleration.
 */
#include "sync/follower.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Relative to the bandwidth by which the target has been filtered. */
#define RATE_RATIO 2.0

#define VELOCITY_PART 0.5
#define JERK_PART     3.4 /* half of it is less than sqrt(3) */

/*
 * Most of J t^2, in V: acceleration_for takes J t^2/72 off V, of which a quarter may go. Where a
 * cycle's jerk is more than V it is not needed.
 */
#define ROUNDED_VELOCITIES 18.0

void takt_follower_init(struct follower *f, double cycle_s)
{
    TAKT_ASSERT(cycle_s > 0.0);
    memset(f, 0, sizeof(*f));
    f->cycle_s = cycle_s;
}

void takt_follower_tune(struct follower *f, double bandwidth_rad_cycle)
{
    const double c = 1.0 - takt_maths_exp(-RATE_RATIO * bandwidth_rad_cycle);
    const double a = c * (3.0 + c * (c / 3.0 - 1.5));
    const double va = c * c * (3.0 - c);

    TAKT_ASSERT(bandwidth_rad_cycle > 0.0);
    TAKT_ASSERT(a > 0.0 && va > 0.0);
    f->gain_a = a / f->cycle_s;
    f->gain_v = va / a / f->cycle_s;
    f->gain_x = c * c * c / va / f->cycle_s;
}

void takt_follower_start(struct follower *f, const struct brake_limits *limits)
{
    TAKT_ASSERT(limits->velocity_mm_s > 0.0 && limits->acceleration_mm_s2 > 0.0 &&
                limits->jerk_mm_s3 > 0.0);
    memset(&f->at, 0, sizeof(f->at));
    f->limits = *limits;
    f->limits.jerk_mm_s3 = maths_min(
        limits->jerk_mm_s3, ROUNDED_VELOCITIES * limits->velocity_mm_s / (f->cycle_s * f->cycle_s));
    f->state = FOLLOWER_FOLLOWS;
}

static double clamp(double value, double most)
{
    return maths_clamp(value, -most, most);
}

static double wanted_jerk(const struct follower *f, const struct follower_target *t)
{
    const double a_max = f->limits.acceleration_mm_s2;
    const double settled = maths_min(a_max, JERK_PART * f->limits.jerk_mm_s3 / f->gain_v);
    const double catching =
        clamp(f->gain_x * (t->x_mm - f->at.x_mm), VELOCITY_PART * settled / f->gain_v);
    const double a = clamp(t->a_mm_s2 + f->gain_v * (t->v_mm_s + catching - f->at.v_mm_s), a_max);

    return t->j_mm_s3 + f->gain_a * (a - f->at.a_mm_s2);
}

/*
 * The highest acceleration u at the end of the cycle from which velocity stays within V when u is
 * taken away at once:
 *
 *     v + (a + u) t/2 + u^2/(2J) <= V   =>   u <= -J t/2 + sqrt(J^2 t^2/4 + 2 J (V - v - a t/2))
 *
 * In the cycle in which the acceleration changes its sign the mean velocity is above both ends by
 * up to J t^2/72.
 */
static double acceleration_for(const struct follower *f, double v, double a)
{
    const double jerk = f->limits.jerk_mm_s3;
    const double half = 0.5 * jerk * f->cycle_s;
    const double most = f->limits.velocity_mm_s - half * f->cycle_s / 36.0;
    const double root = half * half + 2.0 * jerk * (most - v - 0.5 * a * f->cycle_s);

    return root > 0.0 ? maths_sqrt(root) - half : -MATHS_INFINITY;
}

/* Within velocity and acceleration, and before all within the jerk. */
static double allowed_jerk(const struct follower *f, double wanted)
{
    const double t = f->cycle_s;
    const double a = f->at.a_mm_s2;
    const double most = f->limits.acceleration_mm_s2;
    const double high = maths_min(most, acceleration_for(f, f->at.v_mm_s, a));
    const double low = -maths_min(most, acceleration_for(f, -f->at.v_mm_s, -a));
    const double next = maths_clamp(a + wanted * t, low, high);

    return clamp((next - a) / t, f->limits.jerk_mm_s3);
}

static struct brake_state mirrored(const struct brake_state *s, double sense)
{
    return (struct brake_state){sense * s->x_mm, sense * s->v_mm_s, sense * s->a_mm_s2};
}

static void step_brake(struct follower *f)
{
    struct brake_state s;

    takt_brake_step(&f->brake, f->cycle_s, &s);
    f->at = mirrored(&s, f->sense);
}

void takt_follower_step(struct follower *f, const struct follower_target *target,
                        const struct follower_end *end)
{
    TAKT_ASSERT(end->sense == 1.0 || end->sense == -1.0);
    if (f->state != FOLLOWER_FOLLOWS) {
        step_brake(f);
        return;
    }
    const double jerk = allowed_jerk(f, wanted_jerk(f, target));
    const struct brake_state now = mirrored(&f->at, end->sense);
    const struct brake_state next = takt_brake_advance(&now, end->sense * jerk, f->cycle_s);
    const double end_mm = end->sense * end->x_mm;

    if (takt_brake_reach(&next, &f->limits) <= end_mm) {
        f->at = mirrored(&next, end->sense);
        return;
    }
    f->state = FOLLOWER_LANDS;
    f->sense = end->sense;
    takt_brake_begin_at(&f->brake, &now, &f->limits, end->sense * jerk, f->cycle_s, end_mm);
    step_brake(f);
}

void takt_follower_brake(struct follower *f)
{
    if (f->state == FOLLOWER_FOLLOWS) {
        f->sense = 1.0;
        takt_brake_begin(&f->brake, &f->at, &f->limits);
    }
    f->state = FOLLOWER_STOPS;
}
