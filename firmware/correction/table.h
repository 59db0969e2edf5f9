/*
 * A correction table as it is measured, written and stored: points of a grid over up to four axes,
 * and at each of them what is to be added to the commanded coordinates.
 *
 * A table over one axis may tell the two directions of approach apart. Rows are in the order of the
 * file: the first input changes fastest.
 */
#ifndef TAKT_CORRECTION_TABLE_H
#define TAKT_CORRECTION_TABLE_H

#include "base/error.h"
#include "base/point.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TABLE_INPUTS_MAX  4
#define TABLE_OUTPUTS_MAX 12

/*
 * Points along one input, and numbers in the whole table. A build with little memory may have fewer
 * numbers.
 */
#define TABLE_KNOTS_MAX 256
#ifndef TABLE_VALUES_MAX
#define TABLE_VALUES_MAX 16384
#endif

/* For which direction of approach a column holds. Up: the axis moves towards larger positions. */
enum table_direction { TABLE_BOTH, TABLE_UP, TABLE_DOWN };

struct table_output {
    uint8_t axis;      /* enum axis: the coordinate that is corrected */
    uint8_t direction; /* enum table_direction; not TABLE_BOTH: its counterpart is another output */
};

struct table {
    uint8_t inputs, outputs;
    bool errors;                      /* of a unit (geometry.h), of which nothing is to be added */
    uint8_t input[TABLE_INPUTS_MAX];  /* enum axis */
    uint16_t knots[TABLE_INPUTS_MAX]; /* points along each input, 2 ... TABLE_KNOTS_MAX */
    struct table_output output[TABLE_OUTPUTS_MAX];
    double knot_mm[TABLE_INPUTS_MAX][TABLE_KNOTS_MAX]; /* mm or rad, increasing */
    float value_mm[TABLE_VALUES_MAX]; /* K, mm or rad: row by row, outputs side by side */
};

/* What a table must keep to. */
struct table_rules {
    unsigned axes;         /* bit i set: the machine has axis i */
    double largest_mm;     /* |K|, mm or rad */
    double steepest_ratio; /* |difference of K between neighbours| / their distance */
};

uint32_t takt_table_rows(const struct table *table);

/*
 * All that can be wrong with numbers: axes, order, even steps of grids, magnitude, slope. False:
 * *wrong has the first cell that breaks a rule in its word ("X 150 Y 40: KZ"); its line is 0.
 */
bool takt_table_check(const struct table *table, const struct table_rules *rules,
                      struct diagnostic *wrong);

/*
 * Writes "X 150 Y 40: KZ" for a cell, "X 150 Y 40" when output is not below table->outputs.
 * Zero-terminated.
 */
void takt_table_name_cell(const struct table *table, uint32_t row, unsigned output,
                          char name[DIAGNOSTIC_WORD_MAX + 1]);

#endif
