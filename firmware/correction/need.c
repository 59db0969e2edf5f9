#include "correction/need.h"

void need_add_slope(struct need *need, unsigned corrected, unsigned input, double slope,
                    const struct motion_bound *most)
{
    need->velocity_mm_s[corrected] += slope * most->velocity_mm_s[input];
    need->acceleration_mm_s2[corrected] += slope * most->acceleration_mm_s2[input];
    need->jerk_mm_s3[corrected] += slope * most->jerk_mm_s3[input];
}
