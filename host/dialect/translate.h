/*
 * Steps of a translation: what each source of this room does to a line.
 */
#ifndef TAKT_HOST_DIALECT_TRANSLATE_H
#define TAKT_HOST_DIALECT_TRANSLATE_H

#include "dialect/dialect.h"
#include "translation/translator.h"

/* #<_ini[...]> and #<_hal[...]> as numbers. */
void values_translate(struct translator *t);

/* #name and #900000, which LinuxCNC does not know. */
void names_translate(struct translator *t);
/* Which parameters there are of those numbers: all are 0 in the beginning. */
void names_survey(struct survey *s, const struct line *l);
void names_begin(struct translator *t);

/* Behind a parameter of LinuxCNC that is in mm: in the units in effect. */
#define TRANSLATE_IN_UNITS "/[1+24.4*#<_imperial>]"

/* Variables of the control (#5041) of Fanuc and Haas; those of offsets that are given a value. */
void variables_translate(struct translator *t);
void variables_set(struct translator *t);
/* G10 of Fanuc and Haas. */
void offsets_translate(struct translator *t);

/* @ and ^ as X and Y. */
void polar_translate(struct translator *t);

/* Plane and distances, which later lines are understood by. */
void motion_follow_modes(struct translator *t);
/* G28 and G30, whose axes are named alone or are distances. */
void motion_translate_reference(struct translator *t);
/*
 * G53 goes at rapid where no motion is in effect; what was before a cycle stays what goes on behind
 * it.
 */
void motion_translate_machine(struct translator *t);
/*
 * G0 that is in effect at the start, or was given beside G28, which has the axis words of that
 * line.
 */
void motion_translate(struct translator *t);

/* Words that only the code in front of them can mean: not F, S, T and the axes. */
#define TRANSLATE_OWN_WORDS "dehijklpqruvw"

/* What becomes of a word by what the machine file declares it as. */
void declared_use(struct translator *t, struct line_word *w, const struct dialect_code *code);

/* Takes a code and its own words out of the line. */
void codes_drop(struct translator *t, struct line_word *w);
/* What becomes of the G and M words of the line. */
void codes_translate(struct translator *t);

/* 1 with G91, as text: of this line, or of what comes before it. */
const char *motion_distance_mode(struct line *l);

/* A cycle of drilling or boring; what a series of them ends with. */
struct line_word *series_find_cycle(struct line *l);
bool series_ends(struct line *l);
void series_survey(struct survey *s, struct line *l);
/* In a program that is called in a series it goes on. */
void series_follow_programs(struct translator *t);
void series_translate_fine_boring(struct translator *t);
/* What holes keep from those before; first: the line begins a series. */
void series_translate(struct translator *t, bool first);

/* Cycles without R, of lathes, and of Fagor. */
void holes_translate(struct translator *t);
/* #<_name> that the machine file knows. */
void globals_begin(struct translator *t);
/* Macros of printers; what is for extruders. */
void printer_leave_macro(struct translator *t);
void printer_translate(struct translator *t);
/* Has a line a rotary axis? */
bool upright_turns(struct line *l);
/* G43.4, G53.1 and G68.2 of a program that has none. */
void upright_translate(struct translator *t);

/* Systems, and what T, D, H and compensation leave for later lines. */
void registers_translate(struct translator *t);
/* Whether the program is of a lathe: by each line, and at its end. */
void registers_survey(struct survey *s, struct line *l);
void registers_survey_end(struct survey *s);
/* G50, or G92 with S and no axis. NULL: no such line. */
struct line_word *registers_speed_limit(struct line *l);
/* G50 S, and G96 that waits for its S. */
void registers_translate_speed(struct translator *t);
/* x[#<_x>+#5211]: where the axis is when nothing shifts it, for a G92. */
void registers_unshifted(char axis, char *text, size_t size);
/* G70 and G71 as units. */
void registers_translate_unit(struct translator *t);

/* G12 and G13. */
void pocket_translate(struct translator *t);

/* WHILE, DO, END, IF and GOTO. */
void flow_survey(struct survey *s, const struct line *l);
void flow_translate(struct translator *t);
/* All loops of a program end in it. */
void flow_end_program(struct translator *t);
/* O1000, G65, G66, M97, M98 and M99. */
void calls_survey(struct survey *s, struct line *l);
void calls_translate(struct translator *t);

#endif
