#include "program/system_parameters.h"

#include "base/assert.h"
#include "program/coordinates.h"
#include "program/tool_values.h"

static bool is_position(unsigned number)
{
    return number >= PARAMETER_POSITION && number < PARAMETER_POSITION + AXIS_COUNT;
}

static bool is_tool(unsigned number)
{
    return number >= PARAMETER_TOOL_NUMBER && number <= PARAMETER_TOOL_SIDE;
}

bool takt_system_parameter_is_read_only(unsigned number)
{
    return is_position(number) || is_tool(number);
}

static double tool_parameter(const struct program *p, unsigned number)
{
    const struct tool *tool = takt_tool_values_find(p, p->modes.tool_current);

    TAKT_ASSERT(is_tool(number));
    if (number == PARAMETER_TOOL_NUMBER) {
        return p->modes.tool_current;
    }
    if (tool == NULL) {
        return 0.0;
    }
    const unsigned axis = number - PARAMETER_TOOL_OFFSET;

    if (axis < AXIS_COUNT) {
        return takt_coordinates_to_parameter(tool->offset.at[axis], (enum axis)axis);
    }
    switch (number) {
    case PARAMETER_TOOL_DIAMETER:
        return tool->diameter_mm;
    case PARAMETER_TOOL_FRONT:
        return tool->front_angle_deg;
    case PARAMETER_TOOL_BACK:
        return tool->back_angle_deg;
    case PARAMETER_TOOL_SIDE:
        return tool->orientation;
    default:
        return 0.0;
    }
}

double takt_system_parameter_get(const struct program *p, unsigned number)
{
    if (number < PARAMETER_TOOL_NUMBER) {
        return takt_parameters_get(p->config.parameters, number);
    }
    if (is_position(number)) {
        return takt_coordinates_work(p, (enum axis)(number - PARAMETER_POSITION));
    }
    if (is_tool(number)) {
        return tool_parameter(p, number);
    }
    return takt_parameters_get(p->config.parameters, number);
}
