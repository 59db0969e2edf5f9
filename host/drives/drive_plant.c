#include "drives/drive_plant.h"
#include "base/maths.h"

#include <stddef.h>
#include <string.h>

/* Below this a velocity is taken as 0, in mm/s or rad/s: no motor is that slow. */
#define VELOCITY_ZERO 1e-9

/* 1.5 2^52 */
#define ROUNDER 6755399441055744.0

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
    for (unsigned i = 0; i < FRICTION_POINTS; i++)
        CHECK(is_not_negative(c->friction_forward_nm[i]), friction_forward_nm);
    CHECK(is_not_negative(c->friction_forward_step_mm_s), friction_forward_step_mm_s);
    CHECK(is_not_negative(c->told_inertia_kg_m2), told_inertia_kg_m2);
    CHECK(c->torque_delay_steps < DRIVE_PLANT_DELAY_MAX, torque_delay_steps);
    CHECK(c->loop_period_us >= 1 && c->loop_period_us <= DRIVE_PLANT_LOOP_PERIOD_MAX_US &&
              MATHS_TWO_PI * c->velocity_bandwidth_hz * c->loop_period_us * 1e-6 <=
                  SERVO_LOOP_GAIN_STEP_MAX,
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

static bool is_in_home(const struct drive_plant *plant, double table_mm)
{
    double length_mm = plant->config.home_switch_length_mm;
    double into_mm = plant->sign * (table_mm - plant->config.home_switch_mm);
    return into_mm >= 0 && (length_mm <= 0 || into_mm <= length_mm);
}

/* A motor that turns the other way has its limit switches the other way, too. */
static uint32_t inputs_of(const struct drive_plant *plant)
{
    const struct drive_plant_config *c = &plant->config;
    double table_mm = drive_plant_table_mm(plant);
    uint32_t inputs = is_in_home(plant, table_mm) ? MOTOR_HOME : 0;
    if (table_mm <= c->limit_switch_min_mm)
        inputs |= plant->sign < 0 ? MOTOR_POSITIVE_LIMIT : MOTOR_NEGATIVE_LIMIT;
    if (table_mm >= c->limit_switch_max_mm)
        inputs |= plant->sign < 0 ? MOTOR_NEGATIVE_LIMIT : MOTOR_POSITIVE_LIMIT;
    return inputs;
}

/* In whole steps, if it has any. */
static void shift_encoder(struct drive_plant *plant, double shift_mm)
{
    double steps = (shift_mm * plant->encoder_steps_per_mm + ROUNDER) - ROUNDER;
    plant->encoder_shift_mm =
        plant->encoder_step_mm == 0 ? shift_mm : steps * plant->encoder_step_mm;
    plant->encoder_rounder = ROUNDER + steps;
}

/*
 * Everything in units of the axis: with h = travel_per_revolution / 2 pi, an angle phi of the motor
 * is h phi of the axis, so
 *     J d2phi/dt2 = M - b dphi/dt   becomes   d2x/dt2 = a - (b / J) dx/dt
 */
void drive_plant_init(struct drive_plant *plant, const struct drive_plant_config *config,
                      bool turns_round)
{
    double travel_per_rad_mm = config->travel_per_revolution_mm / MATHS_TWO_PI;
    uint32_t counts = config->encoder_counts_per_revolution;
    memset(plant, 0, sizeof *plant);
    plant->config = *config;
    plant->sign = turns_round ? -1 : 1;
    plant->rated_per_mm_s2 =
        1 / (travel_per_rad_mm * config->torque_rated_nm / config->inertia_kg_m2);
    plant->temperature_per_s = 1 / config->temperature_time_s;
    plant->coulomb_mm_s2 = travel_per_rad_mm * config->coulomb_friction_nm / config->inertia_kg_m2;
    plant->friction_per_s = config->viscous_friction_nm_s_per_rad / config->inertia_kg_m2;
    plant->encoder_step_mm = counts ? config->travel_per_revolution_mm / counts : 0;
    plant->encoder_steps_per_mm = counts / config->travel_per_revolution_mm;
    plant->position_mm = plant->sensed_mm = config->start_mm;
    plant->temperature_c = config->ambient_temperature_c;
    plant->damage.torque_ratio = 1;
    shift_encoder(plant, config->absolute_encoder ? 0 : -config->start_mm);
    plant->sense.inputs = inputs_of(plant);
}

static struct friction friction_of(const struct drive_plant_config *config)
{
    const double step_mm_s = config->friction_forward_step_mm_s;
    struct friction f = {.points_per_velocity = step_mm_s > 0 ? 1 / step_mm_s : 0};
    memcpy(f.at, config->friction_forward_nm, sizeof f.at);
    return f;
}

struct servo_loop_config drive_plant_get_loop(const struct drive_plant_config *config)
{
    return (struct servo_loop_config){
        .travel_per_revolution_mm = config->travel_per_revolution_mm,
        .inertia_kg_m2 = config->inertia_kg_m2,
        .told_inertia_kg_m2 = config->told_inertia_kg_m2,
        .torque_max_nm = config->torque_max_nm,
        .torque_rated_nm = config->torque_rated_nm,
        .encoder_counts_per_revolution = config->encoder_counts_per_revolution,
        .loop_period_us = config->loop_period_us,
        .position_gain_per_s = config->position_gain_per_s,
        .velocity_feed_forward_ratio = config->velocity_feed_forward_ratio,
        .velocity_bandwidth_hz = config->velocity_bandwidth_hz,
        .velocity_integral_time_s = config->velocity_integral_time_s,
        .torque_feed_forward_ratio = config->torque_feed_forward_ratio,
        .friction_nm = friction_of(config),
    };
}

/* ---- Motion ---- */

static double slowed(double velocity_mm_s, double by_mm_s)
{
    if (maths_abs(velocity_mm_s) <= by_mm_s)
        return 0;
    return velocity_mm_s > 0 ? velocity_mm_s - by_mm_s : velocity_mm_s + by_mm_s;
}

/* The axis is there at once, and stands. */
static void hit_stop(struct drive_plant *plant)
{
    plant->position_mm = maths_clamp(plant->position_mm, plant->config.hard_stop_min_mm,
                                     plant->config.hard_stop_max_mm);
    plant->velocity_mm_s = 0;
}

/* What the loops asked for torque_delay_steps ago. */
static double delayed(struct drive_plant *plant, double asked_mm_s2)
{
    const uint32_t now = plant->asked++;
    plant->asked_mm_s2[now % DRIVE_PLANT_DELAY_MAX] = asked_mm_s2;
    return plant->asked_mm_s2[(now - plant->config.torque_delay_steps) % DRIVE_PLANT_DELAY_MAX];
}

/*
 * Semi-implicit Euler over a step:  v += (a - f v) dt, slowed by dry friction and held by it,
 * x += v dt. A motor that is all but standing stands: an endless decay would end in numbers too
 * small to be fast.
 */
static double turn(void *context, double asked_mm_s2, double step_s)
{
    struct drive_plant *plant = context;
    const double torque_mm_s2 =
        plant->config.torque_delay_steps > 0 ? delayed(plant, asked_mm_s2) : asked_mm_s2;
    double friction_mm_s2 = plant->friction_per_s * plant->velocity_mm_s;
    double velocity_mm_s = plant->velocity_mm_s + (torque_mm_s2 - friction_mm_s2) * step_s;
    double coulomb_mm_s = plant->coulomb_mm_s2 * step_s;
    if (coulomb_mm_s > 0)
        velocity_mm_s = slowed(velocity_mm_s, coulomb_mm_s);
    if (maths_abs(velocity_mm_s) < VELOCITY_ZERO || plant->damage.is_jammed)
        velocity_mm_s = 0;
    plant->velocity_mm_s = velocity_mm_s;
    plant->position_mm += velocity_mm_s * step_s;
    plant->torque_mm_s2 = torque_mm_s2;
    if (plant->position_mm < plant->config.hard_stop_min_mm ||
        plant->position_mm > plant->config.hard_stop_max_mm)
        hit_stop(plant);
    return measure(plant, plant->position_mm);
}

/*
 * Play: the table stands until the motor has crossed it.
 * Temperature:  dT/dt = (ambient + rise (M / M_rated)^2 - T) / time.
 */
static void end_cycle(struct drive_plant *plant, uint32_t cycle_ns)
{
    const struct drive_plant_config *c = &plant->config;
    double ratio = plant->torque_mm_s2 * plant->rated_per_mm_s2;
    double final_c = c->ambient_temperature_c + c->temperature_rise_k * ratio * ratio;
    plant->temperature_c +=
        (final_c - plant->temperature_c) * (cycle_ns * 1e-9 * plant->temperature_per_s);
    if (c->backlash_mm > 0)
        plant->play_mm = maths_clamp(plant->play_mm + (plant->position_mm - plant->sensed_mm),
                                     -c->backlash_mm / 2, c->backlash_mm / 2);
}

/* ---- What is sensed ---- */

static int32_t direction_of(double velocity_mm_s)
{
    return (velocity_mm_s > 0) - (velocity_mm_s < 0);
}

/*
 * The edge of the switch that has just been crossed, on the axis: of the home switch the nearer to
 * where the table was.
 */
static double edge_mm(const struct drive_plant *plant, uint32_t input, bool is_active)
{
    const struct drive_plant_config *c = &plant->config;
    bool is_far = (plant->velocity_mm_s * plant->sign > 0) != is_active;
    if (input == MOTOR_HOME)
        return c->home_switch_mm + (is_far ? plant->sign * c->home_switch_length_mm : 0);
    bool is_lower = (input == MOTOR_NEGATIVE_LIMIT) == (plant->sign > 0);
    return is_lower ? c->limit_switch_min_mm : c->limit_switch_max_mm;
}

/* Where the encoder was when the table was at the edge. */
static void latch_edges(struct drive_plant *plant, uint32_t inputs)
{
    double table_mm = drive_plant_table_mm(plant);
    uint32_t changed = inputs ^ plant->sense.inputs;
    for (unsigned i = 0; changed >> i != 0; i++) {
        uint32_t input = 1U << i;
        if (!(changed & input))
            continue;
        double past_mm = table_mm - edge_mm(plant, input, inputs & input);
        plant->sense.edge[i] =
            (struct motor_latch){(plant->position_mm - past_mm) + plant->encoder_shift_mm,
                                 direction_of(plant->velocity_mm_s)};
    }
    plant->sense.inputs = inputs;
}

/* The pulse comes once a turn, where the motor's angle is 0. The last one counts. */
static void latch_pulse(struct drive_plant *plant)
{
    double turn_mm = plant->config.travel_per_revolution_mm;
    double from = plant->sensed_mm / turn_mm;
    double to = plant->position_mm / turn_mm;
    double turns = to > from ? takt_maths_floor(to) : takt_maths_ceil(to);
    if (to == from || (to > from ? turns <= from : turns >= from))
        return;
    plant->sense.pulses++;
    plant->sense.pulse =
        (struct motor_latch){turns * turn_mm + plant->encoder_shift_mm, to > from ? 1 : -1};
}

static void sense(void *context, uint32_t cycle_ns, struct motor_sense *seen)
{
    struct drive_plant *plant = context;
    if (cycle_ns > 0)
        end_cycle(plant, cycle_ns);
    latch_edges(plant, inputs_of(plant));
    latch_pulse(plant);
    plant->sensed_mm = plant->position_mm;
    plant->sense.encoder_mm = measure(plant, plant->position_mm);
    plant->sense.temperature_c = plant->temperature_c;
    plant->sense.torque_ratio = plant->damage.torque_ratio;
    *seen = plant->sense;
}

struct motor_port drive_plant_get_port(struct drive_plant *plant)
{
    return (struct motor_port){.turn = turn, .sense = sense, .context = plant};
}

/* x = motor - play + A sin(2 pi motor / period) */
double drive_plant_table_mm(const struct drive_plant *plant)
{
    const struct drive_plant_config *c = &plant->config;
    double table_mm = plant->position_mm - plant->play_mm;
    if (c->pitch_error_mm > 0)
        table_mm += c->pitch_error_mm *
                    takt_maths_sin(MATHS_TWO_PI * plant->position_mm / c->pitch_error_period_mm);
    return table_mm;
}

void drive_plant_shift_encoder(struct drive_plant *plant, double by_mm)
{
    shift_encoder(plant, plant->encoder_shift_mm + by_mm);
}
