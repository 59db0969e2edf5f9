/*
 * Coordinates: from what a word says to machine positions and back.
 *
 *     machine = T (work + axis offset (G92)) + offset of the coordinate system (G54 ...) + tool offset (G43)
 *
 * in mm and rad; T turns X and Y by the rotation of the coordinate system (G10 L2 R). The machine
 * position is what the interpreter keeps; changing an offset moves nothing.
 */
#ifndef TAKT_PROGRAM_COORDINATES_H
#define TAKT_PROGRAM_COORDINATES_H

#include "program/program.h"

/* Coordinate systems G54 ... G59.3. */
#define COORDINATES_SYSTEMS 9

/* Work coordinate of the current position, in the program's units: degrees, and mm or inch. */
double takt_coordinates_work(const struct program *p, enum axis axis);

/* The machine position, in work coordinates: mm and rad. */
void takt_coordinates_work_of(const struct program *p, const struct point *machine,
                              struct point *work);

/*
 * The machine position of work. An axis that is where it is already keeps its position to the last
 * bit.
 */
void takt_coordinates_machine_of(const struct program *p, const struct point *work,
                                 struct point *machine);

/* Turns x and y by the rotation of the coordinate system, or back. */
void takt_coordinates_turn(const struct program_turn *turn, double *x, double *y);
void takt_coordinates_turn_back(const struct program_turn *turn, double *x, double *y);

/* The rotation by so many degrees. */
void takt_coordinates_set_turn(struct program_turn *turn, double degrees);

/* Loads coordinate system 1 ... 9 from the parameters. */
void takt_coordinates_load_system(struct program *p, unsigned system);

/* Offset, or rotation, of a coordinate system as the parameters hold it; mm, rad; degrees. */
double takt_coordinates_system_offset(const struct program *p, unsigned system, enum axis axis);
double takt_coordinates_system_degrees(const struct program *p, unsigned system);

/* The letter of an axis, in lower case. */
char takt_coordinates_letter(enum axis axis);

/* The word of an axis: true and its value in mm or rad, when it is given. */
bool takt_coordinates_word(const struct program *p, enum axis axis, double *value);

/* The point that the axis words ask for; axes without a word stay where they are. */
void takt_coordinates_end(const struct program *p, struct point *end);

/* Values of parameters, mm and degrees, to and from mm and rad. */
double takt_coordinates_to_parameter(double value, enum axis axis);
double takt_coordinates_from_parameter(double value, enum axis axis);

/*
 * Takes the coordinate system and the axis offsets from the parameters, at the start of a program.
 */
void takt_coordinates_open(struct program *p);
/* The same later: other parameters are in force. */
void takt_coordinates_reload(struct program *p);

/* G54 ... G59.3; argument: 1 ... 9 */
bool takt_coordinates_select(struct program *p, const struct program_code *code);
/* G92 (argument 0), G52 (1) */
bool takt_coordinates_set_axis_offset(struct program *p, const struct program_code *code);
/* G92.1 (argument 1: parameters too) and G92.2 */
bool takt_coordinates_cancel_axis_offset(struct program *p, const struct program_code *code);
/* G92.3 */
bool takt_coordinates_restore_axis_offset(struct program *p, const struct program_code *code);
/* G43 and G49 */
bool takt_coordinates_use_tool(struct program *p, const struct program_code *code);
/* G43.1: the axis words are the tool offset. G43.2: H or the axis words add to it. */
bool takt_coordinates_set_tool_offset(struct program *p, const struct program_code *code);
bool takt_coordinates_add_tool_offset(struct program *p, const struct program_code *code);
bool takt_coordinates_drop_tool(struct program *p, const struct program_code *code);
/* G53: the axis words of this line are machine coordinates. */
bool takt_coordinates_use_machine(struct program *p, const struct program_code *code);

#endif
