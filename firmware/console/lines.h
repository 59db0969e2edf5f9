/*
 * The text of a console on its way to the controller: whole lines in a ring that the caller owns.
 *
 *     console   puts bytes, releases lines to the program, collects what became of them, in order
 *     program   reads released lines, one after the other; asking for the next one is the answer to the last
 *
 * These two may be two threads. Every line stands in the ring behind a mark, where its answer is
 * put: so there is no list of answers, and no line without one.
 *
 *     collected    read       released    written   at
 *     ----|---------|-------------|----------|-------|----
 *         answered  being done    waits for the console
 */
#ifndef TAKT_CONSOLE_LINES_H
#define TAKT_CONSOLE_LINES_H

#include "base/error.h"
#include "program/source.h"

#include <stdbool.h>
#include <stdint.h>

/* Longest line without its end: that of a program. */
#define LINES_LENGTH_MAX 256

/* Mark of a line that has been done: the number of its error, 0: none. Else: */
enum lines_mark {
    LINES_NEW = 0xff,  /* not done yet */
    LINES_OWN = 0xfe,  /* the console has answered it */
    LINES_LONG = 0xfd, /* more than LINES_LENGTH_MAX characters, which are not kept */
    LINES_MARKS = 0xf0 /* marks are above, errors below */
};

/* Read and written as a whole by two threads. */
struct lines_place {
    uint32_t value;
};

struct lines_flag {
    bool value;
};

struct lines {
    uint8_t *byte; /* the caller's, size of them: a power of two */
    uint32_t size;
    /* The console's. Places count bytes and wrap. */
    uint32_t at;      /* behind the last byte of the line that comes */
    uint32_t written; /* behind the last whole line */
    uint32_t collected;
    uint32_t last; /* the line collected last */
    bool is_long;  /* the line that comes */
    /* Between the two: read and written as a whole, in order. */
    struct lines_place released; /* the program may read as far as this */
    struct lines_place read;     /* it has done with all before this */
    struct lines_flag active;    /* a program reads */
    struct lines_flag ends;      /* what is released is all there is */
    struct lines_flag has_why;   /* why has been filled, and not been taken */
    uint32_t why_at;             /* the line that it is of */
    struct diagnostic why;
    /* The program's. */
    bool is_handed;           /* the line at read has been handed out, up to out */
    uint32_t out, end;        /* and ends here */
    uint8_t answer;           /* of it */
    struct lines_place cause; /* enum takt_error: why the program failed; TAKT_OK: it did not */
};

void takt_lines_init(struct lines *l, uint8_t *byte, uint32_t size);

/* ---- console ---- */

/* Bytes of text that find room; each of its lines may be as short as its end. */
uint32_t takt_lines_room(const struct lines *l);
/* The same while nothing is there: what a sender may count on. */
uint32_t takt_lines_capacity(const struct lines *l);
/* A byte of a line, which ends with '\n'. False: no room, it is lost. */
bool takt_lines_put(struct lines *l, uint8_t byte);
/* Bytes have been lost before the next one: their line is refused as one that is too long. */
void takt_lines_spoil(struct lines *l);
/* Drops everything; no program reads. */
void takt_lines_clear(struct lines *l);

/*
 * The first line not released, without its end, into text[LINES_LENGTH_MAX + 1]; its mark. 0: there
 * is none.
 */
uint8_t takt_lines_look(const struct lines *l, char *text);
void takt_lines_release(struct lines *l);
/* The console has answered that line itself. */
void takt_lines_skip(struct lines *l);
/* Lines that are released and that no program has read are not; no program reads. */
void takt_lines_take_back(struct lines *l);
/* The next line that is done: its text as above and its answer. False: none is. */
bool takt_lines_collect(struct lines *l, char *text, uint8_t *answer);
/* Why the line collected last has been refused; TAKT_OK: not known. */
void takt_lines_take_why(struct lines *l, struct diagnostic *why);

/* A program reads the lines. */
bool takt_lines_are_read(const struct lines *l);
/* No more are released: the program ends when it has read those that are. */
void takt_lines_finish(struct lines *l);
bool takt_lines_are_finished(const struct lines *l);
/* Why the last program has failed; TAKT_OK: it has not. */
enum takt_error takt_lines_get_cause(const struct lines *l);

/* ---- program ---- */

/* A source of the lines that are released. */
void takt_lines_open(struct lines *l, struct source *source);
/* The line handed out last is not done. */
void takt_lines_refuse(struct lines *l, uint8_t answer, const struct diagnostic *why);
/* Nothing reads any more; the line handed out last has this answer, if it has none yet. */
void takt_lines_end(struct lines *l, uint8_t answer, enum takt_error cause);

#endif
