/*
 * Parts of a record (record.h): each is put at a place that moves on, and taken from there again
 * with the same bits. What is taken counts on what the move or block holds by then: its kind.
 */
#ifndef TAKT_PLAN_RECORD_PARTS_H
#define TAKT_PLAN_RECORD_PARTS_H

#include "plan/block.h"

#include <stdbool.h>
#include <stdint.h>

/* Coordinates that are not 0: which ones is returned as bits, and given to take them again. */
unsigned takt_record_put_coordinates(uint8_t **to, const struct point *p);
void takt_record_take_coordinates(const uint8_t **from, unsigned axes, struct point *p);

/* The same with those bits in front. */
void takt_record_put_point(uint8_t **to, const struct point *p);
void takt_record_take_point(const uint8_t **from, struct point *p);

/* What events have, which no motion has. */
void takt_record_put_event(uint8_t **to, const struct move *m);
void takt_record_take_event(const uint8_t **from, struct move *m);

/* Has it a centre? */
static inline bool record_is_round(const struct move *m)
{
    return move_is_arc(m) || move_is_involute(m);
}

/* What kinds of motion have beside their ends. has_turns: of an arc, they are not 1. */
void takt_record_put_shape(uint8_t **to, const struct move *m);
void takt_record_take_shape(const uint8_t **from, bool has_turns, struct move *m);

/* A piece of an involute, which is costly to cut again. */
void takt_record_put_involute(uint8_t **to, const struct block *b);
void takt_record_take_involute(const uint8_t **from, struct block *b);

#endif
