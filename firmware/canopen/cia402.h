/*
 * Drive profile CiA 402-2: objects, and the state machine of a drive as both ends see it. The drive
 * moves from state to state (takt_cia402_next_state) and shows where it is
 * (takt_cia402_statusword); the controller reads that (takt_cia402_state) and says what it wants
 * next (takt_cia402_step_to_enabled).
 *
 *     NOT_READY -> SWITCH_ON_DISABLED -shutdown-> READY -switch on-> SWITCHED_ON -enable-> ENABLED
 *                        ^    ^                                                              |
 *                        |    +---------- disable voltage, from all four ---- QUICK_STOP <---+
 *                        +-- fault reset -- FAULT <-- FAULT_REACTION <-- any state
 */
#ifndef TAKT_CANOPEN_CIA402_H
#define TAKT_CANOPEN_CIA402_H

#include "canopen/pdo.h"

#include <stdbool.h>
#include <stdint.h>

/* Objects, as they are mapped into PDOs. */
#define CIA402_ERROR_CODE       PDO_MAPPED(0x603F, 0, 16)
#define CIA402_CONTROLWORD      PDO_MAPPED(0x6040, 0, 16)
#define CIA402_STATUSWORD       PDO_MAPPED(0x6041, 0, 16)
#define CIA402_MODE             PDO_MAPPED(0x6060, 0, 8)
#define CIA402_MODE_DISPLAY     PDO_MAPPED(0x6061, 0, 8)
#define CIA402_POSITION_ACTUAL  PDO_MAPPED(0x6064, 0, 32)
#define CIA402_FOLLOWING_WINDOW PDO_MAPPED(0x6065, 0, 32)
#define CIA402_TARGET_POSITION  PDO_MAPPED(0x607A, 0, 32)
#define CIA402_INTERPOLATION    PDO_MAPPED(0x60C1, 1, 32)
#define CIA402_FOLLOWING_ERROR  PDO_MAPPED(0x60F4, 0, 32)
#define CIA402_TARGET_VELOCITY  PDO_MAPPED(0x60FF, 0, 32)

/* Objects that are not mapped. Unit of lengths: increments; of times: s. */
#define CIA402_QUICK_STOP_OPTION    0x605A
#define CIA402_SHUTDOWN_OPTION      0x605B
#define CIA402_DISABLE_OPTION       0x605C
#define CIA402_HALT_OPTION          0x605D
#define CIA402_FAULT_OPTION         0x605E
#define CIA402_CONNECTION_OPTION    0x6007 /* what to do when the connection is lost */
#define CIA402_HOME_OFFSET          0x607C
#define CIA402_PROFILE_ACCELERATION 0x6083
#define CIA402_PROFILE_DECELERATION 0x6084
#define CIA402_ENCODER_RESOLUTION   0x608F /* 1: increments in 2: turns of the motor */
#define CIA402_GEAR_RATIO           0x6091 /* 1: turns of the motor are 2: turns of the shaft */
#define CIA402_FEED_CONSTANT        0x6092 /* 1: increments in 2: turns of the shaft */
#define CIA402_HOMING_METHOD        0x6098
#define CIA402_HOMING_SPEEDS        0x6099 /* 1: towards the switch, 2: towards the zero mark */
#define CIA402_HOMING_ACCELERATION  0x609A
#define CIA402_PROBE_FUNCTION       0x60B8
#define CIA402_PROBE_STATUS         0x60B9
#define CIA402_PROBE_RISEN          0x60BA /* touch probe 1: position at the rising edge */
#define CIA402_PROBE_FALLEN         0x60BB
#define CIA402_PROBE_2_RISEN        0x60BC
#define CIA402_PROBE_2_FALLEN       0x60BD
#define CIA402_INTERPOLATION_PERIOD 0x60C2 /* 1: value, 2: power of ten of its unit in s */
#define CIA402_SUPPORTED_MODES      0x6502 /* bit of mode n: n - 1 */

/* Option codes: brake with the quick stop's deceleration, then "switch on disabled" or "fault". */
#define CIA402_OPTION_QUICK_STOP_RAMP 2
/* Value of the connection option: quick stop. */
#define CIA402_CONNECTION_QUICK_STOP 3

/* Bits of the touch probe function, of touch probe 1; those of 2 are 8 bits higher. */
#define CIA402_PROBE_ENABLE     0x01u
#define CIA402_PROBE_CONTINUOUS 0x02u /* every edge; else the first after it has been enabled */
#define CIA402_PROBE_AT_INDEX   0x04u /* the encoder's index pulse; else the probe input */
#define CIA402_PROBE_AT_RISE    0x10u
#define CIA402_PROBE_AT_FALL    0x20u
/* And of its status. */
#define CIA402_PROBE_IS_ENABLED 0x01u
#define CIA402_PROBE_HAS_RISEN  0x02u
#define CIA402_PROBE_HAS_FALLEN 0x04u

#define CIA402_MODE_NONE                  0
#define CIA402_MODE_PROFILE_POSITION      1
#define CIA402_MODE_PROFILE_VELOCITY      3
#define CIA402_MODE_PROFILE_TORQUE        4
#define CIA402_MODE_HOMING                6
#define CIA402_MODE_INTERPOLATED_POSITION 7
#define CIA402_MODE_CYCLIC_SYNC_POSITION  8
#define CIA402_MODE_CYCLIC_SYNC_VELOCITY  9
#define CIA402_MODE_CYCLIC_SYNC_TORQUE    10

/* Its targets are velocities. */
static inline bool cia402_is_velocity(unsigned mode)
{
    return mode == CIA402_MODE_CYCLIC_SYNC_VELOCITY || mode == CIA402_MODE_PROFILE_VELOCITY;
}

enum cia402_state {
    CIA402_NOT_READY,
    CIA402_SWITCH_ON_DISABLED,
    CIA402_READY,
    CIA402_SWITCHED_ON,
    CIA402_ENABLED,
    CIA402_QUICK_STOP,
    CIA402_FAULT_REACTION,
    CIA402_FAULT
};

/* Controlwords of the commands. */
#define CIA402_DISABLE_VOLTAGE  0x0000
#define CIA402_QUICK_STOP_NOW   0x0002 /* bit 2 clear is the command */
#define CIA402_SHUTDOWN         0x0006
#define CIA402_SWITCH_ON        0x0007
#define CIA402_ENABLE_OPERATION 0x000F
#define CIA402_FAULT_RESET      0x0080 /* acts when bit 7 rises */
/* beside ENABLE_OPERATION, in homing mode: acts when it rises */
#define CIA402_START_HOMING 0x0010
/* the same in interpolated position mode: targets are followed */
#define CIA402_INTERPOLATE 0x0010

/* Bits of the statusword beside the state. */
#define CIA402_VOLTAGE_ENABLED  0x0010
#define CIA402_REMOTE           0x0200
#define CIA402_FOLLOWS_TARGET   0x1000 /* cyclic synchronous modes: the target is being followed */
#define CIA402_FOLLOWING_FAILED 0x2000
#define CIA402_TARGET_REACHED   0x0400 /* homing: idle or done, see also HOMING_ATTAINED */
#define CIA402_INTERPOLATES     0x1000 /* interpolated position mode only */
#define CIA402_HOMING_ATTAINED  0x1000 /* homing mode only */
#define CIA402_HOMING_ERROR     0x2000 /* homing mode only */

/* State that a statusword shows. A pattern CiA 402 does not define reads as CIA402_NOT_READY. */
enum cia402_state takt_cia402_state(uint16_t statusword);

/* takt_cia402_state(statusword) == CIA402_ENABLED, for every drive in every cycle. */
static inline bool cia402_is_enabled(uint16_t statusword)
{
    return (statusword & 0x6F) == 0x27;
}

/* The state's name, "switched on". */
const char *takt_cia402_state_text(enum cia402_state state);

/* The statusword's state bits (mask 0x6F). */
uint16_t takt_cia402_statusword(enum cia402_state state);

/*
 * State of a drive after a controlword; previous: the controlword before, for the rising edge of
 * fault reset.
 */
enum cia402_state takt_cia402_next_state(enum cia402_state state, uint16_t controlword,
                                         uint16_t previous);

/*
 * Controlword that brings a drive one step nearer to CIA402_ENABLED. From FAULT it is fault reset:
 * a step of its own, since the bit must have been clear before.
 */
uint16_t takt_cia402_step_to_enabled(enum cia402_state state);

#endif
