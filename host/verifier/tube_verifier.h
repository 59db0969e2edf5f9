/*
 * The verifier of a path within a tolerance (G64 P): how far setpoints are from the programmed
 * path, and how far the path's corners are from the line through the setpoints.
 *
 * It knows nothing of the planner's reasoning: it reads the part program itself and follows the
 * setpoints along it, never backwards and leaving nothing out. What it remembers are the places of
 * the path at which the last setpoint may be: those within the tolerance of it that can be come to
 * from such places of the setpoint before, past every corner and bend in between, which are within
 * the tolerance too (Alt and Godau's way to decide on a Frechet distance). The nearest of them
 * counts. Where there is no such place left the path has been left: that is how far off the
 * setpoint is, and the path is looked for near by, ahead. Memory is what lies within reach.
 *
 * Between two setpoints of a curve the axes do not go straight: with second differences d it is off
 * its chord by d/8 at most. So much more a bend, not a corner, may be off the line from one to the
 * other.
 *
 * Where motions of a few tolerances go to and fro, a setpoint may be on any number of them. The
 * motion that the run says it executes then chooses: if the setpoint is near it, places far ahead
 * are not gone to yet, and those far behind are left. A run that says what is wrong has fewer
 * places to be at, never more, so that it is verified more strictly.
 */
#ifndef TAKT_HOST_TUBE_VERIFIER_H
#define TAKT_HOST_TUBE_VERIFIER_H

#include "verifier/tube_path.h"

struct tube_figures {
    /* of motions within a tolerance P */
    double path_part;    /* largest distance of a setpoint from the path, as a part of P */
    double corner_part;  /* of a corner of the path from the setpoints' line, likewise */
    double deviation_mm; /* the same as lengths */
    double corner_mm;
    /* of all motions */
    double beyond_mm;      /* most that a setpoint is beyond the tolerance; 0: none */
    uint32_t beyond_line;  /* of the motion where that is */
    double path_length_mm; /* gone so far; motions of rotary axes alone do not count */
};

struct tube_verifier {
    struct tube_path path;
    bool exact_elsewhere; /* the ends of exact motions are verified by others */
    size_t active;        /* pieces before this one may be where the setpoint is */
    struct point last;    /* setpoint, */
    struct point before;  /* and the one before */
    struct point next;    /* not verified yet: what comes after it tells how the axes go there */
    uint32_t next_motion;
    bool has_next;
    double bend_mm; /* of the way at the last setpoint */
    uint64_t looks; /* work: pieces that a setpoint has been compared with */
    struct tube_figures figures;
};

/* exact_mm: what motions in exact path may be off. source: its context stays the caller's. */
void tube_verifier_init(struct tube_verifier *t, const struct program_config *program,
                        const struct source *source, double exact_mm);
/* Before the first setpoint: motions within a tolerance may be off so many of it. */
void tube_verifier_widen(struct tube_verifier *t, double tolerances);
void tube_verifier_free(struct tube_verifier *t);
/* The next setpoint, and the motion it is said to be of. False: out of memory. */
bool tube_verifier_add(struct tube_verifier *t, const struct point *setpoint, uint32_t motion);
/*
 * What the program has been told (G38, M66): everything before it has been executed, but for the
 * rest of a probing move.
 */
void tube_verifier_answer(struct tube_verifier *t, const struct program_answer *answer);
/* After the last setpoint, wherever that is. */
void tube_verifier_stop(struct tube_verifier *t);
/* The same of a program that has been executed to its end. */
void tube_verifier_finish(struct tube_verifier *t);

#endif
