/*
 * What a block is executed by, in as few bytes as it takes: its move and its curve.
 *
 *     head | end | start, where that is not where the block before ends | what the kind of move needs
 *
 * A point takes 8 bytes for each coordinate that is not 0. What can be found again to the last bit
 * is left out: a line and an arc are made of their move anew, and a piece of a smoothed curve
 * shares three of its four control points with the piece before. What has been planned with and is
 * of no use to who executes a move, such as its tolerance, is not kept: it is read back as 0.
 * Records have the same size in every build: when a ring of them is full decides how far is
 * planned.
 */
#ifndef TAKT_PLAN_RECORD_H
#define TAKT_PLAN_RECORD_H

#include "plan/block.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * Bytes of a record at most: an involute of six axes with start, end and a feed per revolution
 * takes 314.
 */
#define RECORD_MAX 320

/*
 * Without pieces of involutes, splines and smoothed curves: an arc of six axes with start, end and
 * turns takes 133.
 */
#define RECORD_SHORT_MAX 136

/* Control points that a piece shares with those before it: this many records back must be kept. */
#define RECORD_BEFORE 3

/* What many blocks in a row have in common. No padding: compared as bytes. */
struct record_modes {
    double piece_mm; /* length of a piece of a smoothed curve; 0: no such piece */
    float work_mm[AXIS_LINEAR_COUNT];
    float overhang_mm[AXIS_LINEAR_COUNT];
    uint32_t tool;
    uint16_t line_high; /* the upper halves of line and number: records have the lower ones */
    uint16_t number_high;
    uint8_t overrides;
    uint8_t path;
    uint8_t plane;
    uint8_t correction_off;
    uint8_t contour_side;
    uint8_t none[3];
};

/*
 * The same bits? What is remade from a record is to be what it was, 0 and -0 too. Of what has no
 * padding.
 */
bool takt_record_is_same(const void *a, const void *b, size_t size);

/* Modes of a block; smooth: it is a piece of a smoothed curve. */
void takt_record_modes_of(const struct block *b, bool smooth, struct record_modes *modes);

/* What the record before leaves for the next one; infinite: nothing. */
struct record_chain {
    struct point end;                    /* where its block ends */
    struct point control[RECORD_BEFORE]; /* the last ones of a piece of a smoothed curve */
};

/* Before the first record. */
void takt_record_begin_chain(struct record_chain *chain);

/*
 * Writes the record of a block; control: of a piece of a smoothed curve, else NULL. modes: by which
 * number its modes are kept. Returns the bytes it takes, <= RECORD_MAX, and tells what it leaves
 * for the next one.
 */
uint32_t takt_record_write(uint8_t bytes[RECORD_MAX], const struct block *b,
                           const struct point control[4], unsigned modes,
                           struct record_chain *chain);

/* Parts of records that are needed alone. */
enum move_kind takt_record_kind(const uint8_t *record);
unsigned takt_record_modes_number(const uint8_t *record);
/* Path for a revolution; 0: the feed does not follow the spindle. */
double takt_record_feed_rev(const uint8_t *record);
void takt_record_set_governor(uint8_t *record, enum governor governor);

/* The move, but for its feed and what only planning needs: that is 0. */
void takt_record_read_move(const uint8_t *record, const struct record_modes *modes,
                           struct move *move);

/*
 * Number, move, curve, and what governs the feed of a block, in four parts, so that a control cycle
 * need not do all: the first returns what the second goes on with; the third tells whether it had
 * anything to do. before: the records of the RECORD_BEFORE blocks before it, the nearest first;
 * NULL where there is none. All else of the block stays as it was.
 */
const uint8_t *takt_record_begin(const uint8_t *record, const struct record_modes *modes,
                                 struct block *b);
void takt_record_take(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                      const uint8_t *from, struct block *b);
/* The control points of a piece of a smoothed curve. */
void takt_record_control(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                         struct point control[4]);
bool takt_record_begin_curve(const uint8_t *record, struct block *b);
void takt_record_finish(const uint8_t *record, struct block *b);

#endif
