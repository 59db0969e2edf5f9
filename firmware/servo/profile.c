/*
 * CiA 402: what the controlword and the motor make of the drive's state.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "servo/servo_private.h"

/* Values of the option codes 6007 and 605A to 605E. */
#define CONNECTION_FAULT           1
#define CONNECTION_DISABLE_VOLTAGE 2
#define CONNECTION_QUICK_STOP      3
#define STOP_BY_DISABLING          0
#define STOP_BY_PROFILE            1
#define STOP_BY_QUICK_STOP         2
#define QUICK_STOP_STAYS           5 /* this and above: the drive stays in "quick stop active" */
#define QUICK_STOP_PROFILE_STAYS   5

#define CONTROL_HALT 0x0100

#define STATUS_WARNING        0x0080
#define STATUS_INTERNAL_LIMIT 0x0800

/* EMCY 8100: the connection is lost, where 6007 says that this is a fault. */
#define EMCY_CONNECTION 0x8100

/* A warning comes before the fault of temperature. */
#define TEMPERATURE_WARNING_K 10.0

static bool is_hot(const struct servo *drive, double below_k)
{
    double max_c = drive->config.temperature_max_c;
    return max_c > 0 && drive->loop.sense.temperature_c > max_c - below_k;
}

static bool is_at_torque_limit(const struct servo *drive)
{
    return maths_abs(drive->loop.torque_mm_s2) >= takt_servo_loop_torque_limit_mm_s2(&drive->loop);
}

/* Object 1002: what is behind the statusword. */
uint32_t takt_servo_manufacturer_status(const struct servo *drive)
{
    uint32_t word = 0;
    if (is_at_torque_limit(drive))
        word |= DRIVE_STATUS_TORQUE_LIMIT;
    if (drive->is_limited)
        word |= DRIVE_STATUS_POSITION_LIMIT;
    if (is_hot(drive, TEMPERATURE_WARNING_K))
        word |= DRIVE_STATUS_WARM;
    if (drive->homing.is_homed)
        word |= DRIVE_STATUS_HOMED;
    if (drive->homing.is_homed && drive->compensation.pitch.points != 0)
        word |= DRIVE_STATUS_PITCH;
    return word;
}

uint16_t takt_servo_statusword(const struct servo *drive)
{
    unsigned word = takt_cia402_statusword(drive->state) | CIA402_VOLTAGE_ENABLED;
    if (drive->nmt == NMT_OPERATIONAL)
        word |= CIA402_REMOTE;
    if (drive->objects.process.error_code == EMCY_FOLLOWING_ERROR)
        word |= CIA402_FOLLOWING_FAILED;
    if (is_hot(drive, TEMPERATURE_WARNING_K))
        word |= STATUS_WARNING;
    if (drive->is_limited || is_at_torque_limit(drive))
        word |= STATUS_INTERNAL_LIMIT;
    return (uint16_t)(word | takt_servo_mode_status(drive));
}

static void clear_fault(struct servo *drive)
{
    drive->objects.process.error_code = EMCY_NONE;
    drive->objects.process.error_register = 0;
    drive->communication_error = 0;
    takt_servo_send_emergency(drive, EMCY_NONE, 0);
}

static double deceleration_of(const struct servo *drive, int16_t option)
{
    bool is_profile = option == STOP_BY_PROFILE || option == QUICK_STOP_PROFILE_STAYS;
    return is_profile ? takt_servo_profile_deceleration_mm_s2(drive) : drive->quick_stop_mm_s2;
}

static void enter_state(struct servo *drive, enum cia402_state state)
{
    const struct drive_settings *s = &drive->objects.settings;
    if (state != drive->state)
        takt_servo_tell(drive, DRIVE_EVENT_STATE, (uint32_t)drive->state, (uint32_t)state);
    if (state != CIA402_ENABLED)
        takt_servo_interrupt_homing(drive);
    drive->state = state;
    drive->is_leaving = false;
    drive->is_stopped = false;
    if (state == CIA402_ENABLED)
        takt_servo_hold(drive);
    if (state == CIA402_QUICK_STOP)
        takt_servo_loop_begin_brake(&drive->loop, deceleration_of(drive, s->quick_stop_option));
    if (state == CIA402_FAULT_REACTION)
        takt_servo_loop_begin_brake(&drive->loop, deceleration_of(drive, s->fault_reaction_option));
}

/* "Shutdown" and "disable operation" may slow the axis down before they take effect. */
static bool begins_to_leave(struct servo *drive, enum cia402_state after)
{
    const struct drive_settings *s = &drive->objects.settings;
    int16_t option = STOP_BY_DISABLING;
    if (after == CIA402_READY)
        option = s->shutdown_option;
    if (after == CIA402_SWITCHED_ON)
        option = s->disable_option;
    if (drive->state != CIA402_ENABLED || option == STOP_BY_DISABLING)
        return false;
    if (!drive->is_leaving)
        drive->velocity_mm_s = drive->loop.command_velocity_mm_s;
    drive->is_leaving = true;
    drive->leaving_to = after;
    return true;
}

/* "Enable operation" in "quick stop active", where that stays (transition 16). */
static enum cia402_state next_state(const struct servo *drive, uint16_t controlword)
{
    enum cia402_state next = takt_cia402_next_state(drive->state, controlword, drive->controlword);
    bool enables =
        (controlword & (CIA402_ENABLE_OPERATION | CIA402_FAULT_RESET)) == CIA402_ENABLE_OPERATION;
    if (drive->state == CIA402_QUICK_STOP && enables &&
        drive->objects.settings.quick_stop_option >= QUICK_STOP_STAYS)
        return CIA402_ENABLED;
    return next;
}

static void take_halt(struct servo *drive, uint16_t controlword)
{
    bool halts = controlword & CONTROL_HALT;
    if (halts && !drive->is_halted)
        drive->velocity_mm_s = drive->loop.command_velocity_mm_s;
    drive->is_halted = halts;
}

void takt_servo_take_controlword(struct servo *drive, uint16_t controlword)
{
    enum cia402_state before = drive->state;
    enum cia402_state after = next_state(drive, controlword);
    uint16_t previous = drive->controlword;
    drive->controlword = controlword;
    drive->objects.process.controlword = controlword;
    take_halt(drive, controlword);
    if (after != before && !begins_to_leave(drive, after)) {
        enter_state(drive, after);
        if (before == CIA402_FAULT)
            clear_fault(drive);
    } else if (after == CIA402_ENABLED && drive->is_leaving) {
        drive->is_leaving = false;
        takt_servo_hold(drive);
    }
    takt_servo_take_mode_controlword(drive, previous, controlword);
}

/* As object 6502 has them: all but 2, velocity for converters, and 5, which is none. */
#define MODES_WRITTEN 0x3EDu

/*
 * Object 6502 says which of those that are written here; a sheet without it, or with an empty one,
 * has them all.
 */
bool takt_servo_has_mode(const struct servo *drive, int8_t mode)
{
    bool has_index;
    const struct object_row *row = takt_dictionary_find(drive->dictionary, 0x6502, 0, &has_index);
    uint32_t modes = row != NULL && row->initial != 0 ? (uint32_t)row->initial : UINT32_MAX;
    bool is_written = mode >= 1 && mode <= 10 && MODES_WRITTEN >> (mode - 1) & 1;
    return mode == CIA402_MODE_NONE || (is_written && modes >> (mode - 1) & 1);
}

/* A mode the drive does not have is not taken: 6061 keeps showing the one before. */
void takt_servo_take_mode(struct servo *drive, int8_t mode)
{
    struct drive_process *p = &drive->objects.process;
    p->mode = mode;
    if (mode == p->mode_display || !takt_servo_has_mode(drive, mode))
        return;
    takt_servo_interrupt_homing(drive);
    p->mode_display = mode;
    takt_servo_tell(drive, DRIVE_EVENT_MODE, (uint8_t)mode, 0);
    takt_servo_hold(drive);
}

void takt_servo_fail(struct servo *drive, uint16_t code, uint8_t error_register)
{
    struct drive_process *p = &drive->objects.process;
    TAKT_ASSERT(code != EMCY_NONE);
    if (drive->state == CIA402_FAULT_REACTION || drive->state == CIA402_FAULT)
        return;
    enter_state(drive, CIA402_FAULT_REACTION);
    p->error_code = code;
    p->error_register |= error_register;
    takt_servo_send_emergency(drive, code, p->error_register);
}

/* Objects 6065 and 6066. */
static void check_following(struct servo *drive, uint32_t cycle_ns)
{
    double window_mm = drive->following_window_mm;
    double error_mm = takt_servo_loop_following_error_mm(&drive->loop);
    if (!(window_mm > 0 && maths_abs(error_mm) > window_mm)) {
        drive->following_ns = 0;
        return;
    }
    uint64_t timeout_ns = (uint64_t)drive->objects.settings.following_timeout_ms * MILLISECOND_NS;
    drive->following_ns += cycle_ns;
    if (timeout_ns == 0 || drive->following_ns > timeout_ns)
        takt_servo_fail(drive, EMCY_FOLLOWING_ERROR, EMCY_REGISTER_GENERIC | EMCY_REGISTER_PROFILE);
}

static void run_enabled(struct servo *drive, uint32_t cycle_ns)
{
    TAKT_ASSERT(drive->state == CIA402_ENABLED);
    if (drive->is_leaving) {
        double deceleration_mm_s2 = takt_servo_profile_deceleration_mm_s2(drive);
        if (takt_servo_slow(drive, deceleration_mm_s2, cycle_ns))
            enter_state(drive, drive->leaving_to);
    } else {
        takt_servo_run_mode(drive, cycle_ns);
    }
    check_following(drive, cycle_ns);
}

static void run_quick_stop(struct servo *drive, uint32_t cycle_ns)
{
    int16_t option = drive->objects.settings.quick_stop_option;
    TAKT_ASSERT(drive->state == CIA402_QUICK_STOP);
    if (option == STOP_BY_DISABLING) {
        enter_state(drive, CIA402_SWITCH_ON_DISABLED);
        takt_servo_loop_coast(&drive->loop, cycle_ns);
    } else if (drive->is_stopped) {
        takt_servo_loop_follow(&drive->loop, drive->loop.command_mm, cycle_ns);
    } else if (takt_servo_loop_brake(&drive->loop, cycle_ns)) {
        if (option >= QUICK_STOP_STAYS)
            drive->is_stopped = true;
        else
            enter_state(drive, CIA402_SWITCH_ON_DISABLED);
    }
}

static void run_fault_reaction(struct servo *drive, uint32_t cycle_ns)
{
    TAKT_ASSERT(drive->state == CIA402_FAULT_REACTION);
    if (drive->objects.settings.fault_reaction_option == STOP_BY_DISABLING) {
        enter_state(drive, CIA402_FAULT);
        takt_servo_loop_coast(&drive->loop, cycle_ns);
    } else if (takt_servo_loop_brake(&drive->loop, cycle_ns)) {
        enter_state(drive, CIA402_FAULT);
    }
}

void takt_servo_move(struct servo *drive, uint32_t cycle_ns)
{
    TAKT_ASSERT(cycle_ns > 0);
    drive->is_limited = false;
    switch (drive->state) {
    case CIA402_ENABLED:
        run_enabled(drive, cycle_ns);
        break;
    case CIA402_QUICK_STOP:
        run_quick_stop(drive, cycle_ns);
        break;
    case CIA402_FAULT_REACTION:
        run_fault_reaction(drive, cycle_ns);
        break;
    case CIA402_NOT_READY:
    case CIA402_SWITCH_ON_DISABLED:
    case CIA402_READY:
    case CIA402_SWITCHED_ON:
    case CIA402_FAULT:
        takt_servo_loop_coast(&drive->loop, cycle_ns);
        break;
    }
    if (is_hot(drive, 0))
        takt_servo_fail(drive, EMCY_TEMPERATURE, EMCY_REGISTER_GENERIC | EMCY_REGISTER_TEMPERATURE);
}

void takt_servo_lose_connection(struct servo *drive)
{
    int16_t option = drive->objects.settings.abort_connection_option;
    if (drive->state != CIA402_ENABLED)
        return;
    if (option == CONNECTION_FAULT)
        takt_servo_fail(drive, EMCY_CONNECTION,
                        EMCY_REGISTER_GENERIC | EMCY_REGISTER_COMMUNICATION);
    else if (option == CONNECTION_DISABLE_VOLTAGE)
        enter_state(drive, CIA402_SWITCH_ON_DISABLED);
    else if (option == CONNECTION_QUICK_STOP)
        enter_state(drive, CIA402_QUICK_STOP);
}

void takt_servo_reset_profile(struct servo *drive)
{
    struct drive_process *p = &drive->objects.process;
    if (drive->state != CIA402_SWITCH_ON_DISABLED)
        enter_state(drive, CIA402_SWITCH_ON_DISABLED);
    drive->controlword = 0;
    drive->is_halted = false;
    p->controlword = 0;
    p->mode = CIA402_MODE_NONE;
    p->mode_display = CIA402_MODE_NONE;
    p->error_code = EMCY_NONE;
    p->error_register = 0;
    p->position_offset = 0;
    p->velocity_offset = 0;
    p->torque_offset = 0;
    p->target_velocity = 0;
    p->target_torque = 0;
    p->probe_function = p->probe_status = 0;
    drive->probe.function = 0;
    takt_servo_hold(drive);
}

enum cia402_state takt_servo_get_state(const struct servo *drive)
{
    return drive->state;
}
