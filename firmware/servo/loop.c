#include "servo/loop.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* A drive takes a motor of less than 0.06 rpm as standing. */
#define STANDSTILL_REVOLUTIONS_PER_S 1e-3

/*
 * Everything in units of the axis: with h = travel_per_revolution / 2 pi, an angle phi of the motor
 * is h phi of the axis, and a torque M of the motor an acceleration h M / J. The velocity loop is
 * v' = Kp (e + integral e / Ti), Kp = 2 pi bandwidth.
 */
void takt_servo_loop_init(struct servo_loop *loop, const struct servo_loop_config *config,
                          const struct motor_port *motor)
{
    double travel_per_rad_mm = config->travel_per_revolution_mm / MATHS_TWO_PI;
    uint32_t counts = config->encoder_counts_per_revolution;
    TAKT_ASSERT(config->travel_per_revolution_mm != 0.0);
    memset(loop, 0, sizeof *loop);
    loop->config = *config;
    loop->motor = *motor;
    loop->acceleration_max_mm_s2 =
        travel_per_rad_mm * config->torque_max_nm / config->inertia_kg_m2;
    loop->mm_s2_per_rated = travel_per_rad_mm * config->torque_rated_nm / config->inertia_kg_m2;
    loop->rated_per_mm_s2 = 1 / loop->mm_s2_per_rated;
    loop->torque_limit_mm_s2 = loop->acceleration_max_mm_s2;
    loop->friction = config->friction_nm;
    for (unsigned i = 0; i < FRICTION_POINTS; i++)
        loop->friction.at[i] *= travel_per_rad_mm / config->inertia_kg_m2;
    takt_servo_loop_tune(loop, config);
    loop->encoder_step_mm = counts ? config->travel_per_revolution_mm / counts : 0;
    loop->encoder_steps_per_mm = counts / config->travel_per_revolution_mm;
    loop->standstill_mm_s = config->travel_per_revolution_mm * STANDSTILL_REVOLUTIONS_PER_S;
    takt_servo_loop_look(loop);
    loop->command_mm = loop->measured_mm;
}

/*
 * The loops think in accelerations, and the motor gets the torque M = J_told a / h: with an inertia
 * J it is accelerated by J_told / J of what they want.
 */
void takt_servo_loop_tune(struct servo_loop *loop, const struct servo_loop_config *config)
{
    const double inertia_kg_m2 = loop->config.inertia_kg_m2,
                 told_kg_m2 = config->told_inertia_kg_m2;
    const double told_ratio = told_kg_m2 > 0 ? told_kg_m2 / inertia_kg_m2 : 1;
    const double integral_time_s = config->velocity_integral_time_s;
    loop->config.position_gain_per_s = config->position_gain_per_s;
    loop->config.velocity_feed_forward_ratio = config->velocity_feed_forward_ratio;
    loop->velocity_gain_per_s = told_ratio * (MATHS_TWO_PI * config->velocity_bandwidth_hz);
    loop->integral_gain_per_s2 =
        integral_time_s > 0 ? loop->velocity_gain_per_s / integral_time_s : 0;
    loop->torque_forward_ratio = told_ratio * config->torque_feed_forward_ratio;
}

static void look(struct servo_loop *loop, uint32_t cycle_ns)
{
    loop->motor.sense(loop->motor.context, cycle_ns, &loop->sense);
    loop->measured_mm = loop->sense.encoder_mm;
}

void takt_servo_loop_look(struct servo_loop *loop)
{
    look(loop, 0);
}

double takt_servo_loop_torque_limit_mm_s2(const struct servo_loop *loop)
{
    return maths_min(loop->acceleration_max_mm_s2 * loop->sense.torque_ratio,
                     loop->torque_limit_mm_s2);
}

/* What does not change within a cycle. */
struct cycle {
    double forward_mm_s;  /* velocity that is fed forward */
    double forward_mm_s2; /* the same for acceleration, by which friction is overcome too */
    double limit_mm_s2;   /* acceleration by all the torque there is */
};

static struct cycle begin_cycle(struct servo_loop *loop, uint32_t cycle_ns)
{
    uint32_t period_ns = loop->config.loop_period_us * 1000;
    TAKT_ASSERT(cycle_ns > 0 && period_ns > 0);
    if (loop->cycle_ns != cycle_ns) {
        loop->cycle_ns = cycle_ns;
        loop->steps = (cycle_ns - 1) / period_ns + 1;
        loop->cycle_s = cycle_ns * 1e-9;
        loop->per_cycle_s = 1 / loop->cycle_s;
        loop->step_s = loop->cycle_s / loop->steps;
        loop->per_step_s = 1 / loop->step_s;
    }
    return (struct cycle){.limit_mm_s2 = takt_servo_loop_torque_limit_mm_s2(loop)};
}

/*
 * For a command that moves at a velocity and changes it: by the loop's inertia, and against
 * friction.
 */
static double forward_torque_mm_s2(const struct servo_loop *loop, double velocity_mm_s,
                                   double acceleration_mm_s2)
{
    return loop->torque_forward_ratio * acceleration_mm_s2 +
           takt_friction_at(&loop->friction, velocity_mm_s) + loop->torque_offset_mm_s2;
}

/* The same of a command for a position. */
static void feed_forward(const struct servo_loop *loop, struct cycle *c, double velocity_mm_s,
                         double acceleration_mm_s2)
{
    c->forward_mm_s =
        loop->config.velocity_feed_forward_ratio * velocity_mm_s + loop->velocity_offset_mm_s;
    c->forward_mm_s2 = forward_torque_mm_s2(loop, velocity_mm_s, acceleration_mm_s2);
}

/* A step with this torque, and what the encoder says after it. */
static void turn(struct servo_loop *loop, double torque_mm_s2)
{
    double measured_mm = loop->motor.turn(loop->motor.context, torque_mm_s2, loop->step_s);
    loop->torque_mm_s2 = torque_mm_s2;
    loop->measured_velocity_mm_s = (measured_mm - loop->measured_mm) * loop->per_step_s;
    loop->measured_mm = measured_mm;
}

/*
 * a = Kp e + integral + forward. Held at the torque limit the integral part must not grow further.
 */
static double control_velocity(struct servo_loop *loop, const struct cycle *c, double error_mm_s)
{
    double wanted_mm_s2 =
        loop->velocity_gain_per_s * error_mm_s + (loop->integral_mm_s2 + c->forward_mm_s2);
    if (maths_abs(wanted_mm_s2) <= c->limit_mm_s2)
        loop->integral_mm_s2 += loop->integral_gain_per_s2 * error_mm_s * loop->step_s;
    return maths_clamp(wanted_mm_s2, -c->limit_mm_s2, c->limit_mm_s2);
}

/*
 * A step of the loops: position loop  v = Kv (told - measured) + forward,  velocity loop, motor,
 * encoder.
 */
static void step(struct servo_loop *loop, const struct cycle *c, double told_mm)
{
    double error_mm = told_mm - loop->measured_mm;
    double wanted_mm_s = loop->config.position_gain_per_s * error_mm + c->forward_mm_s;
    double error_mm_s = wanted_mm_s - loop->measured_velocity_mm_s;
    turn(loop, control_velocity(loop, c, error_mm_s));
}

void takt_servo_loop_follow(struct servo_loop *loop, double command_mm, uint32_t cycle_ns)
{
    struct cycle cycle = begin_cycle(loop, cycle_ns);
    double velocity_mm_s = (command_mm - loop->command_mm) * loop->per_cycle_s;
    double acceleration_mm_s2 = (velocity_mm_s - loop->command_velocity_mm_s) * loop->per_cycle_s;
    TAKT_ASSERT(loop->steps > 0);
    feed_forward(loop, &cycle, velocity_mm_s, acceleration_mm_s2);
    for (uint32_t i = 0; i < loop->steps; i++)
        step(loop, &cycle, loop->command_mm + velocity_mm_s * (i * loop->step_s));
    loop->command_mm = command_mm;
    loop->command_velocity_mm_s = velocity_mm_s;
    look(loop, cycle_ns);
}

void takt_servo_loop_follow_piece(struct servo_loop *loop, const double piece[BETWEEN_COEFFICIENTS],
                                  double end_mm, uint32_t cycle_ns)
{
    struct cycle cycle = begin_cycle(loop, cycle_ns);
    double place[3];
    TAKT_ASSERT(loop->steps > 0);
    for (uint32_t i = 0; i < loop->steps; i++) {
        takt_between_at(piece, i * loop->step_s * loop->per_cycle_s, place);
        double velocity_mm_s = place[1] * loop->per_cycle_s;
        double acceleration_mm_s2 = place[2] * loop->per_cycle_s * loop->per_cycle_s;
        feed_forward(loop, &cycle, velocity_mm_s, acceleration_mm_s2);
        step(loop, &cycle, place[0]);
    }
    takt_between_at(piece, 1, place);
    loop->command_mm = end_mm;
    loop->command_velocity_mm_s = place[1] * loop->per_cycle_s;
    look(loop, cycle_ns);
}

/* Where the motor is at the end of a cycle. */
static void stay_with_motor(struct servo_loop *loop, double velocity_mm_s)
{
    loop->command_mm = loop->measured_mm;
    loop->command_velocity_mm_s = velocity_mm_s;
}

void takt_servo_loop_turn(struct servo_loop *loop, double velocity_mm_s, uint32_t cycle_ns)
{
    struct cycle cycle = begin_cycle(loop, cycle_ns);
    double acceleration_mm_s2 = (velocity_mm_s - loop->command_velocity_mm_s) * loop->per_cycle_s;
    cycle.forward_mm_s = velocity_mm_s + loop->velocity_offset_mm_s;
    cycle.forward_mm_s2 = forward_torque_mm_s2(loop, velocity_mm_s, acceleration_mm_s2);
    for (uint32_t i = 0; i < loop->steps; i++)
        step(loop, &cycle, loop->measured_mm);
    look(loop, cycle_ns);
    stay_with_motor(loop, velocity_mm_s);
}

void takt_servo_loop_push(struct servo_loop *loop, double acceleration_mm_s2, uint32_t cycle_ns)
{
    const struct cycle cycle = begin_cycle(loop, cycle_ns);
    double limited_mm_s2 = maths_clamp(acceleration_mm_s2, -cycle.limit_mm_s2, cycle.limit_mm_s2);
    for (uint32_t i = 0; i < loop->steps; i++)
        turn(loop, limited_mm_s2);
    loop->integral_mm_s2 = 0;
    look(loop, cycle_ns);
    stay_with_motor(loop, loop->measured_velocity_mm_s);
}

/* The velocity is that of the whole cycle: nobody controls it. */
void takt_servo_loop_coast(struct servo_loop *loop, uint32_t cycle_ns)
{
    double before_mm = loop->measured_mm;
    (void)begin_cycle(loop, cycle_ns);
    for (uint32_t i = 0; i < loop->steps; i++)
        turn(loop, 0);
    loop->measured_velocity_mm_s = (loop->measured_mm - before_mm) * loop->per_cycle_s;
    loop->integral_mm_s2 = 0;
    look(loop, cycle_ns);
    stay_with_motor(loop, 0);
}

void takt_servo_loop_begin_brake(struct servo_loop *loop, double deceleration_mm_s2)
{
    TAKT_ASSERT(deceleration_mm_s2 >= 0.0);
    stay_with_motor(loop, loop->measured_velocity_mm_s);
    loop->brake_mm_s2 = deceleration_mm_s2;
    loop->velocity_offset_mm_s = 0;
    loop->torque_offset_mm_s2 = 0;
}

/*
 * The motor has moved in the cycle by no more than at standstill, or a step of the encoder, and
 * does not move faster at its end: where it overshoots and turns round, way out and way back may
 * cancel.
 */
static bool stands(const struct servo_loop *loop, double moved_mm)
{
    double still_mm = maths_max(loop->standstill_mm_s * loop->cycle_s, loop->encoder_step_mm);
    double still_mm_s = maths_max(loop->standstill_mm_s, loop->encoder_step_mm * loop->per_step_s);
    return maths_abs(moved_mm) <= still_mm && maths_abs(loop->measured_velocity_mm_s) <= still_mm_s;
}

static double slowed(double velocity_mm_s, double by_mm_s)
{
    TAKT_ASSERT(by_mm_s >= 0.0);
    if (maths_abs(velocity_mm_s) <= by_mm_s)
        return 0;
    return velocity_mm_s > 0 ? velocity_mm_s - by_mm_s : velocity_mm_s + by_mm_s;
}

/* The command covers (v0 + v1) / 2 of a cycle while it slows from v0 to v1. */
bool takt_servo_loop_brake(struct servo_loop *loop, uint32_t cycle_ns)
{
    double cycle_s = cycle_ns * 1e-9;
    double before_mm = loop->measured_mm;
    double v0_mm_s = loop->command_velocity_mm_s;
    double v1_mm_s = slowed(v0_mm_s, loop->brake_mm_s2 * cycle_s);
    double way_mm = (v0_mm_s + v1_mm_s) / 2 * cycle_s;
    takt_servo_loop_follow(loop, loop->command_mm + way_mm, cycle_ns);
    loop->command_velocity_mm_s = v1_mm_s;
    return v1_mm_s == 0 && stands(loop, loop->measured_mm - before_mm);
}

void takt_servo_loop_let_go(struct servo_loop *loop)
{
    stay_with_motor(loop, 0);
    loop->integral_mm_s2 = 0;
}

double takt_servo_loop_following_error_mm(const struct servo_loop *loop)
{
    return loop->command_mm - loop->measured_mm;
}

double takt_servo_loop_torque_ratio(const struct servo_loop *loop)
{
    return loop->torque_mm_s2 * loop->rated_per_mm_s2;
}
