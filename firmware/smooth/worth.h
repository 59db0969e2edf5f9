/*
 * Whether a curve is worth it: whether it is as quick as the path that it smooths, which comes to
 * rest where it turns.
 */
#ifndef TAKT_SMOOTH_WORTH_H
#define TAKT_SMOOTH_WORTH_H

#include "smooth/exact_time.h"
#include "smooth/verifier.h"
#include "smooth/window.h"

struct smooth;

/*
 * What binds the rate of nominal time on the pieces of a window: working memory, holds nothing
 * between calls.
 */
struct worth_pace {
    float most[SMOOTH_SAMPLES_MAX];   /* of it on each piece, */
    float change[SMOOTH_SAMPLES_MAX]; /* by how much its square may change there, */
    float at[SMOOTH_SAMPLES_MAX +
             1]; /* and what it is where each begins, and where the last one ends */
};

union worth_work {
    struct worth_pace pace;
    struct exact_work exact;
};

/* The first pieces of a window. */
struct worth_window {
    const struct smooth *of;
    union worth_work *work;
    unsigned pieces;
    unsigned kept; /* of them: these are handed on */
    float begin_s; /* what beginning at rest takes longer; 0: they begin in motion */
};

/* What the curve has taken since it came to the stretch of path between two rests that it is on. */
struct worth_since {
    uint32_t element; /* the first one of that */
    float spent_s;
    float rate; /* of nominal time where what was handed on last ends */
};

/* A curve gone along from rest: to a place of the route, or to rest at the chain's end. */
struct worth_far {
    double to_mm; /* MATHS_INFINITY: to rest */
    float time_s;
};

/* What they take; and those that are kept, with the rate of nominal time where these end. */
struct worth_run {
    float time_s;
    float kept_s;
    float rate;
};

/*
 * From rest, is the path itself quicker: to the chain's end, if that is known, or to the last place
 * in the window where it rests? to_mm: that place, or the next one where there is none.
 */
bool takt_worth_path_from_rest(const struct worth_window *now, const struct worth_far *curve,
                               double *to_mm);
/*
 * The pieces gone along at no higher rate than this where they begin, from rest: at any; to the end
 * of the last one.
 */
void takt_worth_run(const struct worth_window *now, float rate, struct worth_run *run);
/*
 * Is the path so much quicker to where the pieces end, with what has been taken on the first
 * stretch before, that a change is worth it?
 */
bool takt_worth_path(const struct worth_window *now, struct worth_since *since);

#endif
