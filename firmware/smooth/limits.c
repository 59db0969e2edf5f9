#include "smooth/limits.h"

#include "base/assert.h"
#include "base/maths.h"

void takt_smooth_limit(struct smooth_limits *limits)
{
    TAKT_ASSERT(limits->cycle_s > 0.0);
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits->acceleration_mm_s2[i] =
            maths_min(limits->acceleration_mm_s2[i],
                      maths_sqrt(2.0 * limits->velocity_mm_s[i] * limits->jerk_mm_s3[i]));
    }
}
