/*
 * G10: coordinate systems and tools set by the program. L says what:
 *
 *     L2   offset of coordinate system P, R: its rotation in degrees
 *     L20  the same, such that the current position gets the coordinates of the words
 *     L1   offsets of tool P, R: its radius, I J: front and back angle, Q: orientation
 *     L10  the same, such that the current position, with the tool in use, gets the coordinates of the words
 *     L11  the same in G59.3, without G92
 *     L12  what tool P has cut, I mm in J s, for its wear
 *     L13  the set-up of the part: displaced by X Y Z, turned about X, Y, Z by I, J, K degrees; R: turn of its table
 */
#ifndef TAKT_PROGRAM_SETTING_H
#define TAKT_PROGRAM_SETTING_H

#include "program/program.h"

bool takt_setting_run(struct program *p, const struct program_code *code);

#endif
