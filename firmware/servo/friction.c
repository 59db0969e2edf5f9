#include "servo/friction.h"

#include "base/assert.h"
#include "base/maths.h"

/* Straight from point to point. */
static double size_at(const struct friction *f, double points)
{
    const unsigned last = FRICTION_POINTS - 1;
    TAKT_ASSERT(points >= 0.0);
    if (points >= last)
        return f->at[last];
    const unsigned k = (unsigned)points;
    return f->at[k] + (points - k) * (f->at[k + 1] - f->at[k]);
}

double takt_friction_at(const struct friction *friction, double velocity)
{
    if (velocity == 0)
        return 0;
    double size = size_at(friction, maths_abs(velocity) * friction->points_per_velocity);
    return velocity > 0 ? size : -size;
}
