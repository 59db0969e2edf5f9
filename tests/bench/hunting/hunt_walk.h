/*
 * Setpoints and programmed path, walked along together.
 */
#ifndef TAKT_TESTS_HUNT_WALK_H
#define TAKT_TESTS_HUNT_WALK_H

#include "hunt_case.h"

/* What one pass finds. */
struct walk {
    bool arrived;
    size_t lost_row;     /* where it has found no way on, */
    size_t tired_row;    /* or has looked for one for too long */
    size_t first, last;  /* pieces touched in the present step */
    double along_mm;     /* most that the present step goes forwards along any of them */
    double tolerance_mm; /* the largest of these pieces */
    double back_mm;      /* gone back for now, */
    size_t back_first;   /* from this piece on */
    double back_part;    /* most of it, as a part of P, less what the path turns by meanwhile */
    unsigned back_line;
    double off_mm; /* most off the exact path */
    unsigned off_line;
    double feed_ratio; /* most over the programmed feed */
    unsigned feed_line;
    unsigned stops, stop_line;
    size_t standing;   /* cycles */
    size_t exact_rows; /* up to this one without a row that a tolerance is for */
    double *time_s[2]; /* along the programmed path, first and last place of each of them */
};

/*
 * One pass with this factor on all tolerances. closely: measures what the places passed say, too.
 */
struct walk walk_along(struct verifier *j, double factor, bool closely, const double *before);
/*
 * Smallest factor on all tolerances with which there is a way; to 0.1 %. Where that is too much
 * work: one that it exceeds.
 */
double least_factor(struct verifier *j);

#endif
