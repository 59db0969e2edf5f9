/*
 * The codes that only change how later words are understood.
 */
#ifndef TAKT_PROGRAM_MODES_H
#define TAKT_PROGRAM_MODES_H

#include "program/program.h"

/* The state a program starts in: G17 G21 G40 G49 G61 G80 G90 G91.1 G94, no F, no S, no tool. */
void takt_modes_open(struct program *p);

/* G93, G94, G95; argument: enum feed_mode */
enum feed_mode { FEED_PER_MINUTE, FEED_INVERSE_TIME, FEED_PER_REVOLUTION };
bool takt_modes_set_feed_mode(struct program *p, const struct program_code *code);
/* F */
bool takt_modes_set_feed(struct program *p, const struct program_code *code);
/* G17, G18, G19; argument: enum plane */
bool takt_modes_set_plane(struct program *p, const struct program_code *code);
/* G20 (argument 1: inch), G21 (0: mm) */
bool takt_modes_set_units(struct program *p, const struct program_code *code);
/* G61, G61.1, G64; argument: enum move_path */
bool takt_modes_set_path(struct program *p, const struct program_code *code);
/* G90 (argument 0), G91 (1) */
bool takt_modes_set_distance(struct program *p, const struct program_code *code);
/* G90.1 (argument 1: absolute), G91.1 (0) */
bool takt_modes_set_centre(struct program *p, const struct program_code *code);
/* G7 (argument 1: X words are diameters), G8 (0) */
bool takt_modes_set_diameter(struct program *p, const struct program_code *code);
/* G98 (argument 0: cycles retract to where they started), G99 (1: to R) */
bool takt_modes_set_retract(struct program *p, const struct program_code *code);
/* M48 (argument 1), M49 (0) */
bool takt_modes_set_overrides(struct program *p, const struct program_code *code);
/* M50 to M53; argument: OVERRIDE_... */
bool takt_modes_set_override(struct program *p, const struct program_code *code);
/* M120 (argument 1: on), M121 (0: off): layers of position-error correction. */
bool takt_modes_set_correction(struct program *p, const struct program_code *code);
/* Codes that are understood and change nothing here: G40. */
bool takt_modes_accept(struct program *p, const struct program_code *code);

#endif
