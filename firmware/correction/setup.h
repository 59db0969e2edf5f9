/*
 * The set-up of the part as its layer has it. Private to this room; correction.h is for others.
 */
#ifndef TAKT_CORRECTION_SETUP_H
#define TAKT_CORRECTION_SETUP_H

#include "correction/correction.h"

/* Makes of its numbers what the control cycle follows. */
void takt_setup_prepare(struct setup *s);

/* The numbers in force. */
void takt_setup_get_numbers(const struct correction *c, double number[CORRECTION_SETUP_VALUES]);

/* c->setup_next is in force from now on. False: the part stands right with it. */
bool takt_setup_exchange(struct correction *c, struct layer_notes *notes);

/* Adds what it takes of the axes at full weight. */
void takt_setup_need(const struct correction *c, const struct setup *s,
                     const struct motion_bound *most, struct need *need);

#endif
