/*
 * A part program being read: text in, canonical moves out, one at a time.
 *
 *     source (text) -> lexer -> expressions -> block of words -> modal state -> moves
 *
 * The caller owns struct program, the source and everything the configuration points to. Nothing is kept of the
 * text but the current line.
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

/* What the interpreter must know of the machine and the session. Copied by program_open. */
struct program_config {
    unsigned axes;                 /* bit i set: the machine has axis i (enum axis) */
    double travel_min[AXIS_COUNT]; /* machine coordinates, mm or rad */
    double travel_max[AXIS_COUNT];
    struct point start;             /* machine position the program starts at */
    double path_tolerance_mm;       /* G64 without P: this tolerance; 0 = exact */
    double spindle_max_rpm;         /* 0: no limit */
    uint32_t from_line;             /* start in the middle, at this line; 0: at the beginning */
    bool exact_path;                /* treat every G64 as G61 */
    bool block_delete;              /* skip lines that begin with '/' */
    bool sharp_corners;             /* for the room offset: outer corners are not rounded */
    const struct tool_table *tools; /* may be NULL: empty table */
    struct parameters *parameters;  /* numbered parameters, read and written; never NULL */
};

enum program_result { PROGRAM_MOVE, PROGRAM_END, PROGRAM_ERROR };

#include "program/program_state.h"

/* Makes p ready to read source from its beginning. */
void program_open(struct program *p, const struct program_config *config,
                  const struct source *source);

/*
 * The next canonical move into *move: PROGRAM_MOVE. After M2, M30 or the end of the text one MOVE_END comes, then
 * PROGRAM_END for ever. PROGRAM_ERROR: *diagnostic says what and where; reading may go on with the next line
 * (for `takt check`; modes are then as before the faulty line).
 */
enum program_result program_next(struct program *p, struct move *move,
                                 struct diagnostic *diagnostic);

/*
 * After the caller has run a MOVE_PROBE: where the probe answered, or the motion ended without an answer (contact
 * false), machine coordinates. Called before the next move is asked for; without it the program goes on as if the
 * motion had ended at its programmed end without contact.
 */
void program_set_probe(struct program *p, const struct point *at, bool contact);

/*
 * Warnings since the last call (words read and ignored, H of an unknown tool): true and *diagnostic while there
 * are any. At most PROGRAM_WARNINGS_MAX are kept between calls; further ones are dropped.
 */
bool program_warning(struct program *p, struct diagnostic *diagnostic);

#endif
