/*
 * The velocity loop is open, with T all that comes late in it: the torque, its being held over a
 * step of the loop and the velocity's being that between two readings (half a step each):
 *
 *     L = Kp (1 + 1/(Ti s)) e^(-sT) / s         phase margin  atan(w Ti) - w T  at  |L| = 1
 *
 * With c = w Ti a margin m is kept by w = (atan c - m) / T, and the loop's error under a load that
 * changes is as Ti/Kp, near c / w^2: the c that makes (atan c - m)^2 / c greatest leaves least of a
 * disturbance for that margin (Astrom and Hagglund 2006, 4.4: the greatest integral gain that keeps
 * a margin). Where friction b/J is more than that 1/Ti, Ti = J/b takes its pole away, and w = (90
 * degrees - m) / T. Less friction makes the margin larger. The position loop around it,
 *
 *     L = Kv / s * T_v,   T_v = L_v / (1 + L_v)
 *
 * gets the greatest Kv that keeps the margin and the overshoot of a step of the model.
 */
#include "tuning/gains.h"

#include "base/maths.h"
#include "tuning/loop_model.h"

#include <math.h>

/*
 * Frequencies that are looked at: from far below the slowest gain that there can be to where the
 * loops sample twice a turn.
 */
#define W_LOW   1e-3
#define W_RATIO 1.01

/* c: from where the margin leaves nothing, each so much higher, up to some 50 times that. */
#define CORNERS      4000
#define CORNER_RATIO 1.001

/* Kv: each try so much lower than the one before, down to a part of the velocity loop's gain. */
#define KV_RATIO 0.96
#define KV_PART  1e-3

/* A step of the encoder asks for no more than so much of the rated torque. */
#define STEP_TORQUE 1.0

static double total_delay(const struct tuning_plant *plant, const struct tuning_drive *drive)
{
    return fmax(plant->delay_s + drive->step_s, drive->step_s / 2);
}

struct loops {
    double kp, ti, kv, friction_per_s, delay_s;
};

static struct loops loops_of(const struct tuning_plant *plant, const struct tuning_drive *drive,
                             const struct tuning_gains *gains)
{
    return (struct loops){
        .kp = MATHS_TWO_PI * gains->velocity_bandwidth_hz * gains->told_inertia_kg_m2 /
              plant->inertia_kg_m2,
        .ti = gains->velocity_integral_s,
        .kv = gains->position_gain_per_s,
        .friction_per_s = plant->viscous_nm_s_per_rad / plant->inertia_kg_m2,
        .delay_s = total_delay(plant, drive),
    };
}

/*
 * Response of an open loop at a frequency: how much it makes of a sine, and by which angle that is
 * ahead.
 */
struct response {
    double gain, phase_rad;
};

static struct response velocity_loop(const struct loops *l, double w)
{
    const double integral = l->ti > 0 ? 1 / (w * l->ti) : 0;

    return (struct response){
        .gain = l->kp * hypot(1, integral) / hypot(w, l->friction_per_s),
        .phase_rad = -atan(integral) - w * l->delay_s - atan2(w, l->friction_per_s),
    };
}

static struct response position_loop(const struct loops *l, double w)
{
    const struct response inner = velocity_loop(l, w);
    const double real = 1 + inner.gain * cos(inner.phase_rad);
    const double imaginary = inner.gain * sin(inner.phase_rad);

    return (struct response){
        .gain = l->kv / w * inner.gain / hypot(real, imaginary),
        .phase_rad = inner.phase_rad - atan2(imaginary, real) - MATHS_PI / 2,
    };
}

/*
 * The least phase above -180 degrees where the gain crosses 1, of -180 to 180 degrees; of a loop
 * whose gain never does, infinite.
 */
static double phase_margin_deg(struct response (*loop)(const struct loops *l, double w),
                               const struct loops *l, double w_high)
{
    const unsigned count = (unsigned)(log(w_high / W_LOW) / log(W_RATIO));
    double margin = MATHS_INFINITY, w = W_LOW;
    bool was_below = loop(l, w).gain < 1;

    for (unsigned i = 0; i < count; i++) {
        w *= W_RATIO;
        const struct response at = loop(l, w);
        const double turns = (at.phase_rad + MATHS_PI) / MATHS_TWO_PI;

        if ((at.gain < 1) != was_below)
            margin = fmin(margin, 360 * (turns - floor(turns + 0.5)));
        was_below = at.gain < 1;
    }
    return margin;
}

void tuning_margins_of(const struct tuning_plant *plant, const struct tuning_drive *drive,
                       const struct tuning_gains *gains, struct tuning_margins *margins)
{
    const struct loops l = loops_of(plant, drive, gains);
    const double w_high = MATHS_PI / drive->step_s;

    *margins = (struct tuning_margins){
        .velocity_phase_deg = phase_margin_deg(velocity_loop, &l, w_high),
        .position_phase_deg = phase_margin_deg(position_loop, &l, w_high),
        .overshoot = loop_model_overshoot(plant, drive, gains),
    };
}

/* Frequencies that are looked at are 1 % apart, so a margin is off by up to half a degree. */
bool tuning_margins_are_good(const struct tuning_margins *margins)
{
    const double least_deg = TUNING_PHASE_DEG - 0.5;

    return margins->velocity_phase_deg >= least_deg && margins->position_phase_deg >= least_deg &&
           margins->overshoot <= TUNING_MODEL_OVERSHOOT;
}

/* c = w Ti with the greatest (atan c - m)^2 / c. */
static double best_corner(double margin_rad)
{
    double best = 0, most = 0, c = tan(margin_rad);

    for (unsigned i = 0; i < CORNERS; i++) {
        c *= CORNER_RATIO;
        const double w = atan(c) - margin_rad;

        if (w * w / c > most) {
            most = w * w / c;
            best = c;
        }
    }
    return best;
}

/*
 * The velocity loop's gain may be no more than what the drive takes, and what the encoder's steps
 * allow.
 */
static double gain_max(const struct tuning_plant *plant, const struct tuning_drive *drive)
{
    const double rated = plant->travel_per_rad * drive->torque_rated_nm / plant->inertia_kg_m2;
    const double taken = MATHS_TWO_PI * drive->bandwidth_max_hz;

    return drive->position_step > 0
               ? fmin(taken, STEP_TORQUE * rated * drive->step_s / drive->position_step)
               : taken;
}

bool tuning_find_gains(const struct tuning_plant *plant, const struct tuning_drive *drive,
                       struct tuning_gains *gains)
{
    const double margin_rad = TUNING_PHASE_DEG * MATHS_PI / 180;
    const double c = best_corner(margin_rad);
    const double to_crossing = sqrt(1 + 1 / (c * c)); /* w / Kp */
    const double delay_s = total_delay(plant, drive), most = gain_max(plant, drive);
    const double friction_per_s = plant->viscous_nm_s_per_rad / plant->inertia_kg_m2;
    double kp = fmin((atan(c) - margin_rad) / delay_s / to_crossing, most);
    double ti = c / (kp * to_crossing);
    struct tuning_margins margins;

    if (friction_per_s * ti > 1) {
        kp = fmin((MATHS_PI / 2 - margin_rad) / delay_s, most);
        ti = 1 / friction_per_s;
    }

    *gains = (struct tuning_gains){
        .told_inertia_kg_m2 = plant->inertia_kg_m2,
        .velocity_bandwidth_hz = kp / MATHS_TWO_PI,
        .velocity_integral_s = ti,
        .velocity_forward = 1,
        .torque_forward = 1,
    };
    gains->position_gain_per_s = kp;
    while (gains->position_gain_per_s > KV_PART * kp) {
        tuning_margins_of(plant, drive, gains, &margins);
        if (tuning_margins_are_good(&margins))
            return true;
        gains->position_gain_per_s *= KV_RATIO;
    }
    return false;
}
