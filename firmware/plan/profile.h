/*
 * A feed profile: how far along a curve at which time, as pieces of constant jerk.
 */
#ifndef TAKT_PLAN_PROFILE_H
#define TAKT_PLAN_PROFILE_H

/* A ramp has three pieces (jerk, constant acceleration, jerk back); a block two ramps and a cruise between. */
#define PROFILE_PIECES_MAX 7

/* s(t) = s + v t + a t^2 / 2 + j t^3 / 6 for 0 <= t <= duration_s, t from the start of the piece. */
struct profile_piece {
    double duration_s;
    double s_mm;
    double v_mm_s;
    double a_mm_s2;
    double j_mm_s3;
};

struct profile {
    double duration_s;
    double feed_start_mm_s;
    double feed_cruise_mm_s;
    double feed_end_mm_s;
    unsigned count;
    struct profile_piece piece[PROFILE_PIECES_MAX];
};

/* Where a profile is at one time. */
struct profile_state {
    double s_mm;
    double v_mm_s;
    double a_mm_s2;
};

/*
 * Appends a piece that starts in state at and lasts duration_s with constant jerk; returns the state at its end.
 * Needs room: at most PROFILE_PIECES_MAX pieces.
 */
struct profile_state profile_append(struct profile *p, struct profile_state at, double duration_s,
                                    double j_mm_s3);

/* State at 0 <= t <= duration of the profile. */
void profile_evaluate(const struct profile *p, double t_s, struct profile_state *state);

#endif
