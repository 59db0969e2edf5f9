/*
 * Canonical moves as text, one a line: what `takt canon` prints.
 *
 *     LINE KIND WORDS
 *
 * LINE is the line of the part program, KIND one of those below. Numbers have six decimals. Positions are machine
 * coordinates in mm, of A B C in degrees; a motion names every axis the machine has, moved or not.
 *
 *     rapid       X Y Z A B C
 *     feed        X Y Z A B C  F         F is mm/min, degrees/min when only A B C move
 *     arc_cw      X Y Z A B C  I J K  P  PLANE  F
 *     arc_ccw     X Y Z A B C  I J K  P  PLANE  F
 *                                        I J K is the centre in machine coordinates; outside the plane it is the
 *                                        start's. P counts the turns begun (1 up to a full circle). PLANE is G17,
 *                                        G18 or G19
 *     dwell P                            seconds
 *     spindle_cw S, spindle_ccw S        rev/min
 *     spindle_off
 *     coolant_off, coolant_mist_on, coolant_flood_on, coolant_mist_flood_on
 *                                        what is on after it
 *     tool_prepare T, tool_change T      whole numbers
 *     stop, optional_stop
 *     end
 */
#ifndef TAKT_HOST_CANON_H
#define TAKT_HOST_CANON_H

#include "program/move.h"

#include <stddef.h>

/* Longest text with its end: six axes, three of a centre, P, F, and the words around them. */
#define CANON_TEXT_MAX 512

/*
 * Writes move without a line end, zero-terminated, into text[CANON_TEXT_MAX]; returns its length. axes: bit i set:
 * the machine has axis i. at: machine position the move starts from; the caller follows it, by move->end after
 * every motion.
 */
size_t canon_format(const struct move *move, unsigned axes, const struct point *at, char *text);

#endif
