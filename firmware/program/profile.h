/*
 * The profile of a turned part, for G70 to G72: a chain of lines and arcs in a plane.
 *
 * Coordinates are u along the part and v across it, as turning.c chooses them: the profile goes
 * towards falling u and, from its beginning to its end, towards rising v; the stock lies above it,
 * to the right of its way.
 */
#ifndef TAKT_PROGRAM_PROFILE_H
#define TAKT_PROGRAM_PROFILE_H

#include "program/program_limits.h"

#include <stdbool.h>
#include <stdint.h>

struct profile_point {
    double u, v;
};

enum profile_kind { PROFILE_LINE, PROFILE_ARC, PROFILE_FILLET, PROFILE_CHAMFER };

struct profile_segment {
    struct profile_point start, end;
    struct profile_point
        centre;   /* of an arc; u: the radius of a fillet or chamfer to be made at start = end */
    uint8_t kind; /* enum profile_kind */
    bool left;    /* an arc turns counterclockwise, from u to v */
};

/* When it is offset, each may get an arc at its corner and a wall. */
#define PROFILE_PATH_MAX (3 * PROGRAM_CONTOUR_MAX + 2)

struct profile {
    unsigned count;
    struct profile_segment segment[PROGRAM_CONTOUR_MAX + 1];
};

struct profile_path {
    unsigned count;
    struct profile_segment segment[PROFILE_PATH_MAX];
};

/* Points nearer than this are the same. */
#define PROFILE_SAME_MM 1e-6

/* What is shorter than this says nothing, and a way back of this length is none. */
#define PROFILE_SHORT_MM 1e-3

double takt_profile_distance(const struct profile_point *a, const struct profile_point *b);

/* Quarter turns and mirrors, and back. A mirror turns arcs the other way. */
void takt_profile_turn(struct profile *p);
void takt_profile_mirror(struct profile *p, bool u, bool v);
void takt_profile_mirror_segment(struct profile_segment *s, bool u, bool v);

/* Makes the fillets and chamfers. False: one does not fit. */
bool takt_profile_round(struct profile *p);

/* Does every segment from first on go towards falling u, arcs without turning back? */
bool takt_profile_falls(const struct profile *p, unsigned first);

/*
 * The profile without its first segment, distance_mm to the right, to *path; outer corners become
 * arcs, what the distance swallows is left out. Its first segment becomes the way to it. False:
 * nothing remains, or too much.
 */
bool takt_profile_offset(const struct profile *p, double distance_mm, struct profile_path *path);

/*
 * Where a segment, which must not turn back in v, is at the height v; the end of u that comes
 * first. False: nowhere.
 */
bool takt_profile_cross(const struct profile_segment *s, double v, double *u);

#endif
