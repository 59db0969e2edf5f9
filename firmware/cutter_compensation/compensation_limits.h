/*
 * Every fixed size of the compensation, the same in all builds: what a contour comes to depends on
 * them. struct cutter_compensation takes about
 * COMPENSATION_ITEMS_MAX * 80 + COMPENSATION_WAYS_MAX * 152 bytes.
 */
#ifndef TAKT_CUTTER_COMPENSATION_LIMITS_H
#define TAKT_CUTTER_COMPENSATION_LIMITS_H

/* Pieces of way, corners included, that may still change: so far back an inner corner can reach. */
#define COMPENSATION_LOOK_AHEAD 16
/* Everything kept: those pieces, pieces an inner corner has swallowed, and commands in between. */
#define COMPENSATION_ITEMS_MAX 48
/* What one move can add: an outer corner of three lines, and its way. */
#define COMPENSATION_ITEMS_ADDED 4
/* Pieces of way that are not swallowed: no more is read when there are more than the look-ahead. */
#define COMPENSATION_WAYS_MAX (COMPENSATION_LOOK_AHEAD + COMPENSATION_ITEMS_ADDED)
/* Warnings kept until they are fetched. */
#define COMPENSATION_WARNINGS_MAX 4

/* Turns of a compensated involute: what looks for crossings and distances looks at each of them. */
#define COMPENSATION_TURNS_MAX 1000

/*
 * By this much of the radius the tool may cut into the contour: rounding, below anything a machine
 * resolves.
 */
#define COMPENSATION_GOUGE_MM 1e-9
/*
 * Outer corners whose tip is nearer than this to the arc around them stay sharp: they would be
 * specks.
 */
#define COMPENSATION_BLUNT_MM 1e-6
/*
 * Near a turn of 180 degrees by this angle, the curvatures of both ways decide whether a corner is
 * an inner one.
 */
#define COMPENSATION_CUSP_RAD 0.05
/*
 * Nearer than this they alone decide: the directions of a programmed cusp differ by its rounding.
 */
#define COMPENSATION_CUSP_SURE_RAD 1e-3

/*
 * Half of the last place that programs are written with: by so much the ends of their arcs are off
 * the circles.
 */
#define COMPENSATION_ROUNDING_MM 5e-4

#endif
