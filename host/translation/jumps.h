/* Jumps and their targets: places in the text, filled in when all lines have theirs. */
#ifndef TAKT_HOST_TRANSLATION_JUMPS_H
#define TAKT_HOST_TRANSLATION_JUMPS_H

#include "translation/translator.h"

/* The line begins at this place of the text. */
void jumps_note_label(struct translator *t, size_t offset);
/* The same for a number, or a name that has been given one. */
void jumps_add_label(struct translator *t, uint32_t number);
/* The nearest label that way; anywhere: the first. */
void jumps_go_to(struct translator *t, uint32_t number, enum jump_way way);
/* The same to whichever line of the program has the number that an expression comes to. */
void jumps_go_to_any(struct translator *t, const char *expression);
/* Fills in where jumps go. One without a target is an error when it is taken. */
void jumps_finish(struct translator *t);

#endif
