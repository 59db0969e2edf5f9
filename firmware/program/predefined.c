#include "program/predefined.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/coordinates.h"

#define SECONDS_PER_MINUTE 60.0

/* What programs that ask for a version know: LinuxCNC 2.9, whose language this is. */
#define VERSION_MAJOR 2.9
#define VERSION_MINOR 0.0

/* A parameter: its value, and what its function is to look at. */
struct predefined {
    const char *name;
    double (*get)(const struct program *p, int argument);
    int argument;
};

enum flag {
    FLAG_METRIC,
    FLAG_IMPERIAL,
    FLAG_ABSOLUTE,
    FLAG_INCREMENTAL,
    FLAG_INVERSE_TIME,
    FLAG_PER_MINUTE,
    FLAG_PER_REVOLUTION,
    FLAG_CENTRE_ABSOLUTE,
    FLAG_DIAMETER,
    FLAG_RADIUS,
    FLAG_RETRACT_TO_R,
    FLAG_RETRACT_OLD,
    FLAG_SPEED,
    FLAG_SURFACE,
    FLAG_SPINDLE_ON,
    FLAG_SPINDLE_CW,
    FLAG_MIST,
    FLAG_FLOOD,
    FLAG_RETURNED
};

static bool is_set(const struct program *p, enum flag flag)
{
    const struct program_modes *m = &p->modes;

    switch (flag) {
    case FLAG_METRIC:
        return m->unit_mm == 1.0;
    case FLAG_IMPERIAL:
        return m->unit_mm != 1.0;
    case FLAG_ABSOLUTE:
        return !m->incremental;
    case FLAG_INCREMENTAL:
        return m->incremental;
    case FLAG_INVERSE_TIME:
        return m->inverse_time;
    case FLAG_PER_MINUTE:
        return !m->inverse_time && !m->per_revolution;
    case FLAG_PER_REVOLUTION:
        return m->per_revolution;
    case FLAG_CENTRE_ABSOLUTE:
        return m->centre_absolute;
    case FLAG_DIAMETER:
        return m->diameter;
    case FLAG_RADIUS:
        return !m->diameter;
    case FLAG_RETRACT_TO_R:
        return m->retract_to_r;
    case FLAG_RETRACT_OLD:
        return !m->retract_to_r;
    case FLAG_SPEED:
        return !m->surface_speed;
    case FLAG_SURFACE:
        return m->surface_speed;
    case FLAG_SPINDLE_ON:
        return m->direction != SPINDLE_OFF;
    case FLAG_SPINDLE_CW:
        return m->direction == SPINDLE_CW;
    case FLAG_MIST:
        return m->mist;
    case FLAG_FLOOD:
        return m->flood;
    case FLAG_RETURNED:
        return p->flow.value_returned;
    }
    return false;
}

static double get_flag(const struct program *p, int argument)
{
    return is_set(p, (enum flag)argument) ? 1.0 : 0.0;
}

static double get_override(const struct program *p, int argument)
{
    return (p->modes.overrides & (unsigned)argument) != 0 ? 1.0 : 0.0;
}

static double get_constant(const struct program *p, int argument)
{
    (void)p;
    return argument;
}

static double get_version(const struct program *p, int argument)
{
    (void)p;
    return argument == 0 ? VERSION_MAJOR : VERSION_MINOR;
}

static double get_line(const struct program *p, int argument)
{
    (void)argument;
    return p->lexer.line;
}

static double get_call_level(const struct program *p, int argument)
{
    (void)argument;
    return p->flow.calls;
}

static double get_value(const struct program *p, int argument)
{
    (void)argument;
    return p->flow.value;
}

/* Ten times the number of the G code: 800 for none. */
static double get_motion(const struct program *p, int argument)
{
    (void)argument;
    return p->modes.motion == NULL ? 800.0 : p->modes.motion->number_x10;
}

static double get_plane(const struct program *p, int argument)
{
    (void)argument;
    switch (p->modes.plane) {
    case PLANE_ZX:
        return 180.0;
    case PLANE_YZ:
        return 190.0;
    case PLANE_XY:
        break;
    }
    return 170.0;
}

static double get_cutter(const struct program *p, int argument)
{
    (void)argument;
    switch (p->modes.cutter_side) {
    case CUTTER_LEFT:
        return 410.0;
    case CUTTER_RIGHT:
        return 420.0;
    case CUTTER_OFF:
        break;
    }
    return 400.0;
}

/* G54 is 540, G59.1 is 591. */
static double get_system(const struct program *p, int argument)
{
    const double system = p->modes.system;

    (void)argument;
    return system < 7.0 ? 530.0 + 10.0 * system : 584.0 + system;
}

static double get_tool_offset(const struct program *p, int argument)
{
    (void)argument;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (p->modes.tool_offset.at[i] != 0.0) {
            return 1.0;
        }
    }
    return 0.0;
}

/* F in the program's units; 0 with G93, where every move has its own. */
static double get_feed(const struct program *p, int argument)
{
    const struct program_modes *m = &p->modes;

    (void)argument;
    if (m->per_revolution) {
        return m->feed_rev_mm / m->unit_mm;
    }
    return m->feed_mm_s * SECONDS_PER_MINUTE / m->unit_mm;
}

static double get_speed(const struct program *p, int argument)
{
    (void)argument;
    return p->modes.speed_rpm;
}

static double get_tool(const struct program *p, int argument)
{
    (void)argument;
    return p->modes.tool_current;
}

static double get_selected_tool(const struct program *p, int argument)
{
    (void)argument;
    return p->modes.tool_is_selected ? (double)p->modes.tool_selected : -1.0;
}

static double get_position(const struct program *p, int argument)
{
    TAKT_ASSERT(argument >= 0 && argument < AXIS_COUNT);
    return takt_coordinates_work(p, (enum axis)argument);
}

static double get_machine_position(const struct program *p, int argument)
{
    const enum axis axis = (enum axis)argument;
    const double value = takt_coordinates_to_parameter(p->modes.at.at[axis], axis);

    TAKT_ASSERT(argument >= 0 && argument < AXIS_COUNT);
    return axis < AXIS_LINEAR_COUNT ? value / p->modes.unit_mm : value;
}

/* Sorted by name. */
static const struct predefined table[] = {
    {"_a", get_position, AXIS_A},
    {"_abs_a", get_machine_position, AXIS_A},
    {"_abs_b", get_machine_position, AXIS_B},
    {"_abs_c", get_machine_position, AXIS_C},
    {"_abs_x", get_machine_position, AXIS_X},
    {"_abs_y", get_machine_position, AXIS_Y},
    {"_abs_z", get_machine_position, AXIS_Z},
    {"_absolute", get_flag, FLAG_ABSOLUTE},
    {"_adaptive_feed", get_override, OVERRIDE_ADAPTIVE},
    {"_b", get_position, AXIS_B},
    {"_c", get_position, AXIS_C},
    {"_call_level", get_call_level, 0},
    {"_ccomp", get_cutter, 0},
    {"_coord_system", get_system, 0},
    {"_current_tool", get_tool, 0},
    {"_feed", get_feed, 0},
    {"_feed_hold", get_override, OVERRIDE_HOLD},
    {"_feed_override", get_override, OVERRIDE_FEED},
    {"_flood", get_flag, FLAG_FLOOD},
    {"_ijk_absolute_mode", get_flag, FLAG_CENTRE_ABSOLUTE},
    {"_imperial", get_flag, FLAG_IMPERIAL},
    {"_incremental", get_flag, FLAG_INCREMENTAL},
    {"_inverse_time", get_flag, FLAG_INVERSE_TIME},
    {"_lathe_diameter_mode", get_flag, FLAG_DIAMETER},
    {"_lathe_radius_mode", get_flag, FLAG_RADIUS},
    {"_line", get_line, 0},
    {"_metric", get_flag, FLAG_METRIC},
    {"_mist", get_flag, FLAG_MIST},
    {"_motion_mode", get_motion, 0},
    {"_plane", get_plane, 0},
    {"_remap_level", get_constant, 0},
    {"_retract_old_z", get_flag, FLAG_RETRACT_OLD},
    {"_retract_r_plane", get_flag, FLAG_RETRACT_TO_R},
    {"_rpm", get_speed, 0},
    {"_selected_tool", get_selected_tool, 0},
    {"_speed_override", get_override, OVERRIDE_SPINDLE},
    {"_spindle_css_mode", get_flag, FLAG_SURFACE},
    {"_spindle_cw", get_flag, FLAG_SPINDLE_CW},
    {"_spindle_on", get_flag, FLAG_SPINDLE_ON},
    {"_spindle_rpm_mode", get_flag, FLAG_SPEED},
    {"_task", get_constant, 1},
    {"_tool_offset", get_tool_offset, 0},
    {"_u", get_constant, 0},
    {"_units_per_minute", get_flag, FLAG_PER_MINUTE},
    {"_units_per_rev", get_flag, FLAG_PER_REVOLUTION},
    {"_v", get_constant, 0},
    {"_value", get_value, 0},
    {"_value_returned", get_flag, FLAG_RETURNED},
    {"_vmajor", get_version, 0},
    {"_vminor", get_version, 1},
    {"_w", get_constant, 0},
    {"_x", get_position, AXIS_X},
    {"_y", get_position, AXIS_Y},
    {"_z", get_position, AXIS_Z},
};

/* Order of the table: < 0, 0, > 0 as entry stands before, at or behind name. */
static int compare(const char *entry, const char *name, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (entry[i] != name[i]) {
            return entry[i] - name[i];
        }
    }
    return entry[length] != '\0' ? 1 : 0;
}

static const struct predefined *find(const char *name, size_t length)
{
    size_t low = 0;
    size_t high = sizeof(table) / sizeof(table[0]);

    while (low < high) {
        const size_t middle = (low + high) / 2;
        const int order = compare(table[middle].name, name, length);

        if (order == 0) {
            return &table[middle];
        }
        if (order < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return NULL;
}

bool takt_predefined_get(const struct program *p, const char *name, size_t length, double *value)
{
    const struct predefined *found = name[0] == '_' ? find(name, length) : NULL;

    if (found == NULL) {
        return false;
    }
    *value = found->get(p, found->argument);
    return true;
}
