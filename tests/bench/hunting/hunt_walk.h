/*
 * Setpoints and programmed path, walked along together.
 */
#ifndef TAKT_TESTS_HUNT_WALK_H
#define TAKT_TESTS_HUNT_WALK_H

#include "hunt_case.h"

/* What one pass finds. */
struct walk {
    bool arrived;
    size_t lost_row;    /* where it has found no way on */
    size_t first, last; /* pieces touched in the present step */
    double along_mm;    /* most that the present step goes forwards along any of them */
    double back_mm;     /* gone back for now */
    double back_part;   /* most of it, as a part of P */
    unsigned back_line;
    double off_mm; /* most off the exact path */
    unsigned off_line;
    double feed_ratio; /* most over the programmed feed */
    unsigned feed_line;
    unsigned stops, stop_line;
    size_t standing;   /* cycles */
    double *time_s[2]; /* along the programmed path, first and last place of each row */
};

/* One pass with this factor on all tolerances. closely: measures what the places passed say, too. */
struct walk walk_along(struct judge *j, double factor, bool closely, const double *before);
/* Smallest factor on all tolerances with which there is a way; to 0.1 %. */
double least_factor(struct judge *j);

#endif
