/*
 * Shared by the sources of the offline way.
 */
#ifndef TAKT_HOST_OFFLINE_PRIVATE_H
#define TAKT_HOST_OFFLINE_PRIVATE_H

#include "takt/offline.h"

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
#define OFFLINE_PIECES_MAX 4096

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
    struct point at;      /* end of the last motion, as programmed */
    struct point written; /* where the written program is */
    struct offline_totals totals;
    const char *wrong; /* NULL: nothing is */
    uint32_t wrong_line;
};

/* The text that takes the place of the line, without the end of its last line. False: r->wrong is set. */
bool offline_rewrite_line(struct offline_rewriter *r, const struct offline_line *line,
                          struct offline_text *text);

/* ---- words of the pieces of a move, one text line each ---- */

struct offline_piece {
    struct point end; /* corrected, as it will be read */
    bool arc;
    double centre_mm[2];
};

/* Divides a motion into pieces that keep the tolerance. Returns how many; 0: r->wrong is set. */
unsigned offline_divide(struct offline_rewriter *r, const struct move *move,
                        struct offline_piece pieces[OFFLINE_PIECES_MAX]);

/* " X1.5 Y2 ..." for a piece that begins at r->written. */
void offline_print_words(const struct offline_rewriter *r, const struct offline_line *line,
                         const struct move *move, const struct offline_piece *piece,
                         struct offline_text *text);

#endif
