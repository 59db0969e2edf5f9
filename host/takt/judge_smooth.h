/*
 * The judge of smoothed stretches (G64 P): every setpoint within the tolerance of the programmed path, and every
 * programmed corner within the tolerance of the line through the setpoints.
 *
 * It keeps the motions that have been read last, some of them ahead of the run, and knows nothing of how the path was
 * smoothed. Memory is fixed.
 */
#ifndef TAKT_HOST_JUDGE_SMOOTH_H
#define TAKT_HOST_JUDGE_SMOOTH_H

#include "program/move.h"

#include <stdbool.h>
#include <stdint.h>

/* Motions kept, and how far around the present one a setpoint is looked for. */
#define JUDGE_MOTIONS_MAX 256
#define JUDGE_BEHIND      80
#define JUDGE_AHEAD       80

struct judge_motion {
    uint32_t number;
    bool has_length;
    bool smoothed;    /* setpoints of a smoothed path have been near */
    double corner_mm; /* least distance of its end from the setpoints' line */
    struct move move;
    struct curve curve;
    double fraction; /* of the curve, where a setpoint was nearest last */
};

/* A queue of motions: those read, the one the run is in, those behind it. */
struct judge_motions {
    uint32_t read;    /* motions so far */
    uint32_t current; /* motions taken so far: the last one taken is the one the run is in */
    uint32_t settled; /* motions whose ends have been judged */
    struct judge_motion motion[JUDGE_MOTIONS_MAX];
};

struct judge_smoothing {
    double path_part;   /* largest distance from the path, as a part of the tolerance */
    double corner_part; /* of a corner from the line through the setpoints, likewise */
};

struct judge_motion *judge_motion_at(struct judge_motions *m, uint32_t index);
bool judge_motions_have_room(const struct judge_motions *m);
/* A smoothed stretch begins with the present motion. */
void judge_smooth_begin(struct judge_motions *m);
/* A setpoint of a smoothed path, and the one before it. */
void judge_smooth_add(struct judge_motions *m, struct judge_smoothing *s, const struct point *from,
                      const struct point *to);
/* The smoothed stretch is over: judges the corners that are still open. */
void judge_smooth_end(struct judge_motions *m, struct judge_smoothing *s);

#endif
