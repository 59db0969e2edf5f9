/*
 * The feed ceiling ahead: what the lead point may do where, made of blocks for one setting of the overrides.
 *
 *    feed |  ____                    ____________      pieces end to end, each with a ceiling, an acceleration and the
 *         |      \      ____________/            \     feed at its end from which everything after it can be met
 *         |       \____/                          \    (a line in feed squared: constant deceleration)
 *         +------------------------------------------> path position
 *
 * Positions are those of the lead point: a slow stretch begins for it as much earlier as the setpoint follows behind.
 * Units here are mm and control cycles: feeds mm/cycle, accelerations mm/cycle2. See spans.md.
 */
#ifndef TAKT_PLAN_CEILING_H
#define TAKT_PLAN_CEILING_H

#include "plan/path.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Pieces of one ceiling at most. A block has one or two, and neighbours of the same limits share one. Where this is not
 * enough the ceiling is not complete: it ends at rest before the last blocks. With 256 some programs take 0.2 % longer,
 * with 384 none that was tried.
 */
#define CEILING_PIECES_MAX 384

#define CEILING_NONE UINT16_MAX

/* Cycles beside half a window by which a ceiling begins earlier: differences of setpoints reach over three cycles. */
#define CEILING_MARGIN_CYCLES 2.0

/* Bit beside OVERRIDE_...: the rapid override counts here. */
#define CEILING_RAPID 256U
/* Likewise: the feed is per revolution of the spindle. */
#define CEILING_SPINDLE 512U

struct ceiling_piece {
    double end_mm; /* from the origin */
    double
        feed; /* mm/cycle: not above this in the piece, nor until the setpoint has passed leave */
    double acceleration; /* mm/cycle2, also of braking */
    double
        end_energy; /* mm2/cycle2: feed squared at the end from which all that follows can be met */
    /* the same two at the highest override, or coming to rest before what follows: a promise, see spans.md */
    double feed_max;
    double end_energy_max;
    /* the lowest end_energy, and end_energy_max, from this piece to the last but one before the joint of landing */
    float way_energy, way_energy_max;
    int64_t start; /* path units from the origin: where the setpoint comes to what it is made of */
    int64_t leave; /* and leaves it */
    uint16_t cycles; /* of the first averaging box, in this span */
    uint16_t
        landing; /* the first landed joint in or after this piece, CEILING_NONE: a stop comes first */
    uint16_t overrides; /* what the operator may do here: OVERRIDE_..., or CEILING_RAPID */
    bool opens : 1;  /* what was not there before begins: a block, or the way to a landed joint */
    bool stop : 1;   /* the span ends with this piece, at leave */
    bool landed : 1; /* the span ends with this piece, at leave, where a setpoint falls in motion */
};

struct ceiling {
    uint64_t origin; /* path position */
    bool complete;   /* reaches to the end of all blocks that were known */
    uint32_t count;
    uint32_t
        open_from; /* from this piece on the span goes on beyond what is known; count: none does */
    struct ceiling_piece piece[CEILING_PIECES_MAX];
};

/* What a ceiling is made for. */
struct ceiling_request {
    uint32_t first;       /* block to begin with */
    uint64_t lead;        /* where the lead point is */
    uint64_t span;        /* where the span starts that it has begun last */
    uint32_t cycles;      /* of the first averaging box in that span */
    double feed_ratio;    /* override of programmed feeds, 0 < ratio <= BLOCK_OVERRIDE_MAX */
    double rapid_ratio;   /* likewise of rapids, <= 1 */
    double spindle_rev_s; /* > 0: as measured, for feeds per revolution; 0: as commanded */
    bool proportional;    /* scale the whole diagram instead of the programmed feed alone */
    bool stops;           /* every motion ends at rest, from this block on */
    uint32_t stops_from;
};

/*
 * The ceiling over the closed blocks of the path, from the first that is asked for on. It ends at rest. Notes the windows
 * of spans in their blocks: the lead point may begin a span under the ceiling that was made before.
 */
void ceiling_build(struct ceiling *c, struct path *path, const struct ceiling_request *request);

/* Does a block of the path end at rest? */
bool ceiling_stops(const struct ceiling_request *request, const struct path *path, uint32_t index);

/* Feed ceiling of one block under a request, mm/s. */
double ceiling_block_feed(const struct path *path, uint32_t index,
                          const struct ceiling_request *request);

#endif
