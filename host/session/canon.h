/*
 * Canonical moves as text, one a line: what `takt canon` prints.
 *
 *     LINE KIND WORDS
 *
 * LINE is the line of the part program, KIND one of those below. Numbers have six decimals.
 * Positions are machine coordinates in mm, of A B C in degrees; a motion names every axis the
 * machine has, moved or not.
 *
 *     rapid       X Y Z A B C
 *     feed        X Y Z A B C  F         F is mm/min, degrees/min when only A B C move
 *                                        (`F...rev`: mm or degrees per revolution of the spindle)
 *     arc_cw      X Y Z A B C  I J K  P  PLANE  F
 *     arc_ccw     X Y Z A B C  I J K  P  PLANE  F
 *                                        I J K is the centre in machine coordinates; outside the plane it is the
 *                                        start's. P counts the turns begun (1 up to a full circle). PLANE is G17,
 *                                        G18 or G19
 *     involute_cw, involute_ccw
 *                 X Y Z A B C  I J K  R  PLANE  F
 *                                        I J K is the centre of the base circle, R its radius
 *     spline      X Y Z A B C  I J  P Q  R  PLANE  F
 *                                        a piece of G5, G5.1, G5.2 or G6.2 (geometry/nurbs.h): direction (degrees) and
 *                                        curvature (1/mm, counter-clockwise > 0) at start and end, and length
 *     thread      X Y Z A B C  F         F is always per revolution
 *     tap         X Y Z A B C  F         into the hole
 *     tap_out     X Y Z A B C  F  S      out of it; S is the speed of the spindle relative to tap
 *     probe       X Y Z A B C  F  CODE   CODE is G38.2, G38.3, G38.4 or G38.5
 *     dwell P                            seconds
 *     spindle_cw S, spindle_ccw S        rev/min; with constant surface speed V, m/min, and S, if
 *                                        given, is the highest
 *     spindle_off
 *     spindle_orient R P Q               degrees; 0 the shortest way, 1 cw, 2 ccw; seconds to wait
 *     coolant_off, coolant_mist_on, coolant_flood_on, coolant_mist_flood_on
 *                                        what is on after it
 *     tool_prepare T, tool_change T, tool_loaded T
 *                                        whole numbers; tool_loaded: it is in the spindle already
 *     output, output_with_motion  P Q    digital output P is Q, 0 or 1; analogue: E Q
 *     input  P L Q                       waits for digital input P (analogue: E) as L says: 0 only
 *                                        reads, 1 rise, 2 fall, 3 high, 4 low; Q: at most, seconds
 *     stop, optional_stop
 *     end
 */
#ifndef TAKT_HOST_CANON_H
#define TAKT_HOST_CANON_H

#include "program/move.h"

#include <stddef.h>

/* Longest text with its end: six axes, three of a centre, P, F, and the words around them. */
#define CANON_TEXT_MAX 512

/* Does it move rotary axes alone, from at? Its feed counts degrees then. */
bool canon_is_rotary(const struct move *move, const struct point *at);

/*
 * Writes move without a line end, zero-terminated, into text[CANON_TEXT_MAX]; returns its length.
 * axes: bit i set: the machine has axis i. at: machine position the move starts from; the caller
 * follows it, by move->end after every motion.
 */
size_t canon_format(const struct move *move, unsigned axes, const struct point *at, char *text);

#endif
