/*
 * Numbers of errors and alarms as Grbl 1.1 tells them.
 */
#ifndef TAKT_CONSOLE_NUMBERS_H
#define TAKT_CONSOLE_NUMBERS_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* error:N */
enum console_error {
    CONSOLE_OK = 0,
    CONSOLE_NO_LETTER = 1,
    CONSOLE_BAD_NUMBER = 2,
    CONSOLE_UNKNOWN_COMMAND = 3, /* also: a setting that cannot be changed here */
    CONSOLE_NEGATIVE = 4,
    CONSOLE_NOT_IDLE = 8,
    CONSOLE_LOCKED = 9, /* by an alarm, a jog, another operator */
    CONSOLE_LINE_TOO_LONG = 11,
    CONSOLE_BEYOND_TRAVEL = 15,
    CONSOLE_BAD_JOG = 16,
    CONSOLE_UNSUPPORTED = 20,
    CONSOLE_CODES_CONFLICT = 21,
    CONSOLE_NO_FEED = 22,
    CONSOLE_NOT_WHOLE = 23,
    CONSOLE_WORD_SHARED = 24,
    CONSOLE_WORD_REPEATED = 25,
    CONSOLE_NO_AXIS_WORD = 26,
    CONSOLE_WORD_MISSING = 28,
    CONSOLE_G53_MODE = 30,
    CONSOLE_NO_MOTION_MODE = 31,
    CONSOLE_BAD_TARGET = 33,
    CONSOLE_BAD_RADIUS = 34,
    CONSOLE_NO_CENTRE = 35,
    CONSOLE_WORD_UNUSED = 36,
    CONSOLE_NO_TOOL = 38
};

/* ALARM:N; from 10 on as grblHAL has them. */
enum console_alarm {
    CONSOLE_ALARM_TRAVEL = 2,
    CONSOLE_ALARM_ABORTED = 3,
    CONSOLE_ALARM_PROBE_STATE = 4,
    CONSOLE_ALARM_NO_CONTACT = 5,
    CONSOLE_ALARM_HOMING = 9,
    CONSOLE_ALARM_EMERGENCY = 10,
    CONSOLE_ALARM_DRIVE = 17
};

/* Error of a line of a program that is refused. */
enum console_error takt_console_error_of(enum takt_error error);

/* Why a program has failed. */
enum console_alarm takt_console_alarm_of(enum takt_error error);

#endif
