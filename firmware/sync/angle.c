#include "sync/angle.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/*
 * All three poles at b = exp(-bandwidth); the gains of the critically damped g-h-k filter:
 *
 *     g = 1 - b^3,   h = 3/2 (1 - b)^2 (1 + b),   2 k = (1 - b)^3
 */
void takt_angle_tune(struct angle *a, double bandwidth_rad_cycle)
{
    const double b = takt_maths_exp(-bandwidth_rad_cycle);
    const double c = 1.0 - b;

    TAKT_ASSERT(bandwidth_rad_cycle > 0.0);
    a->gain_angle = 1.0 - b * b * b;
    a->gain_speed = 1.5 * c * c * (1.0 + b);
    a->gain_acceleration = c * c * c;
}

void takt_angle_init(struct angle *a)
{
    memset(a, 0, sizeof(*a));
}

struct angle_ahead takt_angle_look_ahead(const struct angle *a, double cycles)
{
    TAKT_ASSERT(cycles >= 0.0);
    return (struct angle_ahead){
        .rev = a->rev + cycles * (a->speed + 0.5 * cycles * a->acceleration),
        .speed = a->speed + cycles * a->acceleration,
        .acceleration = a->acceleration,
    };
}

void takt_angle_follow(struct angle *a, double measured_rev)
{
    const struct angle_ahead expected = takt_angle_look_ahead(a, 1.0);
    const double off = measured_rev - expected.rev;

    if (a->state == ANGLE_UNKNOWN) {
        a->rev = measured_rev;
        a->state = ANGLE_STANDS;
        return;
    }
    a->rev = expected.rev + a->gain_angle * off;
    a->speed = expected.speed + a->gain_speed * off;
    a->acceleration = expected.acceleration + a->gain_acceleration * off;
    a->state = a->speed == 0.0 && a->acceleration == 0.0 ? ANGLE_STANDS : ANGLE_TURNS;
}
