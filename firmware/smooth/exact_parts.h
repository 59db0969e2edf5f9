/*
 * Parts of the axes' limits that motions of the exact path take, and when a junction is passed.
 * plan/block.c and plan/junction.c, which say why, go by them; exact_course.c tells by them
 * how long that takes.
 */
#ifndef TAKT_SMOOTH_EXACT_PARTS_H
#define TAKT_SMOOTH_EXACT_PARTS_H

/* At constant feed on an arc; and of jerk in a ramp on it, across and along (0.6^2 + 0.8^2 = 1). */
#define ARC_ACCELERATION 0.9
#define ARC_JERK         0.5
#define RAMP_NORMAL      0.6
#define RAMP_ALONG       0.8

/* Limits of a block are found for overrides up to this. */
#define BLOCK_OVERRIDE_MAX 1.2

/*
 * Part of jerk that blocks leave to junctions at most, and of acceleration that a junction may use
 * with all of that; of acceleration they leave this part of that of jerk.
 */
#define BLOCK_JERK_BUDGET_MAX        0.5
#define JUNCTION_ACCELERATION        0.1
#define ACCELERATION_PER_JERK_BUDGET (JUNCTION_ACCELERATION / BLOCK_JERK_BUDGET_MAX)

/*
 * Junctions no farther apart add up in the third difference; those whose blocks last less than
 * twice that are crowded.
 */
#define JUNCTION_CYCLES_NEAR  3.0
#define JUNCTION_CYCLES_APART (2.0 * JUNCTION_CYCLES_NEAR)

/*
 * A junction feed below this many times jerk x cycle^2, the jerk that the largest share leaves, is
 * too slow to be landed at: the axes stop.
 */
#define JUNCTION_LEAST_CYCLES 4.0

/*
 * To be passed a junction must take less than this part of the time of a stop: landing on it takes
 * some as well.
 */
#define JUNCTION_WORTH 0.75

/*
 * What is left of the third difference of a step of acceleration at a junction: the peak of the
 * quadratic B-spline.
 */
#define JUNCTION_CURVATURE 0.75

#endif
