/*
 * How often a controller must cycle so that the chords between its points stay within a tolerance
 * of the curve.
 *
 * A controller moves in a straight line between the points of two cycles. On a circle of radius R
 * the step H of one cycle leaves the circle by the chord error. Above a certain frequency more
 * cycles per second buy nothing. Source: seed 000, equations (1) to (8), in units of mm and s.
 */
#ifndef TAKT_ACCURACY_CYCLE_FREQUENCY_H
#define TAKT_ACCURACY_CYCLE_FREQUENCY_H

/* What bounds the feed on a circle. Two bits where two limits meet. */
#define CYCLE_LIMIT_FEED         1U
#define CYCLE_LIMIT_ACCELERATION 2U
#define CYCLE_LIMIT_JERK         4U

/*
 * All above 0. MATHS_INFINITY: not limited; at least one of them must be finite, and feed or jerk
 * if the other is.
 */
struct cycle_limits {
    double feed_mm_s;
    double acceleration_mm_s2;
    double jerk_mm_s3;
};

struct cycle_need {
    double frequency_hz;
    double radius_mm; /* of the circle that needs it */
    double feed_mm_s; /* allowed there */
    unsigned limits;  /* CYCLE_LIMIT_... that govern there */
};

/* Step of one cycle. */
double takt_cycle_step_mm(double feed_mm_s, double frequency_hz);

/*
 * Largest distance of a chord of that length from its circle; a chord cannot be longer than the
 * diameter.
 */
double takt_cycle_chord_error_mm(double radius_mm, double step_mm);

/*
 * Frequency at which the chord error is the tolerance; 0 for circles no larger than the tolerance.
 */
double takt_cycle_frequency_hz(double radius_mm, double feed_mm_s, double tolerance_mm);

/*
 * The same turned round: highest feed at a frequency. MATHS_INFINITY for circles no larger than the
 * tolerance.
 */
double takt_cycle_feed_chord_mm_s(double radius_mm, double frequency_hz, double tolerance_mm);

/* Feed at which a circle uses up one limit. */
double takt_cycle_feed_acceleration_mm_s(double radius_mm, double acceleration_mm_s2);
double takt_cycle_feed_jerk_mm_s(double radius_mm, double jerk_mm_s3);

/* Highest feed that all limits allow on a circle, and which of them govern (may be NULL). */
double takt_cycle_feed_allowed_mm_s(const struct cycle_limits *limits, double radius_mm,
                                    unsigned *governing);

/*
 * The highest frequency that any circle larger than the tolerance needs, driven as fast as the
 * limits allow.
 */
void takt_cycle_frequency_find(const struct cycle_limits *limits, double tolerance_mm,
                               struct cycle_need *need);

#endif
