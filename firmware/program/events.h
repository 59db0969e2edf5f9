/*
 * What happens between motions: spindle, coolant, tool, waiting, stopping.
 */
#ifndef TAKT_PROGRAM_EVENTS_H
#define TAKT_PROGRAM_EVENTS_H

#include "program/program.h"

/* S */
bool takt_events_set_speed(struct program *p, const struct program_code *code);
/* T */
bool takt_events_select_tool(struct program *p, const struct program_code *code);
/* M6 */
bool takt_events_change_tool(struct program *p, const struct program_code *code);
/* M61: tool Q is in the spindle already. */
bool takt_events_load_tool(struct program *p, const struct program_code *code);
/* G96 (argument 1: constant surface speed), G97 (0) */
bool takt_events_set_spindle_mode(struct program *p, const struct program_code *code);
/* The spindle as the modes have it; also for cycles. */
void takt_events_spindle_move(const struct program *p, enum spindle_direction direction,
                              struct move *m);
/* Tell spindle and coolant what the modes are. */
void takt_events_tell_spindle(struct program *p);
void takt_events_tell_coolant(struct program *p);
/* M19 */
bool takt_events_orient_spindle(struct program *p, const struct program_code *code);
/* M62, M63, M64, M65, M67, M68; argument: sum of enum output */
enum output { OUTPUT_ON = 1, OUTPUT_WITH_MOTION = 2, OUTPUT_ANALOGUE = 4 };
bool takt_events_set_output(struct program *p, const struct program_code *code);
/* M66 */
bool takt_events_read_input(struct program *p, const struct program_code *code);
/* M3, M4, M5; argument: enum spindle_direction */
bool takt_events_turn_spindle(struct program *p, const struct program_code *code);
/* M7, M8, M9; argument: one of enum coolant */
enum coolant { COOLANT_MIST, COOLANT_FLOOD, COOLANT_OFF };
bool takt_events_set_coolant(struct program *p, const struct program_code *code);
/* G4 */
bool takt_events_dwell(struct program *p, const struct program_code *code);
/* M0, M60 (argument 0), M1 (1) */
bool takt_events_stop(struct program *p, const struct program_code *code);
/* M2, M30 */
bool takt_events_end(struct program *p, const struct program_code *code);

#endif
