#include "drives/drive_plant.h"
#include "base/maths.h"

#include <stddef.h>
#include <string.h>

/* Below this a velocity is taken as 0, in mm/s or rad/s: no motor is that slow. */
#define VELOCITY_ZERO 1e-9

/* A drive takes a motor of less than 0.06 rpm as standing. */
#define STANDSTILL_REVOLUTIONS_PER_S 1e-3

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
        .encoder_counts_per_revolution = 1u << 20,
        .position_gain_per_s = 100,
        .velocity_feed_forward_ratio = 1,
        .velocity_bandwidth_hz = 100,
        .velocity_integral_time_s = 0.02,
        .loop_period_us = 250,
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

const char *drive_plant_check(const struct drive_plant_config *c)
{
    CHECK(is_positive(c->travel_per_revolution_mm), travel_per_revolution_mm);
    CHECK(is_positive(c->inertia_kg_m2), inertia_kg_m2);
    CHECK(is_not_negative(c->viscous_friction_nm_s_per_rad), viscous_friction_nm_s_per_rad);
    CHECK(is_positive(c->torque_max_nm), torque_max_nm);
    CHECK(is_positive(c->position_gain_per_s), position_gain_per_s);
    CHECK(is_not_negative(c->velocity_feed_forward_ratio) && c->velocity_feed_forward_ratio <= 1,
          velocity_feed_forward_ratio);
    CHECK(is_positive(c->velocity_bandwidth_hz), velocity_bandwidth_hz);
    CHECK(is_not_negative(c->velocity_integral_time_s), velocity_integral_time_s);
    CHECK(c->loop_period_us >= 1 && c->loop_period_us <= DRIVE_PLANT_LOOP_PERIOD_MAX_US &&
              MATHS_TWO_PI * c->velocity_bandwidth_hz * c->loop_period_us * 1e-6 <= STABLE_MAX,
          loop_period_us);
    CHECK(is_not_negative(c->following_error_window_mm), following_error_window_mm);
    CHECK(is_positive(c->quick_stop_deceleration_mm_s2), quick_stop_deceleration_mm_s2);
    return NULL;
}

/*
 * The encoder counts whole steps. Adding and subtracting 1.5 2^52 rounds a double of less than 2^51
 * to an integer; this is done several times in every cycle.
 */
static double measure(const struct drive_plant *plant)
{
    const double rounder = 6755399441055744.0;
    if (plant->encoder_step_mm == 0)
        return plant->position_mm;
    double steps = plant->position_mm * plant->encoder_steps_per_mm;
    return ((steps + rounder) - rounder) * plant->encoder_step_mm;
}

/*
 * Everything in units of the axis: with h = travel_per_revolution / 2 pi, an angle phi of the motor
 * is h phi of the axis, so
 *     J d2phi/dt2 = M - b dphi/dt   becomes   d2x/dt2 = a - (b / J) dx/dt,   |a| <= h M_max / J
 * The velocity loop is v' = Kp (e + integral e / Ti) with Kp = 2 pi bandwidth.
 */
void drive_plant_init(struct drive_plant *plant, const struct drive_plant_config *config,
                      double position_mm)
{
    double travel_per_rad_mm = config->travel_per_revolution_mm / MATHS_TWO_PI;
    double integral_time_s = config->velocity_integral_time_s;
    uint32_t counts = config->encoder_counts_per_revolution;
    memset(plant, 0, sizeof *plant);
    plant->config = *config;
    plant->acceleration_max_mm_s2 =
        travel_per_rad_mm * config->torque_max_nm / config->inertia_kg_m2;
    plant->friction_per_s = config->viscous_friction_nm_s_per_rad / config->inertia_kg_m2;
    plant->velocity_gain_per_s = MATHS_TWO_PI * config->velocity_bandwidth_hz;
    plant->integral_gain_per_s2 =
        integral_time_s > 0 ? plant->velocity_gain_per_s / integral_time_s : 0;
    plant->encoder_step_mm = counts ? config->travel_per_revolution_mm / counts : 0;
    plant->encoder_steps_per_mm = counts / config->travel_per_revolution_mm;
    plant->standstill_mm_s = config->travel_per_revolution_mm * STANDSTILL_REVOLUTIONS_PER_S;
    plant->position_mm = position_mm;
    plant->measured_mm = measure(plant);
    plant->command_mm = plant->measured_mm;
}

/*
 * Semi-implicit Euler over dt:  v += (a - f v) dt,  x += v dt.  A motor that is all but standing
 * stands: an endless decay would end in numbers too small to be fast.
 */
static void move(struct drive_plant *plant, double acceleration_mm_s2, double dt_s)
{
    double friction_mm_s2 = plant->friction_per_s * plant->velocity_mm_s;
    double velocity_mm_s = plant->velocity_mm_s + (acceleration_mm_s2 - friction_mm_s2) * dt_s;
    plant->velocity_mm_s = maths_abs(velocity_mm_s) < VELOCITY_ZERO ? 0 : velocity_mm_s;
    plant->position_mm += plant->velocity_mm_s * dt_s;
}

/* Held at the torque limit the integral part must not grow further. */
static double control_velocity(struct drive_plant *plant, double error_mm_s, double dt_s)
{
    double wanted_mm_s2 = plant->velocity_gain_per_s * error_mm_s + plant->integral_mm_s2;
    double limit_mm_s2 = plant->acceleration_max_mm_s2;
    if (maths_abs(wanted_mm_s2) <= limit_mm_s2)
        plant->integral_mm_s2 += plant->integral_gain_per_s2 * error_mm_s * dt_s;
    return maths_clamp(wanted_mm_s2, -limit_mm_s2, limit_mm_s2);
}

struct slices {
    uint32_t count;
    double dt_s;
};

static struct slices slice_cycle(const struct drive_plant *plant, uint32_t cycle_ns)
{
    uint32_t period_ns = plant->config.loop_period_us * 1000;
    uint32_t count = (cycle_ns - 1) / period_ns + 1;
    return (struct slices){count, cycle_ns * 1e-9 / count};
}

/*
 * A step of the loops: position loop  v = Kv (told - measured) + forward,  velocity loop,
 * mechanics, encoder.
 */
static void step(struct drive_plant *plant, double told_mm, double forward_mm_s, double dt_s)
{
    double error_mm = told_mm - plant->measured_mm;
    double wanted_mm_s = plant->config.position_gain_per_s * error_mm + forward_mm_s;
    double error_mm_s = wanted_mm_s - plant->measured_velocity_mm_s;
    move(plant, control_velocity(plant, error_mm_s, dt_s), dt_s);
    double measured_mm = measure(plant);
    plant->measured_velocity_mm_s = (measured_mm - plant->measured_mm) / dt_s;
    plant->measured_mm = measured_mm;
}

void drive_plant_follow(struct drive_plant *plant, double command_mm, uint32_t cycle_ns)
{
    struct slices slices = slice_cycle(plant, cycle_ns);
    double velocity_mm_s = (command_mm - plant->command_mm) / (cycle_ns * 1e-9);
    double forward_mm_s = plant->config.velocity_feed_forward_ratio * velocity_mm_s;
    for (uint32_t i = 0; i < slices.count; i++) {
        double told_mm = plant->command_mm + velocity_mm_s * (i * slices.dt_s);
        step(plant, told_mm, forward_mm_s, slices.dt_s);
    }
    plant->command_mm = command_mm;
    plant->command_velocity_mm_s = velocity_mm_s;
}

static double slowed(double velocity_mm_s, double by_mm_s)
{
    if (maths_abs(velocity_mm_s) <= by_mm_s)
        return 0;
    return velocity_mm_s > 0 ? velocity_mm_s - by_mm_s : velocity_mm_s + by_mm_s;
}

void drive_plant_begin_brake(struct drive_plant *plant)
{
    plant->command_mm = plant->measured_mm;
    plant->command_velocity_mm_s = plant->measured_velocity_mm_s;
}

/* The command covers (v0 + v1) / 2 of a cycle while it slows from v0 to v1. */
bool drive_plant_brake(struct drive_plant *plant, uint32_t cycle_ns)
{
    double cycle_s = cycle_ns * 1e-9;
    double before_mm = plant->measured_mm;
    double v0_mm_s = plant->command_velocity_mm_s;
    double v1_mm_s = slowed(v0_mm_s, plant->config.quick_stop_deceleration_mm_s2 * cycle_s);
    double way_mm = (v0_mm_s + v1_mm_s) / 2 * cycle_s;
    drive_plant_follow(plant, plant->command_mm + way_mm, cycle_ns);
    plant->command_velocity_mm_s = v1_mm_s;
    double moved_mm = maths_abs(plant->measured_mm - before_mm);
    double still_mm = maths_max(plant->standstill_mm_s * cycle_s, plant->encoder_step_mm);
    return v1_mm_s == 0 && moved_mm <= still_mm;
}

void drive_plant_coast(struct drive_plant *plant, uint32_t cycle_ns)
{
    struct slices slices = slice_cycle(plant, cycle_ns);
    for (uint32_t i = 0; i < slices.count; i++)
        move(plant, 0, slices.dt_s);
    double measured_mm = measure(plant);
    plant->measured_velocity_mm_s = (measured_mm - plant->measured_mm) / (cycle_ns * 1e-9);
    plant->measured_mm = measured_mm;
    plant->integral_mm_s2 = 0;
    plant->command_mm = measured_mm;
    plant->command_velocity_mm_s = 0;
}

double drive_plant_following_error_mm(const struct drive_plant *plant)
{
    return plant->command_mm - plant->measured_mm;
}
