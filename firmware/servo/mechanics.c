/*
 * The drive's own table of its screw's error of pitch and its backlash (objects 2010 and 2011): as
 * PDOs are mapped, points are written while their number is 0, and count when it is written.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "servo/servo_private.h"

#define MM_PER_NM 1e-6

/* Positions and errors are the drive's, whose motor may turn the other way. */
static bool make_pitch(const struct servo *drive, unsigned points, struct pitch *pitch)
{
    const struct drive_settings *s = &drive->objects.settings;
    double mm_per_nm = drive->increments_per_mm < 0 ? -MM_PER_NM : MM_PER_NM;
    pitch->points = points;
    pitch->first_mm = s->pitch_first / drive->increments_per_mm;
    pitch->steps_per_mm = drive->increments_per_mm / s->pitch_distance;
    for (unsigned i = 0; i < points; i++)
        pitch->value_mm[i] = s->pitch_nm[i] * mm_per_nm;
    return takt_pitch_make(pitch);
}

/*
 * Without torque the command stays with the motor: nothing jumps but what is said of its position.
 */
static bool may_change(const struct servo *drive)
{
    bool has_torque = drive->state == CIA402_ENABLED || drive->state == CIA402_QUICK_STOP ||
                      drive->state == CIA402_FAULT_REACTION;
    return drive->nmt == NMT_PREOPERATIONAL && !has_torque;
}

uint32_t takt_servo_check_compensation(const struct servo *drive, const struct object_row *row,
                                       uint32_t value)
{
    struct pitch pitch;
    bool is_number = row->index == 0x2010 && row->sub == 1;
    bool is_backlash = row->index == 0x2010 && row->sub == 4;
    bool is_used = drive->objects.settings.pitch_points != 0;
    if (!may_change(drive) || (is_used && !is_number && !is_backlash))
        return SDO_ABORT_STATE;
    if (is_number && value != 0 && !make_pitch(drive, value, &pitch))
        return SDO_ABORT_VALUE;
    return SDO_ABORT_NONE;
}

void takt_servo_take_origin(struct servo *drive)
{
    struct servo_loop *loop = &drive->loop;
    drive->compensation.is_homed = drive->homing.is_homed;
    drive->compensation.origin_mm = drive->origin_mm;
    double axis_mm = takt_compensation_get_axis_mm(&drive->compensation);
    loop->command_mm += axis_mm - loop->measured_mm;
    loop->measured_mm = axis_mm;
}

/* Values that have been stored by another hand need not make sense: then there is no error. */
void takt_servo_derive_compensation(struct servo *drive)
{
    const struct drive_settings *s = &drive->objects.settings;
    (void)make_pitch(drive, s->pitch_points, &drive->compensation.pitch);
    takt_compensation_set_backlash(&drive->compensation, s->backlash_nm * MM_PER_NM);
    takt_servo_take_origin(drive);
}

/*
 * Nobody tells it to go by less than an increment, and nobody sees less than a step of the encoder.
 */
void takt_servo_note_way(struct servo *drive)
{
    const struct servo_loop *loop = &drive->loop;
    if (drive->compensation.backlash_mm == 0)
        return;
    const struct compensation_way way = {
        .way_mm = loop->command_velocity_mm_s * loop->cycle_s,
        .resolution_mm = maths_max(1 / servo_scale(drive), loop->encoder_step_mm),
        .acceleration_mm_s2 = takt_servo_profile_acceleration_mm_s2(drive),
        .step_s = loop->step_s,
    };
    takt_compensation_follow(&drive->compensation, &way);
}
