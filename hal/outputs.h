/*
 * What the firmware asks of the machine beside the axes: the state of the outputs after each
 * control cycle. Whoever runs the cycle carries them to the spindle drive, valves and lines.
 */
#ifndef TAKT_HAL_OUTPUTS_H
#define TAKT_HAL_OUTPUTS_H

#include <stdbool.h>
#include <stdint.h>

/* Outputs that M62 to M65 (digital P0 ... 31) and M67, M68 (analogue E0 ... 3) can set. */
#define OUTPUTS_DIGITAL_MAX  32
#define OUTPUTS_ANALOGUE_MAX 4

struct outputs {
    /* commanded; positive clockwise (M3), negative counter-clockwise, 0 off */
    double spindle_speed_rpm;
    bool spindle_orient; /* M19: hold spindle_angle_rad */
    double spindle_angle_rad;
    bool mist;
    bool flood;
    bool tool_change;    /* M6: the changer is to bring tool_asked, until it has answered */
    uint32_t tool;       /* in the spindle */
    uint32_t digital;    /* bit i: output i */
    uint32_t tool_asked; /* by T: what M6 changes to */
    double analogue[OUTPUTS_ANALOGUE_MAX];
};

#endif
