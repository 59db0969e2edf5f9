#include "controller/outputs.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/program_limits.h"

#include <string.h>

#define SECONDS_PER_MINUTE 60.0

/* Maximum for a surface speed without one: above that of any spindle. */
#define RPM_MAX 1e6

_Static_assert(PROGRAM_DIGITAL_MAX + 1 == OUTPUTS_DIGITAL_MAX,
               "a program knows the outputs there are");
_Static_assert(PROGRAM_ANALOGUE_MAX + 1 == OUTPUTS_ANALOGUE_MAX,
               "a program knows the outputs there are");

static double sense_of(enum spindle_direction direction)
{
    switch (direction) {
    case SPINDLE_CW:
        return 1.0;
    case SPINDLE_CCW:
        return -1.0;
    case SPINDLE_OFF:
        break;
    }
    return 0.0;
}

static void stop_spindle(struct outputs *o, struct outputs_surface *surface)
{
    memset(surface, 0, sizeof(*surface));
    o->spindle_speed_rpm = 0.0;
    o->spindle_orient = false;
}

/* With a surface speed the number of revolutions follows with the setpoint of the cycle. */
static void turn_spindle(struct outputs *o, struct outputs_surface *surface, const struct move *m)
{
    const double sense = sense_of(m->direction);

    stop_spindle(o, surface);
    if (m->surface_mm_s > 0.0) {
        *surface = (struct outputs_surface){.mm_s = m->surface_mm_s,
                                            .axis_x_mm = m->surface_x_mm,
                                            .highest_rpm = m->speed_rpm,
                                            .sense = sense};
    } else {
        o->spindle_speed_rpm = sense * m->speed_rpm;
    }
}

static void set_output(struct outputs *o, const struct move *m)
{
    TAKT_ASSERT(m->channel < (m->analogue ? OUTPUTS_ANALOGUE_MAX : OUTPUTS_DIGITAL_MAX));
    if (m->analogue) {
        o->analogue[m->channel] = m->output;
    } else if (m->output != 0.0) {
        o->digital |= UINT32_C(1) << m->channel;
    } else {
        o->digital &= ~(UINT32_C(1) << m->channel);
    }
}

/* The end of the program turns spindle and coolant off; outputs stay, as in LinuxCNC. */
static void end(struct outputs *o, struct outputs_surface *surface)
{
    stop_spindle(o, surface);
    o->mist = false;
    o->flood = false;
}

static void orient_spindle(struct outputs *o, struct outputs_surface *surface, const struct move *m)
{
    stop_spindle(o, surface);
    o->spindle_orient = true;
    o->spindle_angle_rad = m->orient_rad;
}

static void set_coolant(struct outputs *o, const struct move *m)
{
    o->mist = m->mist;
    o->flood = m->flood;
}

/* T alone prepares a tool and leaves the spindle's. */
static void set_tool(struct outputs *o, const struct move *m)
{
    o->tool_asked = m->tool;
    if (m->tool_change || m->tool_loaded) {
        o->tool = m->tool;
    }
}

void takt_outputs_apply(struct outputs *o, struct outputs_surface *surface, const struct move *m)
{
    switch (m->kind) {
    case MOVE_SPINDLE:
        turn_spindle(o, surface, m);
        break;
    case MOVE_ORIENT:
        orient_spindle(o, surface, m);
        break;
    case MOVE_COOLANT:
        set_coolant(o, m);
        break;
    case MOVE_TOOL:
        set_tool(o, m);
        break;
    case MOVE_OUTPUT:
        set_output(o, m);
        break;
    case MOVE_END:
        end(o, surface);
        break;
    case MOVE_RAPID:
    case MOVE_FEED:
    case MOVE_ARC_CW:
    case MOVE_ARC_CCW:
    case MOVE_INVOLUTE_CW:
    case MOVE_INVOLUTE_CCW:
    case MOVE_SPLINE:
    case MOVE_THREAD:
    case MOVE_TAP:
    case MOVE_TAP_OUT:
    case MOVE_PROBE:
    case MOVE_DWELL:
    case MOVE_INPUT:
    case MOVE_WEAR:
    case MOVE_SETUP:
    case MOVE_STOP:
        break;
    }
}

/*
 * Surface speed v at the distance x of the tool from the spindle's axis:
 *
 *     speed = v / (2 pi |x|),   not above its maximum
 */
void takt_outputs_keep_surface(struct outputs *o, const struct outputs_surface *surface,
                               const struct point *setpoint)
{
    const double turn_mm = MATHS_TWO_PI * maths_abs(setpoint->at[AXIS_X] - surface->axis_x_mm);
    const double highest = surface->highest_rpm > 0.0 ? surface->highest_rpm : RPM_MAX;
    const double mm_min = surface->mm_s * SECONDS_PER_MINUTE;

    o->spindle_speed_rpm =
        surface->sense * (mm_min < highest * turn_mm ? mm_min / turn_mm : highest);
}
