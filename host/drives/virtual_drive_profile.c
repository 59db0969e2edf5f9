/*
 * CiA 402: what the controlword and the motor make of the drive's state.
 */
#include "base/maths.h"
#include "canopen/emcy.h"
#include "drives/virtual_drive_private.h"

#define INCREMENTS_MAX 2147483647.0

int32_t virtual_drive_increments(const struct virtual_drive *drive, double position_mm)
{
    double increments = maths_round(position_mm * drive->config.increments_per_mm);
    return (int32_t)maths_clamp(increments, -INCREMENTS_MAX, INCREMENTS_MAX);
}

/*
 * What the target of an earlier run was is forgotten: an enabled drive stands until it gets a new
 * one.
 */
static void hold_here(struct virtual_drive *drive)
{
    drive->target_inc = virtual_drive_increments(drive, drive->plant.measured_mm);
}

static void clear_fault(struct virtual_drive *drive)
{
    drive->error_code = EMCY_NONE;
    drive->error_register = 0;
    virtual_drive_send_emergency(drive, EMCY_NONE, 0);
}

static void enter_state(struct virtual_drive *drive, enum cia402_state state)
{
    drive->state = state;
    if (state == CIA402_ENABLED)
        hold_here(drive);
    if (state == CIA402_QUICK_STOP || state == CIA402_FAULT_REACTION)
        drive_plant_begin_brake(&drive->plant);
}

void virtual_drive_take_controlword(struct virtual_drive *drive, uint16_t controlword)
{
    enum cia402_state before = drive->state;
    enum cia402_state after = cia402_next_state(before, controlword, drive->controlword);
    drive->controlword = controlword;
    if (after == before)
        return;
    enter_state(drive, after);
    if (before == CIA402_FAULT)
        clear_fault(drive);
}

static void fail(struct virtual_drive *drive, uint16_t code, uint8_t error_register)
{
    enter_state(drive, CIA402_FAULT_REACTION);
    drive->error_code = code;
    drive->error_register = error_register;
    virtual_drive_send_emergency(drive, code, error_register);
}

/* Objects 6065 and 60F4. */
static void check_following(struct virtual_drive *drive)
{
    double window_mm = drive->config.plant.following_error_window_mm;
    double error_mm = drive_plant_following_error_mm(&drive->plant);
    if (window_mm > 0 && maths_abs(error_mm) > window_mm)
        fail(drive, EMCY_FOLLOWING_ERROR, EMCY_REGISTER_GENERIC | EMCY_REGISTER_PROFILE);
}

/* In any other mode than cyclic synchronous position the drive stands where its command is. */
static void follow(struct virtual_drive *drive, uint32_t cycle_ns)
{
    double command_mm = drive->plant.command_mm;
    if (drive->mode == CIA402_MODE_CYCLIC_SYNC_POSITION)
        command_mm = drive->target_inc / drive->config.increments_per_mm;
    drive_plant_follow(&drive->plant, command_mm, cycle_ns);
    check_following(drive);
}

/*
 * Quick stop ends in "switch on disabled" (object 605A = 2), fault reaction in "fault" (605E = 2).
 */
void virtual_drive_move(struct virtual_drive *drive, uint32_t cycle_ns)
{
    switch (drive->state) {
    case CIA402_ENABLED:
        follow(drive, cycle_ns);
        break;
    case CIA402_QUICK_STOP:
        if (drive_plant_brake(&drive->plant, cycle_ns))
            drive->state = CIA402_SWITCH_ON_DISABLED;
        break;
    case CIA402_FAULT_REACTION:
        if (drive_plant_brake(&drive->plant, cycle_ns))
            drive->state = CIA402_FAULT;
        break;
    case CIA402_NOT_READY:
    case CIA402_SWITCH_ON_DISABLED:
    case CIA402_READY:
    case CIA402_SWITCHED_ON:
    case CIA402_FAULT:
        drive_plant_coast(&drive->plant, cycle_ns);
        break;
    }
}

void virtual_drive_lose_connection(struct virtual_drive *drive)
{
    if (drive->state == CIA402_ENABLED)
        enter_state(drive, CIA402_QUICK_STOP);
}

void virtual_drive_reset_profile(struct virtual_drive *drive)
{
    drive->state = CIA402_SWITCH_ON_DISABLED;
    drive->controlword = 0;
    drive->mode = CIA402_MODE_NONE;
    drive->error_code = EMCY_NONE;
    drive->error_register = 0;
    hold_here(drive);
}

enum cia402_state virtual_drive_get_state(const struct virtual_drive *drive)
{
    return drive->state;
}

double virtual_drive_get_position_mm(const struct virtual_drive *drive)
{
    return drive->plant.position_mm;
}
