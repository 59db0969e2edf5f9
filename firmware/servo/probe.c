/*
 * Touch probes (CiA 402-2, 60B8 ... 60BD): the position is latched at the very moment at which the
 * input changes, or at which the index pulse comes, as the hardware of a drive does it; within a
 * cycle the motor runs evenly.
 */
#include "base/assert.h"
#include "servo/servo_private.h"

/* Bits of touch probe 2 are so much higher than those of 1, and its values so much later. */
#define SECOND_BITS   8
#define SECOND_VALUES 2

static unsigned bits_of(unsigned word, unsigned probe)
{
    TAKT_ASSERT(probe < 2);
    return word >> SECOND_BITS * probe & 0xFF;
}

/* Enabling begins anew: what has been latched counts no more. Disabled, the status is 0. */
void takt_servo_take_probe_function(struct servo *drive)
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
static void latch(struct servo *drive, unsigned probe, bool rises, int32_t position_inc)
{
    struct drive_process *p = &drive->objects.process;
    unsigned function = bits_of(p->probe_function, probe);
    unsigned wanted = rises ? CIA402_PROBE_AT_RISE : CIA402_PROBE_AT_FALL;
    unsigned seen = (rises ? CIA402_PROBE_HAS_RISEN : CIA402_PROBE_HAS_FALLEN)
                    << SECOND_BITS * probe;
    bool is_first = !(p->probe_status & seen);
    TAKT_ASSERT(probe < 2);
    if (!(function & CIA402_PROBE_ENABLE) || !(function & wanted) ||
        !(is_first || function & CIA402_PROBE_CONTINUOUS))
        return;
    p->probe_status = (uint16_t)(p->probe_status | seen);
    p->probe_latched[SECOND_VALUES * probe + !rises] = position_inc;
    takt_servo_tell(drive, DRIVE_EVENT_PROBE, probe + 1, (uint32_t)position_inc);
}

static void latch_all(struct servo *drive, bool is_index, bool rises, double position_mm)
{
    int32_t position_inc = takt_servo_increments(drive, position_mm);
    for (unsigned i = 0; i < DRIVE_TOUCH_PROBES; i++) {
        bool by_index = bits_of(drive->objects.process.probe_function, i) & CIA402_PROBE_AT_INDEX;
        if (by_index == is_index)
            latch(drive, i, rises, position_inc);
    }
}

double takt_servo_get_position_at_mm(const struct servo *drive, double ratio)
{
    double begin_mm = drive->probe.begin_mm;
    return begin_mm + (drive->loop.measured_mm - begin_mm) * ratio - drive->origin_mm;
}

void takt_servo_touch(struct servo *drive, bool touches, double ratio)
{
    TAKT_ASSERT(ratio >= 0.0 && ratio <= 1.0);
    if (touches == drive->probe.touches)
        return;
    drive->probe.touches = touches;
    latch_all(drive, false, touches, takt_servo_get_position_at_mm(drive, ratio));
}

void takt_servo_begin_probe(struct servo *drive)
{
    drive->probe.begin_mm = drive->loop.measured_mm;
    drive->probe.pulses = drive->loop.sense.pulses;
}

/*
 * A pulse is where the motor's angle is 0: its rising and its falling edge are one. The last one of
 * a cycle counts.
 */
void takt_servo_run_probe(struct servo *drive)
{
    const struct motor_sense *sense = &drive->loop.sense;
    if (sense->pulses == drive->probe.pulses || drive->probe.function == 0)
        return;
    double pulse_mm = sense->pulse.encoder_mm - drive->origin_mm;
    latch_all(drive, true, true, pulse_mm);
    latch_all(drive, true, false, pulse_mm);
}
