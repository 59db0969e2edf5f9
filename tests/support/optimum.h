/*
 * The least time for moves under limits of feed, acceleration and jerk along the path: a slow
 * reference for the planner, which shares no code with it and knows no cycles.
 *
 *    feed |      ________                        chain of three: at each junction feed and acceleration are free, as long
 *         |     /        \__________             as the feed is allowed on both sides of it; the moves between are then
 *         |    /                    \            the fastest ones from one such state to the next
 *         +---/------junction 1---junction 2--\----> position
 *
 * Units: mm, s.
 */
#ifndef TAKT_TESTS_OPTIMUM_H
#define TAKT_TESTS_OPTIMUM_H

#include <stdbool.h>

/* A straight move, or one whose limits along the path are the same everywhere. */
struct optimum_move {
    double length;
    double feed;         /* highest */
    double acceleration; /* highest, either way */
    double jerk;
    double junction_feed; /* highest at its end; 0: a stop */
    double
        level_feed; /* at which it may level off beyond its ends, where moves are faster; 0: feed */
};

#define OPTIMUM_MOVES 3

/* One move from rest to rest: the closed form. */
double optimum_single(const struct optimum_move *m);

/*
 * Three moves from rest to rest, by search over the states at both junctions: not below the least
 * time, and near it.
 */
double optimum_chain(const struct optimum_move chain[OPTIMUM_MOVES]);

/* A state between two moves. */
struct optimum_state {
    double feed;
    double acceleration;
};

/* The feed at which it may level off. */
double optimum_level(const struct optimum_move *m);

/* The least time of a move from one state to another; HUGE_VAL if there is no way. */
double optimum_between(const struct optimum_move *m, const struct optimum_state *from,
                       const struct optimum_state *to);

/*
 * A move by phases of full jerk, each until acceleration or feed is at its limit and then that
 * kept.
 */
struct optimum_phases {
    double first_sign; /* 1 or -1; the next one has the other, the third this one again */
    double time[2];    /* of the first two */
    double time_max;   /* of the third, which lasts to the end of the move */
};

/*
 * Replaces the state at the start by that at the end, and tells the time; false: it does not come
 * there.
 */
bool optimum_pass(const struct optimum_move *m, const struct optimum_phases *phases,
                  struct optimum_state *state, double *time);

/*
 * May this be the state at an end of the move: does it come from and lead to feeds that are
 * allowed?
 */
bool optimum_may_be(const struct optimum_move *m, const struct optimum_state *state);

#endif
