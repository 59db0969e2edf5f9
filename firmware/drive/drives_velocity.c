/*
 * Drives without a mode of position: the position loop is closed here, as with drives that take
 * +-10 V.
 *
 *     v = dset/T + K (set - actual)
 *
 * set - actual is that of the last report. K = 1 / (4 sum of all delays) lets the lag die away
 * without overshoot: two delays in a row, of the drive and of the loop, t s^2 + s + K = 0, have a
 * double root there.
 */
#include "base/maths.h"
#include "drive/drives_private.h"

#define VELOCITY_MAX 2147483647.0

/* The best first. */
static const uint8_t follow_modes[] = {
    CIA402_MODE_CYCLIC_SYNC_POSITION, CIA402_MODE_INTERPOLATED_POSITION,
    CIA402_MODE_CYCLIC_SYNC_VELOCITY, CIA402_MODE_PROFILE_VELOCITY};
#define FOLLOW_MODES (sizeof follow_modes / sizeof follow_modes[0])

uint8_t takt_drives_mode_after(const struct drives_axis *axis, uint8_t mode)
{
    bool is_after = mode == CIA402_MODE_NONE;
    for (unsigned i = 0; i < FOLLOW_MODES; i++) {
        if (is_after && axis->modes >> (follow_modes[i] - 1) & 1)
            return follow_modes[i];
        is_after = is_after || follow_modes[i] == mode;
    }
    return CIA402_MODE_NONE;
}

void takt_drives_rest(struct drives_axis *axis)
{
    axis->target_inc = drives_is_by_velocity(axis) ? 0 : axis->actual_inc;
}

/* v = step/T + K lag, in units of object 60FF. */
void takt_drives_steer(struct drives *d, unsigned index, double step_mm, double lag_mm)
{
    struct drives_axis *axis = &d->axis[index];
    const double velocity_mm_s = step_mm * (1e6 / d->cycle_us) + d->position_gain_per_s * lag_mm;
    const double units = takt_maths_round(velocity_mm_s * axis->config.velocity_units_per_mm_s);
    if (maths_abs(units) <= VELOCITY_MAX)
        axis->target_inc = (int32_t)units;
    else
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_RANGE,
                          takt_drives_axis_shown(axis, velocity_mm_s), NULL);
}
