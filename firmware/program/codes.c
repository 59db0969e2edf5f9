#include "program/codes.h"

#include "program/circular.h"
#include "program/coordinates.h"
#include "program/events.h"
#include "program/modes.h"
#include "program/straight.h"

#include <stddef.h>

#define WORDS_ARC (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('r') | LETTER_BIT('p'))

#define SYSTEM(number_x10, system)                                                                 \
    {                                                                                              \
        'g', number_x10, GROUP_SYSTEM, STEP_SYSTEM, 0, system, coordinates_select                  \
    }

/* Sorted by letter, then number. */
static const struct program_code codes[] = {
    {'f', CODE_ANY, GROUP_NONE, STEP_FEED, LETTER_BIT('f'), 0, modes_set_feed},

    {'g', 0, GROUP_MOTION, STEP_MOTION, LETTERS_AXES, MOVE_RAPID, straight_move},
    {'g', 10, GROUP_MOTION, STEP_MOTION, LETTERS_AXES, MOVE_FEED, straight_move},
    {'g', 20, GROUP_MOTION, STEP_MOTION, WORDS_ARC, MOVE_ARC_CW, circular_move},
    {'g', 30, GROUP_MOTION, STEP_MOTION, WORDS_ARC, MOVE_ARC_CCW, circular_move},
    {'g', 40, GROUP_NON_MODAL, STEP_DWELL, LETTER_BIT('p'), 0, events_dwell},
    {'g', 170, GROUP_PLANE, STEP_PLANE, 0, PLANE_XY, modes_set_plane},
    {'g', 180, GROUP_PLANE, STEP_PLANE, 0, PLANE_ZX, modes_set_plane},
    {'g', 190, GROUP_PLANE, STEP_PLANE, 0, PLANE_YZ, modes_set_plane},
    {'g', 200, GROUP_UNITS, STEP_UNITS, 0, 1, modes_set_units},
    {'g', 210, GROUP_UNITS, STEP_UNITS, 0, 0, modes_set_units},
    {'g', 280, GROUP_NON_MODAL, STEP_REFERENCE, LETTERS_AXES, PARAMETER_REFERENCE_1,
     straight_to_reference},
    {'g', 300, GROUP_NON_MODAL, STEP_REFERENCE, LETTERS_AXES, PARAMETER_REFERENCE_2,
     straight_to_reference},
    {'g', 400, GROUP_CUTTER, STEP_CUTTER, 0, 0, modes_accept},
    {'g', 430, GROUP_TOOL_LENGTH, STEP_TOOL_LENGTH, LETTER_BIT('h'), 0, coordinates_use_tool},
    {'g', 490, GROUP_TOOL_LENGTH, STEP_TOOL_LENGTH, 0, 0, coordinates_drop_tool},
    {'g', 530, GROUP_NON_MODAL, STEP_MACHINE, 0, 0, coordinates_use_machine},
    SYSTEM(540, 1),
    SYSTEM(550, 2),
    SYSTEM(560, 3),
    SYSTEM(570, 4),
    SYSTEM(580, 5),
    SYSTEM(590, 6),
    SYSTEM(591, 7),
    SYSTEM(592, 8),
    SYSTEM(593, 9),
    {'g', 610, GROUP_PATH, STEP_PATH, 0, PATH_EXACT, modes_set_path},
    {'g', 611, GROUP_PATH, STEP_PATH, 0, PATH_EXACT_STOP, modes_set_path},
    {'g', 640, GROUP_PATH, STEP_PATH, LETTER_BIT('p') | LETTER_BIT('q'), PATH_BLEND,
     modes_set_path},
    {'g', 800, GROUP_MOTION, STEP_MOTION, 0, 0, straight_cancel},
    {'g', 900, GROUP_DISTANCE, STEP_DISTANCE, 0, 0, modes_set_distance},
    {'g', 901, GROUP_CENTRE, STEP_CENTRE, 0, 1, modes_set_centre},
    {'g', 910, GROUP_DISTANCE, STEP_DISTANCE, 0, 1, modes_set_distance},
    {'g', 911, GROUP_CENTRE, STEP_CENTRE, 0, 0, modes_set_centre},
    {'g', 920, GROUP_NON_MODAL, STEP_AXIS_OFFSET, LETTERS_AXES, 0, coordinates_set_axis_offset},
    {'g', 921, GROUP_NON_MODAL, STEP_AXIS_OFFSET, 0, 1, coordinates_cancel_axis_offset},
    {'g', 922, GROUP_NON_MODAL, STEP_AXIS_OFFSET, 0, 0, coordinates_cancel_axis_offset},
    {'g', 923, GROUP_NON_MODAL, STEP_AXIS_OFFSET, 0, 0, coordinates_restore_axis_offset},
    {'g', 930, GROUP_FEED_MODE, STEP_FEED_MODE, 0, 1, modes_set_feed_mode},
    {'g', 940, GROUP_FEED_MODE, STEP_FEED_MODE, 0, 0, modes_set_feed_mode},

    {'m', 0, GROUP_STOP, STEP_STOP, 0, 0, events_stop},
    {'m', 10, GROUP_STOP, STEP_STOP, 0, 1, events_stop},
    {'m', 20, GROUP_STOP, STEP_STOP, 0, 0, events_end},
    {'m', 30, GROUP_SPINDLE, STEP_SPINDLE, 0, SPINDLE_CW, events_turn_spindle},
    {'m', 40, GROUP_SPINDLE, STEP_SPINDLE, 0, SPINDLE_CCW, events_turn_spindle},
    {'m', 50, GROUP_SPINDLE, STEP_SPINDLE, 0, SPINDLE_OFF, events_turn_spindle},
    {'m', 60, GROUP_TOOL_CHANGE, STEP_TOOL_CHANGE, 0, 0, events_change_tool},
    {'m', 70, GROUP_COOLANT, STEP_COOLANT, 0, COOLANT_MIST, events_set_coolant},
    {'m', 80, GROUP_COOLANT, STEP_COOLANT, 0, COOLANT_FLOOD, events_set_coolant},
    {'m', 90, GROUP_COOLANT, STEP_COOLANT, 0, COOLANT_OFF, events_set_coolant},
    {'m', 300, GROUP_STOP, STEP_STOP, 0, 0, events_end},
    {'m', 480, GROUP_OVERRIDE, STEP_OVERRIDE, 0, 0, modes_accept},
    {'m', 490, GROUP_OVERRIDE, STEP_OVERRIDE, 0, 0, modes_accept},

    {'s', CODE_ANY, GROUP_NONE, STEP_SPEED, LETTER_BIT('s'), 0, events_set_speed},

    {'t', CODE_ANY, GROUP_NONE, STEP_TOOL_SELECT, LETTER_BIT('t'), 0, events_select_tool},
};

#undef SYSTEM

/* Order of the table: < 0, 0, > 0 as code stands before, at or behind what is looked for. */
static int compare(const struct program_code *code, char letter, unsigned number_x10)
{
    if (code->letter != letter) {
        return code->letter - letter;
    }
    return (int)code->number_x10 - (int)number_x10;
}

const struct program_code *code_find(char letter, unsigned number_x10)
{
    size_t low = 0;
    size_t high = sizeof(codes) / sizeof(codes[0]);

    while (low < high) {
        const size_t middle = (low + high) / 2;
        const int order = compare(&codes[middle], letter, number_x10);

        if (order == 0) {
            return &codes[middle];
        }
        if (order < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return NULL;
}
