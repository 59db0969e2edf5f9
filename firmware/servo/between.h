/*
 * What a drive does between targets that come once a cycle (object 60C0 = -1): a polynomial with
 * continuous acceleration.
 */
#ifndef TAKT_SERVO_BETWEEN_H
#define TAKT_SERVO_BETWEEN_H

#include <stdbool.h>

#define BETWEEN_COEFFICIENTS 6

/* The targets of the last cycles, the newest last. */
struct between {
    bool is_known;
    double target_mm[4];
};

/*
 * Takes the target of this cycle, and gives the piece to go in it: position over the part u = 0 ...
 * 1 of the cycle, by powers of u. It ends at the target of the cycle before, which the next target
 * tells how to pass. at_mm: where the command is; if it is not where the last piece ended, the axis
 * is taken to stand there.
 */
void takt_between_take(struct between *between, double at_mm, double target_mm,
                       double piece[BETWEEN_COEFFICIENTS]);

/* Position and its first two derivatives by u. */
void takt_between_at(const double piece[BETWEEN_COEFFICIENTS], double u, double place[3]);

#endif
