/*
 * The objects of the drive, by the entry that maps them into a PDO.
 */
#include "canopen/emcy.h"
#include "drives/virtual_drive_private.h"

static uint16_t statusword(const struct virtual_drive *drive)
{
    unsigned word = cia402_statusword(drive->state) | CIA402_VOLTAGE_ENABLED;
    if (drive->nmt == NMT_OPERATIONAL)
        word |= CIA402_REMOTE;
    if (drive->state == CIA402_ENABLED && drive->mode == CIA402_MODE_CYCLIC_SYNC_POSITION)
        word |= CIA402_FOLLOWS_TARGET;
    if (drive->error_code == EMCY_FOLLOWING_ERROR)
        word |= CIA402_FOLLOWING_FAILED;
    return (uint16_t)word;
}

static uint32_t increments(const struct virtual_drive *drive, double position_mm)
{
    return (uint32_t)virtual_drive_increments(drive, position_mm);
}

bool virtual_drive_read_object(const struct virtual_drive *drive, uint32_t object, uint32_t *value)
{
    switch (object) {
    case CIA402_STATUSWORD:
        *value = statusword(drive);
        return true;
    case CIA402_POSITION_ACTUAL:
        *value = increments(drive, drive->plant.measured_mm);
        return true;
    case CIA402_FOLLOWING_ERROR:
        *value = increments(drive, drive_plant_following_error_mm(&drive->plant));
        return true;
    case CIA402_FOLLOWING_WINDOW:
        *value = increments(drive, drive->config.plant.following_error_window_mm);
        return true;
    case CIA402_TARGET_POSITION:
        *value = (uint32_t)drive->target_inc;
        return true;
    case CIA402_CONTROLWORD:
        *value = drive->controlword;
        return true;
    case CIA402_MODE:
    case CIA402_MODE_DISPLAY:
        *value = (uint8_t)drive->mode;
        return true;
    case CIA402_ERROR_CODE:
        *value = drive->error_code;
        return true;
    default:
        return false;
    }
}

bool virtual_drive_write_object(struct virtual_drive *drive, uint32_t object, uint32_t value)
{
    switch (object) {
    case CIA402_CONTROLWORD:
        virtual_drive_take_controlword(drive, (uint16_t)value);
        return true;
    case CIA402_MODE:
        drive->mode = (int8_t)(uint8_t)value;
        return true;
    case CIA402_TARGET_POSITION:
        drive->target_inc = (int32_t)value;
        return true;
    default:
        return false;
    }
}
