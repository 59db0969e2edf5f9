/*
 * The trapezoidal reference: moves along the path with constant acceleration, no acceleration, or
 * constant deceleration, under a ceiling (plan/ceiling.h). The setpoint is its moving average and
 * follows behind it.
 *
 * Between accelerations of opposite sign it keeps its feed for a whole averaging window; then the
 * average's jerk is never more than acceleration / first box, on every setpoint, whatever the
 * operator does.
 *
 * Feeds are mm/cycle, accelerations mm/cycle2, positions path units.
 */
#ifndef TAKT_MOTION_REFERENCE_H
#define TAKT_MOTION_REFERENCE_H

#include "motion/landing.h"
#include "plan/ceiling.h"
#include "plan/ramp_profile.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * Ceilings that bind until the setpoint has left what they are made of: at most this many are told
 * apart.
 */
#define REFERENCE_LOW_MAX 32

/* Pieces that the trapezoidal reference comes to, or that are looked at, in one cycle at most. */
#define REFERENCE_PIECES_MAX 32

/* By their pieces: whose feed it is, and which of them the setpoint must have left. */
struct reference_low {
    uint16_t feed;
    uint16_t leave;
};

/* Where the trapezoidal reference is in a ceiling. */
struct reference_place {
    const struct ceiling *ceiling; /* NULL: none */
    uint32_t piece;      /* the ceiling's count: beyond its end. At a stop: the first behind it */
    bool late;           /* too fast for something that begins here and was not known before: */
    uint64_t late_start; /* it starts here for the setpoint, */
    double late_a;       /* and this acceleration still counts, as was promised */
    /*
     * from the setpoint's piece to the trapezoidal reference's, feeds rising: the first is the
     * lowest
     */
    uint32_t low_first, low_count;
    struct reference_low low[REFERENCE_LOW_MAX];
    double low_feed;    /* of the first */
    uint64_t low_leave; /* path position */
};

/* Does the trapezoidal reference halt at the end of every motion that it can come to rest in? */
enum reference_halting {
    REFERENCE_PASSES,    /* no */
    REFERENCE_SEEKS,     /* yes: at none that is known */
    REFERENCE_HALTS,     /* yes: it comes to rest at the one that has been found, and stays */
    REFERENCE_HALTS_ONCE /* not any more, but still at that one */
};

/* Where it halts: at the end of a motion in its span. */
struct reference_halt {
    enum reference_halting state;
    uint32_t block; /* the path's: those before it, in its span, end no motion ahead */
    uint64_t span;  /* where that span starts; another one than that it is in: none is known, */
    uint64_t end;   /* and that block ends */
    uint64_t left;  /* the last end that has been left again */
    double a;       /* mm/cycle2: the lowest of the blocks of the motion up to there */
};

enum reference_phase {
    REFERENCE_RUNS,   /* in a span */
    REFERENCE_STANDS, /* at a stop, or where the machine was switched on: between two spans */
    REFERENCE_LEAVES  /* likewise, and may leave it */
};

struct reference {
    enum ramp_profile profile;
    enum reference_phase phase;
    uint64_t at;
    uint64_t span;  /* where the span starts that has been begun last */
    uint64_t known; /* up to here it can follow the ceilings so far: what starts behind is new */
    uint64_t
        entered; /* where what the trapezoidal reference has come to last starts for the setpoint */
    double feed; /* at the end of the last cycle */
    double owed_mm;     /* what rounding has left so far */
    bool follows;       /* it can do all that the ceiling asks for */
    uint32_t cycles;    /* of the first averaging box, in this span */
    double window;      /* cycles that the averages reach over */
    int32_t since_plus; /* cycles since it sped up */
    /* and since it slowed down; -1: to rest where it was, and waits for a cycle more */
    int32_t since_minus;
    struct reference_place here;
    struct reference_place coming; /* in the next ceiling */
    uint64_t junction;             /* the next one to land on, where there is one */
    double landing_feed; /* as was promised for it, until it can come down to what is said now */
    struct landing_run run;
    struct reference_halt halt;
};

/* At rest at a position; takt_reference_release lets it leave. */
void takt_reference_init(struct reference *l, enum ramp_profile profile, uint64_t at);

/*
 * A new ceiling, over a path that reaches further or under other overrides. It is taken when the
 * trapezoidal reference's place in it has been found, some cycles later; until then the ceiling in
 * use and the new one stay as they are. Not taken is one that ends too early, for want of pieces.
 */
void takt_reference_set_ceiling(struct reference *l, const struct ceiling *ceiling);

/* Goes on taking it, once a cycle. True: it is not taken yet. */
bool takt_reference_find_place(struct reference *l);
static inline bool reference_take(struct reference *l)
{
    return l->coming.ceiling != NULL && takt_reference_find_place(l);
}

/* At rest, at a stop further on: what lay before it has been done by others. */
void takt_reference_stand(struct reference *l, uint64_t at);

/* At a stop, or may leave it. */
static inline bool reference_stands(const struct reference *l)
{
    return l->phase != REFERENCE_RUNS;
}

/* Has it found an end of a motion to halt at? */
static inline bool reference_halts(const struct reference *l)
{
    return l->halt.state >= REFERENCE_HALTS;
}

/* Does it look for them? */
static inline bool reference_seeks(const struct reference *l)
{
    return l->halt.state == REFERENCE_SEEKS || l->halt.state == REFERENCE_HALTS;
}

/* The stop at which everything stands has been served. */
void takt_reference_release(struct reference *l);

/* From now on it halts at the end of every motion that it can come to rest in; or it does not. */
void takt_reference_end_blocks(struct reference *l, bool on);
/* Is it at rest there? It stays until it is told that the setpoint has come. */
bool takt_reference_has_halted(const struct reference *l);
void takt_reference_leave_halt(struct reference *l);

/*
 * Could it be at a position, a little ahead, with this feed, mm/cycle, and meet what is ahead?
 * highest: at the highest overrides, else as they are.
 */
bool takt_reference_could_be(const struct reference *l, uint64_t at, double feed, bool highest);
/* Could it come to rest from there before another position, whatever the ceiling asks for? */
bool takt_reference_could_rest(const struct reference *l, uint64_t at, double feed, uint64_t end);
/*
 * It is there: the setpoint is moved by others (hold.h), to a position, and has had that feed for a
 * whole window but for one cycle, in which it keeps it: third differences reach over that many
 * more.
 */
void takt_reference_follow(struct reference *l, uint64_t at, double feed, uint64_t setpoint);

/*
 * A span that begins: the averages start anew from where the trapezoidal reference is, as if it had
 * always moved by step.
 */
struct reference_start {
    uint64_t at;
    uint64_t step; /* path units a cycle */
};

/*
 * One cycle. setpoint: where the setpoint was at the end of the last one. hold: come to rest and
 * stay. True when it begins a span, with l->cycles; start is then filled.
 */
bool takt_reference_step(struct reference *l, uint64_t setpoint, bool hold,
                         struct reference_start *start);

#endif
