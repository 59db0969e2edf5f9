/*
 * The feed ceiling ahead: what the trapezoidal reference may do where, made of blocks for one
 * setting of the overrides.
 *
 *    feed |  ____                    ____________      pieces end to end, each with a ceiling, an acceleration and the
 *         |      \      ____________/            \     feed at its end from which everything after it can be met
 *         |       \____/                          \    (a line in feed squared: constant deceleration)
 *         +------------------------------------------> path position
 *
 * Positions are those of the trapezoidal reference: a slow stretch begins for it as much earlier as
 * the setpoint follows behind, at the feed that the overrides allow; a lower acceleration counts
 * from where the block's highest feed would begin on, so that no override changes how hard the
 * trapezoidal reference may brake anywhere. Units here are mm and control cycles: feeds mm/cycle,
 * accelerations mm/cycle2. See spans.md.
 */
#ifndef TAKT_PLAN_CEILING_H
#define TAKT_PLAN_CEILING_H

#include <stdbool.h>
#include <stdint.h>

/*
 * Pieces of one ceiling at most. A block has one or two, and neighbours of the same limits share
 * one. Where this is not enough the ceiling is not complete: it ends at rest before the last
 * blocks. With 272 a smoothed spiral takes 0.3 % longer, with 288 0.08 %, with 304 none that was
 * tried.
 */
#define CEILING_PIECES_MAX 288

/* No piece. */
#define CEILING_NONE 511U

/*
 * Cycles beside half a window by which a ceiling begins earlier: differences of setpoints reach
 * over three cycles.
 */
#define CEILING_MARGIN_CYCLES 2.0

/*
 * What the operator may do in a piece: hold, override the feed or the rapids; and its feed follows
 * the spindle.
 */
#define CEILING_HOLD    1U
#define CEILING_FEED    2U
#define CEILING_RAPID   4U
#define CEILING_SPINDLE 8U

/* What a piece ends with. */
enum ceiling_end {
    CEILING_GOES_ON, /* another one of its span */
    CEILING_STOPS,   /* the span, where the setpoint leaves the piece */
    CEILING_LANDS    /* likewise, and a setpoint falls there in motion */
};

/*
 * Small, since two ceilings of all pieces are kept: limits are of single precision, not above the
 * exact ones, and what can be met is kept as a feed, not as its square. Feeds are mm/s here, so
 * that one that is programmed is exact; ceiling_feed() makes them mm/cycle.
 */
struct ceiling_piece {
    float feed_mm_s;     /* not above this in the piece, nor until the setpoint has left it */
    float acceleration;  /* mm/cycle2, also of braking */
    float end_feed_mm_s; /* at the end, from which all that follows can be met */
    /* this at the highest override; of a landed junction the highest feed there */
    float end_feed_max_mm_s;
    unsigned start : 9; /* block that it begins with, from the ceiling's first on */
    unsigned
        leave : 9; /* the one behind those of this feed, at whose start the setpoint leaves it */
    unsigned
        landing : 9;    /* first landed junction in or after it; CEILING_NONE: a stop comes first */
    unsigned opens : 1; /* what was not there before begins: a block, or the way to the junction */
    unsigned end : 2;   /* enum ceiling_end */
    unsigned lowest : 1; /* no end_feed is lower from here to the last but one before landing */
};

struct path;

struct ceiling {
    const struct path *path;
    double cycle_s;
    uint32_t first;  /* block of the path */
    uint64_t origin; /* path position: its start */
    uint32_t behind; /* the block behind those that it is made of */
    uint32_t count;
    uint32_t
        open_from; /* from this piece on the span goes on beyond what is known; count: none does */
    double end_mm[CEILING_PIECES_MAX]; /* where pieces end, from the origin */
    struct ceiling_piece piece[CEILING_PIECES_MAX];
};

/* A feed of its pieces, mm/cycle. */
static inline double ceiling_feed(const struct ceiling *c, float feed_mm_s)
{
    return (double)feed_mm_s * c->cycle_s;
}

/* What a ceiling is made for. */
struct ceiling_request {
    uint32_t first;       /* block to begin with */
    uint64_t reference;   /* where the trapezoidal reference is */
    uint64_t span;        /* where the span starts that it has begun last */
    uint32_t cycles;      /* of the first averaging box in that span */
    double feed_ratio;    /* override of programmed feeds, 0 < ratio <= BLOCK_OVERRIDE_MAX */
    double rapid_ratio;   /* likewise of rapids, <= 1 */
    double spindle_rev_s; /* > 0: as measured, for feeds per revolution; 0: as commanded */
    bool proportional;    /* scale the whole diagram instead of the programmed feed alone */
};

/*
 * The ceiling over the closed blocks of the path, from the first that is asked for on. It ends at
 * rest. Notes the windows of spans in their blocks: the trapezoidal reference may begin a span
 * under the ceiling that was made before.
 */
void takt_ceiling_build(struct ceiling *c, struct path *path,
                        const struct ceiling_request *request);

/*
 * Control cycle: where on the path the setpoint comes to what a piece is made of; where it leaves
 * it: path.h. Of what it had left when a ceiling was asked for last: where the block started that
 * it was in.
 */
uint64_t takt_ceiling_start(const struct ceiling *c, uint32_t k);

/* The highest feed whatever the overrides are, of what a piece begins with, mm/s. */
float takt_ceiling_top_feed(const struct ceiling *c, uint32_t k);

/*
 * Control cycle: what the operator may do in a piece, CEILING_...: as in the last block that it is
 * made of.
 */
unsigned takt_ceiling_overrides(const struct ceiling *c, uint32_t k);

/* Cycles of the first averaging box in the span that begins with a piece. */
uint32_t takt_ceiling_cycles(const struct ceiling *c, uint32_t k);

/* Feed ceiling of one block under a request, mm/s. */
double takt_ceiling_block_feed(const struct path *path, uint32_t index,
                               const struct ceiling_request *request);

/*
 * Acceleration of the trapezoidal reference in it, by the first averaging box: A tau^2, or J tau^3
 * N; mm/cycle2, single precision.
 */
double takt_ceiling_block_acceleration(const struct path *path, uint32_t index, uint32_t cycles);

#endif
