/*
 * Coming to rest on a line as fast as acceleration and jerk allow, from any velocity and
 * acceleration, and exactly at a position if that is wanted. mm and s.
 */
#ifndef TAKT_SYNC_BRAKE_H
#define TAKT_SYNC_BRAKE_H

#include <stdbool.h>

/* A point that moves along a line. */
struct brake_state {
    double x_mm;
    double v_mm_s;
    double a_mm_s2;
};

struct brake_limits {
    double velocity_mm_s;
    double acceleration_mm_s2;
    double jerk_mm_s3;
};

/* One more phase than coming to rest takes: what was going on may go on for a part of a cycle. */
#define BRAKE_PHASES 4

struct brake {
    struct brake_state from; /* where the current phase began */
    double jerk_mm_s3[BRAKE_PHASES];
    double time_s[BRAKE_PHASES];
    unsigned phase;
    double passed_s; /* of it */
    double end_mm;   /* where it comes to rest */
};

/* The state after some time of constant jerk. */
struct brake_state takt_brake_advance(const struct brake_state *s, double jerk_mm_s3,
                                      double time_s);

/*
 * The farthest that a point gets in the positive direction when it comes to rest from now on: its
 * position.
 */
double takt_brake_reach(const struct brake_state *s, const struct brake_limits *limits);

/* To rest, wherever that is. */
void takt_brake_begin(struct brake *b, const struct brake_state *s,
                      const struct brake_limits *limits);

/*
 * To rest at a position that takt_brake_reach(s) is not beyond, but the state after time_s of
 * jerk_mm_s3 is: that jerk goes on for the part of the time after which the reach is the position.
 */
void takt_brake_begin_at(struct brake *b, const struct brake_state *s,
                         const struct brake_limits *limits, double jerk_mm_s3, double time_s,
                         double end_mm);

/* The next cycle. */
void takt_brake_step(struct brake *b, double cycle_s, struct brake_state *s);

/* Has it come to rest? */
static inline bool brake_is_over(const struct brake *b)
{
    return b->phase == BRAKE_PHASES;
}

#endif
