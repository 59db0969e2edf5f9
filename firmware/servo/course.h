/*
 * The way of a profile: a trapezoid of velocity to a target, and the same averaged, so that its
 * jerk is limited.
 */
#ifndef TAKT_SERVO_COURSE_H
#define TAKT_SERVO_COURSE_H

#include <stdbool.h>
#include <stdint.h>

/* Cycles that are averaged, at most: 8 bytes each. */
#define COURSE_CYCLES_MAX 512

struct course {
    double at_mm, velocity_mm_s;
};

struct course_ramps {
    double velocity_mm_s, acceleration_mm_s2, deceleration_mm_s2;
    double end_mm_s;   /* velocity at the target */
    double jerk_mm_s3; /* 0: not limited */
};

/* Where the trapezoid has been lately. */
struct course_average {
    struct course course; /* the trapezoid, which is ahead */
    double out_mm;        /* the average; as long as it is the command, nobody else has moved it */
    uint32_t count, next; /* cycles; 0: there are none yet */
    int64_t sum, place[COURSE_CYCLES_MAX]; /* in COURSE_PLACES_PER_MM: their sum is exact */
};

/* value goes to goal, by so much at most. */
double takt_course_approach(double value, double goal, double by);

/*
 * A cycle of a trapezoid. Near enough to get there within the next cycle's rounding, it is there.
 */
void takt_course_step(struct course *course, double target_mm, const struct course_ramps *ramps,
                      double cycle_s);

/*
 * The same with limited jerk: from where the command is, with its velocity, which both become those
 * of the next cycle. Averages over other cycles begin only at rest.
 */
void takt_course_step_average(struct course_average *average, struct course *command,
                              double target_mm, const struct course_ramps *ramps, double cycle_s);

/* Is there no average yet, or has something else moved the command since? */
bool takt_course_is_elsewhere(const struct course_average *average, const struct course *command);

#endif
