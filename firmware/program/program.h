/*
 * A part program being read: text in, canonical moves out, one at a time.
 *
 *     source (text) -> lexer -> expressions -> block of words -> modal state -> moves
 *
 * The caller owns struct program, the source and everything the configuration points to. Nothing is
 * kept of the text but the current line.
 */
#ifndef TAKT_PROGRAM_PROGRAM_H
#define TAKT_PROGRAM_PROGRAM_H

#include "base/error.h"
#include "base/point.h"
#include "program/move.h"
#include "program/parameters.h"
#include "program/source.h"
#include "program/tools.h"

#include <stdbool.h>
#include <stdint.h>

struct program;
struct program_modes;

/* What the interpreter must know of the machine and the session. Copied by takt_program_open. */
struct program_config {
    unsigned axes;                 /* bit i set: the machine has axis i (enum axis) */
    double travel_min[AXIS_COUNT]; /* machine coordinates, mm or rad */
    double travel_max[AXIS_COUNT];
    struct point start;         /* machine position the program starts at */
    double path_tolerance_mm;   /* G64 without P: this tolerance; 0 = exact */
    double spindle_max_rpm;     /* 0: no limit */
    bool spindle_encoder;       /* its angle is measured: threads can be cut */
    uint32_t from_line;         /* start in the middle, at this line; 0: at the beginning */
    uint32_t repeats_max;       /* lines that may be read again in all; 0: any number */
    uint32_t correction_layers; /* of position-error correction, for M120 and M121: 0 ... 8 */
    bool exact_path;            /* treat every G64 as G61 */
    bool block_delete;          /* skip lines that begin with '/' */
    bool waits;         /* PROGRAM_WAIT until takt_program_answer; else no contact, input 0 */
    bool sharp_corners; /* for the room offset: outer corners are not rounded */
    /*
     * NULL, or hears of every line that is executed but O-words, before anything else of it: its
     * comment, if it has one, is that of p->lexer. It changes nothing of p.
     */
    void (*say)(void *listener, const struct program *p);
    void *listener;
    const struct program_modes *modes; /* to go on with; NULL: those a program begins with */
    const struct tool_table *tools;    /* may be NULL: empty table */
    struct parameters *parameters;     /* numbered parameters, read and written; never NULL */
};

enum program_result {
    PROGRAM_MOVE,
    PROGRAM_END,
    PROGRAM_ERROR,
    PROGRAM_WAIT, /* nothing more is read until takt_program_answer */
    PROGRAM_LATER /* the text is still coming, and its next line has not come: ask again */
};

/* What #5399 is after M66 when its time is over. */
#define PROGRAM_INPUT_TIMED_OUT (-1.0)

/* What became of a MOVE_PROBE or a MOVE_INPUT; machine coordinates. */
struct program_answer {
    bool contact;            /* MOVE_PROBE: it ended by the probe */
    struct point contact_at; /* MOVE_PROBE: where the probe answered; without contact, rest_at */
    struct point rest_at;    /* MOVE_PROBE: where the axes came to rest */
    double value; /* MOVE_INPUT: 0 or 1, any of an analogue one, or PROGRAM_INPUT_TIMED_OUT */
};

#include "program/program_state.h"

/* Makes p ready to read source from its beginning. */
void takt_program_open(struct program *p, const struct program_config *config,
                       const struct source *source);

/*
 * The next canonical move into *move: PROGRAM_MOVE. After M2, M30 or the end of the text one
 * MOVE_END comes, then PROGRAM_END for ever. PROGRAM_ERROR: *diagnostic says what and where;
 * reading may go on with the next line (for `takt check`; modes are then as before the faulty
 * line).
 *
 * What follows a MOVE_PROBE or a MOVE_INPUT may depend on what becomes of it. With config.waits
 * PROGRAM_WAIT comes then, again and again, until takt_program_answer; without, the program goes on
 * as if the probing move had ended where it is programmed to, without contact, and the input were
 * 0.
 */
enum program_result takt_program_next(struct program *p, struct move *move,
                                      struct diagnostic *diagnostic);

/*
 * After the caller has run a MOVE_PROBE or a MOVE_INPUT, before the next move is asked for. Else it
 * does nothing.
 */
void takt_program_answer(struct program *p, const struct program_answer *answer);

/*
 * The tool is at *at, not where the program has left it: after a contour without a move that leaves
 * it. What the line being read still moves comes first. Before more is asked for.
 */
void takt_program_settle(struct program *p, const struct point *at);

/*
 * What the lines read so far leave for the next, also for another text that goes on with it, but
 * for cutter compensation. Valid as long as p.
 */
const struct program_modes *takt_program_get_modes(const struct program *p);

/*
 * Warnings since the last call (words read and ignored, H of an unknown tool): true and *diagnostic
 * while there are any. At most PROGRAM_WARNINGS_MAX are kept between calls; further ones are
 * dropped.
 */
bool takt_program_warning(struct program *p, struct diagnostic *diagnostic);

#endif
