/*
 * Modes of velocity and torque: profile velocity (3) and profile torque (4), which go to their
 * target by ramps, and cyclic synchronous velocity (9) and torque (10), whose targets the
 * controller makes. The position loop rests.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "servo/servo_private.h"

/* ---- Velocity ---- */

static double target_velocity_mm_s(const struct servo *drive)
{
    return drive->velocity_sign * drive->objects.process.target_velocity /
           servo_velocity_scale(drive);
}

/* As far as the limit lets it: an internal limit. */
static double limited_mm_s(struct servo *drive, double velocity_mm_s, double most_mm_s)
{
    double limited = maths_clamp(velocity_mm_s, -most_mm_s, most_mm_s);
    TAKT_ASSERT(most_mm_s >= 0.0);
    drive->is_limited = limited != velocity_mm_s;
    return limited;
}

static void turn(struct servo *drive, double velocity_mm_s, uint32_t cycle_ns)
{
    TAKT_ASSERT(cycle_ns > 0);
    drive->velocity_mm_s = velocity_mm_s;
    takt_servo_loop_turn(&drive->loop, velocity_mm_s, cycle_ns);
}

/* Objects 606D and 606E. */
static void check_velocity(struct servo *drive, double target_mm_s, uint32_t cycle_ns)
{
    const struct drive_settings *s = &drive->objects.settings;
    double window_mm_s = s->velocity_window / servo_velocity_scale(drive);
    bool is_inside = maths_abs(target_mm_s - drive->loop.measured_velocity_mm_s) <= window_mm_s;
    takt_servo_note_reached(drive, is_inside, s->velocity_window_ms, cycle_ns);
}

/* To the other direction it slows down first, and then speeds up. */
void takt_servo_run_profile_velocity(struct servo *drive, uint32_t cycle_ns)
{
    double target_mm_s = limited_mm_s(drive, target_velocity_mm_s(drive),
                                      takt_servo_profile_velocity_max_mm_s(drive));
    double now_mm_s = drive->velocity_mm_s;
    double goal_mm_s = now_mm_s * target_mm_s < 0 ? 0 : target_mm_s;
    bool speeds_up = maths_abs(goal_mm_s) > maths_abs(now_mm_s);
    double ramp_mm_s2 = speeds_up ? takt_servo_profile_acceleration_mm_s2(drive)
                                  : takt_servo_profile_deceleration_mm_s2(drive);
    turn(drive, takt_course_approach(now_mm_s, goal_mm_s, ramp_mm_s2 * (cycle_ns * 1e-9)),
         cycle_ns);
    check_velocity(drive, target_mm_s, cycle_ns);
}

void takt_servo_run_cyclic_velocity(struct servo *drive, uint32_t cycle_ns)
{
    takt_servo_set_offsets(drive);
    turn(
        drive,
        limited_mm_s(drive, target_velocity_mm_s(drive), takt_servo_motor_velocity_max_mm_s(drive)),
        cycle_ns);
}

/* ---- Torque ---- */

/*
 * Torque in parts of the rated one, as the motor turns. At its highest speed (6080) a motor gets
 * none that speeds it up.
 */
static void push(struct servo *drive, double ratio, uint32_t cycle_ns)
{
    struct servo_loop *loop = &drive->loop;
    double velocity_mm_s = loop->measured_velocity_mm_s;
    double most = takt_servo_loop_torque_limit_mm_s2(loop) * loop->rated_per_mm_s2;
    bool is_fast = maths_abs(velocity_mm_s) >= takt_servo_motor_velocity_max_mm_s(drive) &&
                   ratio * velocity_mm_s > 0;
    double limited = is_fast ? 0 : maths_clamp(ratio, -most, most);
    drive->is_limited = limited != ratio;
    drive->objects.process.demand_torque =
        (int16_t)takt_maths_round(drive->torque_sign * limited * TORQUE_PER_RATED);
    takt_servo_loop_push(loop, limited * loop->mm_s2_per_rated, cycle_ns);
    drive->velocity_mm_s = loop->measured_velocity_mm_s;
}

static double ratio_of(const struct servo *drive, int32_t torque)
{
    return drive->torque_sign * torque / TORQUE_PER_RATED;
}

/* Halt: to no torque. */
void takt_servo_run_profile_torque(struct servo *drive, uint32_t cycle_ns)
{
    const struct drive_objects *o = &drive->objects;
    double target = drive->is_halted ? 0 : ratio_of(drive, o->process.target_torque);
    double by = o->settings.torque_slope / TORQUE_PER_RATED * (cycle_ns * 1e-9);
    drive->torque_ratio = takt_course_approach(drive->torque_ratio, target, by);
    push(drive, drive->torque_ratio, cycle_ns);
    drive->setpoints.is_reached = drive->torque_ratio == target;
}

void takt_servo_run_cyclic_torque(struct servo *drive, uint32_t cycle_ns)
{
    const struct drive_process *p = &drive->objects.process;
    push(drive, ratio_of(drive, (int32_t)p->target_torque + p->torque_offset), cycle_ns);
}
