/*
 * What the lines read have made of parameters that last (offsets, reference positions), so that it
 * can be taken back: a program is read far ahead of what is executed, and may be given up before it
 * gets there.
 *
 * Every move tells by a number which changes come before it (struct move, changes). Who executes
 * moves counts them, and says where the first one behind a change is.
 */
#ifndef TAKT_PROGRAM_CHANGES_H
#define TAKT_PROGRAM_CHANGES_H

#include "program/program.h"

/* Everything that has been read has been done. */
#define CHANGES_ALL UINT32_MAX

void takt_changes_open(struct program *p);

/* A parameter has been set; before: what it was. */
void takt_changes_note(struct program *p, unsigned parameter, double before);

/* So has the tool of an index among those the program has changed. */
void takt_changes_note_tool(struct program *p, unsigned index);

/* A move leaves the program, behind all changes so far. */
void takt_changes_stamp(struct program *p, struct move *move);

/* The first move behind the change of a number, and behind those before it, is the place-th. */
void takt_changes_place(struct program *p, uint8_t number, uint32_t place);

/* Value of a parameter where reached moves have been begun. */
double takt_changes_value(const struct program *p, unsigned parameter, uint32_t reached);

/* Leaves out of a copy of the parameters what comes behind that. False: it has no room for that. */
bool takt_changes_leave_out(const struct program *p, uint32_t reached,
                            struct parameters *parameters);

/*
 * The program is given up when reached moves have been begun: changes behind them are taken back.
 * False: there were so many that some of them could not be.
 */
bool takt_changes_take_back(struct program *p, uint32_t reached);

#endif
