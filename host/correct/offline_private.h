/*
 * Shared by the sources of the offline way.
 */
#ifndef TAKT_HOST_OFFLINE_PRIVATE_H
#define TAKT_HOST_OFFLINE_PRIVATE_H

#include "correct/offline.h"

/* A growing text. */
struct offline_text {
    char *bytes; /* ends in zero; NULL: empty */
    size_t length, room;
    bool failed; /* out of memory */
};

void offline_text_add(struct offline_text *t, const char *bytes, size_t length);
__attribute__((format(printf, 2, 3))) void offline_text_print(struct offline_text *t,
                                                              const char *format, ...);
void offline_text_free(struct offline_text *t);

/* Moves of one execution of one line. */
#define OFFLINE_MOVES_MAX 4096

/* Pieces one move may become. */
#define OFFLINE_PIECES_MAX 16384

/* One execution of a line, while it is collected. */
struct offline_line {
    uint32_t line;          /* 0: none */
    uint32_t reading;       /* of the source, to tell two executions of a line apart */
    struct program context; /* the interpreter as it was: words and modes of the line */
    const char *raw;        /* the line's text, without its end */
    size_t raw_length;
    unsigned moves;
    struct move move[OFFLINE_MOVES_MAX];
};

/* What turns moves into words. */
struct offline_rewriter {
    struct correction correction;
    double tolerance_mm;
    unsigned axes;
    struct point at;                    /* end of the last motion, as programmed */
    struct point written;               /* where the written program is */
    const char *code;                   /* the motion code it is in; NULL: not known */
    double reference_mm[2][AXIS_COUNT]; /* G28, G30: machine coordinates, before the program */
    struct offline_totals totals;
    const char *wrong; /* NULL: nothing is */
    uint32_t wrong_line;
};

/*
 * The text that takes the place of the line, without the end of its last line. False: r->wrong is
 * set.
 */
bool offline_rewrite_line(struct offline_rewriter *r, const struct offline_line *line,
                          struct offline_text *text);

/* Does the line that has been read take over where the machine stands (G92, G10 L20 ...)? */
bool offline_is_setting(const struct program *p);

/* The part is set up: what follows is corrected by it (MOVE_SETUP). */
void offline_set_up(struct offline_rewriter *r, const struct move *move);

/* ---- cutting words out of the line ---- */

/* Which bytes of the line go; the place of the first of them gets the new words. */
struct offline_cuts {
    bool gone[PROGRAM_LINE_MAX + 2];
    size_t first; /* the line's length: none is gone */
};

void offline_cuts_init(struct offline_cuts *cuts, const struct offline_line *line);
/* Words by their letters: bits as in program/words.h. */
void offline_cut_letters(struct offline_cuts *cuts, const struct offline_line *line,
                         uint32_t letters);
/* The code of a step, if the line has one. */
void offline_cut_code(struct offline_cuts *cuts, const struct offline_line *line, enum step step);
/* What is left of the line, with new words (" X1 Y2") in the place of the old ones. */
void offline_print_kept(const struct offline_line *line, const struct offline_cuts *cuts,
                        const char *words, struct offline_text *text);

struct offline_piece;

/* ---- cycles: lines whose moves are written out one by one ---- */

bool offline_is_cycle(const struct offline_line *line);
/* Is it an event that cycles make between their motions? */
bool offline_is_cycle_event(const struct move *move);
bool offline_rewrite_cycle(struct offline_rewriter *r, const struct offline_line *line,
                           struct offline_piece *pieces, struct offline_text *text);

/* ---- what the forms of lines have in common ---- */

/* The stop at the end of the line (M0, M1, M2, M98 ...), to be put on a text line of its own. */
void offline_cut_stop(struct offline_cuts *cuts, const struct offline_line *line);
void offline_print_stop(const struct offline_line *line, struct offline_text *text);
/*
 * A motion that stands alone: "\n" and code and words of each piece, from the first one given on.
 */
void offline_print_pieces(struct offline_rewriter *r, const struct offline_line *line,
                          const struct move *move, const struct offline_piece *pieces,
                          unsigned first, unsigned n, struct offline_text *text);

/* ---- words of the pieces of a move, one text line each ---- */

struct offline_piece {
    struct point end;      /* corrected, as it will be read */
    double share;          /* of the motion's length */
    bool straight;         /* of an arc or an involute that only lines can follow */
    double centre_mm[2];   /* arcs, and the base circle of involutes */
    double base_radius_mm; /* involutes */
    double pitch_mm;       /* threads: per revolution */
};

/*
 * Divides a motion into pieces that keep the tolerance. Returns how many; 0: r->wrong is set.
 * Threads stay whole, since a controller begins each of their blocks anew; r->totals tells how far
 * that leads off.
 */
unsigned offline_divide(struct offline_rewriter *r, const struct move *move,
                        struct offline_piece pieces[OFFLINE_PIECES_MAX]);

/* The words of a setting by position: as given, and by what the written program stands off. */
void offline_print_setting(const struct offline_rewriter *r, const struct offline_line *line,
                           struct offline_text *text);

/*
 * " X1.5 Y2 ..." for a piece that begins at r->written, which becomes its end as it will be read.
 */
void offline_print_words(struct offline_rewriter *r, const struct offline_line *line,
                         const struct move *move, const struct offline_piece *piece,
                         struct offline_text *text);

#endif
