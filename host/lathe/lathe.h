/*
 * Lines of lathes of Fanuc and Haas: turning cycles, passes, threads, arcs, turrets and increments,
 * in the language of LinuxCNC.
 */
#ifndef TAKT_HOST_LATHE_LATHE_H
#define TAKT_HOST_LATHE_LATHE_H

#include "translation/translator.h"

/* G70, G71, G72, G74, G75 and G76 of lathes. */
void turning_translate(struct translator *t);
/* Distances of a cycle that are whole thousandths, since nothing is that large. */
bool turning_is_whole(struct line *l);
/* Only programs for lathes have such a line. */
bool turning_tells(struct line *l);

/* G90, G92 and G94 of lathes. */
void passes_survey(struct survey *s, struct line *l);
void passes_translate(struct translator *t);
/* U and W of lathes. */
void lathe_translate_increments(struct translator *t);
/* G32. */
void threads_translate(struct translator *t);

/* Arcs of lathes that have no centre. */
void arcs_translate(struct translator *t);
/* Diameters, feeds and turret of lathes. */
void lathe_translate(struct translator *t);

#endif
