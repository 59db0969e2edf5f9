#include "controller/controller_spindle_sync.h"

/* The spindle is waited for so long at most where the machine does not say. */
#define WAIT_S 10.0

/*
 * A setpoint sent in cycle k is reached two cycles after the angle of cycle k was read: in the
 * third the position of that moment is reported (DRIVES_LATENCY_CYCLES).
 */
#define AHEAD_CYCLES ((double)(DRIVES_LATENCY_CYCLES - 1))

void takt_controller_spindle_sync_init(struct controller *c)
{
    const struct machine *machine = &c->machine;
    const struct spindle_sync_config config = {
        .cycle_s = 1e-6 * (double)machine->cycle_us,
        .ahead_cycles = AHEAD_CYCLES,
        .tolerance_mm = machine->thread_tolerance_mm,
        .counts =
            machine->spindle_encoder_counts > 0 ? (double)machine->spindle_encoder_counts : 1.0,
        .ramp_rpm_s = machine->spindle_ramp_rpm_s,
        .max_rpm = machine->spindle_max_rpm,
        .wait_s = machine->spindle_at_speed_s > 0.0 ? machine->spindle_at_speed_s : WAIT_S,
    };

    takt_spindle_sync_init(&c->sync, &config);
}
