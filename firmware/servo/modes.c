/*
 * Modes of operation: where the command goes while the drive is enabled.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "servo/servo_private.h"

#define CONTROL_BIT_4     0x0010 /* new set-point, homing start, enable interpolation */
#define CONTROL_IMMEDIATE 0x0020
#define CONTROL_RELATIVE  0x0040

#define STATUS_REACHED 0x0400
#define STATUS_BIT_12  0x1000 /* set-point acknowledged, homing attained, follows the target */
#define STATUS_BIT_13  0x2000 /* following error, homing error */

#define WINDOW_ANY      UINT32_MAX
#define HALT_QUICK_STOP 2

/* Object 60C0; 0: straight lines. */
#define INTERPOLATION_SMOOTH (-1)

/* Object 6086. */
#define PROFILE_JERK_LIMITED 3
#define SECONDS_PER_MIN      60.0

#define INCREMENTS_MAX 2147483647.0

int32_t takt_servo_increments(const struct servo *drive, double position_mm)
{
    double increments = position_mm * drive->increments_per_mm;
    return maths_nearest(maths_clamp(increments, -INCREMENTS_MAX, INCREMENTS_MAX));
}

double takt_servo_actual_mm(const struct servo *drive)
{
    return drive->loop.measured_mm - drive->origin_mm;
}

static double least_mm(const struct servo *drive, uint32_t a, uint32_t b)
{
    return (a < b ? a : b) / servo_velocity_scale(drive);
}

double takt_servo_profile_acceleration_mm_s2(const struct servo *drive)
{
    const struct drive_settings *s = &drive->objects.settings;
    return least_mm(drive, s->profile_acceleration, s->max_acceleration);
}

double takt_servo_profile_deceleration_mm_s2(const struct servo *drive)
{
    const struct drive_settings *s = &drive->objects.settings;
    return least_mm(drive, s->profile_deceleration, s->max_deceleration);
}

double takt_servo_motor_velocity_max_mm_s(const struct servo *drive)
{
    return drive->objects.settings.max_motor_speed_rpm / SECONDS_PER_MIN *
           drive->config.loop.travel_per_revolution_mm;
}

double takt_servo_profile_velocity_max_mm_s(const struct servo *drive)
{
    return maths_min(drive->objects.settings.max_profile_velocity / servo_velocity_scale(drive),
                     takt_servo_motor_velocity_max_mm_s(drive));
}
/*
 * What the target of an earlier run was is forgotten: the drive stands, or slows down to stand,
 * until it gets a new one.
 */
void takt_servo_hold(struct servo *drive)
{
    struct drive_process *p = &drive->objects.process;
    int32_t here_inc = takt_servo_increments(drive, drive->loop.command_mm - drive->origin_mm);
    p->target_position = here_inc;
    p->interpolation_target = here_inc;
    drive->velocity_mm_s = drive->loop.command_velocity_mm_s;
    drive->goal_mm = drive->loop.command_mm;
    drive->steps = 0;
    drive->interpolates = false;
    drive->following_ns = 0;
    drive->loop.velocity_offset_mm_s = 0;
    drive->loop.torque_offset_mm_s2 = 0;
    drive->torque_ratio = 0;
    p->demand_torque = 0;
    drive->setpoints = (struct drive_setpoints){.active_inc = here_inc, .is_reached = true};
}

/* ---- Motion of the command ---- */

/* x += (v0 + v1) / 2 t */
static void move_command(struct servo *drive, double velocity_mm_s, uint32_t cycle_ns)
{
    double mean_mm_s = (drive->velocity_mm_s + velocity_mm_s) / 2;
    drive->velocity_mm_s = velocity_mm_s;
    takt_servo_loop_follow(&drive->loop, drive->loop.command_mm + mean_mm_s * (cycle_ns * 1e-9),
                           cycle_ns);
}

void takt_servo_run_at(struct servo *drive, double velocity_mm_s, double acceleration_mm_s2,
                       uint32_t cycle_ns)
{
    double by_mm_s = acceleration_mm_s2 * (cycle_ns * 1e-9);
    TAKT_ASSERT(acceleration_mm_s2 >= 0.0 && cycle_ns > 0);
    move_command(drive, takt_course_approach(drive->velocity_mm_s, velocity_mm_s, by_mm_s),
                 cycle_ns);
}

bool takt_servo_slow(struct servo *drive, double deceleration_mm_s2, uint32_t cycle_ns)
{
    takt_servo_run_at(drive, 0, deceleration_mm_s2, cycle_ns);
    return drive->velocity_mm_s == 0;
}

/* ---- Profile position ---- */

/* Without a target behind it the end velocity is 0: nobody would stop the axis. */
static struct course_ramps profile_ramps(const struct servo *drive)
{
    const struct drive_settings *s = &drive->objects.settings;
    double per_mm = servo_velocity_scale(drive);
    double velocity_mm_s =
        maths_min(s->profile_velocity / per_mm, takt_servo_profile_velocity_max_mm_s(drive));
    double end_mm_s = drive->setpoints.has_next ? s->end_velocity / per_mm : 0;
    return (struct course_ramps){
        velocity_mm_s, takt_servo_profile_acceleration_mm_s2(drive),
        takt_servo_profile_deceleration_mm_s2(drive), maths_min(end_mm_s, velocity_mm_s),
        s->motion_profile_type == PROFILE_JERK_LIMITED ? s->profile_jerk / per_mm : 0};
}

/* Object 607D; limits that leave no room are none. */
static double limited(const struct servo *drive, double position_inc)
{
    const int32_t *limit = drive->objects.settings.position_limit;
    return limit[0] < limit[1] ? maths_clamp(position_inc, limit[0], limit[1]) : position_inc;
}

/* Where the encoder is to be for a target, as far as the limits let it. */
static double take_target(struct servo *drive, double target_inc)
{
    double limited_inc = limited(drive, target_inc);
    drive->is_limited = limited_inc != target_inc;
    return limited_inc / drive->increments_per_mm + drive->origin_mm;
}

static void activate(struct servo *drive, int64_t target_inc)
{
    struct drive_setpoints *s = &drive->setpoints;
    s->active_inc = target_inc;
    s->has_next = false;
    s->is_reached = false;
    s->in_window_ns = 0;
    takt_servo_tell(drive, DRIVE_EVENT_SETPOINT, (uint32_t)target_inc, 0);
}

/* A relative target counts from the one before. One target may wait until the active is reached. */
static void take_setpoint(struct servo *drive, uint16_t controlword)
{
    struct drive_setpoints *s = &drive->setpoints;
    int64_t target_inc = drive->objects.process.target_position;
    if (s->is_acknowledged)
        return;
    if (controlword & CONTROL_RELATIVE)
        target_inc += (int64_t)limited(drive, (double)s->active_inc);
    s->is_acknowledged = true;
    if (controlword & CONTROL_IMMEDIATE || s->is_reached) {
        activate(drive, target_inc);
    } else {
        s->next_inc = target_inc;
        s->has_next = true;
    }
}

/* The master has taken notice when bit 4 has fallen; then there is room for another one. */
static void release_setpoint(struct servo *drive)
{
    if (!(drive->controlword & CONTROL_BIT_4) && !drive->setpoints.has_next)
        drive->setpoints.is_acknowledged = false;
}

void takt_servo_note_reached(struct servo *drive, bool is_inside, uint16_t time_ms,
                             uint32_t cycle_ns)
{
    struct drive_setpoints *s = &drive->setpoints;
    TAKT_ASSERT(cycle_ns > 0);
    s->in_window_ns = is_inside ? s->in_window_ns + cycle_ns : 0;
    s->is_reached = is_inside && s->in_window_ns >= (uint64_t)time_ms * MILLISECOND_NS;
}

/* Objects 6067 and 6068. */
static void check_reached(struct servo *drive, double target_mm, uint32_t cycle_ns)
{
    const struct drive_settings *o = &drive->objects.settings;
    double window_mm = o->position_window / servo_scale(drive);
    bool is_inside = o->position_window == WINDOW_ANY ||
                     maths_abs(target_mm - drive->loop.measured_mm) <= window_mm;
    takt_servo_note_reached(drive, is_inside, o->position_window_ms, cycle_ns);
}

/*
 * With an end velocity the target is passed on the way to the next one, in the cycle that would
 * reach it.
 */
static bool passes_target(const struct course *course, double target_mm,
                          const struct course_ramps *ramps, uint32_t cycle_ns)
{
    double way_mm = target_mm - course->at_mm;
    double step_mm = course->velocity_mm_s * (cycle_ns * 1e-9);
    return ramps->end_mm_s > 0 && maths_abs(way_mm) <= maths_abs(step_mm);
}

/* The trapezoid under way: the command itself, or what is averaged to it. */
static struct course trapezoid(const struct servo *drive, const struct course *command,
                               const struct course_ramps *ramps)
{
    bool is_own = ramps->jerk_mm_s3 == 0 || takt_course_is_elsewhere(&drive->average, command);
    return is_own ? *command : drive->average.course;
}

/* A cycle of the profile to target_mm, as a position of the encoder. */
static void run_profile(struct servo *drive, struct course *command, double target_mm,
                        const struct course_ramps *ramps, uint32_t cycle_ns)
{
    if (ramps->jerk_mm_s3 > 0)
        takt_course_step_average(&drive->average, command, target_mm, ramps, cycle_ns * 1e-9);
    else
        takt_course_step(command, target_mm, ramps, cycle_ns * 1e-9);
    drive->velocity_mm_s = command->velocity_mm_s;
    takt_servo_loop_follow(&drive->loop, command->at_mm, cycle_ns);
}

static void run_position(struct servo *drive, uint32_t cycle_ns)
{
    struct drive_setpoints *s = &drive->setpoints;
    double target_mm = take_target(drive, (double)s->active_inc);
    struct course_ramps ramps = profile_ramps(drive);
    struct course command = {drive->loop.command_mm, drive->velocity_mm_s};
    struct course course = trapezoid(drive, &command, &ramps);
    if (s->has_next && (s->is_reached || passes_target(&course, target_mm, &ramps, cycle_ns))) {
        activate(drive, s->next_inc);
        target_mm = take_target(drive, (double)s->active_inc);
        ramps = profile_ramps(drive);
    }
    release_setpoint(drive);
    run_profile(drive, &command, target_mm, &ramps, cycle_ns);
    check_reached(drive, target_mm, cycle_ns);
}

/* ---- Cyclic synchronous and interpolated position ---- */

/* Cycles of a period of object 60C2; mostly one. */
static uint32_t period_cycles(const struct servo *drive, uint32_t cycle_ns)
{
    TAKT_ASSERT(cycle_ns > 0);
    if (2 * drive->interpolation_ns < 3 * (uint64_t)cycle_ns)
        return 1;
    return (uint32_t)((drive->interpolation_ns + cycle_ns / 2) / cycle_ns);
}

static void follow_smoothly(struct servo *drive, double command_mm, uint32_t cycle_ns)
{
    double piece[BETWEEN_COEFFICIENTS];
    takt_between_take(&drive->between, drive->loop.command_mm, command_mm, piece);
    takt_servo_loop_follow_piece(&drive->loop, piece, drive->between.target_mm[2], cycle_ns);
}

/* The command goes to the target in a straight line, within the period after it has changed. */
static void run_interpolated(struct servo *drive, double target_inc, uint32_t cycle_ns)
{
    double goal_mm = take_target(drive, target_inc);
    double command_mm = goal_mm;
    if (goal_mm != drive->goal_mm) {
        drive->goal_mm = goal_mm;
        drive->steps = period_cycles(drive, cycle_ns);
    }
    if (drive->steps > 1) {
        double from_mm = drive->loop.command_mm;
        command_mm = from_mm + (goal_mm - from_mm) / drive->steps;
        drive->steps--;
    }
    if (drive->objects.settings.interpolation_submode == INTERPOLATION_SMOOTH)
        follow_smoothly(drive, command_mm, cycle_ns);
    else
        takt_servo_loop_follow(&drive->loop, command_mm, cycle_ns);
}

/* Objects 60B1 and 60B2. */
void takt_servo_set_offsets(struct servo *drive)
{
    const struct drive_process *p = &drive->objects.process;
    struct servo_loop *loop = &drive->loop;
    loop->velocity_offset_mm_s =
        p->velocity_offset ? drive->velocity_sign * p->velocity_offset / servo_velocity_scale(drive)
                           : 0;
    loop->torque_offset_mm_s2 = p->torque_offset ? drive->torque_sign * p->torque_offset /
                                                       TORQUE_PER_RATED * loop->mm_s2_per_rated
                                                 : 0;
}

static void run_cyclic(struct servo *drive, uint32_t cycle_ns)
{
    const struct drive_process *p = &drive->objects.process;
    takt_servo_set_offsets(drive);
    run_interpolated(drive, (double)p->target_position + p->position_offset, cycle_ns);
}

static void run_ip(struct servo *drive, uint32_t cycle_ns)
{
    const struct drive_process *p = &drive->objects.process;
    if (!drive->interpolates) {
        (void)takt_servo_slow(drive, takt_servo_profile_deceleration_mm_s2(drive), cycle_ns);
        return;
    }
    run_interpolated(drive, p->interpolation_target, cycle_ns);
    drive->velocity_mm_s = drive->loop.command_velocity_mm_s;
    check_reached(drive, drive->goal_mm, cycle_ns);
}

/* ---- What all modes have ---- */

static void run_halt(struct servo *drive, uint32_t cycle_ns)
{
    bool is_quick = drive->objects.settings.halt_option == HALT_QUICK_STOP;
    double deceleration_mm_s2 =
        is_quick ? drive->quick_stop_mm_s2 : takt_servo_profile_deceleration_mm_s2(drive);
    (void)takt_servo_slow(drive, deceleration_mm_s2, cycle_ns);
    release_setpoint(drive);
}

/* Modes in which halt is the controller's own business: it sends the targets. */
static bool run_cyclic_mode(struct servo *drive, int8_t mode, uint32_t cycle_ns)
{
    if (mode == CIA402_MODE_CYCLIC_SYNC_POSITION)
        run_cyclic(drive, cycle_ns);
    else if (mode == CIA402_MODE_CYCLIC_SYNC_VELOCITY)
        takt_servo_run_cyclic_velocity(drive, cycle_ns);
    else if (mode == CIA402_MODE_CYCLIC_SYNC_TORQUE)
        takt_servo_run_cyclic_torque(drive, cycle_ns);
    else
        return false;
    return true;
}

/* Halt takes the torque away by its slope in profile torque; in the others the axis slows down. */
static void run_other_mode(struct servo *drive, int8_t mode, uint32_t cycle_ns)
{
    if (mode == CIA402_MODE_PROFILE_TORQUE)
        takt_servo_run_profile_torque(drive, cycle_ns);
    else if (drive->is_halted)
        run_halt(drive, cycle_ns);
    else if (mode == CIA402_MODE_PROFILE_POSITION)
        run_position(drive, cycle_ns);
    else if (mode == CIA402_MODE_PROFILE_VELOCITY)
        takt_servo_run_profile_velocity(drive, cycle_ns);
    else if (mode == CIA402_MODE_HOMING)
        takt_servo_run_homing(drive, cycle_ns);
    else if (mode == CIA402_MODE_INTERPOLATED_POSITION)
        run_ip(drive, cycle_ns);
    else
        (void)takt_servo_slow(drive, takt_servo_profile_deceleration_mm_s2(drive), cycle_ns);
}

void takt_servo_run_mode(struct servo *drive, uint32_t cycle_ns)
{
    int8_t mode = drive->objects.process.mode_display;
    if (!run_cyclic_mode(drive, mode, cycle_ns))
        run_other_mode(drive, mode, cycle_ns);
}

static void take_interpolation(struct servo *drive, bool enables)
{
    if (enables == drive->interpolates)
        return;
    drive->interpolates = enables;
    drive->goal_mm = drive->loop.command_mm;
    drive->steps = 0;
    drive->velocity_mm_s = drive->loop.command_velocity_mm_s;
}

void takt_servo_take_mode_controlword(struct servo *drive, uint16_t before, uint16_t controlword)
{
    bool is_set = controlword & CONTROL_BIT_4;
    bool rises = is_set && !(before & CONTROL_BIT_4);
    bool is_enabled = drive->state == CIA402_ENABLED && !drive->is_leaving;
    switch (drive->objects.process.mode_display) {
    case CIA402_MODE_PROFILE_POSITION:
        if (rises && is_enabled)
            take_setpoint(drive, controlword);
        release_setpoint(drive);
        break;
    case CIA402_MODE_HOMING:
        if (rises && is_enabled)
            takt_servo_begin_homing(drive);
        else if (!is_set)
            takt_servo_interrupt_homing(drive);
        break;
    case CIA402_MODE_INTERPOLATED_POSITION:
        take_interpolation(drive, is_set && is_enabled);
        break;
    default:
        break;
    }
}

/* Bit 10 is set while nothing is under way: idle drives have reached their target. */
static uint16_t homing_status(const struct servo *drive)
{
    const struct drive_homing *h = &drive->homing;
    unsigned word = h->is_homed ? STATUS_BIT_12 : 0;
    if (h->phase == HOMING_FAILED)
        word = STATUS_BIT_13 | (drive->velocity_mm_s == 0 ? STATUS_REACHED : 0);
    else if (h->phase == HOMING_IDLE)
        word |= STATUS_REACHED;
    return (uint16_t)word;
}

static uint16_t position_status(const struct servo *drive)
{
    bool is_reached = drive->is_halted ? drive->velocity_mm_s == 0 : drive->setpoints.is_reached;
    unsigned word = is_reached ? STATUS_REACHED : 0;
    if (drive->setpoints.is_acknowledged)
        word |= STATUS_BIT_12;
    return (uint16_t)word;
}

/* Bit 12: it stands (606F). */
static uint16_t velocity_status(const struct servo *drive)
{
    double threshold_mm_s =
        drive->objects.settings.velocity_threshold / servo_velocity_scale(drive);
    bool stands = maths_abs(drive->loop.measured_velocity_mm_s) <= threshold_mm_s;
    bool is_reached = drive->is_halted ? drive->velocity_mm_s == 0 : drive->setpoints.is_reached;
    return (uint16_t)((is_reached ? STATUS_REACHED : 0) | (stands ? STATUS_BIT_12 : 0));
}

uint16_t takt_servo_mode_status(const struct servo *drive)
{
    bool is_enabled = drive->state == CIA402_ENABLED && !drive->is_leaving;
    switch (drive->objects.process.mode_display) {
    case CIA402_MODE_CYCLIC_SYNC_POSITION:
    case CIA402_MODE_CYCLIC_SYNC_VELOCITY:
    case CIA402_MODE_CYCLIC_SYNC_TORQUE:
        return is_enabled ? CIA402_FOLLOWS_TARGET : 0;
    case CIA402_MODE_PROFILE_POSITION:
        return position_status(drive);
    case CIA402_MODE_PROFILE_VELOCITY:
        return velocity_status(drive);
    case CIA402_MODE_PROFILE_TORQUE:
        return drive->setpoints.is_reached ? STATUS_REACHED : 0;
    case CIA402_MODE_HOMING:
        return homing_status(drive);
    case CIA402_MODE_INTERPOLATED_POSITION:
        return (uint16_t)((drive->interpolates && is_enabled ? STATUS_BIT_12 : 0) |
                          (drive->setpoints.is_reached ? STATUS_REACHED : 0));
    default:
        return 0;
    }
}
