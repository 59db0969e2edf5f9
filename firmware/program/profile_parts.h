/* Shared by the sources of a profile. */
#ifndef TAKT_PROGRAM_PROFILE_PARTS_H
#define TAKT_PROGRAM_PROFILE_PARTS_H

#include "program/profile.h"

/*
 * Ends of offset segments that are this far from each other in u need an arc between them; nearer
 * ones are lengthened.
 */
#define GAP_MM 1e-2

/* Of an arc. */
double takt_profile_radius(const struct profile_segment *s);

/* Moves a segment by d to its right; false: an arc that the distance swallows. */
bool takt_profile_offset_segment(struct profile_segment *s, double d);

/* Where the lines and circles of two segments meet; of two points the one nearer to near. */
struct profile_point takt_profile_meet(const struct profile_segment *a,
                                       const struct profile_segment *b, struct profile_point near);

/* Lengthens or shortens two segments so that the second begins where the first ends. */
void takt_profile_join(struct profile_segment *a, struct profile_segment *b);

/*
 * takt_profile_offset of a profile whose stock lies above it, by d > 0; the way to it is the
 * caller's.
 */
bool takt_profile_offset_up(const struct profile *p, double d, struct profile_path *path);

#endif
