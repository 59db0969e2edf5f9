/*
 * The operator's panel as a table: every register once, with number, name, unit, scale, access and
 * the states in which it may be written. The server, its documentation (registers.md,
 * registers.csv) and `takt panel` all read it.
 *
 * To add a register: a row in PANEL_REGISTERS, in the order of table and address, and if it is set
 * a line in service/service_state.h; then `takt panel table` writes the documentation again.
 */
#ifndef TAKT_PANEL_REGISTERS_H
#define TAKT_PANEL_REGISTERS_H

#include "modbus/modbus.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Raised when a register changes its meaning; added ones do not raise it. */
#define PANEL_TABLE_VERSION 1

/* Bytes. The mailbox of an upload is one request of function 16 long. */
#define PANEL_CHUNK_MAX      238
#define PANEL_MDI_MAX        240
#define PANEL_ALARM_TEXT_MAX 200

/* What the controller does, register STATE. */
enum panel_state {
    PANEL_STARTING, /* the drives are being enabled */
    PANEL_IDLE,     /* ready, at rest */
    PANEL_RUNNING,  /* a program */
    PANEL_MDI,      /* a line from the panel */
    PANEL_JOGGING,  /* an axis, by hand */
    PANEL_HOMING,   /* all axes to machine zero */
    PANEL_HELD, /* a program or line, at rest on its path or coming to it; HOLD_REASON says why */
    PANEL_STOPPING,  /* coming to rest before what runs is given up */
    PANEL_ALARM,     /* a program or a drive has failed; ALARM says what. RESET leads out of it */
    PANEL_EMERGENCY, /* stopped at once. EMERGENCY_STOP 0, then RESET lead out of it */
    PANEL_STATES
};

/* Register MODE: what the start coils may start. */
enum panel_mode { PANEL_MODE_PROGRAM, PANEL_MODE_MDI, PANEL_MODE_JOG };

/* Register HOLD_REASON. */
enum panel_hold {
    PANEL_HOLD_NONE,
    PANEL_HOLD_OPERATOR,     /* FEED_HOLD */
    PANEL_HOLD_SINGLE_BLOCK, /* the block has ended */
    PANEL_HOLD_PROGRAM,      /* M0, or M1 with OPTIONAL_STOP */
    PANEL_HOLD_SPINDLE,      /* the spindle drive has tripped or is silent; an alarm stands */
    PANEL_HOLD_PANEL         /* the panel in control is silent; an alarm stands */
};

/* Register ALARM. */
enum panel_alarm {
    PANEL_ALARM_NONE,
    PANEL_ALARM_PROGRAM,
    PANEL_ALARM_DRIVE,
    PANEL_ALARM_SPINDLE,
    PANEL_ALARM_PANEL,
    PANEL_ALARM_EMERGENCY,
    PANEL_ALARM_INTERNAL,
    PANEL_ALARM_STARVED
};

/* Register OUTCOME: of the last program or line. */
enum panel_outcome {
    PANEL_OUTCOME_NONE,
    PANEL_OUTCOME_COMPLETED,
    PANEL_OUTCOME_ABORTED,
    PANEL_OUTCOME_FAILED
};

/* Register OVERRIDE_REASON: what the effective override differs for. */
enum panel_override_reason {
    PANEL_OVERRIDE_FOLLOWS, /* it is what is asked for, or on its way there */
    PANEL_OVERRIDE_HELD,
    PANEL_OVERRIDE_LOCKED,
    PANEL_OVERRIDE_LIMITED
};

/* Register UPLOAD_COMMAND. */
enum panel_upload_command {
    PANEL_UPLOAD_BEGIN = 1,
    PANEL_UPLOAD_COMMIT = 2,
    PANEL_UPLOAD_ABANDON = 3,
    PANEL_UPLOAD_STREAM = 4
};

/* Register UPLOAD_KIND. */
enum panel_upload_kind { PANEL_UPLOAD_PROGRAM, PANEL_UPLOAD_SETTINGS, PANEL_UPLOAD_PLAN };

/* Register UPLOAD_STATE. */
enum panel_upload_state { PANEL_UPLOAD_NONE, PANEL_UPLOAD_OPEN, PANEL_UPLOAD_WHOLE };

/* Register REFUSAL: why the last refused write of this client was refused. */
enum panel_refusal {
    PANEL_REFUSAL_NONE,
    PANEL_REFUSAL_STATE,   /* not in this state */
    PANEL_REFUSAL_LOCKED,  /* PASSWORD first */
    PANEL_REFUSAL_CONTROL, /* another panel has claimed control */
    PANEL_REFUSAL_VALUE,
    PANEL_REFUSAL_ADDRESS,
    PANEL_REFUSAL_BUSY
};

/* Register CONTROL. */
enum panel_control { PANEL_CONTROL_FREE, PANEL_CONTROL_MINE, PANEL_CONTROL_OTHER };

enum panel_form {
    PANEL_BIT,
    PANEL_U16,
    PANEL_U32, /* 32 bits: the high word first, written whole */
    PANEL_S32,
    /* two characters a word, the first in its high byte; ends with a zero or the last */
    PANEL_TEXT,
    PANEL_BYTES /* two bytes a word */
};

/* States as a set: bit i is state i. */
#define PANEL_IN(state)   (1U << (state))
#define PANEL_ANY         ((1U << PANEL_STATES) - 1U)
#define PANEL_NEVER       0U
#define PANEL_WHEN_IDLE   PANEL_IN(PANEL_IDLE)
#define PANEL_WHEN_HELD   PANEL_IN(PANEL_HELD)
#define PANEL_WHEN_WORK   (PANEL_WHEN_HELD | PANEL_IN(PANEL_RUNNING) | PANEL_IN(PANEL_MDI))
#define PANEL_WHEN_JOG    (PANEL_IN(PANEL_IDLE) | PANEL_IN(PANEL_JOGGING))
#define PANEL_WHEN_OUT    (PANEL_ANY & ~PANEL_IN(PANEL_EMERGENCY)) /* the button is */
#define PANEL_WHEN_MOTION (PANEL_WHEN_IDLE | PANEL_WHEN_HELD)

#define PANEL_U16_MOST 65535
#define PANEL_U32_MOST 4294967295
#define PANEL_S32_MOST 2147483647

/* Largest program an upload may bring, bytes. */
#define PANEL_PROGRAM_BYTES_MAX 16777216

/*
 * ROW(id, table, address, form, words, unit, decimals, least, most, states, meaning)
 *
 * One count is 10^-decimals units. states: in which it may be written; PANEL_NEVER: read only. AXIS
 * rows stand for six, of X Y Z A B C in this order; of rotary axes read deg for mm.
 */
#define PANEL_AXIS_ROWS(ROW, id, table, address, form, words, unit, decimals, least, most, states, \
                        meaning)                                                                   \
    ROW(id##_X, table, address, form, words, unit, decimals, least, most, states, meaning)         \
    ROW(id##_Y, table, (address) + (words), form, words, unit, decimals, least, most, states,      \
        meaning)                                                                                   \
    ROW(id##_Z, table, (address) + 2 * (words), form, words, unit, decimals, least, most, states,  \
        meaning)                                                                                   \
    ROW(id##_A, table, (address) + 3 * (words), form, words, unit, decimals, least, most, states,  \
        meaning)                                                                                   \
    ROW(id##_B, table, (address) + 4 * (words), form, words, unit, decimals, least, most, states,  \
        meaning)                                                                                   \
    ROW(id##_C, table, (address) + 5 * (words), form, words, unit, decimals, least, most, states,  \
        meaning)

/* clang-format off */
#define PANEL_COIL(ROW, id, address, states, meaning) \
    ROW(id, MODBUS_COILS, address, PANEL_BIT, 1, "", 0, 0, 1, states, meaning)
#define PANEL_SET16(ROW, id, address, unit, decimals, least, most, states, meaning) \
    ROW(id, MODBUS_HOLDINGS, address, PANEL_U16, 1, unit, decimals, least, most, states, meaning)
#define PANEL_SHOW16(ROW, id, address, unit, decimals, meaning) \
    ROW(id, MODBUS_INPUTS, address, PANEL_U16, 1, unit, decimals, 0, PANEL_U16_MOST, PANEL_NEVER, meaning)
#define PANEL_SHOW32(ROW, id, address, unit, decimals, meaning) \
    ROW(id, MODBUS_INPUTS, address, PANEL_U32, 2, unit, decimals, 0, PANEL_U32_MOST, PANEL_NEVER, meaning)
#define PANEL_SHOW_SIGNED(ROW, id, address, unit, decimals, meaning) \
    ROW(id, MODBUS_INPUTS, address, PANEL_S32, 2, unit, decimals, -PANEL_S32_MOST, PANEL_S32_MOST, PANEL_NEVER, meaning)
#define PANEL_SHOW_AXES(ROW, id, address, unit, meaning) \
    PANEL_AXIS_ROWS(ROW, id, MODBUS_INPUTS, address, PANEL_S32, 2, unit, 3, -PANEL_S32_MOST, PANEL_S32_MOST, \
                    PANEL_NEVER, meaning)
#define PANEL_SET_AXES(ROW, id, address, unit, meaning) \
    PANEL_AXIS_ROWS(ROW, id, MODBUS_HOLDINGS, address, PANEL_S32, 2, unit, 3, -PANEL_S32_MOST, PANEL_S32_MOST, \
                    PANEL_WHEN_IDLE, meaning)

#define PANEL_SET_SETUP(ROW, id, address, unit, most, meaning) \
    ROW(id, MODBUS_HOLDINGS, address, PANEL_S32, 2, unit, 4, -(most), most, PANEL_WHEN_IDLE, meaning)
#define SETUP_TURN_MOST 3600000

#define PANEL_COILS(ROW) \
    PANEL_COIL(ROW, CYCLE_START, 0, PANEL_WHEN_MOTION, \
        "1: starts the program (MODE 0), or continues after a hold. Reads 1 while a program runs") \
    PANEL_COIL(ROW, FEED_HOLD, 1, PANEL_ANY, \
        "1: stops on the path and holds, where M53 P0 forbids that as soon as it may; anyone may. Reads 1 until RESUME. 0: no effect") \
    PANEL_COIL(ROW, RESUME, 2, PANEL_WHEN_HELD, "1: continues after a hold. Reads 0") \
    PANEL_COIL(ROW, SINGLE_BLOCK, 3, PANEL_ANY, \
               "1: each motion of a program or a line ends in a hold, the last and the current one too, that if there is room to brake") \
    PANEL_COIL(ROW, OPTIONAL_STOP, 4, PANEL_ANY, "1: M1 stops as M0 does") \
    PANEL_COIL(ROW, BLOCK_DELETE, 5, PANEL_WHEN_IDLE, "1: lines that begin with / are skipped") \
    PANEL_COIL(ROW, RESET, 6, PANEL_WHEN_OUT, \
        "1: gives up what runs, after coming to rest; acknowledges alarms; enables drives again. Not while drives brake. Reads 0") \
    PANEL_COIL(ROW, EMERGENCY_STOP, 7, PANEL_ANY, \
        "1: quick stop of all drives, spindle off; anyone may. 0: releases it, then RESET continues") \
    PANEL_COIL(ROW, ACKNOWLEDGE, 8, PANEL_ANY, \
        "1: the operator has seen the alarm; a held program may then be resumed. Reads 0") \
    PANEL_COIL(ROW, MDI_START, 9, PANEL_WHEN_IDLE, "1: runs MDI_TEXT (MODE 1), with the modes of the last line; after a program or RESET with the initial ones. Reads 1 while it runs") \
    PANEL_COIL(ROW, JOG_PLUS, 10, PANEL_WHEN_JOG, \
        "1: moves JOG_AXIS upwards (MODE 2), by JOG_DISTANCE or until 0 is written") \
    PANEL_COIL(ROW, JOG_MINUS, 11, PANEL_WHEN_JOG, "1: the same downwards") \
    PANEL_COIL(ROW, HOME, 12, PANEL_WHEN_IDLE, \
        "1: axes with a home_order find their homes again, then all move to machine zero, Z first (MODE 2)") \
    PANEL_COIL(ROW, CORRECTION_MATRIX, 16, PANEL_ANY, "1: this layer of the position correction is on") \
    PANEL_COIL(ROW, CORRECTION_SETUP, 17, PANEL_ANY, "1: likewise, set-up") \
    PANEL_COIL(ROW, CORRECTION_AXIS_TABLES, 18, PANEL_ANY, "1: likewise, axis tables") \
    PANEL_COIL(ROW, CORRECTION_VOLUME, 19, PANEL_ANY, "1: likewise, volume table") \
    PANEL_COIL(ROW, CORRECTION_THERMAL, 20, PANEL_ANY, "1: likewise, thermal growth") \
    PANEL_COIL(ROW, CORRECTION_WEAR, 21, PANEL_ANY, "1: likewise, tool wear and length") \
    PANEL_COIL(ROW, FLOOD, 22, PANEL_WHEN_OUT, "1: flood coolant on, 0: off, until the program says otherwise") \
    PANEL_COIL(ROW, MIST, 23, PANEL_WHEN_OUT, "1: mist coolant likewise") \
    PANEL_COIL(ROW, SPINDLE_STOP, 24, PANEL_WHEN_WORK, \
        "1: with or after FEED_HOLD: the spindle stands from when the axes rest; 0 and at speed again, before RESUME") \
    PANEL_COIL(ROW, SETUP_TAKE, 25, PANEL_WHEN_IDLE, \
        "1: the part is set up as SETUP_X ... SETUP_TABLE say, as by G10 L13; more than correction has reserved of the axes is an alarm, and changes nothing. Reads 0")

#define PANEL_INPUT_ROWS(ROW) \
    PANEL_SHOW16(ROW, VERSION, 0, "", 0, "of this table") \
    PANEL_SHOW16(ROW, STATE, 1, "", 0, \
        "0 starting, 1 idle, 2 running, 3 MDI, 4 jogging, 5 homing, 6 held, 7 stopping, 8 alarm, 9 emergency stop") \
    PANEL_SHOW16(ROW, HOLD_REASON, 2, "", 0, \
        "0 none, 1 operator, 2 single block, 3 program stop, 4 spindle drive, 5 panel silent") \
    PANEL_SHOW16(ROW, ALARM, 3, "", 0, \
        "0 none, 1 program, 2 drive, 3 spindle, 4 panel silent, 5 emergency stop, 6 internal, 7 program starved; ALARM_TEXT says more") \
    PANEL_SHOW32(ROW, ALARM_LINE, 4, "", 0, "line of the program it is about; 0: none") \
    PANEL_SHOW32(ROW, ACTIVE_LINE, 6, "", 0, "line of the program being executed") \
    PANEL_SHOW32(ROW, BLOCK, 8, "", 0, "motion being executed, from 1") \
    PANEL_SHOW_SIGNED(ROW, FEED, 10, "mm/min", 1, "along the path") \
    PANEL_SHOW16(ROW, OVERRIDE_EFFECTIVE, 12, "%", 1, "feed override in effect") \
    PANEL_SHOW16(ROW, OVERRIDE_REASON, 13, "", 0, \
        "why it is not FEED_OVERRIDE: 0 it is or follows, 1 held, 2 locked by the program, 3 limited") \
    PANEL_SHOW16(ROW, LIMITER, 14, "", 4, "axis velocity limiter K; 1: not acting") \
    PANEL_SHOW16(ROW, AXES, 15, "", 0, "bit i: there is axis i of X Y Z A B C") \
    PANEL_SHOW_SIGNED(ROW, SPINDLE_COMMANDED, 16, "rpm", 1, "positive clockwise; with SPINDLE_OVERRIDE") \
    PANEL_SHOW_SIGNED(ROW, SPINDLE_SPEED, 18, "rpm", 1, "measured") \
    PANEL_SHOW16(ROW, SPINDLE_LOAD, 20, "%", 1, "of rated torque") \
    PANEL_SHOW16(ROW, SPINDLE_STATUS, 21, "", 0, "bit 0 at speed, bit 1 tripped, bit 2 silent") \
    PANEL_SHOW32(ROW, TOOL, 22, "", 0, "in the spindle") \
    PANEL_SHOW16(ROW, COOLANT, 24, "", 0, "bit 0 mist, bit 1 flood") \
    PANEL_SHOW16(ROW, BUS_LOAD, 25, "%", 1, "of the drives' bus") \
    PANEL_SHOW32(ROW, CYCLE_MIN, 26, "us", 3, "duration of the control cycle: shortest") \
    PANEL_SHOW32(ROW, CYCLE_MEAN, 28, "us", 3, "mean") \
    PANEL_SHOW32(ROW, CYCLE_MAX, 30, "us", 3, "longest") \
    PANEL_SHOW32(ROW, CYCLES, 32, "", 0, "control cycles since power-on; wraps") \
    PANEL_SHOW32(ROW, OVERRUNS, 34, "", 0, "cycles that began later than the next one was due") \
    PANEL_SHOW16(ROW, REFUSAL, 36, "", 0, \
        "why this client's last write was refused: 1 state, 2 locked, 3 another panel in control, 4 value, 5 address, 6 busy") \
    PANEL_SHOW16(ROW, UPLOAD_STATE, 37, "", 0, "0 none, 1 open, 2 all bytes are there") \
    PANEL_SHOW32(ROW, UPLOAD_RECEIVED, 38, "byte", 0, "bytes received: continue from here") \
    PANEL_SHOW32(ROW, PROGRAM_SIZE, 40, "byte", 0, "size of the program that CYCLE_START starts; 0: none") \
    PANEL_SHOW32(ROW, PROGRAM_CRC, 42, "", 0, "CRC-32 of that program") \
    PANEL_SHOW32(ROW, PROGRAM_MAX, 44, "byte", 0, "largest program") \
    PANEL_SHOW16(ROW, OUTCOME, 46, "", 0, "of the last program or line: 0 none yet, 1 completed, 2 aborted, 3 failed") \
    PANEL_SHOW16(ROW, RUNS, 47, "", 0, "programs, lines, jogs and homings ended so far; wraps") \
    PANEL_SHOW32(ROW, DIGITAL_OUTPUTS, 48, "", 0, "bit i: output i") \
    PANEL_SHOW16(ROW, CONTROL, 50, "", 0, "0 no panel has claimed it, 1 this client has, 2 another") \
    PANEL_SHOW16(ROW, SYSTEM, 51, "", 0, "coordinate system of the line read last: 1 G54 ... 9 G59.3") \
    PANEL_SHOW32(ROW, DIGEST_HIGH, 52, "", 0, "FNV-1a 64 of all setpoints of the program so far: upper half") \
    PANEL_SHOW32(ROW, DIGEST_LOW, 54, "", 0, "lower half") \
    PANEL_SHOW32(ROW, UPLOAD_ROOM, 56, "byte", 0, "that can be handed in now") \
    PANEL_SHOW16(ROW, HOMED, 58, "", 0, "bit i: axis i knows its home, or needs none") \
    PANEL_SHOW_AXES(ROW, POSITION, 60, "mm", "setpoint, machine coordinates, without correction") \
    PANEL_SHOW_AXES(ROW, ACTUAL, 72, "mm", "position its drive reports") \
    PANEL_SHOW_AXES(ROW, FOLLOWING, 84, "mm", "setpoint minus the position reported for it") \
    PANEL_AXIS_ROWS(ROW, DRIVE_STATUS, MODBUS_INPUTS, 96, PANEL_U16, 1, "", 0, 0, PANEL_U16_MOST, PANEL_NEVER, \
        "statusword of its drive (CiA 402, 6041)") \
    PANEL_SHOW32(ROW, MODES, 102, "", 0, \
        "of the line read last: bits 0-1 plane (0 G17, 1 G18, 2 G19), 2 G91, 3 G20, 4-5 path (0 G61, 1 G61.1, 2 G64), 6-7 cutter (0 G40, 1 G41, 2 G42), 8 G93, 9 G95, 10 G98, 11 G96, 12 G7; 16-31 motion: 10 is G1, 382 G38.2, 800 none") \
    PANEL_SHOW_AXES(ROW, WORK_POSITION, 104, "mm", "setpoint in work coordinates: offsets, rotation and tool taken off") \
    PANEL_SHOW_AXES(ROW, DISTANCE_TO_GO, 116, "mm", "from the setpoint to the end of the motion being executed") \
    PANEL_SHOW_AXES(ROW, AXIS_FEED, 128, "mm/min", "velocity of the setpoint") \
    PANEL_SHOW32(ROW, CUT_LINE, 140, "", 0, "line of the program that runs, or at which the last one was cut short, by a power cut too; 0: it came to its end") \
    PANEL_SHOW32(ROW, DRIVES_GIVEN_UP, 142, "", 0, "bit i: what a drive does not have and is driven without, enum drives_given_up (firmware/drive)") \
    PANEL_SHOW16(ROW, PROBE, 144, "", 0, "1: the probe has contact") \
    ROW(ALARM_TEXT, MODBUS_INPUTS, 200, PANEL_TEXT, PANEL_ALARM_TEXT_MAX / 2, "", 0, 0, 0, PANEL_NEVER, \
        "what is wrong, as text") \
    ROW(UPLOAD_TEXT, MODBUS_INPUTS, 300, PANEL_TEXT, PANEL_ALARM_TEXT_MAX / 2, "", 0, 0, 0, PANEL_NEVER, \
        "why the last upload of settings or of a compiled program was refused, as text; empty: it was not")

#define PANEL_HOLDING_ROWS(ROW) \
    PANEL_SET16(ROW, FEED_OVERRIDE, 0, "%", 1, 0, 1200, PANEL_ANY, "%F") \
    PANEL_SET16(ROW, RAPID_OVERRIDE, 1, "%", 1, 0, 1000, PANEL_ANY, "of rapid moves") \
    PANEL_SET16(ROW, SPINDLE_OVERRIDE, 2, "%", 1, 500, 1500, PANEL_ANY, "%S") \
    PANEL_SET16(ROW, MODE, 3, "", 0, 0, 2, PANEL_WHEN_IDLE, "0 program, 1 MDI, 2 jog") \
    PANEL_SET16(ROW, JOG_AXIS, 4, "", 0, 0, 5, PANEL_ANY, "0 ... 5: X Y Z A B C") \
    PANEL_SET16(ROW, JOG_FEED, 5, "mm/min", 0, 1, PANEL_U16_MOST, PANEL_ANY, "of jogging; deg/min for rotary axes") \
    ROW(JOG_DISTANCE, MODBUS_HOLDINGS, 6, PANEL_S32, 2, "mm", 3, 0, PANEL_S32_MOST, PANEL_ANY, \
        "0: as long as the coil is 1") \
    PANEL_SET16(ROW, WORK_SYSTEM, 8, "", 0, 1, 9, PANEL_ANY, "whose WORK_OFFSET is shown: 1 G54 ... 9 G59.3") \
    PANEL_SET16(ROW, TOOL_SELECT, 9, "", 0, 0, PANEL_U16_MOST, PANEL_ANY, \
        "whose TOOL_OFFSET and TOOL_DIAMETER are shown") \
    PANEL_SET_AXES(ROW, WORK_OFFSET, 10, "mm", "offset of the system selected by WORK_SYSTEM") \
    PANEL_SET_AXES(ROW, TOOL_OFFSET, 22, "mm", "offset of the tool selected by TOOL_SELECT; its length is Z") \
    ROW(TOOL_DIAMETER, MODBUS_HOLDINGS, 34, PANEL_S32, 2, "mm", 3, 0, PANEL_S32_MOST, PANEL_WHEN_IDLE, \
        "diameter of the tool selected by TOOL_SELECT") \
    PANEL_SET16(ROW, WATCHDOG, 36, "ms", 0, 0, 60000, PANEL_ANY, \
        "not 0: this client claims control and must send a request at least this often, else the feed is held. 0: gives it up") \
    ROW(PASSWORD, MODBUS_HOLDINGS, 37, PANEL_U32, 2, "", 0, 0, PANEL_U32_MOST, PANEL_ANY, \
        "the right one lets this client write. Reads 0") \
    ROW(START_LINE, MODBUS_HOLDINGS, 40, PANEL_U32, 2, "", 0, 0, PANEL_U32_MOST, PANEL_WHEN_IDLE, \
        "the next CYCLE_START starts the program at this line, by a safe way; 0, and after it: at its beginning") \
    ROW(TOOL_WEAR_LENGTH, MODBUS_HOLDINGS, 42, PANEL_U32, 2, "mm", 0, 0, PANEL_U32_MOST, PANEL_WHEN_IDLE, \
        "that the tool selected by TOOL_SELECT has cut since it was new; 0 resets it") \
    ROW(TOOL_WEAR_TIME, MODBUS_HOLDINGS, 44, PANEL_U32, 2, "s", 0, 0, PANEL_U32_MOST, PANEL_WHEN_IDLE, \
        "likewise, how long") \
    ROW(UPLOAD_SIZE, MODBUS_HOLDINGS, 50, PANEL_U32, 2, "byte", 0, 1, PANEL_PROGRAM_BYTES_MAX, PANEL_ANY, \
        "of the program to come") \
    ROW(UPLOAD_CRC, MODBUS_HOLDINGS, 52, PANEL_U32, 2, "", 0, 0, PANEL_U32_MOST, PANEL_ANY, \
        "CRC-32 (ISO 3309) of the program to come") \
    PANEL_SET16(ROW, UPLOAD_COMMAND, 54, "", 0, 1, 4, PANEL_ANY, \
        "1 begin, or go on with an open upload of the same size and CRC; 2 commit (when idle); 3 abandon; 4 begin, and CYCLE_START runs it while it comes (when idle). Reads 0") \
    PANEL_SET16(ROW, UPLOAD_KIND, 55, "", 0, 0, 2, PANEL_ANY, \
        "what the next upload brings: 0 a program, 1 settings of `takt machine --pack`, which are taken while the drives are off (emergency stop) and count from the next start on, 2 what `takt compile` has made of the program that is there, which takes UPLOAD_COMMAND 4") \
    PANEL_AXIS_ROWS(ROW, RISE, MODBUS_HOLDINGS, 60, PANEL_S32, 2, "K", 3, -1000000, 1000000, PANEL_ANY, \
        "how much warmer than at calibration its sensor finds it: for the thermal layer of the correction") \
    PANEL_SET_SETUP(ROW, SETUP_X, 72, "mm", PANEL_S32_MOST, "set-up of the part, along X: as it is, and once written as SETUP_TAKE makes it") \
    PANEL_SET_SETUP(ROW, SETUP_Y, 74, "mm", PANEL_S32_MOST, "likewise, along Y") \
    PANEL_SET_SETUP(ROW, SETUP_Z, 76, "mm", PANEL_S32_MOST, "likewise, along Z") \
    PANEL_SET_SETUP(ROW, SETUP_I, 78, "deg", SETUP_TURN_MOST, "likewise, turned about X") \
    PANEL_SET_SETUP(ROW, SETUP_J, 80, "deg", SETUP_TURN_MOST, "likewise, then about Y") \
    PANEL_SET_SETUP(ROW, SETUP_K, 82, "deg", SETUP_TURN_MOST, "likewise, then about Z") \
    PANEL_SET_SETUP(ROW, SETUP_TABLE, 84, "deg", SETUP_TURN_MOST, "likewise, what the table itself turns back") \
    ROW(UPLOAD_OFFSET, MODBUS_HOLDINGS, 100, PANEL_U32, 2, "byte", 0, 0, PANEL_PROGRAM_BYTES_MAX, PANEL_ANY, \
        "of the first byte of the chunk: UPLOAD_RECEIVED, or less") \
    PANEL_SET16(ROW, UPLOAD_LENGTH, 102, "byte", 0, 1, PANEL_CHUNK_MAX, PANEL_ANY, "bytes in the chunk") \
    PANEL_SET16(ROW, UPLOAD_CHECK, 103, "", 0, 0, PANEL_U16_MOST, PANEL_ANY, \
        "CRC-16/MODBUS of the bytes in the chunk; writing it hands the chunk in. Reads 0") \
    ROW(UPLOAD_DATA, MODBUS_HOLDINGS, 104, PANEL_BYTES, PANEL_CHUNK_MAX / 2, "", 0, 0, 0, PANEL_ANY, \
        "the chunk") \
    ROW(MDI_TEXT, MODBUS_HOLDINGS, 300, PANEL_TEXT, PANEL_MDI_MAX / 2, "", 0, 0, 0, PANEL_ANY, \
        "line of a part program")
/* clang-format on */

/* All of them, by table and address. */
#define PANEL_REGISTERS(ROW)                                                                       \
    PANEL_COILS(ROW)                                                                               \
    PANEL_INPUT_ROWS(ROW)                                                                          \
    PANEL_HOLDING_ROWS(ROW)

#define PANEL_ID(id, table, address, form, words, unit, decimals, least, most, states, meaning)    \
    REGISTER_##id,
enum panel_id { PANEL_REGISTERS(PANEL_ID) REGISTER_COUNT };
#undef PANEL_ID

/* Eight bytes, since an image keeps the whole table. */
struct panel_register {
    uint16_t address; /* on the wire, from 0 */
    uint16_t range;   /* see panel_most */
    unsigned range_bits : 4;
    unsigned least : 2; /* enum panel_from */
    unsigned states : 10;
    unsigned words : 7; /* how many registers it takes */
    unsigned table : 2; /* enum modbus_table */
    unsigned form : 3;  /* enum panel_form */
    unsigned decimals : 3;
};

/* Where a range begins. */
enum panel_from { PANEL_FROM_0, PANEL_FROM_1, PANEL_FROM_500, PANEL_FROM_MINUS_MOST };

/* range 2^range_bits; range 0: as much as the form holds. */
static inline uint32_t panel_most(const struct panel_register *row)
{
    if (row->range == 0)
        return row->form == PANEL_S32 ? INT32_MAX : UINT32_MAX;
    return (uint32_t)row->range << row->range_bits;
}

int32_t takt_panel_least(const struct panel_register *row);

/* What only those ask who show the table: an image that does not is without it. */
struct panel_text {
    const char *name;
    const char *unit;
    const char *meaning;
};

extern const struct panel_register takt_panel_registers[REGISTER_COUNT];
extern const struct panel_text takt_panel_texts[REGISTER_COUNT];

static inline const struct panel_text *panel_text(const struct panel_register *row)
{
    return &takt_panel_texts[row - takt_panel_registers];
}

/* The row that has this register among its own; REGISTER_COUNT: none. */
enum panel_id takt_panel_find(enum modbus_table table, uint16_t address);

/*
 * No row has this register, but one behind it has: it reads as 0, so that rows around it may be
 * read at once.
 */
bool takt_panel_is_gap(enum modbus_table table, uint16_t address);

/* The row of that name, upper or lower case; REGISTER_COUNT: none. */
enum panel_id takt_panel_find_name(const char *name);

/* Counts of a register that make one of its units: 10^decimals. */
double takt_panel_counts_per_unit(enum panel_id id);

/* Does the table let this register be written in a state? */
bool takt_panel_may_write(enum panel_id id, enum panel_state state);

#endif
