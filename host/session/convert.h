/*
 * A program as another controller's: its canonical moves in the words of a dialect. Reading the
 * result in that dialect, from the same start and without offsets, gives the same moves again.
 */
#ifndef TAKT_HOST_CONVERT_H
#define TAKT_HOST_CONVERT_H

#include "dialect/dialect.h"
#include "program/move.h"

#include <stdio.h>

#define CONVERT_NUMBER_MAX 48

/* What has been written last: words that would say the same again are left out. */
struct convert {
    FILE *out;
    enum dialect dialect;
    unsigned axes;
    struct point at;
    char axis[AXIS_COUNT][CONVERT_NUMBER_MAX];
    char feed[CONVERT_NUMBER_MAX];
    enum plane plane;
    enum move_path path;
    double unit_mm; /* of the words being written */
    double tolerance_mm, merge_mm;
    bool per_revolution, surface, mist, flood;
};

void convert_open(struct convert *c, FILE *out, enum dialect dialect, unsigned axes,
                  const struct point *start);

/* NULL: it is written; else what of it the dialect has no words for. */
const char *convert_move(struct convert *c, const struct move *move);

/* Behind the last move. */
void convert_close(struct convert *c);

#endif
