/*
 * The control cycle: the path ahead and its feed ceiling in, one setpoint of every axis out, once a
 * cycle.
 *
 *     trapezoidal reference (reference.h) -> average (average.h) -> position on the path -> curve -> setpoint
 *
 * The cycle asks for a new ceiling every MOTION_EXCHANGE_CYCLES and takes the answer that many
 * cycles later, so that every build makes the same setpoints as long as its background is not later
 * than that.
 */
#ifndef TAKT_MOTION_MOTION_H
#define TAKT_MOTION_MOTION_H

#include "base/handoff.h"
#include "motion/average.h"
#include "motion/cycle_record.h"
#include "motion/hold.h"
#include "motion/reference.h"
#include "motion/watch.h"
#include "plan/ceiling.h"
#include "plan/path.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MOTION_EXCHANGE_CYCLES 16

enum motion_result {
    MOTION_CYCLE,   /* the record holds this cycle */
    MOTION_DONE,    /* the end of the program has been reached: no cycle was made */
    MOTION_NOT_YET, /* nothing has been planned yet: no cycle was made */
    MOTION_EMPTY,   /* everything has been done, but no end of program came: no cycle was made */
    MOTION_STALLED, /* the path is not gone on along, for no reason (watch.h): no cycle was made */
    /*
     * the axes stand where a block begins that follows the spindle (handover.h): no cycle was made
     */
    MOTION_HANDED_OVER
};

/* Blocks whose setpoints somebody else makes (handover.h): each level has all before it. */
enum motion_handover {
    MOTION_HANDS_OVER_NONE,         /* those that follow the spindle go at its commanded speed */
    MOTION_HANDS_OVER_SYNCHRONIZED, /* those that follow the spindle */
    MOTION_HANDS_OVER_LINEAR,       /* those in which no rotary axis moves, but probing moves */
    MOTION_HANDS_OVER_ALL           /* all but probing moves */
};

/* What moves the setpoint in a hold. */
enum motion_held {
    MOTION_NOT_HELD, /* the trapezoidal reference */
    MOTION_LOOKS,    /* likewise, and the hold looks whether it can */
    MOTION_HELD      /* the hold */
};

/*
 * Is the feed held? Each level has all before it. In any of them nothing that lies behind a stop is
 * passed; a tool change that has begun is finished.
 */
enum motion_hold {
    MOTION_GOES,
    MOTION_HOLD_ASKED, /* comes to rest on the path where the program lets it (M53), and stays */
    MOTION_HOLDS,      /* whatever the program says; a thread comes to its end first */
    MOTION_STOPS       /* in a thread too, which is not gone on with */
};

/* In which program stops does the cycle that passes them pass nothing behind? */
enum motion_obeys { MOTION_OBEYS_NONE, MOTION_OBEYS_M0, MOTION_OBEYS_M0_AND_M1 };

/* What the operator wants, in this cycle. */
struct motion_operator {
    double feed_ratio;  /* of programmed feeds, 0 ... BLOCK_OVERRIDE_MAX; 0 holds */
    double rapid_ratio; /* 0 ... 1; 0 holds rapids */
    enum motion_hold hold;
    enum motion_obeys obeys;
    bool single_block; /* every motion that it can still brake in ends at rest */
    bool wait;         /* does not leave a stop: the spindle has not reached its speed */
    bool settles;      /* does not pass one: what is sent has not come to it yet */
    bool tool_waits;   /* a tool change is not passed: the changer has not answered */
    bool measures; /* the spindle's speed, for feeds per revolution; else they are as commanded */
    double spindle_rev_s; /* >= 0; 0 holds them */
};

/*
 * A hold lies at the end of the averages' memory, and the pieces that it looks at where their
 * inputs leave room.
 */
#define MOTION_STORE_MAX                                                                           \
    ((sizeof(struct average) - offsetof(struct average, input) - sizeof(struct hold)) /            \
     sizeof(float))

struct motion_beside {
    uint8_t average[offsetof(struct average, input)];
    float store[MOTION_STORE_MAX];
    struct hold hold;
};

/* At the end of the oldest block; what is told of this cycle alone comes last. */
enum motion_end {
    MOTION_UNDER_WAY,
    MOTION_ARRIVED,      /* the next cycle passes it */
    MOTION_CHANGES_TOOL, /* this cycle stands at a tool change that is not passed */
    MOTION_STOPPED       /* this cycle has passed M0 or M1, and nothing behind it */
};

/* Who has the ceiling that is not in use: the cycle, but for the one that is wanted. */
enum motion_exchange {
    MOTION_CEILING_FREE,   /* or the background has answered that no other is needed */
    MOTION_CEILING_ASKED,  /* the background is told so as soon as there is room */
    MOTION_CEILING_WANTED, /* the background has it */
    MOTION_CEILING_BUILT   /* and has made it */
};

struct motion {
    double cycle_s;
    struct path *path;
    uint64_t cycles;       /* made so far */
    struct point at;       /* last commanded position */
    uint64_t setpoint;     /* where that is on the path, rounded down */
    double feed;           /* mm/cycle, of the setpoint */
    double feed_before[2]; /* likewise, in the two cycles before */
    double lag;            /* of the setpoint behind the trapezoidal reference, path units */
    enum motion_held held;
    enum motion_end end;
    /* this cycle does what few do: a block read, a span begun, a place in a ceiling looked for */
    bool busy;
    uint32_t current; /* the block of the last cycle */
    uint32_t ahead;   /* the block of the trapezoidal reference, when a ceiling was asked for */
    uint64_t rested;  /* cycles at rest since the last stop was landed on */
    uint64_t waited;  /* cycles of the wait that is being executed */
    /* the path's first before this cycle: blocks from there to first were passed in it */
    uint32_t passed_first;
    uint64_t late; /* exchanges for which no ceiling was ready */
    struct reference reference;
    union {
        struct average average;
        struct motion_beside beside;
    } mover;
    unsigned active;   /* the ceiling in use, of the path's two */
    uint32_t asked;    /* times the background has been asked for another one */
    uint32_t exchange; /* enum motion_exchange */
    struct ceiling_request request;
    uint64_t asked_leave; /* of the piece the trapezoidal reference was in then */
    /* what the ceiling in use was made for, and of how many blocks; feed_ratio 0: there is none */
    struct ceiling_request made;
    uint32_t made_closed;
    uint32_t restarts; /* of the path, so that no ceiling of an old one is taken */
    uint32_t asked_restarts;
    uint32_t built_restarts;
    enum motion_handover hands_over;
    bool ending; /* comes to rest where it is, and the rest of the path is dropped */
    struct watch watch;
};

/* start: where the machine stands. The path is read here, and passed; it must outlive m. */
void takt_motion_init(struct motion *m, struct path *path, const struct point *start,
                      bool proportional);

/*
 * Background: what a ceiling is asked for; NULL: none is. Until it has been made the path may
 * smooth motions.
 */
const struct ceiling_request *takt_motion_wanted(struct motion *m);
/* Background: makes it, from all blocks pushed so far. Needs takt_motion_wanted. */
void takt_motion_build(struct motion *m);
/*
 * Background: blocks that the path has beyond the trapezoidal reference's, as that was when a
 * ceiling was asked for.
 */
uint32_t takt_motion_ahead(struct motion *m);

/*
 * In a control cycle before the first of them: takes the first ceiling, if it is there, so that the
 * first need not.
 */
void takt_motion_prepare(struct motion *m);

/* One control cycle. Fills everything of the record but set, act and spindle_rev. */
enum motion_result takt_motion_cycle(struct motion *m, const struct motion_operator *wanted,
                                     struct cycle_record *record);

/*
 * The move that is executed ends where the axes come to rest from now on; all other blocks of the
 * path are dropped. The path goes on from there.
 */
void takt_motion_end_here(struct motion *m);

/* Did the setpoint stand at the end of the last cycle? */
bool takt_motion_rests(const struct motion *m);

/* Where the path is not gone on along: line of the program. After MOTION_STALLED. */
uint32_t takt_motion_stalled_line(const struct motion *m);

/*
 * Has there been a ceiling? Also for the background, between whose reads the cycle may end the
 * path: of that the count of restarts tells, last.
 */
static inline bool motion_has_ceiling(const struct motion *m)
{
    return m->reference.here.ceiling != NULL || m->reference.coming.ceiling != NULL ||
           handoff_get_count(&m->restarts) > 0;
}

/* Has everything on the path been done? */
bool takt_motion_is_idle(const struct motion *m);

/* Is a hold in a block obeyed? may_hold: as the program says (M53). */
static inline bool motion_is_held(const struct motion_operator *wanted, bool may_hold)
{
    return wanted->hold > MOTION_HOLD_ASKED || (wanted->hold != MOTION_GOES && may_hold);
}

/* Would a hold that is asked for be obeyed where the axes are? At a stop it always is. */
static inline bool motion_may_hold(const struct motion *m)
{
    const struct path *p = m->path;

    return p->first == p->closed || !path_at(p, p->first)->motion || path_at(p, p->first)->may_hold;
}

/* The block the last cycle executed. Valid until the next cycle. */
static inline const struct block *motion_block(const struct motion *m)
{
    return path_read(m->path, m->current);
}

#endif
