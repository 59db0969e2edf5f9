/*
 * O-words: the label and the keyword that a line of flow control begins with.
 */
#ifndef TAKT_PROGRAM_OWORD_H
#define TAKT_PROGRAM_OWORD_H

#include "program/program.h"

enum oword_kind {
    OWORD_PROGRAM, /* a label alone: a numbered program */
    OWORD_SUB,
    OWORD_ENDSUB,
    OWORD_RETURN,
    OWORD_CALL,
    OWORD_IF,
    OWORD_ELSEIF,
    OWORD_ELSE,
    OWORD_ENDIF,
    OWORD_WHILE,
    OWORD_ENDWHILE,
    OWORD_DO,
    OWORD_REPEAT,
    OWORD_ENDREPEAT,
    OWORD_BREAK,
    OWORD_CONTINUE,
    OWORD_GOTO,
    OWORD_M98, /* no O-words, but calls like them */
    OWORD_M99
};

struct oword {
    enum oword_kind kind;
    struct program_label label; /* its name stays for the line; takt_oword_keep */
    uint32_t line;              /* where it stands */
    uint16_t column;
};

/*
 * True when the line is an O-word, after an N and its number perhaps; the lexer is then behind the
 * O.
 */
bool takt_oword_begins(struct program *p);

/* Reads label and keyword. False: p->error is set. */
bool takt_oword_read(struct program *p, struct oword *o);

/* Nothing but what has been read may stand on an O-word's line. */
bool takt_oword_finish(struct program *p, const struct oword *o);

/*
 * The label stays for as long as a block or a subroutine has it. False: no room, p->error is set.
 */
bool takt_oword_keep(struct program *p, struct oword *o);

static inline bool oword_same_label(const struct program_label *a, const struct program_label *b)
{
    return a->id == b->id;
}

/* Sets p->error about an O-word, by label and keyword ("O100 ENDIF"). Returns false. */
bool takt_oword_error(struct program *p, enum takt_error code, const struct oword *o, double value);

#endif
