#include "drives/drive_plant.h"
#include "base/maths.h"

#include <stddef.h>
#include <string.h>

/* Below this a velocity is taken as 0, in mm/s or rad/s: no motor is that slow. */
#define VELOCITY_ZERO 1e-9

/* A drive takes a motor of less than 0.06 rpm as standing. */
#define STANDSTILL_REVOLUTIONS_PER_S 1e-3

/* 1.5 2^52 */
#define ROUNDER 6755399441055744.0

/*
 * Velocity gain times loop period. The loop rings above 1 and is unstable above 2; half of 1 leaves
 * room for the rest.
 */
#define STABLE_MAX 0.5

void drive_plant_set_default(struct drive_plant_config *config)
{
    *config = (struct drive_plant_config){
        .travel_per_revolution_mm = 10,
        .inertia_kg_m2 = 3e-4,
        .viscous_friction_nm_s_per_rad = 1e-3,
        .torque_max_nm = 3.8,
        .torque_rated_nm = 1.27,
        .encoder_counts_per_revolution = 1u << 20,
        .position_gain_per_s = 100,
        .velocity_feed_forward_ratio = 1,
        .velocity_bandwidth_hz = 100,
        .velocity_integral_time_s = 0.02,
        .loop_period_us = 250,
        .pitch_error_period_mm = 10,
        .ambient_temperature_c = 25,
        .temperature_rise_k = 60,
        .temperature_time_s = 600,
        .temperature_max_c = 120,
        .absolute_encoder = 1,
        .limit_switch_min_mm = -1e6,
        .limit_switch_max_mm = 1e6,
        .hard_stop_min_mm = -2e6,
        .hard_stop_max_mm = 2e6,
        .following_error_window_mm = 2,
        .quick_stop_deceleration_mm_s2 = 2000,
    };
}

static bool is_positive(double value)
{
    return value > 0 && maths_is_finite(value);
}

static bool is_not_negative(double value)
{
    return value >= 0 && maths_is_finite(value);
}

#define CHECK(good, field)                                                                         \
    if (!(good))                                                                                   \
    return #field

static const char *check_motor(const struct drive_plant_config *c)
{
    CHECK(is_positive(c->travel_per_revolution_mm), travel_per_revolution_mm);
    CHECK(is_positive(c->inertia_kg_m2), inertia_kg_m2);
    CHECK(is_not_negative(c->viscous_friction_nm_s_per_rad), viscous_friction_nm_s_per_rad);
    CHECK(is_not_negative(c->coulomb_friction_nm), coulomb_friction_nm);
    CHECK(is_positive(c->torque_max_nm), torque_max_nm);
    CHECK(is_positive(c->torque_rated_nm), torque_rated_nm);
    CHECK(maths_is_finite(c->ambient_temperature_c), ambient_temperature_c);
    CHECK(is_not_negative(c->temperature_rise_k), temperature_rise_k);
    CHECK(is_positive(c->temperature_time_s), temperature_time_s);
    CHECK(is_not_negative(c->temperature_max_c), temperature_max_c);
    return NULL;
}

static const char *check_axis(const struct drive_plant_config *c)
{
    CHECK(is_not_negative(c->backlash_mm), backlash_mm);
    CHECK(is_not_negative(c->pitch_error_mm), pitch_error_mm);
    CHECK(is_positive(c->pitch_error_period_mm), pitch_error_period_mm);
    CHECK(maths_is_finite(c->start_mm), start_mm);
    CHECK(c->absolute_encoder <= 1, absolute_encoder);
    CHECK(maths_is_finite(c->limit_switch_min_mm), limit_switch_min_mm);
    CHECK(c->limit_switch_max_mm > c->limit_switch_min_mm &&
              maths_is_finite(c->limit_switch_max_mm),
          limit_switch_max_mm);
    CHECK(maths_is_finite(c->home_switch_mm), home_switch_mm);
    CHECK(is_not_negative(c->home_switch_length_mm), home_switch_length_mm);
    CHECK(maths_is_finite(c->hard_stop_min_mm) && c->hard_stop_min_mm <= c->start_mm,
          hard_stop_min_mm);
    CHECK(maths_is_finite(c->hard_stop_max_mm) && c->hard_stop_max_mm >= c->start_mm,
          hard_stop_max_mm);
    return NULL;
}

static const char *check_loops(const struct drive_plant_config *c)
{
    CHECK(is_positive(c->position_gain_per_s), position_gain_per_s);
    CHECK(is_not_negative(c->velocity_feed_forward_ratio) && c->velocity_feed_forward_ratio <= 1,
          velocity_feed_forward_ratio);
    CHECK(is_positive(c->velocity_bandwidth_hz), velocity_bandwidth_hz);
    CHECK(is_not_negative(c->velocity_integral_time_s), velocity_integral_time_s);
    CHECK(is_not_negative(c->torque_feed_forward_ratio) && c->torque_feed_forward_ratio <= 1,
          torque_feed_forward_ratio);
    CHECK(c->loop_period_us >= 1 && c->loop_period_us <= DRIVE_PLANT_LOOP_PERIOD_MAX_US &&
              MATHS_TWO_PI * c->velocity_bandwidth_hz * c->loop_period_us * 1e-6 <= STABLE_MAX,
          loop_period_us);
    CHECK(is_not_negative(c->following_error_window_mm), following_error_window_mm);
    CHECK(is_positive(c->quick_stop_deceleration_mm_s2), quick_stop_deceleration_mm_s2);
    return NULL;
}

const char *drive_plant_check(const struct drive_plant_config *config)
{
    const char *wrong = check_motor(config);
    if (!wrong)
        wrong = check_axis(config);
    return wrong ? wrong : check_loops(config);
}

/*
 * The encoder counts whole steps. Adding and subtracting 1.5 2^52 rounds a double of less than 2^51
 * to an integer; this is done several times in every cycle. What the encoder is shifted by is added
 * on the way.
 */
static double measure(const struct drive_plant *plant, double motor_mm)
{
    if (plant->encoder_step_mm == 0)
        return motor_mm + plant->encoder_shift_mm;
    double steps = motor_mm * plant->encoder_steps_per_mm;
    return ((steps + plant->encoder_rounder) - ROUNDER) * plant->encoder_step_mm;
}

/* In whole steps, if it has any. */
static void shift_encoder(struct drive_plant *plant, double shift_mm)
{
    double steps = (shift_mm * plant->encoder_steps_per_mm + ROUNDER) - ROUNDER;
    plant->encoder_shift_mm =
        plant->encoder_step_mm == 0 ? shift_mm : steps * plant->encoder_step_mm;
    plant->encoder_rounder = ROUNDER + steps;
    plant->measured_mm = measure(plant, plant->position_mm);
}

/*
 * Everything in units of the axis: with h = travel_per_revolution / 2 pi, an angle phi of the motor
 * is h phi of the axis, so
 *     J d2phi/dt2 = M - b dphi/dt   becomes   d2x/dt2 = a - (b / J) dx/dt,   |a| <= h M_max / J
 * The velocity loop is v' = Kp (e + integral e / Ti) with Kp = 2 pi bandwidth.
 */
void drive_plant_init(struct drive_plant *plant, const struct drive_plant_config *config)
{
    double travel_per_rad_mm = config->travel_per_revolution_mm / MATHS_TWO_PI;
    double integral_time_s = config->velocity_integral_time_s;
    uint32_t counts = config->encoder_counts_per_revolution;
    memset(plant, 0, sizeof *plant);
    plant->config = *config;
    plant->acceleration_max_mm_s2 =
        travel_per_rad_mm * config->torque_max_nm / config->inertia_kg_m2;
    plant->mm_s2_per_rated = travel_per_rad_mm * config->torque_rated_nm / config->inertia_kg_m2;
    plant->rated_per_mm_s2 = 1 / plant->mm_s2_per_rated;
    plant->torque_limit_mm_s2 = plant->acceleration_max_mm_s2;
    plant->temperature_per_s = 1 / config->temperature_time_s;
    plant->coulomb_mm_s2 = travel_per_rad_mm * config->coulomb_friction_nm / config->inertia_kg_m2;
    plant->friction_per_s = config->viscous_friction_nm_s_per_rad / config->inertia_kg_m2;
    plant->velocity_gain_per_s = MATHS_TWO_PI * config->velocity_bandwidth_hz;
    plant->integral_gain_per_s2 =
        integral_time_s > 0 ? plant->velocity_gain_per_s / integral_time_s : 0;
    plant->encoder_step_mm = counts ? config->travel_per_revolution_mm / counts : 0;
    plant->encoder_steps_per_mm = counts / config->travel_per_revolution_mm;
    plant->standstill_mm_s = config->travel_per_revolution_mm * STANDSTILL_REVOLUTIONS_PER_S;
    plant->position_mm = config->start_mm;
    plant->temperature_c = config->ambient_temperature_c;
    plant->damage.torque_ratio = 1;
    shift_encoder(plant, config->absolute_encoder ? 0 : -config->start_mm);
    plant->command_mm = plant->measured_mm;
}

static double slowed(double velocity_mm_s, double by_mm_s)
{
    if (maths_abs(velocity_mm_s) <= by_mm_s)
        return 0;
    return velocity_mm_s > 0 ? velocity_mm_s - by_mm_s : velocity_mm_s + by_mm_s;
}

double drive_plant_torque_limit_mm_s2(const struct drive_plant *plant)
{
    return maths_min(plant->acceleration_max_mm_s2 * plant->damage.torque_ratio,
                     plant->torque_limit_mm_s2);
}

/*
 * What the steps of a cycle change. They work on a copy: a compiler keeps that in registers, which
 * it cannot do with memory that others may point to.
 */
struct motion {
    double position_mm;
    double velocity_mm_s;
    double acceleration_mm_s2;
    double measured_mm;
    double measured_velocity_mm_s;
    double integral_mm_s2;
};

static struct motion motion_of(const struct drive_plant *plant)
{
    return (struct motion){
        plant->position_mm, plant->velocity_mm_s,          plant->acceleration_mm_s2,
        plant->measured_mm, plant->measured_velocity_mm_s, plant->integral_mm_s2};
}

/* What does not change within a cycle. */
struct cycle {
    double step_s, per_step_s;
    double forward_mm_s;   /* velocity that is fed forward */
    double forward_mm_s2;  /* the same for acceleration */
    double limit_mm_s2;    /* acceleration by all the torque there is */
    double coulomb_mm_s;   /* velocity that dry friction takes in a step */
    double min_mm, max_mm; /* hard stops */
    bool is_jammed;
};

static struct cycle cycle_of(struct drive_plant *plant, uint32_t cycle_ns)
{
    uint32_t period_ns = plant->config.loop_period_us * 1000;
    if (plant->cycle_ns != cycle_ns) {
        plant->cycle_ns = cycle_ns;
        plant->steps = (cycle_ns - 1) / period_ns + 1;
        plant->cycle_s = cycle_ns * 1e-9;
        plant->per_cycle_s = 1 / plant->cycle_s;
        plant->step_s = plant->cycle_s / plant->steps;
        plant->per_step_s = 1 / plant->step_s;
    }
    return (struct cycle){
        .step_s = plant->step_s,
        .per_step_s = plant->per_step_s,
        .limit_mm_s2 = drive_plant_torque_limit_mm_s2(plant),
        .coulomb_mm_s = plant->coulomb_mm_s2 * plant->step_s,
        .min_mm = plant->config.hard_stop_min_mm,
        .max_mm = plant->config.hard_stop_max_mm,
        .is_jammed = plant->damage.is_jammed,
    };
}

/* The axis is there at once, and stands. */
static void hit_stop(const struct cycle *c, struct motion *m)
{
    m->position_mm = maths_clamp(m->position_mm, c->min_mm, c->max_mm);
    m->velocity_mm_s = 0;
}

/*
 * Semi-implicit Euler over a step:  v += (a - f v) dt, slowed by dry friction and held by it,
 * x += v dt. A motor that is all but standing stands: an endless decay would end in numbers too
 * small to be fast.
 */
static inline void move(const struct drive_plant *plant, const struct cycle *c, struct motion *m,
                        double acceleration_mm_s2)
{
    double friction_mm_s2 = plant->friction_per_s * m->velocity_mm_s;
    double velocity_mm_s = m->velocity_mm_s + (acceleration_mm_s2 - friction_mm_s2) * c->step_s;
    if (c->coulomb_mm_s > 0)
        velocity_mm_s = slowed(velocity_mm_s, c->coulomb_mm_s);
    if (maths_abs(velocity_mm_s) < VELOCITY_ZERO || c->is_jammed)
        velocity_mm_s = 0;
    m->velocity_mm_s = velocity_mm_s;
    m->position_mm += velocity_mm_s * c->step_s;
    m->acceleration_mm_s2 = acceleration_mm_s2;
    if (m->position_mm < c->min_mm || m->position_mm > c->max_mm)
        hit_stop(c, m);
}

/*
 * a = Kp e + integral + forward. Held at the torque limit the integral part must not grow further.
 */
static inline double control_velocity(const struct drive_plant *plant, const struct cycle *c,
                                      struct motion *m, double error_mm_s)
{
    double wanted_mm_s2 =
        plant->velocity_gain_per_s * error_mm_s + (m->integral_mm_s2 + c->forward_mm_s2);
    if (maths_abs(wanted_mm_s2) <= c->limit_mm_s2)
        m->integral_mm_s2 += plant->integral_gain_per_s2 * error_mm_s * c->step_s;
    return maths_clamp(wanted_mm_s2, -c->limit_mm_s2, c->limit_mm_s2);
}

/* What the encoder says after a step. */
static inline void look(const struct drive_plant *plant, const struct cycle *c, struct motion *m)
{
    double measured_mm = measure(plant, m->position_mm);
    m->measured_velocity_mm_s = (measured_mm - m->measured_mm) * c->per_step_s;
    m->measured_mm = measured_mm;
}

/*
 * A step of the loops: position loop  v = Kv (told - measured) + forward,  velocity loop,
 * mechanics, encoder.
 */
static inline void step(const struct drive_plant *plant, const struct cycle *c, struct motion *m,
                        double told_mm)
{
    double error_mm = told_mm - m->measured_mm;
    double wanted_mm_s = plant->config.position_gain_per_s * error_mm + c->forward_mm_s;
    double error_mm_s = wanted_mm_s - m->measured_velocity_mm_s;
    move(plant, c, m, control_velocity(plant, c, m, error_mm_s));
    look(plant, c, m);
}

/*
 * Play: the table stands until the motor has crossed it.
 * Temperature:  dT/dt = (ambient + rise (M / M_rated)^2 - T) / time.
 */
static void end_cycle(struct drive_plant *plant, const struct motion *m)
{
    const struct drive_plant_config *c = &plant->config;
    double from_mm = plant->position_mm;
    plant->position_mm = m->position_mm;
    plant->velocity_mm_s = m->velocity_mm_s;
    plant->acceleration_mm_s2 = m->acceleration_mm_s2;
    plant->measured_mm = m->measured_mm;
    plant->measured_velocity_mm_s = m->measured_velocity_mm_s;
    plant->integral_mm_s2 = m->integral_mm_s2;
    double ratio = drive_plant_torque_ratio(plant);
    double final_c = c->ambient_temperature_c + c->temperature_rise_k * ratio * ratio;
    plant->temperature_c +=
        (final_c - plant->temperature_c) * (plant->cycle_s * plant->temperature_per_s);
    if (c->backlash_mm > 0)
        plant->play_mm = maths_clamp(plant->play_mm + (plant->position_mm - from_mm),
                                     -c->backlash_mm / 2, c->backlash_mm / 2);
}

void drive_plant_follow(struct drive_plant *plant, double command_mm, uint32_t cycle_ns)
{
    struct cycle cycle = cycle_of(plant, cycle_ns);
    struct motion motion = motion_of(plant);
    double velocity_mm_s = (command_mm - plant->command_mm) * plant->per_cycle_s;
    double acceleration_mm_s2 = (velocity_mm_s - plant->command_velocity_mm_s) * plant->per_cycle_s;
    cycle.forward_mm_s =
        plant->config.velocity_feed_forward_ratio * velocity_mm_s + plant->velocity_offset_mm_s;
    cycle.forward_mm_s2 =
        plant->config.torque_feed_forward_ratio * acceleration_mm_s2 + plant->torque_offset_mm_s2;
    for (uint32_t i = 0; i < plant->steps; i++)
        step(plant, &cycle, &motion, plant->command_mm + velocity_mm_s * (i * cycle.step_s));
    plant->command_mm = command_mm;
    plant->command_velocity_mm_s = velocity_mm_s;
    end_cycle(plant, &motion);
}

/* Where the motor is at the end of a cycle. */
static void stay_with_motor(struct drive_plant *plant, double velocity_mm_s)
{
    plant->command_mm = plant->measured_mm;
    plant->command_velocity_mm_s = velocity_mm_s;
}

void drive_plant_turn(struct drive_plant *plant, double velocity_mm_s, uint32_t cycle_ns)
{
    struct cycle cycle = cycle_of(plant, cycle_ns);
    struct motion motion = motion_of(plant);
    double acceleration_mm_s2 = (velocity_mm_s - plant->command_velocity_mm_s) * plant->per_cycle_s;
    cycle.forward_mm_s = velocity_mm_s + plant->velocity_offset_mm_s;
    cycle.forward_mm_s2 =
        plant->config.torque_feed_forward_ratio * acceleration_mm_s2 + plant->torque_offset_mm_s2;
    for (uint32_t i = 0; i < plant->steps; i++)
        step(plant, &cycle, &motion, motion.measured_mm);
    end_cycle(plant, &motion);
    stay_with_motor(plant, velocity_mm_s);
}

void drive_plant_push(struct drive_plant *plant, double acceleration_mm_s2, uint32_t cycle_ns)
{
    struct cycle cycle = cycle_of(plant, cycle_ns);
    struct motion motion = motion_of(plant);
    double limited_mm_s2 = maths_clamp(acceleration_mm_s2, -cycle.limit_mm_s2, cycle.limit_mm_s2);
    for (uint32_t i = 0; i < plant->steps; i++) {
        move(plant, &cycle, &motion, limited_mm_s2);
        look(plant, &cycle, &motion);
    }
    motion.integral_mm_s2 = 0;
    end_cycle(plant, &motion);
    stay_with_motor(plant, plant->measured_velocity_mm_s);
}

void drive_plant_begin_brake(struct drive_plant *plant, double deceleration_mm_s2)
{
    plant->command_mm = plant->measured_mm;
    plant->command_velocity_mm_s = plant->measured_velocity_mm_s;
    plant->brake_mm_s2 = deceleration_mm_s2;
    plant->velocity_offset_mm_s = 0;
    plant->torque_offset_mm_s2 = 0;
}

/*
 * The motor has moved in the cycle by no more than at standstill, or a step of the encoder, and does not move faster at
 * its end: where it overshoots and turns round, way out and way back may cancel.
 */
static bool stands(const struct drive_plant *plant, double moved_mm)
{
    double still_mm = maths_max(plant->standstill_mm_s * plant->cycle_s, plant->encoder_step_mm);
    double still_mm_s =
        maths_max(plant->standstill_mm_s, plant->encoder_step_mm * plant->per_step_s);
    return maths_abs(moved_mm) <= still_mm &&
           maths_abs(plant->measured_velocity_mm_s) <= still_mm_s;
}

/* The command covers (v0 + v1) / 2 of a cycle while it slows from v0 to v1. */
bool drive_plant_brake(struct drive_plant *plant, uint32_t cycle_ns)
{
    double cycle_s = cycle_ns * 1e-9;
    double before_mm = plant->measured_mm;
    double v0_mm_s = plant->command_velocity_mm_s;
    double v1_mm_s = slowed(v0_mm_s, plant->brake_mm_s2 * cycle_s);
    double way_mm = (v0_mm_s + v1_mm_s) / 2 * cycle_s;
    drive_plant_follow(plant, plant->command_mm + way_mm, cycle_ns);
    plant->command_velocity_mm_s = v1_mm_s;
    return v1_mm_s == 0 && stands(plant, plant->measured_mm - before_mm);
}

void drive_plant_coast(struct drive_plant *plant, uint32_t cycle_ns)
{
    struct cycle cycle = cycle_of(plant, cycle_ns);
    struct motion motion = motion_of(plant);
    for (uint32_t i = 0; i < plant->steps; i++)
        move(plant, &cycle, &motion, 0);
    motion.measured_mm = measure(plant, motion.position_mm);
    motion.measured_velocity_mm_s = (motion.measured_mm - plant->measured_mm) * plant->per_cycle_s;
    motion.integral_mm_s2 = 0;
    end_cycle(plant, &motion);
    plant->command_mm = plant->measured_mm;
    plant->command_velocity_mm_s = 0;
}

double drive_plant_following_error_mm(const struct drive_plant *plant)
{
    return plant->command_mm - plant->measured_mm;
}

/* x = motor - play + A sin(2 pi motor / period) */
double drive_plant_table_mm(const struct drive_plant *plant)
{
    const struct drive_plant_config *c = &plant->config;
    double table_mm = plant->position_mm - plant->play_mm;
    if (c->pitch_error_mm > 0)
        table_mm += c->pitch_error_mm *
                    maths_sin(MATHS_TWO_PI * plant->position_mm / c->pitch_error_period_mm);
    return table_mm;
}

double drive_plant_torque_ratio(const struct drive_plant *plant)
{
    return plant->acceleration_mm_s2 * plant->rated_per_mm_s2;
}

void drive_plant_shift_encoder(struct drive_plant *plant, double by_mm)
{
    shift_encoder(plant, plant->encoder_shift_mm + by_mm);
}
