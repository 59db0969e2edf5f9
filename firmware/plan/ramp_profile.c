#include "plan/ramp_profile.h"

#include "base/assert.h"

/*
 * With three boxes: 64 x 32 x 32 = 2^16 times 2^38 units a mm leaves 512 mm between trapezoidal
 * reference and setpoint.
 */
uint32_t takt_ramp_profile_cycles_max(enum ramp_profile profile)
{
    return profile == RAMP_PROFILE_GENTLE ? RAMP_PROFILE_CYCLES_MAX / 4 : RAMP_PROFILE_CYCLES_MAX;
}

unsigned takt_ramp_profile_boxes(enum ramp_profile profile)
{
    TAKT_ASSERT(profile <= RAMP_PROFILE_GENTLE);
    switch (profile) {
    case RAMP_PROFILE_JERK:
        return 1;
    case RAMP_PROFILE_SMOOTH:
        return 2;
    case RAMP_PROFILE_GENTLE:
        break;
    }
    return 3;
}

double takt_ramp_profile_windows(enum ramp_profile profile)
{
    return 0.5 + 0.5 * (double)takt_ramp_profile_boxes(profile);
}

uint32_t takt_ramp_profile_box_cycles(unsigned i, uint32_t cycles)
{
    return i == 0 ? cycles : (cycles + 1) / 2;
}

uint32_t takt_ramp_profile_window_cycles(enum ramp_profile profile, uint32_t cycles)
{
    uint32_t window = 1;

    TAKT_ASSERT(cycles <= RAMP_PROFILE_CYCLES_MAX);
    for (unsigned i = 0; i < takt_ramp_profile_boxes(profile); i++) {
        window += takt_ramp_profile_box_cycles(i, cycles) - 1;
    }
    return window;
}
