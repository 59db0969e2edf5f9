/*
 * A program's path as the verifier of rounded paths wants it: read as it is needed, and cut into
 * straight pieces.
 *
 * A planner may take several lines for one element, as long as that is straight. Of one within the
 * tolerance of a place no more than twice the tolerance is, so a motion counts as that part of an
 * element which it is of that length, no less than a 25th and no more than a whole one.
 *
 * Bent curves are cut so that a piece is off the curve by a small part of the tolerance. Only the
 * pieces between the first and the last that are asked for are in memory.
 */
#ifndef TAKT_HOST_TUBE_PATH_H
#define TAKT_HOST_TUBE_PATH_H

#include "cutter_compensation/cutter_compensation.h"
#include "geometry/curve.h"
#include "program/program.h"
#include "verifier/tube_segment.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A tap turns back so much of a revolution above the bottom of its hole at most. */
#define TUBE_TURNING_REV 0.1

/* A motion with a length; its pieces share it. */
struct tube_motion {
    size_t users; /* its pieces in memory, and the path as long as it is the last one read */
    struct curve curve;
    uint32_t line;
    uint32_t number;     /* of the program's motions, from 1; 0: the place where it begins */
    bool rounded;        /* G64 P: to be kept within a tolerance, not exactly */
    bool probing;        /* may end early */
    double tolerance_mm; /* P, or of an exact one what it may be off */
    double turning_mm;   /* a tap turns back so far before its end at most; 0: it is none */
    double travel_mm;    /* path before it; motions of rotary axes alone have none */
    double elements;     /* to its end */
    double cut_mm;       /* pieces are so far off the curve at most */
    double even_mm;      /* length of an arc's pieces; 0: it is none */
};

struct tube_piece {
    struct tube_motion *motion;
    struct tube_segment segment;
    double from_mm, length_mm; /* of the motion's curve */
    bool ends;                 /* with its motion */
    bool reached;              /* the verifier's: the last setpoint may be on it, */
    double from;               /* from this part of it on, 0 ... 1 */
    double corner_mm;          /* nearest that the setpoints' line has come to its end */
};

struct tube_path {
    struct program program;
    struct cutter_compensation offset;
    double exact_mm;            /* what exact motions may be off */
    double tolerances;          /* and others, P; 1 from the start */
    bool ended;                 /* there are no more motions */
    bool failed;                /* out of memory */
    struct point end;           /* of what has been read */
    uint32_t motions;           /* likewise, those without a length too */
    double travel_mm;           /* of what has been read */
    double elements;            /* likewise */
    struct tube_motion *motion; /* read last, */
    double cut_to_mm;           /* how far pieces have been made of it, */
    struct point cut_to;        /* and where that is */
    struct tube_piece *piece;   /* a queue, owned */
    size_t first, count, capacity;
};

/*
 * Begins with one piece that has no length, where the program starts. source: its context stays the
 * caller's.
 */
void tube_path_init(struct tube_path *p, const struct program_config *program,
                    const struct source *source, double exact_mm);
void tube_path_free(struct tube_path *p);
/* For the pieces in memory; valid until the next one is appended. */
static inline struct tube_piece *tube_path_at(const struct tube_path *p, size_t k)
{
    return &p->piece[(p->first + k) & (p->capacity - 1)];
}
/*
 * Appends the next piece. False: there is none before an answer, or at all, or no memory (failed).
 */
bool tube_path_extend(struct tube_path *p);
void tube_path_drop(struct tube_path *p);
/*
 * What the program waits for. All pieces go but one: where the path goes on, at rest_at after a
 * probing motion.
 */
void tube_path_answer(struct tube_path *p, const struct program_answer *answer);

#endif
