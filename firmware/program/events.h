/*
 * What happens between motions: spindle, coolant, tool, waiting, stopping.
 */
#ifndef TAKT_PROGRAM_EVENTS_H
#define TAKT_PROGRAM_EVENTS_H

#include "program/program.h"

/* S */
bool events_set_speed(struct program *p, const struct program_code *code);
/* T */
bool events_select_tool(struct program *p, const struct program_code *code);
/* M6 */
bool events_change_tool(struct program *p, const struct program_code *code);
/* M3, M4, M5; argument: enum spindle_direction */
bool events_turn_spindle(struct program *p, const struct program_code *code);
/* M7, M8, M9; argument: one of enum coolant */
enum coolant { COOLANT_MIST, COOLANT_FLOOD, COOLANT_OFF };
bool events_set_coolant(struct program *p, const struct program_code *code);
/* G4 */
bool events_dwell(struct program *p, const struct program_code *code);
/* M0 (argument 0), M1 (1) */
bool events_stop(struct program *p, const struct program_code *code);
/* M2, M30 */
bool events_end(struct program *p, const struct program_code *code);

#endif
