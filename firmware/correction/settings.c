/* What corrections are like that nobody has set up otherwise. */
#include "correction/correction.h"

#include <string.h>

void takt_correction_settings_set_default(struct correction_settings *settings)
{
    memset(settings, 0, sizeof(*settings));
    settings->largest_mm = 1.0;
    settings->steepest_ratio = 0.005;
    settings->fade_s = 1.0;
    settings->reversal_fade_s = 0.25;
    settings->turn_axis = AXIS_COUNT;
    settings->head_axis = AXIS_COUNT;
    settings->tool_direction[AXIS_Z] = 1.0;
}

void takt_correction_table_rules(const struct correction_settings *settings, unsigned axes,
                                 struct table_rules *rules)
{
    rules->axes = axes;
    rules->largest_mm = settings->largest_mm;
    rules->steepest_ratio = settings->steepest_ratio;
}
