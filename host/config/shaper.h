/*
 * What the controller does so that a machine's modes (geometry.mode_x) do not swing: see
 * firmware/shape.
 */
#ifndef TAKT_HOST_CONFIG_SHAPER_H
#define TAKT_HOST_CONFIG_SHAPER_H

#include "config/machine_setup.h"
#include "plan/limits.h"
#include "shape/shape.h"

enum shaper {
    SHAPER_NONE,
    SHAPER_NEUTRAL, /* ZV, and the tool keeps its way */
    SHAPER_ZV,
    SHAPER_MZV, /* for comparison: classic/shapers.h */
    SHAPER_EI
};

/* NULL: good, or none; else what is wrong. */
const char *shaper_check(const struct machine_setup *setup);

/* The setup is good. Fills s, and gives it back; NULL: none is wanted, and s is not touched. */
struct shape *shaper_prepare(const struct machine_setup *setup, struct shape *s);

/*
 * The modes that a program planned ahead meets: as they are at their places' ratio of 1, each along
 * its own axis. None where setpoints are shaped: then that is the shaper's.
 */
void shaper_planned_modes(const struct machine_setup *setup, struct vibration_config *modes);

/* The planner's limits of a machine, less what its shaper takes: as the controller has them. */
void shaper_plan_limits(const struct machine_setup *setup, struct plan_limits *limits);

#endif
