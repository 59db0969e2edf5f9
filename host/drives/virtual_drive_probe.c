/*
 * Touch probes (CiA 402-2, 60B8 ... 60BD): the position is latched at the very moment at which the input changes, or at
 * which the index pulse comes, as the hardware of a drive does it; within a cycle the motor runs evenly.
 */
#include "base/maths.h"
#include "drives/virtual_drive_private.h"

/* Bits of touch probe 2 are so much higher than those of 1, and its values so much later. */
#define SECOND_BITS   8
#define SECOND_VALUES 2

static unsigned bits_of(unsigned word, unsigned probe)
{
    return word >> SECOND_BITS * probe & 0xFF;
}

/* Enabling begins anew: what has been latched counts no more. Disabled, the status is 0. */
void virtual_drive_take_probe_function(struct virtual_drive *drive)
{
    struct drive_process *p = &drive->objects.process;
    unsigned status = p->probe_status;
    for (unsigned i = 0; i < DRIVE_TOUCH_PROBES; i++) {
        bool is_enabled = bits_of(p->probe_function, i) & CIA402_PROBE_ENABLE;
        bool was_enabled = bits_of(drive->probe.function, i) & CIA402_PROBE_ENABLE;
        if (is_enabled && was_enabled)
            continue;
        status &= ~(0xFFu << SECOND_BITS * i);
        status |= is_enabled ? CIA402_PROBE_IS_ENABLED << SECOND_BITS * i : 0u;
    }
    p->probe_status = (uint16_t)status;
    drive->probe.function = p->probe_function;
}

/* An edge of a probe's source. */
static void latch(struct virtual_drive *drive, unsigned probe, bool rises, int32_t position_inc)
{
    struct drive_process *p = &drive->objects.process;
    unsigned function = bits_of(p->probe_function, probe);
    unsigned wanted = rises ? CIA402_PROBE_AT_RISE : CIA402_PROBE_AT_FALL;
    unsigned seen = (rises ? CIA402_PROBE_HAS_RISEN : CIA402_PROBE_HAS_FALLEN)
                    << SECOND_BITS * probe;
    bool is_first = !(p->probe_status & seen);
    if (!(function & CIA402_PROBE_ENABLE) || !(function & wanted) ||
        !(is_first || function & CIA402_PROBE_CONTINUOUS))
        return;
    p->probe_status = (uint16_t)(p->probe_status | seen);
    p->probe_latched[SECOND_VALUES * probe + !rises] = position_inc;
    virtual_drive_tell(drive, DRIVE_EVENT_PROBE, probe + 1, (uint32_t)position_inc);
}

static void latch_all(struct virtual_drive *drive, bool is_index, bool rises, double position_mm)
{
    int32_t position_inc = virtual_drive_increments(drive, position_mm);
    for (unsigned i = 0; i < DRIVE_TOUCH_PROBES; i++) {
        bool by_index = bits_of(drive->objects.process.probe_function, i) & CIA402_PROBE_AT_INDEX;
        if (by_index == is_index)
            latch(drive, i, rises, position_inc);
    }
}

double virtual_drive_get_position_at_mm(const struct virtual_drive *drive, double ratio)
{
    double begin_mm = drive->probe.begin_mm;
    return begin_mm + (drive->plant.measured_mm - begin_mm) * ratio - drive->origin_mm;
}

void virtual_drive_touch(struct virtual_drive *drive, bool touches, double ratio)
{
    if (touches == drive->probe.touches)
        return;
    drive->probe.touches = touches;
    latch_all(drive, false, touches, virtual_drive_get_position_at_mm(drive, ratio));
}

void virtual_drive_begin_probe(struct virtual_drive *drive)
{
    drive->probe.begin_mm = drive->plant.measured_mm;
}

/* A pulse is where the motor's angle is 0: its rising and its falling edge are one. The last one of a cycle counts. */
void virtual_drive_run_probe(struct virtual_drive *drive)
{
    double turn_mm = drive->config.plant.travel_per_revolution_mm;
    double shift_mm = drive->plant.encoder_shift_mm;
    double from = (drive->probe.begin_mm - shift_mm) / turn_mm;
    double to = (drive->plant.measured_mm - shift_mm) / turn_mm;
    double turns = to > from ? maths_floor(to) : maths_ceil(to);
    bool is_passed = to > from ? turns > from : turns < from;
    if (!is_passed || to == from || drive->probe.function == 0)
        return;
    double pulse_mm = turns * turn_mm + shift_mm - drive->origin_mm;
    latch_all(drive, true, true, pulse_mm);
    latch_all(drive, true, false, pulse_mm);
}
