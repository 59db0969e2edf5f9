/*
 * Step for step what firmware/servo/loop.c does, on x'' = a(t - D) - (b/J) x':
 *
 *     v_wanted = Kv (1 - x),  a = Kp e + integral of Kp e / Ti,  e = v_wanted - v
 *     v += (a delayed - b/J v) dt,  x += v dt
 *
 * In this scheme a torque acts half a step early, so its delay is D + dt/2; a part of a step lies
 * straight between two.
 */
#include "tuning/loop_model.h"

#include "base/maths.h"

#include <math.h>

#define DELAY_MAX 4096u /* steps; a power of two */

/*
 * It is looked at for this many time constants of the slowest of its parts, and is lost when this
 * far away.
 */
#define TIME_CONSTANTS 12.0
#define STEPS_MAX      400000.0
#define LOST           20.0

/* At rest it is so near to its target, over the last part of the time. */
#define NEAR      0.02
#define LAST_PART 0.2

struct loop {
    double kp, ki, kv, friction_per_s, dt;
    double delay_steps;
    double x, v, integral;
    double asked[DELAY_MAX];
    unsigned at;
};

static double delayed(struct loop *l, double a)
{
    const double whole = floor(l->delay_steps), part = l->delay_steps - whole;
    const unsigned now = l->at++;
    const unsigned back = (unsigned)whole;

    l->asked[now % DELAY_MAX] = a;
    return (1 - part) * l->asked[(now - back) % DELAY_MAX] +
           part * l->asked[(now - back - 1) % DELAY_MAX];
}

static void advance(struct loop *l)
{
    const double error = l->kv * (1 - l->x) - l->v;
    const double a = delayed(l, l->kp * error + l->integral);

    l->integral += l->ki * error * l->dt;
    l->v += (a - l->friction_per_s * l->v) * l->dt;
    l->x += l->v * l->dt;
}

static double run(struct loop *l, unsigned steps)
{
    const unsigned last = (unsigned)((1 - LAST_PART) * steps);
    double most = 0;

    for (unsigned k = 0; k < steps; k++) {
        advance(l);
        if (!(fabs(l->x) < LOST) || (k >= last && fabs(l->x - 1) > NEAR))
            return MATHS_INFINITY;
        most = fmax(most, l->x - 1);
    }
    return most;
}

double loop_model_overshoot(const struct tuning_plant *plant, const struct tuning_drive *drive,
                            const struct tuning_gains *gains)
{
    const double told = gains->told_inertia_kg_m2 / plant->inertia_kg_m2;
    const double kp = MATHS_TWO_PI * gains->velocity_bandwidth_hz * told;
    const double ti = gains->velocity_integral_s, dt = drive->step_s;
    struct loop l = {
        .kp = kp,
        .ki = ti > 0 ? kp / ti : 0,
        .kv = gains->position_gain_per_s,
        .friction_per_s = plant->viscous_nm_s_per_rad / plant->inertia_kg_m2,
        .dt = dt,
        .delay_steps = fmin(fmax(plant->delay_s / dt + 0.5, 0), DELAY_MAX - 2),
    };
    const double time_s = TIME_CONSTANTS * (1 / l.kv + ti + 1 / kp + plant->delay_s);

    return run(&l, (unsigned)fmin(fmax(time_s / dt, 100), STEPS_MAX));
}
