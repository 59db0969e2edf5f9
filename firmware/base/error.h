/*
 * One number line for errors: takt's own are negative, protocol codes (SDO aborts, Modbus
 * exceptions) positive, 0 is success. A broken invariant is not an error: it is an assert.
 */
#ifndef TAKT_BASE_ERROR_H
#define TAKT_BASE_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * Every error: its name and its text. In a text, %w stands for the offending word, %v for the
 * value, with up to six decimals, %l for a second one, its limit, %u for the unit of the axis that
 * is the word, %x for the value in hexadecimal and %m for its meaning. The numbers are the order of
 * this list, from -1 down; append at the end of a group, the numbers are not stored anywhere.
 */
#define TAKT_ERRORS(X)                                                                             \
    /* reading the text of a program */                                                            \
    X(SOURCE_UNREADABLE, "the program cannot be read")                                             \
    X(LINE_TOO_LONG, "the line is longer than %v characters")                                      \
    X(CHARACTER_UNKNOWN, "unexpected character '%w'")                                              \
    X(COMMENT_UNCLOSED, "a comment is not closed")                                                 \
    X(NUMBER_EXPECTED, "a number is missing after '%w'")                                           \
    X(WORD_UNKNOWN, "unknown word '%w'")                                                           \
    X(WORD_REPEATED, "the word '%w' is given twice")                                               \
    X(WORD_UNUSED, "no code on this line uses the word '%w'")                                      \
    X(WORD_SHARED, "two codes on this line claim the word '%w'")                                   \
    X(WORD_NEGATIVE, "'%w' must not be negative: %v")                                              \
    X(WORD_NOT_WHOLE, "'%w' must be a whole number: %v")                                           \
    X(WORD_OUT_OF_RANGE, "'%w' is out of range: %v")                                               \
    X(WORDS_CONFLICT, "'%w' contradicts another word of its group on this line")                   \
    X(AXIS_MISSING, "the machine has no axis %w")                                                  \
    X(AXIS_WORD_MISSING, "'%w' needs an axis word")                                                \
    X(BRACKET_EXPECTED, "a '[' is missing after '%w'")                                             \
    X(FUNCTION_UNKNOWN, "there is no function '%w'")                                               \
    X(BRACKET_UNCLOSED, "a '[' is not closed")                                                     \
    X(OPERATOR_EXPECTED, "an operator or ']' is missing after '%w'")                               \
    X(SLASH_EXPECTED, "ATAN needs two values: ATAN[y]/[x]")                                        \
    X(EQUALS_EXPECTED, "a '=' is missing after '%w'")                                              \
    X(NESTING_TOO_DEEP, "the expression is nested deeper than %v levels")                          \
    X(DIVISION_BY_ZERO, "division by zero")                                                        \
    X(CALCULATION_UNDEFINED, "%w is not defined for %v")                                           \
    X(CALCULATION_NOT_FINITE, "the result is too large")                                           \
    X(PARAMETER_NUMBER, "there is no parameter number %v")                                         \
    X(PARAMETER_NAME, "a parameter's name has 1 to %v characters and ends with '>'")               \
    X(PARAMETER_UNDEFINED, "the parameter '%w' has not been set")                                  \
    X(PARAMETER_READ_ONLY, "the parameter '%w' cannot be set by a program")                        \
    X(PARAMETERS_FULL, "no room for the parameter '%w'")                                           \
    X(ASSIGNMENTS_TOO_MANY, "more than %v assignments on one line")                                \
    /* flow of a program */                                                                        \
    X(OWORD_LABEL, "'%w' needs a whole number, or a <name> of up to %v characters")                \
    X(OWORD_UNKNOWN, "there is no O-word '%w'")                                                    \
    X(OWORD_ALONE, "'%w' must stand alone on its line")                                            \
    X(OWORD_UNMATCHED, "'%w' belongs to no open block of its kind and label")                      \
    X(OWORD_CROSSED, "'%w' stands inside another block, opened in line %v and not closed")         \
    X(OWORD_LABEL_USED, "'%w' has the label of an open block, of line %v")                         \
    X(OWORD_UNCLOSED, "'%w' is not closed")                                                        \
    X(OWORD_TOO_DEEP, "'%w' is nested deeper than %v blocks")                                      \
    X(SUB_UNKNOWN, "'%w' calls a subroutine that this program does not have")                      \
    X(SUB_DEFINED_TWICE, "'%w' has been defined already, in line %v")                              \
    X(SUB_NESTED, "'%w' begins inside another subroutine")                                         \
    X(SUB_NOT_INSIDE, "'%w' is not inside its subroutine")                                         \
    X(SUB_STYLE,                                                                                   \
      "'%w' mixes O... sub, which goes with call, and a bare O..., which goes with M98")           \
    X(SUBS_TOO_MANY, "'%w' is more than the %v subroutines a program can have")                    \
    X(CALL_TOO_DEEP, "'%w' is a call inside more than %v others")                                  \
    X(CALL_ARGUMENTS, "'%w' has more than %v arguments")                                           \
    X(CALL_P_MISSING, "'%w' needs P, the number of the program to call")                           \
    X(JUMP_BACK, "'%w' has to go back in the text, which a stream cannot")                         \
    X(JUMP_NOWHERE, "'%w' goes to a label that no line has, outside of other blocks")              \
    X(CIRCLE, "the program is in an endless loop: %v lines without a move")                        \
    X(ENDLESS, "the program does not end: %v lines have been read again")                          \
    X(MODES_NOT_SAVED, "'%w' finds no saved modes: no M70 or M73 in this call")                    \
    X(PROGRAM_FULL, "no room for '%w' beside the names, calls and saved modes there are")          \
    X(ABORTED, "the program ends itself:%w")                                                       \
    X(FROM_LINE_MISSED, "the program never reaches line %v")                                       \
    X(FROM_LINE_PROBE, "what this probing move finds is not known to a start at line %v")          \
    X(FROM_LINE_CUTTER, "line %v is inside a compensated contour: start before its G41 or G42")    \
    /* motion */                                                                                   \
    X(ARC_ENDPOINT, "the arc's end is %v mm off its circle")                                       \
    X(FEED_MISSING, "a cutting move needs a feed: F above 0 comes first")                          \
    X(TRAVEL_EXCEEDED, "axis %w would leave its travel: %v %u, limit %l %u")                       \
    X(MOTION_MODE_MISSING, "the word '%w' needs a motion code (G0, G1, G2 or G3)")                 \
    X(ARC_CENTRE_MISSING, "the arc's centre is missing: '%w' needs R, or I J K of its plane")      \
    X(ARC_CENTRE_TWICE, "the arc's centre is given twice: '%w' and I J K")                         \
    X(ARC_CENTRE_PARTIAL, "an absolute centre (G90.1) needs '%w' too")                             \
    X(ARC_RADIUS_ZERO, "the arc's centre is on its start or end")                                  \
    X(ARC_RADIUS_SMALL, "the arc's radius is %v mm too short to reach its end")                    \
    X(ARC_CLOSED, "an arc with R cannot end where it starts: give I J K for a full circle")        \
    X(MACHINE_COORDINATES, "'%w' works only with G0 or G1 and G90")                                \
    X(ARC_TILTED, "'%w' works only in G17 while the coordinate system is rotated (by %v degrees)") \
    X(SPINDLE_STANDS, "'%w' needs a turning spindle: M3 or M4, and S above 0")                     \
    X(SPINDLE_WRONG_WAY, "'%w' needs the spindle to turn the other way")                           \
    X(SPINDLE_NO_ENCODER, "'%w' needs a spindle with an encoder, and this machine's has none")     \
    X(WORD_MISSING, "this code needs the word '%w'")                                               \
    X(WORD_ZERO, "'%w' must not be 0")                                                             \
    X(WORD_NOT_POSITIVE, "'%w' must be above 0: %v")                                               \
    X(FEED_MODE_UNFIT, "'%w' does not work in this feed mode: use G94")                            \
    X(CYCLE_UPSIDE_DOWN, "the bottom of '%w' is %v mm above its R")                                \
    X(CYCLE_TOO_LONG, "'%w' would repeat itself more than %v times")                               \
    X(THREAD_DEPTH, "the depth of the thread, '%w', must be above that of the first cut, J")       \
    X(PROFILE_PLANE, "'%w' works only in G18, without rotation of the coordinate system")          \
    X(PROFILE_LONG, "the profile of '%w' has more than %v moves, fillets and chamfers")            \
    X(PROFILE_BACK, "the profile of '%w' turns back: it may go only one way in Z, for G72 in X")   \
    X(PROFILE_CORNER, "a fillet (A) or chamfer (C) in the profile of '%w' does not fit")           \
    X(PROFILE_GONE, "nothing remains of the profile of '%w' at this distance (D, E)")              \
    X(SPLINE_OPEN, "'%w' comes before the spline is ended (by G5.3, or all knots of G6.2)")        \
    X(SPLINE_ABSENT,                                                                               \
      "'%w' ends a spline that has not begun: G5.2, or G6.2 with a point, comes first")            \
    X(SPLINE_SHORT, "the spline ends with fewer control points than its order: %v")                \
    X(SPLINE_START, "the spline's first control point is %v mm from where the tool is")            \
    X(SPLINE_KNOT, "the knot '%w' (%v) is below the one before, or there too often")               \
    X(SPLINE_PLANE, "'%w' works only in G17")                                                      \
    X(SPLINE_CUSP, "the spline of '%w' is too sharp, or its knots are too near to each other")     \
    X(INVOLUTE_START, "the start is %v mm inside the involute's base circle")                      \
    X(INVOLUTE_END, "the end is %v mm off the involute")                                           \
    X(INVOLUTE_TURNS, "the base circle is too small: the involute would turn %v times")            \
    X(INVOLUTE_CLOSED, "start and end are equally far from the centre of the involute '%w'")       \
    X(PROBE_NO_WAY, "the probing move '%w' ends where it starts")                                  \
    X(PROBE_NO_CONTACT, "the probing move ended without contact")                                  \
    X(PROBE_NO_RELEASE, "the probing move ended without losing contact")                           \
    X(PROBE_TOUCHES, "the probe is in contact already where the probing move begins")              \
    X(PROBE_CLEAR, "the probe has no contact where the probing move away from it begins")          \
    X(SETTING_MISSING, "'%w' has no word to set anything")                                         \
    X(TOOL_ABSENT, "tool %v is not in the tool table")                                             \
    X(TOOL_CHANGES_FULL, "a program can change the values of %v tools at most")                    \
    X(CUTTER_REPEATED, "'%w': cutter compensation is on already; G40 comes first")                 \
    X(CUTTER_DIAMETER, "'%w' needs D, the diameter of the tool")                                   \
    X(CUTTER_ORIENTATION, "'%w': a lathe tool (orientation %v) is compensated in G18 only")        \
    X(CUTTER_ON, "'%w' is not possible while cutter compensation is on")                           \
    X(CUTTER_EXIT_ARC, "the first move after cutter compensation must be straight, not '%w'")      \
    X(OFFSET_ENTRY_SHORT,                                                                          \
      "the entry move is too short for the tool's radius: it must be more than %v mm longer")      \
    X(OFFSET_ENTRY_ARC, "no arc leads from here to the compensated end of the entry move")         \
    X(OFFSET_ENTRY_INVOLUTE, "cutter compensation cannot begin with an involute")                  \
    X(OFFSET_ARC_SMALL,                                                                            \
      "the tool does not fit into the arc: its radius would have to be more than %v mm larger")    \
    X(OFFSET_TURNS, "an involute of more than %v turns cannot be compensated")                     \
    X(OFFSET_GOUGE, "the tool does not fit here: it would cut %v mm into the contour")             \
    X(OFFSET_LEFT_OUT, "this move is left out: the tool, radius %v mm, does not fit there")        \
    X(OFFSET_CROWDED, "more than %v commands between two moves of a compensated contour")          \
    X(DWELL_MISSING, "'%w' needs P, the seconds to wait")                                          \
    X(TOOL_MISSING, "'%w' needs a tool: no T has been given")                                      \
    X(REPEATS, "the program goes back to its beginning for ever (M99); it was read for %v lines")  \
    X(TOOL_UNKNOWN, "tool %v is not in the tool table: its length counts as 0")                    \
    X(SPINDLE_LIMITED, "'%w' is above the spindle's maximum of %v rev/min, which is used instead") \
    /* correction tables */                                                                        \
    X(TABLE_COLUMN_UNKNOWN,                                                                        \
      "'%w' is no column of a table, such as X_mm, C_deg, KX_um or KY_up_um")                      \
    X(TABLE_COLUMN_TWICE, "the column '%w' is given twice")                                        \
    X(TABLE_COLUMN_ORDER, "the position '%w' stands behind a correction")                          \
    X(TABLE_POSITIONS, "a table has 1 to %v columns of positions")                                 \
    X(TABLE_OUTPUTS_MISSING, "the table has no column of corrections, such as KX_um")              \
    X(TABLE_DIRECTION_ALONE, "the column '%w' needs that of the other direction beside it")        \
    X(TABLE_DIRECTION_GRID, "'%w': directions of approach are for tables over one axis")           \
    X(TABLE_ROTARY_SECOND, "a grid has one rotary axis at most, and '%w' is another")              \
    X(TABLE_CELL_COUNT, "the row has %v cells, which is not one for each column")                  \
    X(TABLE_NUMBER, "'%w' is not a number")                                                        \
    X(TABLE_NOT_FINITE, "%w is not finite")                                                        \
    X(TABLE_ORDER, "%w: positions must increase")                                                  \
    X(TABLE_UNEVEN, "%w: a grid has even steps, and this one is off by a ratio of %v")             \
    X(TABLE_POINT, "the point %w is expected here: points are missing, or in another order")       \
    X(TABLE_POINTS_FEW, "the table has fewer than 2 points along %w")                              \
    X(TABLE_POINTS_MANY, "the table has more than %v points along %w")                             \
    X(TABLE_FULL, "the table has more than %v numbers")                                            \
    X(TABLE_LARGE, "%w: a correction of %v mm (rad) is above the machine's maximum")               \
    X(TABLE_STEEP, "%w: a slope of %v from the point before is above the machine's maximum")       \
    X(TABLE_CHECKSUM, "the checksum is wrong: the table is damaged, or was changed by hand")       \
    X(TABLE_AFTER_CHECKSUM, "the table goes on behind its checksum")                               \
    X(TABLE_DAMAGED, "this is no stored correction table of this version")                         \
    X(TABLE_TRIPLET, "three numbers are expected: nominal, forward, reverse")                      \
    X(TABLE_KIND, "this needs a table over one axis; a volume one over two to four (here: %v)")    \
    X(TABLE_PAIRS_MANY, "more than %v pairs of axes, or the points of '%w' find no room")          \
    X(TABLE_PAIR_TWICE, "the correction '%w' is in two tables of the same axis")                   \
    X(TABLE_ERRORS, "'%w': a table of a unit's errors is over its axis alone, and has no others")  \
    X(TABLE_UNIT, "this is no table of errors of a unit of the machine's chain (here: over %w)")   \
    X(TABLE_RESERVE, "axis %w would need %v percent of its limits, more than has been reserved")   \
    X(SETUP_RESERVE,                                                                               \
      "this set-up would need more of the axes' limits than correction has reserved")              \
    /* machine and drives */                                                                       \
    X(STALLED, "the axes do not go on, and nothing explains it: a fault of the planner")           \
    X(TOOL_CHANGE_SLOW, "the tool changer has not ended its answer to M6 within %v s")             \
    X(SPINDLE_SLOW, "the spindle has not reached its speed in time")                               \
    X(DRIVE_FAULT, "the drive of axis %w reports %x: %m")                                          \
    X(DRIVE_STATE, "the drive of axis %w has left operation: its state is '%m'")                   \
    X(DRIVE_NOT_ENABLED, "the drive of axis %w cannot be enabled: it stays in '%m'")               \
    X(DRIVE_REBOOTED, "the drive of axis %w has restarted")                                        \
    X(DRIVE_ABSENT, "the drive of axis %w has not booted within %v s")                             \
    X(DRIVE_SILENT, "the drive of axis %w has sent no position for %v ms")                         \
    X(DRIVE_HEARTBEAT, "the drive of axis %w has sent no heartbeat for %v ms")                     \
    X(DRIVE_NMT, "the drive of axis %w is not operational any more, but %m")                       \
    X(DRIVE_TYPE, "axis %w has no CiA 402 drive: the device type, object 1000, is %x")             \
    X(DRIVE_IDENTITY, "axis %w has another drive than the machine file says: its %m is %x")        \
    X(DRIVE_MODES, "the drive of axis %w has no %m mode: the modes, object 6502, are %x")          \
    X(DRIVE_MODE, "the drive of axis %w does not take the mode %v")                                \
    X(DRIVE_REFUSES, "the drive of axis %w refuses with abort code %x: %m")                        \
    X(DRIVE_UNANSWERED, "the drive of axis %w does not answer within %v ms")                       \
    X(DRIVE_UNMAPPED, "the drive of axis %w is in no PDO of every SYNC and refuses: %x, %m")       \
    X(DRIVE_UNWATCHED,                                                                             \
      "the drive of axis %w follows velocities, and would go on if the controller fell silent")    \
    X(DRIVE_PERIOD, "the drive of axis %w keeps 60C2, %v us between targets; cycle_us is %l")      \
    X(DRIVE_SCALING,                                                                               \
      "the drive of axis %w counts %v units in a turn of its motor; increments_per_mm says %l")    \
    X(DRIVE_FOLLOWING, "axis %w lags %v %u behind its setpoint")                                   \
    X(DRIVE_SHARES, "the drive of axis %w takes the PDO %x, which is meant for another drive")     \
    X(DRIVE_SKEW, "axis %w is %v mm off the other drive of its gantry")                            \
    X(DRIVE_HOMING, "the drive of axis %w reports an error while homing: statusword %x")           \
    X(DRIVE_HOMING_SLOW, "homing of axis %w has not ended within %v s")                            \
    X(DRIVE_HOME_OFFSET,                                                                           \
      "after homing axis %w is at %v %u: change home_offset_is_position for this drive")           \
    X(DRIVE_RANGE, "%v %u is beyond the position range of the drive of axis %w")                   \
    X(DRIVE_UNREACHABLE, "the bus refuses frames for the drive of axis %w")                        \
    X(IO_STOP, "the stop input, %w, is open")                                                      \
    X(IO_LIMIT, "the limit input, %w, has opened")                                                 \
    X(IO_ABSENT, "I/O %w has not booted within %v s")                                              \
    X(IO_TYPE, "I/O %w is no CiA 401 node: the device type, object 1000, is %x")                   \
    X(IO_REFUSES, "I/O %w refuses with abort code %x: %m")                                         \
    X(IO_UNANSWERED, "I/O %w does not answer within %v ms")                                        \
    X(IO_UNMAPPED, "I/O %w is %x: what is wired is not in the first PDOs of the node")             \
    X(IO_SILENT, "I/O %w has sent no inputs for %v ms")                                            \
    X(IO_HEARTBEAT, "I/O %w has sent no heartbeat for %v ms")                                      \
    X(IO_LEFT, "I/O %w is not operational any more, but %m")                                       \
    X(IO_FAULT, "I/O %w reports %x: %m")                                                           \
    X(CYCLE_SLOW,                                                                                  \
      "the control cycle of %v Hz is below the %l Hz the axes need: curves are driven slower")     \
    X(STEP_RATE, "axis %w would need %v steps/s, more than its step drive takes")                  \
    X(STEP_PORT, "the step output has no room for the pulses of a cycle")                          \
    X(BUS_OVERLOAD, "the bus cannot carry a cycle: it takes %w at worst, %v percent")              \
    /* operator and spindle */                                                                     \
    X(EMERGENCY_STOP, "emergency stop")                                                            \
    X(BUS_LOST, "the bus %w is gone")                                                              \
    X(ENDED, "the end")                                                                            \
    X(HOMING_STOPPED, "homing was stopped: the positions of the axes are not known")               \
    X(PANEL_SILENT, "the panel in control has been silent for %v ms")                              \
    X(SPINDLE_SILENT, "the spindle drive does not answer")                                         \
    X(SPINDLE_TRIPPED, "the spindle drive has switched off")                                       \
    X(THREAD_WAITS, "a thread waits for the spindle: it has not turned as commanded for %v s")     \
    X(THREAD_STOPPED, "the spindle has stopped in a thread")                                       \
    X(THREAD_FAST, "pitch times speed of the spindle is %v mm/s, and the axes can do %l mm/s")     \
    X(THREAD_LAG, "the thread is %v mm off the spindle's angle, more than the allowed %l mm")      \
    X(TAP_DEEP, "the spindle does not turn back in time: the tap would go %v mm below the bottom") \
    X(THREAD_SHORT, "the thread is %v mm long; the lead-in and stopping take %l mm")               \
    X(CHANGES_AHEAD,                                                                               \
      "more than %v offsets were read ahead of where it was given up: check those in force")       \
    X(PROGRAM_STARVED, "the program did not arrive fast enough: the axes had to wait for it")      \
    X(PLAN_DAMAGED, "the compiled program is damaged")                                             \
    X(PLAN_STRAYED, "the compiled program does not match the part program")                        \
    X(PLAN_FOREIGN, "this is no compiled program")                                                 \
    X(PLAN_VERSION, "the program was compiled by another version of takt")                         \
    X(PLAN_MACHINE, "it was compiled for another machine: %w is %v there and %l here")             \
    X(PLAN_PROGRAM, "it was compiled from another program than the one loaded")                    \
    /* machine as a whole, and how it is stored */                                                 \
    X(MACHINE_NO_AXIS, "the machine has no axis")                                                  \
    X(MACHINE_TRAVEL, "axis %w: its travel ends before it begins")                                 \
    X(MACHINE_TRAVEL_ZERO, "axis %w: its travel must include 0, where the drives start")           \
    X(MACHINE_INCREMENTS,                                                                          \
      "axis %w: at increments_per_mm %v its travel does not fit a drive's 32 bits")                \
    X(MACHINE_ACCELERATION,                                                                        \
      "axis %w: max_acceleration is too low for so short a cycle: at least %v")                    \
    X(MACHINE_JERK, "axis %w: max_jerk is too low for so short a cycle: at least %v")              \
    X(MACHINE_STEP_RATE,                                                                           \
      "axis %w: at max_velocity its steps come at %v Hz, above its step_rate_max_hz of %l")        \
    X(MACHINE_STEPS, "axis %w: its travel does not fit 32 bits of steps")                          \
    X(MACHINE_HOME,                                                                                \
      "axis %w: its home_offset_mm does not fit a drive's 32 bits (home_offset_deg when rotary)")  \
    X(MACHINE_HOME_METHOD,                                                                         \
      "axis %w: home_method is 1 ... 37, or below 0 a method of the drive's maker")                \
    X(MACHINE_NODES, "axes %w have the same drive_node %v")                                        \
    X(MACHINE_CONTROLLER_NODE, "controller_node %v is the drive_node of axis %w")                  \
    X(MACHINE_IO, "%w is wired wrongly, or has no node before it: the first is io 1")              \
    X(MACHINE_IO_NODE, "%w: another node on the bus has its id %v")                                \
    X(MACHINE_GANTRY,                                                                              \
      "a gantry needs X, Y or Z on CAN, a free node, skew_max_mm, no gap; %v drives at most")      \
    X(MACHINE_GANTRY_HOME,                                                                         \
      "gantry of axis %w: a maker's home_method and a reversed motor need one in [gantry], too")   \
    X(MACHINE_FORM, "'%w' of this machine is for comparison: this image has only its default")     \
    X(MACHINE_FD, "data_bitrate %v: this image has classical CAN alone, so it must be 0")          \
    X(MACHINE_BUS, "CAN bus %v: the buses of this build are 0 ... %l")                             \
    X(MACHINE_DATA_RATE, "data_bitrate %v is below bitrate: data of CAN FD are as fast at least")  \
    X(SETTINGS_ABSENT, "no settings are stored: make them with takt machine --pack and load them") \
    X(SETTINGS_KIND, "these are no settings of this version")                                      \
    X(SETTINGS_CHECKSUM, "the settings are damaged: their checksum is wrong")                      \
    X(SETTINGS_SHAPE, "the settings are damaged in record %v")                                     \
    X(SETTINGS_UNKNOWN, "the settings hold record %v, which this version does not know")           \
    X(SETTINGS_VALUE, "setting %w is out of range: %v")                                            \
    X(SETTINGS_TABLE, "a stored correction table is wrong: %m")                                    \
    X(SETTINGS_SHARE, "corrections would take %v percent of what axis %w can do: at most %l")      \
    /* image of a target */                                                                        \
    X(IMAGE_DAMAGED, "the image in the flash memory is damaged: its checksum is %x")               \
    X(CAN_ABSENT, "the CAN controller does not answer")                                            \
    X(CAN_RATE, "the CAN controller cannot make %v bit/s")                                         \
    X(CAN_BUS, "the CAN bus is not idle: is there a transceiver, and is nothing shorted?")         \
    X(CRYSTAL_ABSENT, "the crystal does not oscillate, and without it the CAN bus has no rate")    \
    X(STEP_CYCLE, "step drives need a cycle of at most %v us, in steps of 5 us")                   \
    X(WATCHDOG_RESET, "the watchdog had to restart the controller")                                \
    X(CRASHED, "the controller had to stop and restart: %m at %x")                                 \
    X(INVARIANT_BROKEN, "the controller had to stop and restart: invariant broken in %w, line %v")

#define TAKT_ERROR_INDEX(name, text) TAKT_ERROR_INDEX_##name,
enum takt_error_index { TAKT_ERRORS(TAKT_ERROR_INDEX) TAKT_ERROR_TOTAL };
#undef TAKT_ERROR_INDEX

#define TAKT_ERROR_NUMBER(name, text) TAKT_ERROR_##name = -1 - (int)TAKT_ERROR_INDEX_##name,
enum takt_error { TAKT_OK = 0, TAKT_ERRORS(TAKT_ERROR_NUMBER) };
#undef TAKT_ERROR_NUMBER

#define DIAGNOSTIC_WORD_MAX 31
#define DIAGNOSTIC_TEXT_MAX 200

/* What went wrong, where: enough to print FILE:LINE:COLUMN: error: TEXT. */
struct diagnostic {
    enum takt_error code;
    uint32_t line;   /* from 1; 0: not of a line */
    uint32_t column; /* from 1; 0: the whole line */
    char word[DIAGNOSTIC_WORD_MAX + 1];
    double value;
    union {                  /* by the text of the error: no text has both */
        double limit;        /* of the value; 0: none */
        const char *meaning; /* of the value, a constant; NULL: none */
    };
};

/*
 * Fills d; word may be any length and need not end in zero. It is cut to DIAGNOSTIC_WORD_MAX bytes,
 * never within a UTF-8 character, and control characters become '?'.
 */
void takt_diagnostic_set(struct diagnostic *d, enum takt_error code, uint32_t line, uint32_t column,
                         const char *word, size_t word_length, double value);

/* The same for an error whose text has a limit. */
void takt_diagnostic_set_limit(struct diagnostic *d, double limit);

/*
 * The text of d without file, line and column ("the arc's end is 0.031 mm off its circle"),
 * zero-terminated, in text[DIAGNOSTIC_TEXT_MAX]. Returns its length. A code outside the list reads
 * "error CODE".
 */
size_t takt_diagnostic_text(const struct diagnostic *d, char *text);

#endif
