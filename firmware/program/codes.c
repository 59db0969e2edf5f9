#include "program/codes.h"

#include "program/calls.h"
#include "program/circular.h"
#include "program/contour.h"
#include "program/coordinates.h"
#include "program/cutter.h"
#include "program/cycles.h"
#include "program/events.h"
#include "program/involute.h"
#include "program/modes.h"
#include "program/probe.h"
#include "program/saved_modes.h"
#include "program/setting.h"
#include "program/spline.h"
#include "program/straight.h"
#include "program/threading.h"

#include <stddef.h>

#define WORDS_ARC      (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('r') | LETTER_BIT('p'))
#define WORDS_INVOLUTE (LETTERS_AXES | LETTERS_CENTRE | LETTER_BIT('r'))

#define WORDS_SETTING                                                                              \
    (LETTERS_AXES | LETTER_BIT('i') | LETTER_BIT('j') | LETTER_BIT('k') | LETTER_BIT('l') |        \
     LETTER_BIT('p') | LETTER_BIT('q') | LETTER_BIT('r'))
#define WORDS_THREADING                                                                            \
    (WORDS_CYCLE | LETTERS_CENTRE | LETTER_BIT('e') | LETTER_BIT('h') | LETTER_BIT('p') |          \
     LETTER_BIT('q'))

#define WORDS_PROFILE (LETTER_BIT('x') | LETTER_BIT('z') | LETTER_BIT('d') | LETTER_BIT('q'))
#define ROUGH(number_x10, kind)                                                                    \
    {                                                                                              \
        'g', number_x10, GROUP_MOTION, STEP_MOTION, kind,                                          \
            WORDS_PROFILE | LETTER_BIT('i') | LETTER_BIT('r'), takt_contour_start                  \
    }

/* With the words it takes beside those of its point. */
#define SPLINE(number_x10, words, which)                                                           \
    {                                                                                              \
        'g', number_x10, GROUP_MOTION, STEP_MOTION, which, LETTERS_LINEAR | (words),               \
            takt_spline_start                                                                      \
    }

/* With the words it takes beside those that all cycles take. */
#define CYCLE(number_x10, words, cycle)                                                            \
    {                                                                                              \
        'g', number_x10, GROUP_MOTION, STEP_MOTION, cycle, WORDS_CYCLE | (words),                  \
            takt_cycles_start                                                                      \
    }

#define SWITCH(number_x10, which)                                                                  \
    {                                                                                              \
        'm', number_x10, GROUP_OVERRIDE, STEP_OVERRIDE, which, LETTER_BIT('p'),                    \
            takt_modes_set_override                                                                \
    }

#define OUTPUT(number_x10, words, what)                                                            \
    {                                                                                              \
        'm', number_x10, GROUP_CHANNEL, STEP_CHANNEL, what, words, takt_events_set_output          \
    }

#define PROBE(number_x10, what)                                                                    \
    {                                                                                              \
        'g', number_x10, GROUP_MOTION, STEP_MOTION, what, LETTERS_AXES, takt_probe_move            \
    }

#define SYSTEM(number_x10, system)                                                                 \
    {                                                                                              \
        'g', number_x10, GROUP_SYSTEM, STEP_SYSTEM, system, 0, takt_coordinates_select             \
    }

/* Sorted by letter, then number. */
static const struct program_code codes[] = {
    {'f', CODE_ANY, GROUP_NONE, STEP_FEED, 0, LETTER_BIT('f'), takt_modes_set_feed},

    {'g', 0, GROUP_MOTION, STEP_MOTION, MOVE_RAPID, LETTERS_AXES, takt_straight_move},
    {'g', 10, GROUP_MOTION, STEP_MOTION, MOVE_FEED, LETTERS_AXES, takt_straight_move},
    {'g', 20, GROUP_MOTION, STEP_MOTION, MOVE_ARC_CW, WORDS_ARC, takt_circular_move},
    {'g', 22, GROUP_MOTION, STEP_MOTION, MOVE_INVOLUTE_CW, WORDS_INVOLUTE, takt_involute_move},
    {'g', 30, GROUP_MOTION, STEP_MOTION, MOVE_ARC_CCW, WORDS_ARC, takt_circular_move},
    {'g', 32, GROUP_MOTION, STEP_MOTION, MOVE_INVOLUTE_CCW, WORDS_INVOLUTE, takt_involute_move},
    {'g', 40, GROUP_NON_MODAL, STEP_DWELL, 0, LETTER_BIT('p'), takt_events_dwell},
    SPLINE(50, LETTER_BIT('i') | LETTER_BIT('j') | LETTER_BIT('p') | LETTER_BIT('q'), SPLINE_CUBIC),
    SPLINE(51, LETTER_BIT('i') | LETTER_BIT('j'), SPLINE_QUADRATIC),
    SPLINE(52, LETTER_BIT('l') | LETTER_BIT('p'), SPLINE_POINTS),
    SPLINE(53, 0, SPLINE_END),
    SPLINE(62, LETTER_BIT('k') | LETTER_BIT('p') | LETTER_BIT('q') | LETTER_BIT('r'), SPLINE_KNOTS),
    {'g', 70, GROUP_DIAMETER, STEP_DIAMETER, 1, 0, takt_modes_set_diameter},
    {'g', 80, GROUP_DIAMETER, STEP_DIAMETER, 0, 0, takt_modes_set_diameter},
    {'g', 100, GROUP_NON_MODAL, STEP_SETTING, 0, WORDS_SETTING, takt_setting_run},
    {'g', 170, GROUP_PLANE, STEP_PLANE, PLANE_XY, 0, takt_modes_set_plane},
    {'g', 180, GROUP_PLANE, STEP_PLANE, PLANE_ZX, 0, takt_modes_set_plane},
    {'g', 190, GROUP_PLANE, STEP_PLANE, PLANE_YZ, 0, takt_modes_set_plane},
    {'g', 200, GROUP_UNITS, STEP_UNITS, 1, 0, takt_modes_set_units},
    {'g', 210, GROUP_UNITS, STEP_UNITS, 0, 0, takt_modes_set_units},
    {'g', 280, GROUP_NON_MODAL, STEP_REFERENCE, PARAMETER_REFERENCE_1, LETTERS_AXES,
     takt_straight_to_reference},
    {'g', 281, GROUP_NON_MODAL, STEP_REFERENCE, PARAMETER_REFERENCE_1, 0,
     takt_straight_store_reference},
    {'g', 300, GROUP_NON_MODAL, STEP_REFERENCE, PARAMETER_REFERENCE_2, LETTERS_AXES,
     takt_straight_to_reference},
    {'g', 301, GROUP_NON_MODAL, STEP_REFERENCE, PARAMETER_REFERENCE_2, 0,
     takt_straight_store_reference},
    {'g', 330, GROUP_MOTION, STEP_MOTION, 0, LETTERS_AXES | LETTER_BIT('k'), takt_straight_thread},
    {'g', 331, GROUP_MOTION, STEP_MOTION, 0, LETTERS_LINEAR | LETTER_BIT('i') | LETTER_BIT('k'),
     takt_straight_tap},
    PROBE(382, 0),
    PROBE(383, PROBE_OPTIONAL),
    PROBE(384, PROBE_AWAY),
    PROBE(385, PROBE_OPTIONAL + PROBE_AWAY),
    {'g', 400, GROUP_CUTTER, STEP_CUTTER, 0, 0, takt_cutter_cancel},
    {'g', 410, GROUP_CUTTER, STEP_CUTTER, CUTTER_LEFT, LETTER_BIT('d'), takt_cutter_use_tool},
    {'g', 411, GROUP_CUTTER, STEP_CUTTER, CUTTER_LEFT, LETTER_BIT('d') | LETTER_BIT('l'),
     takt_cutter_use_diameter},
    {'g', 420, GROUP_CUTTER, STEP_CUTTER, CUTTER_RIGHT, LETTER_BIT('d'), takt_cutter_use_tool},
    {'g', 421, GROUP_CUTTER, STEP_CUTTER, CUTTER_RIGHT, LETTER_BIT('d') | LETTER_BIT('l'),
     takt_cutter_use_diameter},
    {'g', 430, GROUP_TOOL_LENGTH, STEP_TOOL_LENGTH, 0, LETTER_BIT('h'), takt_coordinates_use_tool},
    {'g', 431, GROUP_TOOL_LENGTH, STEP_TOOL_LENGTH, 0, LETTERS_AXES,
     takt_coordinates_set_tool_offset},
    {'g', 432, GROUP_TOOL_LENGTH, STEP_TOOL_LENGTH, 0, LETTERS_AXES | LETTER_BIT('h'),
     takt_coordinates_add_tool_offset},
    {'g', 490, GROUP_TOOL_LENGTH, STEP_TOOL_LENGTH, 0, 0, takt_coordinates_drop_tool},
    {'g', 520, GROUP_NON_MODAL, STEP_AXIS_OFFSET, 1, LETTERS_AXES,
     takt_coordinates_set_axis_offset},
    {'g', 530, GROUP_NON_MODAL, STEP_MACHINE, 0, 0, takt_coordinates_use_machine},
    SYSTEM(540, 1),
    SYSTEM(550, 2),
    SYSTEM(560, 3),
    SYSTEM(570, 4),
    SYSTEM(580, 5),
    SYSTEM(590, 6),
    SYSTEM(591, 7),
    SYSTEM(592, 8),
    SYSTEM(593, 9),
    {'g', 610, GROUP_PATH, STEP_PATH, PATH_EXACT, 0, takt_modes_set_path},
    {'g', 611, GROUP_PATH, STEP_PATH, PATH_EXACT_STOP, 0, takt_modes_set_path},
    {'g', 640, GROUP_PATH, STEP_PATH, PATH_BLEND,
     LETTER_BIT('p') | LETTER_BIT('q') | LETTER_BIT('r'), takt_modes_set_path},
    {'g', 700, GROUP_MOTION, STEP_MOTION, TURNING_FINISH,
     WORDS_PROFILE | LETTER_BIT('e') | LETTER_BIT('p'), takt_contour_start},
    ROUGH(710, TURNING_ROUGH),
    ROUGH(711, TURNING_NO_POCKETS),
    ROUGH(712, TURNING_POCKETS),
    ROUGH(720, TURNING_ROUGH + CONTOUR_FACING),
    ROUGH(721, TURNING_NO_POCKETS + CONTOUR_FACING),
    ROUGH(722, TURNING_POCKETS + CONTOUR_FACING),
    CYCLE(730, LETTER_BIT('d') | LETTER_BIT('q'), CYCLE_CHIP_BREAK),
    CYCLE(740, LETTER_BIT('p'), CYCLE_TAP + CYCLE_LEFT),
    {'g', 760, GROUP_MOTION, STEP_MOTION, 0, WORDS_THREADING, takt_threading_start},
    {'g', 800, GROUP_MOTION, STEP_MOTION, 0, 0, takt_straight_cancel},
    CYCLE(810, 0, CYCLE_DRILL),
    CYCLE(820, LETTER_BIT('p'), CYCLE_DRILL_WAIT),
    CYCLE(830, LETTER_BIT('d') | LETTER_BIT('q'), CYCLE_PECK),
    CYCLE(840, LETTER_BIT('p'), CYCLE_TAP),
    CYCLE(850, 0, CYCLE_REAM),
    CYCLE(860, LETTER_BIT('p'), CYCLE_BORE_STOP),
    CYCLE(870, LETTERS_CENTRE, CYCLE_BORE_BACK),
    CYCLE(880, LETTER_BIT('p'), CYCLE_BORE_PAUSE),
    CYCLE(890, LETTER_BIT('p'), CYCLE_BORE_WAIT),
    {'g', 900, GROUP_DISTANCE, STEP_DISTANCE, 0, 0, takt_modes_set_distance},
    {'g', 901, GROUP_CENTRE, STEP_CENTRE, 1, 0, takt_modes_set_centre},
    {'g', 910, GROUP_DISTANCE, STEP_DISTANCE, 1, 0, takt_modes_set_distance},
    {'g', 911, GROUP_CENTRE, STEP_CENTRE, 0, 0, takt_modes_set_centre},
    {'g', 920, GROUP_NON_MODAL, STEP_AXIS_OFFSET, 0, LETTERS_AXES,
     takt_coordinates_set_axis_offset},
    {'g', 921, GROUP_AXIS_APPLIED, STEP_AXIS_APPLIED, 1, 0, takt_coordinates_cancel_axis_offset},
    {'g', 922, GROUP_AXIS_APPLIED, STEP_AXIS_APPLIED, 0, 0, takt_coordinates_cancel_axis_offset},
    {'g', 923, GROUP_AXIS_APPLIED, STEP_AXIS_APPLIED, 0, 0, takt_coordinates_restore_axis_offset},
    {'g', 930, GROUP_FEED_MODE, STEP_FEED_MODE, FEED_INVERSE_TIME, 0, takt_modes_set_feed_mode},
    {'g', 940, GROUP_FEED_MODE, STEP_FEED_MODE, FEED_PER_MINUTE, 0, takt_modes_set_feed_mode},
    {'g', 950, GROUP_FEED_MODE, STEP_FEED_MODE, FEED_PER_REVOLUTION, 0, takt_modes_set_feed_mode},
    {'g', 960, GROUP_SPINDLE_MODE, STEP_SPINDLE_MODE, 1, LETTER_BIT('d'),
     takt_events_set_spindle_mode},
    {'g', 970, GROUP_SPINDLE_MODE, STEP_SPINDLE_MODE, 0, 0, takt_events_set_spindle_mode},
    {'g', 980, GROUP_RETRACT, STEP_RETRACT, 0, 0, takt_modes_set_retract},
    {'g', 990, GROUP_RETRACT, STEP_RETRACT, 1, 0, takt_modes_set_retract},

    {'m', 0, GROUP_STOP, STEP_STOP, 0, 0, takt_events_stop},
    {'m', 10, GROUP_STOP, STEP_STOP, 1, 0, takt_events_stop},
    {'m', 20, GROUP_STOP, STEP_STOP, 0, 0, takt_events_end},
    {'m', 30, GROUP_SPINDLE, STEP_SPINDLE, SPINDLE_CW, 0, takt_events_turn_spindle},
    {'m', 40, GROUP_SPINDLE, STEP_SPINDLE, SPINDLE_CCW, 0, takt_events_turn_spindle},
    {'m', 50, GROUP_SPINDLE, STEP_SPINDLE, SPINDLE_OFF, 0, takt_events_turn_spindle},
    {'m', 60, GROUP_TOOL_CHANGE, STEP_TOOL_CHANGE, 0, 0, takt_events_change_tool},
    {'m', 70, GROUP_COOLANT, STEP_COOLANT, COOLANT_MIST, 0, takt_events_set_coolant},
    {'m', 80, GROUP_COOLANT, STEP_COOLANT, COOLANT_FLOOD, 0, takt_events_set_coolant},
    {'m', 90, GROUP_COOLANT, STEP_COOLANT, COOLANT_OFF, 0, takt_events_set_coolant},
    {'m', 190, GROUP_SPINDLE, STEP_SPINDLE, 0, LETTER_BIT('p') | LETTER_BIT('q') | LETTER_BIT('r'),
     takt_events_orient_spindle},
    {'m', 300, GROUP_STOP, STEP_STOP, 0, 0, takt_events_end},
    {'m', 480, GROUP_OVERRIDE, STEP_OVERRIDE, 1, 0, takt_modes_set_overrides},
    {'m', 490, GROUP_OVERRIDE, STEP_OVERRIDE, 0, 0, takt_modes_set_overrides},
    SWITCH(500, OVERRIDE_FEED),
    SWITCH(510, OVERRIDE_SPINDLE),
    SWITCH(520, OVERRIDE_ADAPTIVE),
    SWITCH(530, OVERRIDE_HOLD),
    {'m', 600, GROUP_STOP, STEP_STOP, 0, 0, takt_events_stop},
    {'m', 610, GROUP_TOOL_CHANGE, STEP_TOOL_CHANGE, 0, LETTER_BIT('q'), takt_events_load_tool},
    OUTPUT(620, LETTER_BIT('p'), OUTPUT_ON + OUTPUT_WITH_MOTION),
    OUTPUT(630, LETTER_BIT('p'), OUTPUT_WITH_MOTION),
    OUTPUT(640, LETTER_BIT('p'), OUTPUT_ON),
    OUTPUT(650, LETTER_BIT('p'), 0),
    {'m', 660, GROUP_CHANNEL, STEP_CHANNEL, 0,
     LETTER_BIT('e') | LETTER_BIT('l') | LETTER_BIT('p') | LETTER_BIT('q'), takt_events_read_input},
    OUTPUT(670, LETTER_BIT('e') | LETTER_BIT('q'), OUTPUT_ANALOGUE + OUTPUT_WITH_MOTION),
    OUTPUT(680, LETTER_BIT('e') | LETTER_BIT('q'), OUTPUT_ANALOGUE),
    {'m', 700, GROUP_MODES, STEP_MODES, 0, 0, takt_saved_modes_run_code},
    {'m', 710, GROUP_MODES, STEP_MODES, 1, 0, takt_saved_modes_run_code},
    {'m', 720, GROUP_MODES, STEP_MODES, 2, 0, takt_saved_modes_run_code},
    {'m', 730, GROUP_MODES, STEP_MODES, 3, 0, takt_saved_modes_run_code},
    {'m', 980, GROUP_STOP, STEP_STOP, 0, LETTER_BIT('l') | LETTER_BIT('p'), takt_calls_run_code},
    {'m', 990, GROUP_STOP, STEP_STOP, 1, 0, takt_calls_run_code},
    {'m', 1200, GROUP_CORRECTION, STEP_CORRECTION, 1, LETTER_BIT('p'), takt_modes_set_correction},
    {'m', 1210, GROUP_CORRECTION, STEP_CORRECTION, 0, LETTER_BIT('p'), takt_modes_set_correction},

    {'s', CODE_ANY, GROUP_NONE, STEP_SPEED, 0, LETTER_BIT('s'), takt_events_set_speed},

    {'t', CODE_ANY, GROUP_NONE, STEP_TOOL_SELECT, 0, LETTER_BIT('t'), takt_events_select_tool},
};

#undef CYCLE
#undef OUTPUT
#undef PROBE
#undef ROUGH
#undef SPLINE
#undef SWITCH
#undef SYSTEM

/* Order of the table: < 0, 0, > 0 as code stands before, at or behind what is looked for. */
static int compare(const struct program_code *code, char letter, unsigned number_x10)
{
    if (code->letter != letter) {
        return code->letter - letter;
    }
    return (int)code->number_x10 - (int)number_x10;
}

const struct program_code *takt_code_find(char letter, unsigned number_x10)
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
