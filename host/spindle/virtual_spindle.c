#include "spindle/virtual_spindle.h"

#include "base/maths.h"

#include <stddef.h>
#include <string.h>

/* Bandwidth of the speed loop, and the time in which its integral part takes over. */
#define LOOP_RAD_S      60.0
#define LOOP_INTEGRAL_S 0.1

/* Longest step of the integration: the loop is stable up to 1/LOOP_RAD_S. */
#define STEP_MAX_S 0.001

/* Below this a commanded or measured speed counts as none. */
#define STANDSTILL_RPM 1.0

#define RAD_S_PER_RPM (2.0 * MATHS_PI / 60.0)

void virtual_spindle_set_default(struct virtual_spindle_config *config)
{
    *config = (struct virtual_spindle_config){
        .max_rpm = 24000.0,
        .ramp_rpm_s = 12000.0,
        .inertia_kg_m2 = 0.0003,
        .friction_nm_s_per_rad = 2e-5,
        .rated_torque_nm = 0.875,
        .torque_limit_percent = 150.0,
        .overload_percent = 120.0,
        .overload_s = 10.0,
        .at_speed_percent = 2.0,
        .encoder_counts_per_revolution = 4096,
        .ripple_per_revolution = 6.0,
        .cut_width_mm = 0.0,
        .cut_depth_mm = 0.0,
        .cutting_force_n_per_mm2 = 700.0,
    };
}

struct field_range {
    const char *name;
    double value, least, most;
};

/* Written so that NaN is out of every range. */
static bool is_in_range(const struct field_range *range)
{
    return range->value >= range->least && range->value <= range->most;
}

const char *virtual_spindle_check(const struct virtual_spindle_config *c)
{
    const struct field_range ranges[] = {
        {"max_rpm", c->max_rpm, STANDSTILL_RPM, 1e6},
        {"ramp_rpm_s", c->ramp_rpm_s, 1e-3, 1e9},
        {"inertia_kg_m2", c->inertia_kg_m2, 1e-9, 1e3},
        {"friction_nm_s_per_rad", c->friction_nm_s_per_rad, 0, 1e3},
        {"rated_torque_nm", c->rated_torque_nm, 1e-6, 1e6},
        {"torque_limit_percent", c->torque_limit_percent, 1, 1000},
        {"overload_percent", c->overload_percent, 1, 1000},
        {"overload_s", c->overload_s, 0, 1e6},
        {"at_speed_percent", c->at_speed_percent, 0.01, 100},
        {"encoder_noise_counts", c->encoder_noise_counts, 0, 1e6},
        {"ripple_percent", c->ripple_percent, 0, 1000},
        {"ripple_per_revolution", c->ripple_per_revolution, 0, 1000},
        {"cut_width_mm", c->cut_width_mm, 0, 1e4},
        {"cut_depth_mm", c->cut_depth_mm, 0, 1e4},
        {"cutting_force_n_per_mm2", c->cutting_force_n_per_mm2, 0, 1e5},
    };

    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        if (!is_in_range(&ranges[i]))
            return ranges[i].name;
    }
    return NULL;
}

void virtual_spindle_init(struct virtual_spindle *s, const struct virtual_spindle_config *config)
{
    memset(s, 0, sizeof *s);
    s->config = *config;
}

/*
 * Milling: power = specific force x volume removed a second = k_c a_e a_p v_f,
 * torque = power / angular velocity. (Mean cutting force; DIN 6580 and 6584 name the quantities.)
 */
double virtual_spindle_cut_nm(const struct virtual_spindle *s, double feed_mm_s, double depth_mm)
{
    const struct virtual_spindle_config *c = &s->config;
    const double speed_rad_s = maths_abs(s->speed_rad_s);
    const double power_nmm_s =
        c->cutting_force_n_per_mm2 * c->cut_width_mm * depth_mm * maths_abs(feed_mm_s);

    if (speed_rad_s < STANDSTILL_RPM * RAD_S_PER_RPM)
        return 0.0;
    return power_nmm_s * 1e-3 / speed_rad_s;
}

static double clamp(double value, double most)
{
    return maths_clamp(value, -most, most);
}

static double limit_nm(const struct virtual_spindle *s)
{
    return 0.01 * s->config.torque_limit_percent * s->config.rated_torque_nm;
}

/* The ramp's way to the command in dt. */
static double ramp_step_rpm(const struct virtual_spindle *s, double dt_s, double commanded_rpm)
{
    const double wanted_rpm = clamp(commanded_rpm, s->config.max_rpm);

    return clamp(wanted_rpm - s->ramp_rpm, s->config.ramp_rpm_s * dt_s);
}

/*
 * PI control with the ramp fed forward, M = J (dw/dt + b e) + integral of J b e / T_i, b the
 * bandwidth. The integral stands while the torque is at its limit.
 */
static double loop_nm(struct virtual_spindle *s, double dt_s, double ramp_rpm)
{
    const double inertia = s->config.inertia_kg_m2;
    const double error_rad_s = s->ramp_rpm * RAD_S_PER_RPM - s->speed_rad_s;
    const double forward_nm = inertia * ramp_rpm * RAD_S_PER_RPM / dt_s;
    const double proportional_nm = inertia * LOOP_RAD_S * error_rad_s;
    const double integral_nm = s->integral_nm + proportional_nm * dt_s / LOOP_INTEGRAL_S;
    const double wanted_nm = forward_nm + proportional_nm + integral_nm;
    const double given_nm = clamp(wanted_nm, limit_nm(s));

    if (maths_abs(wanted_nm) <= limit_nm(s))
        s->integral_nm = integral_nm;
    return given_nm;
}

/*
 * What poles, slots and a toothed belt make of the torque, while it turns: ripple sin(2 pi n
 * angle).
 */
static double ripple_nm(const struct virtual_spindle *s)
{
    const double turns = s->config.ripple_per_revolution * s->angle_rev;

    if (s->config.ripple_percent == 0.0 || s->speed_rad_s == 0.0)
        return 0.0;
    return 0.01 * s->config.ripple_percent * s->config.rated_torque_nm *
           takt_maths_sin(2.0 * MATHS_PI * (turns - takt_maths_floor(turns)));
}

/* The load resists and never drives: with less torque than it the rotor comes to rest and stays. */
static void turn_rotor(struct virtual_spindle *s, double dt_s, double load_nm)
{
    const double per_inertia = dt_s / s->config.inertia_kg_m2;
    const double before_rad_s = s->speed_rad_s;
    const double free_rad_s = (before_rad_s + (s->torque_nm + ripple_nm(s)) * per_inertia) /
                              (1.0 + s->config.friction_nm_s_per_rad * per_inertia);
    const double resisted_rad_s = free_rad_s - clamp(free_rad_s, load_nm * per_inertia);

    s->speed_rad_s = s->locked ? 0.0 : resisted_rad_s;
    s->angle_rev += 0.5 * (before_rad_s + s->speed_rad_s) * dt_s / (2.0 * MATHS_PI);
}

static double load_percent(const struct virtual_spindle *s)
{
    return 100.0 * maths_abs(s->torque_nm) / s->config.rated_torque_nm;
}

static void watch_overload(struct virtual_spindle *s, double dt_s)
{
    if (load_percent(s) <= s->config.overload_percent) {
        s->overload_s = 0.0;
        return;
    }
    s->overload_s += dt_s;
    if (s->overload_s >= s->config.overload_s)
        virtual_spindle_set_trip(s, VIRTUAL_SPINDLE_OVERLOAD);
}

/* Without output: no torque, and a restart begins at the speed the rotor has then. */
static void coast(struct virtual_spindle *s)
{
    s->torque_nm = 0.0;
    s->integral_nm = 0.0;
    s->ramp_rpm = s->speed_rad_s / RAD_S_PER_RPM;
}

static void drive(struct virtual_spindle *s, double dt_s, double commanded_rpm)
{
    const double ramp_rpm = ramp_step_rpm(s, dt_s, commanded_rpm);

    s->ramp_rpm += ramp_rpm;
    s->torque_nm = loop_nm(s, dt_s, ramp_rpm);
}

static void step(struct virtual_spindle *s, double dt_s, double commanded_rpm, double load_nm)
{
    if (s->trip != VIRTUAL_SPINDLE_GOOD)
        coast(s);
    else
        drive(s, dt_s, commanded_rpm);
    turn_rotor(s, dt_s, load_nm);
    watch_overload(s, dt_s);
}

static void run(struct virtual_spindle *s, double dt_s, double commanded_rpm, double load_nm)
{
    const unsigned steps = (unsigned)maths_max(1.0, takt_maths_ceil(dt_s / STEP_MAX_S));
    const double part_s = dt_s / (double)steps;

    for (unsigned i = 0; i < steps; i++)
        step(s, part_s, commanded_rpm, load_nm);
}

/* Nothing turns it, and nothing is to. */
static bool rests(const struct virtual_spindle *s, double commanded_rpm)
{
    return commanded_rpm == 0.0 && s->speed_rad_s == 0.0 && s->ramp_rpm == 0.0 &&
           s->torque_nm == 0.0 && s->integral_nm == 0.0 && s->overload_s == 0.0;
}

static bool is_at_speed(const struct virtual_spindle *s, double commanded_rpm)
{
    const double speed_rpm = s->speed_rad_s / RAD_S_PER_RPM;
    const double room_rpm =
        maths_max(STANDSTILL_RPM, 0.01 * s->config.at_speed_percent * maths_abs(commanded_rpm));

    return s->trip == VIRTUAL_SPINDLE_GOOD && maths_abs(speed_rpm - commanded_rpm) <= room_rpm;
}

/*
 * From -1 to 1, the same row of numbers in every run: a linear congruential generator modulo 2^64.
 */
static double next_noise(struct virtual_spindle *s)
{
    s->noise = s->noise * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(s->noise >> 11) / 4503599627370496.0 - 1.0;
}

static double measured_angle_rev(struct virtual_spindle *s)
{
    const double counts = (double)s->config.encoder_counts_per_revolution;
    const double noise =
        s->config.encoder_noise_counts > 0 ? s->config.encoder_noise_counts * next_noise(s) : 0.0;

    return counts > 0 ? takt_maths_floor(s->angle_rev * counts + noise) / counts : s->angle_rev;
}

struct spindle_feedback virtual_spindle_step(struct virtual_spindle *s, double dt_s,
                                             double commanded_rpm, double load_nm)
{
    if (!rests(s, commanded_rpm))
        run(s, dt_s, commanded_rpm, load_nm);
    return (struct spindle_feedback){
        .angle_rev = measured_angle_rev(s),
        .speed_rpm = s->speed_rad_s / RAD_S_PER_RPM,
        .load_percent = load_percent(s),
        .at_speed = is_at_speed(s, commanded_rpm),
        .tripped = s->trip != VIRTUAL_SPINDLE_GOOD,
    };
}

void virtual_spindle_set_trip(struct virtual_spindle *s, enum virtual_spindle_trip trip)
{
    s->trip = trip;
    s->overload_s = 0.0;
}
